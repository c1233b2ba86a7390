//! How far two pictures are apart.
//!
//! In: two pictures of one size. Out: a [`Comparison`], numbers and the pictures of the differences. Everything is
//! computed in a fixed order from portable functions: the same numbers on every machine.

mod filter;
mod flip;
mod magma;

pub use flip::{PIXELS_PER_DEGREE, flip};

use crate::image::Picture;
use lancer_core::color::srgb_to_linear;
use lancer_core::film::Image;
use lancer_core::geometry::portable;

/// Two pictures are not of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} x {} pixels cannot be compared with {} x {}", .0.0, .0.1, .1.0, .1.1)]
pub struct SizeError(pub (u32, u32), pub (u32, u32));

/// How far two pictures are apart.
///
/// Where both hold radiance, `mean`, `rmse`, `max` and `psnr` are of radiance; otherwise of sRGB values from 0 to 1, as
/// displays are sent them. FLIP is always of what displays show.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Whether radiance was compared.
    pub is_linear: bool,
    /// Pixels that are not the same.
    pub differing: u64,
    /// The mean of the absolute differences of all channels.
    pub mean: f64,
    /// The root of the mean of their squares.
    pub rmse: f64,
    /// The greatest of them.
    pub max: f64,
    /// The peak signal-to-noise ratio in decibels, for a peak of 1; infinite for equal pictures.
    pub psnr: f64,
    /// The mean of FLIP, from 0 for equal pictures to 1; see [`flip`].
    pub flip: f64,
    /// FLIP of each pixel, top row first.
    pub flip_map: Vec<f32>,
    /// The absolute differences.
    pub differences: Image,
}

impl Comparison {
    /// Compares two pictures, FLIP on the threads of the current rayon pool; what `pixels_per_degree` means, [`flip`] says.
    ///
    /// # Errors
    /// They are not of one size.
    pub fn of(a: &Picture, b: &Picture, pixels_per_degree: f64) -> Result<Self, SizeError> {
        let size = |picture: &Picture| (picture.values.width(), picture.values.height());
        if size(a) != size(b) {
            return Err(SizeError(size(a), size(b)));
        }
        let (width, height) = size(a);
        let is_linear = a.is_linear && b.is_linear;
        let shown = (a.to_display(), b.to_display());
        let (of_a, of_b) = if is_linear { (&a.values, &b.values) } else { (&*shown.0, &*shown.1) };
        let differences = differences(of_a, of_b);

        let (mut differing, mut sum, mut squares, mut max) = (0, 0.0, 0.0, 0.0_f64);
        for pixel in differences.pixels() {
            differing += u64::from(*pixel != [0.0; 3]);
            for difference in pixel.map(f64::from) {
                sum += difference;
                squares += difference * difference;
                max = max.max(difference);
            }
        }
        let channels = 3.0 * f64::from(width) * f64::from(height);
        let mean_square: f64 = squares / channels;
        let flip_map = flip(&shown.0, &shown.1, pixels_per_degree);
        let flip = flip_map.iter().map(|&value| f64::from(value)).sum::<f64>() / flip_map.len() as f64;
        Ok(Self {
            width,
            height,
            is_linear,
            differing,
            mean: sum / channels,
            rmse: mean_square.sqrt(),
            max,
            psnr: -10.0 * portable::log10(mean_square),
            flip,
            flip_map,
            differences,
        })
    }

    /// FLIP as a picture: black where nothing differs, through violet and red to white.
    pub fn flip_picture(&self) -> Image {
        let mut picture = Image::black(self.width, self.height);
        let colors = self.flip_map.iter().map(|&value| {
            // Codes are to come out as they stand in the table.
            magma::color(value).map(|code| srgb_to_linear(f64::from(code) / 255.0) as f32)
        });
        picture.put(0, 0, self.width, &colors.collect::<Vec<_>>());
        picture
    }

    /// The absolute differences as a picture, times `factor`; codes of a display are as many codes.
    pub fn difference_picture(&self, factor: f32) -> Image {
        let shown = |difference: f32| (difference * factor).clamp(0.0, 1.0);
        match self.is_linear {
            true => self.differences.map(|pixel| pixel.map(shown)),
            false => self
                .differences
                .map(|pixel| pixel.map(|value| srgb_to_linear(f64::from(shown(value))) as f32)),
        }
    }
}

/// Absolute differences. Values that are both infinite or both no number are the same; a number and none are
/// infinitely apart.
fn differences(a: &Image, b: &Image) -> Image {
    let apart = |a: f32, b: f32| match (a - b).abs() {
        difference if difference.is_finite() => difference,
        _ if a.to_bits() == b.to_bits() || a == b || (a.is_nan() && b.is_nan()) => 0.0,
        _ => f32::INFINITY,
    };
    let pixels = a.pixels().iter().zip(b.pixels());
    let pixels = pixels.map(|(a, b)| std::array::from_fn(|channel| apart(a[channel], b[channel])));
    let mut differences = Image::black(a.width(), a.height());
    differences.put(0, 0, a.width(), &pixels.collect::<Vec<[f32; 3]>>());
    differences
}
