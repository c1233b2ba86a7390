//! From radiance to what a display can show: exposure, clamping, sRGB.

use super::Image;
use crate::color::linear_to_srgb;
use crate::geometry::portable;
use std::sync::LazyLock;

/// How radiance becomes a displayable value. By default it is left alone, then clamped to [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Exposure in stops: radiance is multiplied by 2 to this power.
    pub exposure: f64,
}

impl Tone {
    /// The most stops of exposure, and of darkening: 2 to this power, and its inverse, times any radiance worth
    /// showing is still an `f32`. Beyond 127 black would become 0 times infinity.
    pub const MAX_EXPOSURE: f64 = 100.0;

    /// What radiance is multiplied by.
    pub fn factor(&self) -> f32 {
        portable::exp2(self.exposure) as f32
    }

    /// The image with the exposure applied, still linear and unclamped.
    pub fn expose(&self, image: &Image) -> Image {
        let factor = self.factor();
        image.map(|pixel| pixel.map(|channel| channel * factor))
    }
}

/// The image as 8-bit sRGB, clamped to [0, 1] and rounded to nearest. Shape: `[height * width][3]`.
pub fn to_srgb8(image: &Image) -> Vec<[u8; 3]> {
    let codes = LazyLock::force(&CODES);
    image.pixels().iter().map(|pixel| pixel.map(|channel| codes.of(channel))).collect()
}

static CODES: LazyLock<Codes> = LazyLock::new(Codes::new);

/// The encoding as a table: the power in it takes longer than some rays.
struct Codes {
    /// The least value of each code; beyond the last, infinity.
    least: [f32; 257],
    /// The code at the start of each range of values that share their upper bits.
    first: Vec<u8>,
}

impl Codes {
    /// Leaves six bits of the mantissa: about one code to a range where codes are densest.
    const SHIFT: u32 = 17;

    fn new() -> Self {
        let mut least = [0.0; 257];
        least[256] = f32::INFINITY;
        for code in 1..=255_u8 {
            // Positive floats are ordered as their bits are.
            let (mut below, mut at) = (0, 1.0_f32.to_bits());
            while at - below > 1 {
                let middle = below + (at - below) / 2;
                if encode(f32::from_bits(middle)) < code { below = middle } else { at = middle }
            }
            least[usize::from(code)] = f32::from_bits(at);
        }
        let ranges = 0..=1.0_f32.to_bits() >> Self::SHIFT;
        Self { least, first: ranges.map(|range| encode(f32::from_bits(range << Self::SHIFT))).collect() }
    }

    fn of(&self, linear: f32) -> u8 {
        // What is not a number becomes 0.
        let value = linear.clamp(0.0, 1.0).max(0.0);
        let mut code = self.first[(value.to_bits() >> Self::SHIFT) as usize];
        while value >= self.least[usize::from(code) + 1] {
            code += 1;
        }
        code
    }
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
    fn the_table_says_what_the_formula_says() {
        let near_steps = CODES.least[1..256].iter().flat_map(|least| {
            let bits = least.to_bits();
            (bits - 200..bits + 200).map(f32::from_bits)
        });
        let everywhere = (0..=1_000_000).map(|i| i as f32 / 1e6);
        let odd = [-1.0, -0.0, 1.0, 7.0, f32::MIN_POSITIVE, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for value in near_steps.chain(everywhere).chain(odd) {
            assert_eq!(CODES.of(value), encode(value), "{value}");
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
