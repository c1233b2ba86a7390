//! The colours of what is drawn over the picture.
//!
//! The picture below may have any colour. Lines therefore come with a casing, a wider and softer line of the opposite
//! lightness below them: what is lost on one part of a picture is told by the other.

/// sRGB.
pub(super) type Color = [u8; 3];

/// The colours for a dark or a light theme.
#[derive(Clone, Copy, Debug)]
pub(super) struct Palette {
    /// Below each line.
    pub(super) casing: Color,
    pub(super) grid: Color,
    /// X, Y and Z.
    pub(super) axes: [Color; 3],
    pub(super) light: Color,
    pub(super) selection: Color,
    pub(super) tree: Color,
    pub(super) interest: Color,
}

impl Palette {
    /// Bright lines on dark casings.
    const DARK: Self = Self {
        casing: [12, 14, 18],
        grid: [226, 231, 240],
        axes: [[255, 92, 97], [126, 211, 70], [84, 150, 255]],
        light: [255, 214, 92],
        selection: [255, 158, 44],
        tree: [92, 222, 205],
        interest: [255, 255, 255],
    };

    /// Dark lines on bright casings.
    const LIGHT: Self = Self {
        casing: [255, 255, 255],
        grid: [32, 38, 50],
        axes: [[212, 32, 44], [38, 136, 18], [24, 88, 216]],
        light: [176, 116, 0],
        selection: [226, 96, 0],
        tree: [0, 122, 112],
        interest: [16, 20, 28],
    };

    pub(super) fn of_theme(dark: bool) -> &'static Self {
        if dark { &Self::DARK } else { &Self::LIGHT }
    }
}
