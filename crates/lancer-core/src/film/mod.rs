//! Images: linear, free of any file's encoding. It knows neither rays nor formats.

mod tone;

pub use tone::{Tone, ToneCurve, to_srgb8};

/// A linear RGB picture with sRGB primaries. Shape: `pixels: [height * width][3]`, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A black image.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] }
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, top row first.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The pixel of a column and a row.
    ///
    /// # Panics
    /// Where there is none.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        assert!(x < self.width, "column {x} of an image {} wide", self.width);
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// A function applied to every pixel.
    #[must_use]
    pub fn map(&self, f: impl Fn([f32; 3]) -> [f32; 3]) -> Self {
        Self { pixels: self.pixels.iter().map(|&pixel| f(pixel)).collect(), ..*self }
    }

    /// Puts a tile of `width` columns in place, its top left pixel at (`x`, `y`).
    ///
    /// # Panics
    /// Where it does not fit.
    pub fn put(&mut self, x: u32, y: u32, width: u32, tile: &[[f32; 3]]) {
        for (row, pixels) in tile.chunks_exact(width as usize).enumerate() {
            let start = (y as usize + row) * self.width as usize + x as usize;
            self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
        }
    }
}
