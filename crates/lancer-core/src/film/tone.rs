//! From radiance to what a display can show: exposure, a curve, clamping, sRGB.

use super::Image;
use crate::color::{linear_to_srgb, srgb_to_linear};
use crate::geometry::portable;
use std::sync::LazyLock;

/// How radiance becomes what a display shows: multiplied by the exposure, bent by the curve, clamped to [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Exposure in stops: radiance is multiplied by 2 to this power.
    pub exposure: f64,
    /// What becomes of radiance that is brighter than the display.
    pub curve: ToneCurve,
}

/// How exposed radiance is fitted into [0, 1]. Files that hold radiance itself are written without any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// None: what is brighter than 1 is cut to 1, channel by channel.
    #[default]
    Linear,
    /// Reinhard's: darker tones are kept, bright ones are compressed, hues stay. The luminance L becomes
    /// L (1 + L / w^2) / (1 + L) with w = [`ToneCurve::REINHARD_WHITE`].
    ///
    /// Source: Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH
    /// 2002, equation 4; w is fixed, where they take the brightest pixel: then a part of a picture would not have
    /// the values of the whole.
    Reinhard,
    /// As film: a toe, a shoulder, and bright colours that turn white, channel by channel.
    ///
    /// Source: Narkowicz, "ACES Filmic Tone Mapping Curve", 2016: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), a
    /// fit of the ACES reference transforms. Like his, it is brighter than they are: `exposure: -0.74`, which
    /// multiplies by 0.6, gives theirs.
    Filmic,
    /// No curve and no sRGB encoding either: linear values are written as if they were encoded, which looks too dark
    /// and has too much contrast. For comparison with renderers that do so.
    Raw,
}

impl ToneCurve {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Reinhard, Self::Filmic, Self::Raw];

    /// The luminance that [`ToneCurve::Reinhard`] makes 1: two stops above what `Linear` cuts. Less would cut
    /// highlights, more would darken them.
    pub const REINHARD_WHITE: f64 = 4.0;

    /// Its name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Reinhard => "reinhard",
            Self::Filmic => "filmic",
            Self::Raw => "raw",
        }
    }

    /// The curve of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }

    /// What exposed radiance becomes, not yet clamped.
    fn bend(self, pixel: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Linear | Self::Raw => pixel,
            Self::Reinhard => {
                let factor = reinhard_factor(luminance(pixel));
                pixel.map(|channel| (f64::from(channel) * factor) as f32)
            }
            Self::Filmic => pixel.map(|channel| narkowicz(f64::from(channel)) as f32),
        }
    }
}

/// Y of linear sRGB, at least 0 and finite. Source: IEC 61966-2-1.
fn luminance([r, g, b]: [f32; 3]) -> f64 {
    let y = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    y.clamp(0.0, f64::from(f32::MAX))
}

/// What each channel is multiplied by, so that the luminance follows the curve.
fn reinhard_factor(luminance: f64) -> f64 {
    const WHITE_SQUARED: f64 = ToneCurve::REINHARD_WHITE * ToneCurve::REINHARD_WHITE;
    (1.0 + luminance / WHITE_SQUARED) / (1.0 + luminance)
}

fn narkowicz(x: f64) -> f64 {
    // Beyond, the curve is above 1 all the same, and an infinite x would give no number.
    let x = x.clamp(0.0, 1e6);
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}

impl Tone {
    /// The most stops of exposure, and of darkening: 2 to this power, and its inverse, times any radiance worth
    /// showing is still an `f32`. Beyond 127 black would become 0 times infinity.
    pub const MAX_EXPOSURE: f64 = 100.0;

    /// What radiance is multiplied by.
    pub fn factor(&self) -> f32 {
        portable::exp2(self.exposure) as f32
    }

    /// The image with the exposure applied and nothing else: linear and unclamped, as files of radiance hold it.
    pub fn expose(&self, image: &Image) -> Image {
        let factor = self.factor();
        image.map(|pixel| pixel.map(|channel| channel * factor))
    }

    /// The image as 8-bit codes for a display: exposed, bent, clamped to [0, 1], encoded as sRGB unless the curve is
    /// [`ToneCurve::Raw`], rounded to nearest. Shape: `[height * width][3]`.
    pub fn to_codes8(&self, image: &Image) -> Vec<[u8; 3]> {
        let codes = LazyLock::force(&CODES);
        let shown = self.shown(image);
        match self.curve {
            ToneCurve::Raw => {
                shown.map(|pixel| pixel.map(|value| (unit(value) * 255.0).round() as u8)).collect()
            }
            _ => shown.map(|pixel| pixel.map(|value| codes.of(value))).collect(),
        }
    }

    /// The image as 16-bit codes for a display; see [`Tone::to_codes8`].
    pub fn to_codes16(&self, image: &Image) -> Vec<[u16; 3]> {
        let is_encoded = self.curve != ToneCurve::Raw;
        let code = |value: f32| {
            let value = unit(value);
            ((if is_encoded { linear_to_srgb(value) } else { value }) * 65535.0).round() as u16
        };
        self.shown(image).map(|pixel| pixel.map(code)).collect()
    }

    /// The linear light in [0, 1] that a display gives off for a radiance.
    pub fn light(&self, pixel: [f32; 3]) -> [f32; 3] {
        let factor = self.factor();
        self.curve.bend(pixel.map(|channel| channel * factor)).map(|value| match self.curve {
            ToneCurve::Raw => srgb_to_linear(unit(value)) as f32,
            _ => unit(value) as f32,
        })
    }

    /// The pixels exposed and bent.
    fn shown<'a>(&self, image: &'a Image) -> impl Iterator<Item = [f32; 3]> + use<'a> {
        let (factor, curve) = (self.factor(), self.curve);
        image.pixels().iter().map(move |pixel| curve.bend(pixel.map(|channel| channel * factor)))
    }
}

/// A value clamped to [0, 1]; what is not a number becomes 0.
fn unit(value: f32) -> f64 {
    f64::from(value.clamp(0.0, 1.0).max(0.0))
}

/// The image as 8-bit sRGB, clamped to [0, 1] and rounded to nearest. Shape: `[height * width][3]`.
pub fn to_srgb8(image: &Image) -> Vec<[u8; 3]> {
    Tone::default().to_codes8(image)
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
            let linear = srgb_to_linear(f64::from(value) / 255.0);
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

    fn pixel_of(pixel: [f32; 3]) -> Image {
        let mut image = Image::black(1, 1);
        image.put(0, 0, 1, &[pixel]);
        image
    }

    fn of(curve: ToneCurve) -> Tone {
        Tone { curve, ..Tone::default() }
    }

    #[test]
    fn every_curve_keeps_black_never_falls_and_never_leaves_the_display() {
        for curve in ToneCurve::ALL {
            let codes = |grey: f32| of(curve).to_codes16(&pixel_of([grey; 3]))[0];
            assert_eq!(codes(0.0), [0; 3], "{curve:?}");
            assert_eq!(codes(-3.0), [0; 3], "{curve:?}");
            assert_eq!(codes(f32::NAN), [0; 3], "{curve:?}");
            let rising = (0..2000).map(|i| codes(0.01 * i as f32)).collect::<Vec<_>>();
            assert!(rising.windows(2).all(|pair| pair[0] <= pair[1]), "{curve:?}");
            assert_eq!(codes(1e30), [65535; 3], "{curve:?}");
            assert_eq!(codes(f32::INFINITY), [65535; 3], "{curve:?}");
        }
    }

    #[test]
    fn reinhard_makes_its_white_one_and_keeps_hues() {
        let tone = of(ToneCurve::Reinhard);
        let white = ToneCurve::REINHARD_WHITE as f32;
        assert!(tone.light([white; 3]).iter().all(|value| (value - 1.0).abs() < 1e-6));
        // L = 1 gives (1 + 1 / 16) / 2.
        assert!((tone.light([1.0; 3])[1] - 17.0 / 32.0).abs() < 1e-6);
        let [r, g, b] = tone.light([0.8, 0.4, 0.1]);
        assert!((r / g - 2.0).abs() < 1e-5 && (g / b - 4.0).abs() < 1e-5);
    }

    #[test]
    fn filmic_has_the_values_of_its_formula() {
        // 2.54 / 3.16 at 1 and 0.6425 / 1.0425 at 0.5.
        let tone = of(ToneCurve::Filmic);
        for (x, y) in [(1.0, 0.803_797_5), (0.5, 0.616_306_95), (0.0, 0.0)] {
            assert!((tone.light([x; 3])[0] - y).abs() < 1e-6, "{x}");
        }
    }

    #[test]
    fn raw_writes_linear_values_which_a_display_shows_too_dark() {
        let tone = of(ToneCurve::Raw);
        assert_eq!(tone.to_codes8(&pixel_of([0.5, 0.25, 2.0])), [[128, 64, 255]]);
        assert_eq!(tone.to_codes16(&pixel_of([0.5, 0.25, 2.0])), [[32768, 16384, 65535]]);
        assert!((tone.light([0.5; 3])[0] - 0.214_041).abs() < 1e-5);
    }

    #[test]
    fn sixteen_bits_round_to_the_eight_but_for_halves() {
        let mut ramp = Image::black(1001, 1);
        for x in 0..1001 {
            ramp.put(x, 0, 1, &[[x as f32 / 1000.0; 3]]);
        }
        for curve in ToneCurve::ALL {
            let (eight, sixteen) = (of(curve).to_codes8(&ramp), of(curve).to_codes16(&ramp));
            for (eight, sixteen) in eight.iter().flatten().zip(sixteen.iter().flatten()) {
                assert!((f64::from(*sixteen) / 257.0 - f64::from(*eight)).abs() <= 0.502, "{curve:?}");
            }
        }
    }

    #[test]
    fn exposure_comes_before_the_curve() {
        for curve in ToneCurve::ALL {
            let brighter = Tone { exposure: 1.0, curve };
            assert_eq!(
                brighter.to_codes8(&pixel_of([0.1, 0.2, 0.3])),
                of(curve).to_codes8(&pixel_of([0.2, 0.4, 0.6])),
            );
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
