//! What is seen.

use crate::Failure;
use std::collections::HashSet;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A part of the display, in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The first column.
    pub x: u16,
    /// The first row.
    pub y: u16,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

impl Area {
    /// The pixel in the middle.
    pub fn centre(self) -> (i32, i32) {
        (i32::from(self.x + self.width / 2), i32::from(self.y + self.height / 2))
    }
}

/// Pixels of a display at one moment. Shape: `[height * width][3]`, top row first, as the screen has them (sRGB).
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    width: u16,
    height: u16,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// From the words of 32 bits in which the server keeps pixels.
    pub(crate) fn from_words(width: u16, height: u16, bytes: &[u8], blue_first: bool) -> Self {
        let pixels = bytes.chunks_exact(4).map(|word| match blue_first {
            true => [word[2], word[1], word[0]],
            false => [word[1], word[2], word[3]],
        });
        Self { width, height, pixels: pixels.collect() }
    }

    /// One pixel.
    ///
    /// # Panics
    /// It lies outside.
    pub fn pixel(&self, x: u16, y: u16) -> [u8; 3] {
        self.pixels[usize::from(y) * usize::from(self.width) + usize::from(x)]
    }

    /// How many colours are in it: few where nothing is drawn, very many where a scene is shown.
    pub fn colours(&self) -> usize {
        self.pixels.iter().collect::<HashSet<_>>().len()
    }

    /// Which part of the pixels differs, 0 to 1; all of them where the sizes do.
    pub fn difference(&self, other: &Self) -> f64 {
        self.different_pixels(other) as f64 / self.pixels.len() as f64
    }

    /// How many pixels differ; all of them where the sizes do.
    pub(crate) fn different_pixels(&self, other: &Self) -> usize {
        match (self.width, self.height) == (other.width, other.height) {
            true => self.pixels.iter().zip(&other.pixels).filter(|(a, b)| a != b).count(),
            false => self.pixels.len(),
        }
    }

    /// A part of it.
    ///
    /// # Panics
    /// The part lies outside.
    pub fn crop(&self, area: Area) -> Self {
        let Area { x, y, width, height } = area;
        let rows = (y..y + height).map(|row| usize::from(row) * usize::from(self.width) + usize::from(x));
        let pixels = rows.flat_map(|start| &self.pixels[start..start + usize::from(width)]);
        Self { width, height, pixels: pixels.copied().collect() }
    }

    /// Writes it as a PNG, in directories that are made where they are missing.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), Failure> {
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.width.into(), self.height.into());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns 0 to 3 of rows 0 and 1: the red channel counts, green is the row.
    fn counted() -> Picture {
        let words = (0..8).flat_map(|i| [0, i / 4, i, 255]).collect::<Vec<u8>>();
        Picture::from_words(4, 2, &words, true)
    }

    #[test]
    fn words_are_read_in_either_order() {
        assert_eq!(counted().pixel(1, 1), [5, 1, 0]);
        assert_eq!(Picture::from_words(1, 1, &[9, 1, 2, 3], false).pixel(0, 0), [1, 2, 3]);
    }

    #[test]
    fn a_crop_has_the_pixels_of_its_area() {
        let crop = counted().crop(Area { x: 1, y: 1, width: 2, height: 1 });
        assert_eq!(crop.pixels, [[5, 1, 0], [6, 1, 0]]);
    }

    #[test]
    fn difference_is_the_part_of_the_pixels_that_differ() {
        let mut other = counted();
        assert_eq!(other.difference(&counted()), 0.0);
        other.pixels[3] = [9; 3];
        assert_eq!(other.difference(&counted()), 0.125);
        assert_eq!(counted().colours(), 8);
    }
}
