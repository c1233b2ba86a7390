//! What a file says about its picture beside the pixels.

/// What a file says about itself. A format leaves out what it has no place for; PFM has none at all.
///
/// `docs/images.md` says where each format holds what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Metadata {
    /// The program that made it.
    pub software: String,
    /// What the picture shows: the scene's name; may be empty.
    pub title: String,
    /// How the picture was made, in ASCII on one line: see [`Provenance`](crate::provenance::Provenance).
    pub provenance: Option<String>,
    /// Pixels to the inch in print.
    pub dpi: Option<u16>,
    /// Where the picture lies in a larger one of which it is a part.
    pub window: Option<Window>,
}

/// Where a picture lies in a larger one. In pixels; (0, 0) is the top left one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The larger picture's column that is the first one here.
    pub x: u32,
    /// Its row that is the first one here.
    pub y: u32,
    /// Columns of the larger picture.
    pub width: u32,
    /// Rows of the larger picture.
    pub height: u32,
}

impl Default for Metadata {
    fn default() -> Self {
        Self {
            software: concat!("Lancer ", env!("CARGO_PKG_VERSION")).to_owned(),
            title: String::new(),
            provenance: None,
            dpi: None,
            window: None,
        }
    }
}

impl Metadata {
    /// Pixels to the metre, as PNG counts them.
    pub(super) fn pixels_per_metre(&self) -> Option<u32> {
        // An inch is 0.0254 m.
        self.dpi.map(|dpi| (f64::from(dpi) / 0.0254).round() as u32)
    }
}
