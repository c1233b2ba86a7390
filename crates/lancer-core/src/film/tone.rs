//! From radiance to what a display can show: exposure, clamping, sRGB.

use super::Image;
use crate::color::linear_to_srgb;
use crate::geometry::portable;

/// How radiance becomes a displayable value. By default it is left alone, then clamped to [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Exposure in stops: radiance is multiplied by 2 to this power.
    pub exposure: f64,
}

impl Tone {
    /// The image with the exposure applied, still linear and unclamped.
    pub fn expose(&self, image: &Image) -> Image {
        let factor = portable::exp2(self.exposure) as f32;
        image.map(|pixel| pixel.map(|channel| channel * factor))
    }
}

/// The image as 8-bit sRGB, clamped to [0, 1] and rounded to nearest. Shape: `[height * width][3]`.
pub fn to_srgb8(image: &Image) -> Vec<[u8; 3]> {
    image.pixels().iter().map(|pixel| pixel.map(encode)).collect()
}

fn encode(linear: f32) -> u8 {
    (linear_to_srgb(f64::from(linear).clamp(0.0, 1.0)) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_8_bit_value_survives_decoding_and_encoding() {
        for value in 0..=255_u8 {
            let linear = crate::color::srgb_to_linear(f64::from(value) / 255.0);
            assert_eq!(encode(linear as f32), value);
        }
    }

    #[test]
    fn values_beyond_the_display_are_clamped() {
        assert_eq!(encode(-1.0), 0);
        assert_eq!(encode(7.0), 255);
        assert_eq!(encode(f32::INFINITY), 255);
        assert_eq!(encode(f32::NAN), 0);
    }
}
