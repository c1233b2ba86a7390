//! S as a function of the texture coordinates.

use crate::color::{Rgb, srgb_to_linear};
use crate::geometry::DVec2;
use std::fmt;
use std::sync::{Arc, LazyLock};

/// The colour of a surface, by texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// The same everywhere.
    Solid(Rgb),
    /// Squares of two colours, `size` wide in texture coordinates. (0, 0) is the lower left corner of an even
    /// square.
    Checker {
        /// The colour of the square at the origin.
        even: Rgb,
        /// The colour of its four neighbours.
        odd: Rgb,
        /// The length of a square's edge, above 0.
        size: f64,
    },
    /// An image.
    Image {
        /// Shared, since it may be large.
        image: Arc<ImageTexture>,
        /// What lies beyond it, along u and along v.
        wrap: [Wrap; 2],
    },
}

impl From<Rgb> for Texture {
    fn from(color: Rgb) -> Self {
        Self::Solid(color)
    }
}

/// The image, repeated.
impl From<Arc<ImageTexture>> for Texture {
    fn from(image: Arc<ImageTexture>) -> Self {
        Self::Image { image, wrap: [Wrap::Repeat; 2] }
    }
}

impl Texture {
    /// Whether its colour depends on the texture coordinates.
    pub(crate) fn wants_uv(&self) -> bool {
        !matches!(self, Self::Solid(_))
    }

    /// The colour at texture coordinates `uv`.
    pub fn color_at(&self, uv: DVec2) -> Rgb {
        match self {
            Self::Solid(color) => *color,
            Self::Checker { even, odd, size } => {
                let square = (uv / *size).floor();
                if (square.x + square.y).rem_euclid(2.0) == 0.0 { *even } else { *odd }
            }
            Self::Image { image, wrap } => image.color_at(uv, *wrap),
        }
    }
}

/// What lies beyond an image's borders, along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// Its outermost texels, drawn out.
    Clamp,
    /// The image again, every other time mirrored, so that it meets itself without a seam.
    Mirror,
}

impl Wrap {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Repeat, Self::Clamp, Self::Mirror];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Repeat => "repeat",
            Self::Clamp => "clamp",
            Self::Mirror => "mirror",
        }
    }

    /// That of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|wrap| wrap.name() == name)
    }

    /// The place within the image, from 0 to 1, where what lies at `t` is found.
    fn within(self, t: f64) -> f64 {
        match self {
            Self::Repeat => t - t.floor(),
            Self::Clamp => t.clamp(0.0, 1.0),
            Self::Mirror => {
                let t = t - 2.0 * (0.5 * t).floor();
                if t > 1.0 { 2.0 - t } else { t }
            }
        }
    }

    /// Which of `n` texels lies at `i`, from -1 to n.
    fn texel(self, i: f64, n: u32) -> usize {
        match self {
            Self::Repeat => i.rem_euclid(f64::from(n)) as usize % n as usize,
            // In a mirror at the border, the outermost texel is its own neighbour.
            Self::Clamp | Self::Mirror => i.clamp(0.0, f64::from(n - 1)) as usize,
        }
    }
}

/// Why an image is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("an image of {width} x {height} pixels cannot have {found} texels")]
pub struct ImageError {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Texels given.
    pub found: usize,
}

/// An 8-bit sRGB image.
#[derive(Clone, PartialEq)]
pub struct ImageTexture {
    width: u32,
    height: u32,
    texels: Vec<[u8; 3]>,
}

impl ImageTexture {
    /// An image from its rows, top row first. Shape: `texels: [height * width][3]`, sRGB-encoded.
    ///
    /// # Errors
    /// [`ImageError`] where a side is 0 or the number of texels is not their product.
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Result<Self, ImageError> {
        let expected = u64::from(width) * u64::from(height);
        if expected == 0 || texels.len() as u64 != expected {
            return Err(ImageError { width, height, found: texels.len() });
        }
        Ok(Self { width, height, texels })
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The rows, top row first. Shape: `[height * width][3]`, sRGB-encoded.
    pub fn texels(&self) -> &[[u8; 3]] {
        &self.texels
    }

    /// The colour at `uv`, linear: bilinear between texel centres, and beyond [0, 1] as `wrap` says along u and v.
    ///
    /// (0, 0) is the lower left corner of the image and (1, 1) the upper right one.
    pub fn color_at(&self, uv: DVec2, wrap: [Wrap; 2]) -> Rgb {
        if !uv.is_finite() {
            return Rgb::BLACK;
        }
        let x = wrap[0].within(uv.x) * f64::from(self.width) - 0.5;
        let y = (1.0 - wrap[1].within(uv.y)) * f64::from(self.height) - 0.5;
        let (column, row) = (x.floor(), y.floor());
        let (right, down) = (x - column, y - row);
        let texel = |dx: f64, dy: f64| self.texel(column + dx, row + dy, wrap);
        (texel(0.0, 0.0) * (1.0 - right) + texel(1.0, 0.0) * right) * (1.0 - down)
            + (texel(0.0, 1.0) * (1.0 - right) + texel(1.0, 1.0) * right) * down
    }

    /// The texel at a column and row, which may be one beyond the image.
    fn texel(&self, column: f64, row: f64, [across, down]: [Wrap; 2]) -> Rgb {
        let index = down.texel(row, self.height) * self.width as usize + across.texel(column, self.width);
        let [r, g, b] = self.texels[index];
        let linear = |encoded: u8| SRGB_TO_LINEAR[usize::from(encoded)];
        Rgb::new(linear(r), linear(g), linear(b))
    }
}

impl fmt::Debug for ImageTexture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ImageTexture({} x {})", self.width, self.height)
    }
}

static SRGB_TO_LINEAR: LazyLock<[f64; 256]> =
    LazyLock::new(|| std::array::from_fn(|encoded| srgb_to_linear(encoded as f64 / 255.0)));

#[cfg(test)]
mod tests {
    use super::*;

    const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];

    fn two_by_one() -> ImageTexture {
        ImageTexture::new(2, 1, vec![[255, 0, 0], [0, 0, 255]]).unwrap()
    }

    #[test]
    fn texel_centers_give_the_texels_and_between_them_lies_the_mean() {
        let image = two_by_one();
        assert_eq!(image.color_at(DVec2::new(0.25, 0.5), REPEAT), Rgb::new(1.0, 0.0, 0.0));
        assert_eq!(image.color_at(DVec2::new(0.75, 0.5), REPEAT), Rgb::new(0.0, 0.0, 1.0));
        assert_eq!(image.color_at(DVec2::new(0.5, 0.5), REPEAT), Rgb::new(0.5, 0.0, 0.5));
    }

    #[test]
    fn clamped_images_end_in_their_outermost_texels_and_mirrored_ones_turn_back() {
        let image = two_by_one();
        let red_part = |u: f64, across| image.color_at(DVec2::new(u, 0.5), [across, Wrap::Repeat]).r;
        for (wrap, expected) in [
            // Texel centres lie at 1/4 and 3/4 of an image, and the borders half-way between two of them.
            (Wrap::Repeat, [0.5, 1.0, 0.5, 0.0, 0.5, 1.0, 0.5]),
            (Wrap::Clamp, [1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0]),
            (Wrap::Mirror, [1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.5]),
        ] {
            let found = std::array::from_fn(|quarter| red_part(quarter as f64 / 4.0, wrap));
            assert_eq!(found, expected, "{wrap:?}");
        }
        assert_eq!([-0.25, -1.25, 2.25, 3.25].map(|u| red_part(u, Wrap::Mirror)), [1.0, 0.0, 1.0, 0.0]);
        assert_eq!([-1e300, 1e300].map(|u| red_part(u, Wrap::Clamp)), [1.0, 0.0]);
    }

    #[test]
    fn each_axis_is_wrapped_in_its_own_way() {
        let column = ImageTexture::new(1, 2, vec![[255; 3], [0; 3]]).unwrap();
        let at = |v: f64, wrap| column.color_at(DVec2::new(0.5, v), [Wrap::Repeat, wrap]);
        assert_eq!([1.25, -0.25].map(|v| at(v, Wrap::Clamp)), [Rgb::WHITE, Rgb::BLACK]);
        assert_eq!([1.25, 1.75].map(|v| at(v, Wrap::Mirror)), [Rgb::WHITE, Rgb::BLACK]);
        assert_eq!([1.25, 1.75].map(|v| at(v, Wrap::Repeat)), [Rgb::BLACK, Rgb::WHITE]);
    }

    #[test]
    fn images_repeat_and_v_runs_upward() {
        let image = two_by_one();
        assert_eq!(image.color_at(DVec2::new(-0.75, 7.5), REPEAT), Rgb::new(1.0, 0.0, 0.0));
        let column = ImageTexture::new(1, 2, vec![[255, 255, 255], [0, 0, 0]]).unwrap();
        assert_eq!(column.color_at(DVec2::new(0.5, 0.75), REPEAT), Rgb::WHITE);
        assert_eq!(column.color_at(DVec2::new(0.5, 0.25), REPEAT), Rgb::BLACK);
    }

    #[test]
    fn checker_alternates_across_the_origin() {
        let checker = Texture::Checker { even: Rgb::WHITE, odd: Rgb::BLACK, size: 2.0 };
        assert_eq!(checker.color_at(DVec2::new(1.0, 1.0)), Rgb::WHITE);
        assert_eq!(checker.color_at(DVec2::new(-1.0, 1.0)), Rgb::BLACK);
        assert_eq!(checker.color_at(DVec2::new(-1.0, -1.0)), Rgb::WHITE);
    }

    #[test]
    fn an_image_needs_all_of_its_texels() {
        assert!(ImageTexture::new(2, 2, vec![[0; 3]; 3]).is_err());
        assert!(ImageTexture::new(0, 0, vec![]).is_err());
    }
}
