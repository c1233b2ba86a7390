//! Linear RGB with sRGB primaries, and the encoding of it that files use.

use crate::geometry::{RayPacket, portable};
use std::ops::{Add, AddAssign, Mul, MulAssign};

/// A colour, an intensity, a radiance or a coefficient: one number a channel, linear, sRGB primaries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb {
    /// Red.
    pub r: f64,
    /// Green.
    pub g: f64,
    /// Blue.
    pub b: f64,
}

impl Rgb {
    /// Zero in all channels.
    pub const BLACK: Self = Self::grey(0.0);
    /// One in all channels.
    pub const WHITE: Self = Self::grey(1.0);

    /// A colour of three linear channels, which may exceed 1.
    pub const fn new(r: f64, g: f64, b: f64) -> Self {
        Self { r, g, b }
    }

    /// The same value in all channels.
    pub const fn grey(value: f64) -> Self {
        Self { r: value, g: value, b: value }
    }

    /// The colour written `#rrggbb` in sRGB, as for example `0x87ceeb`.
    pub fn from_srgb_hex(rrggbb: u32) -> Self {
        let channel = |shift: u32| srgb_to_linear(f64::from(rrggbb >> shift & 0xff) / 255.0);
        Self::new(channel(16), channel(8), channel(0))
    }

    /// Red, green and blue.
    pub const fn to_array(self) -> [f64; 3] {
        [self.r, self.g, self.b]
    }

    /// A function applied to each channel.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// The greatest channel.
    pub fn max_channel(self) -> f64 {
        self.r.max(self.g).max(self.b)
    }

    /// Whether all channels are zero.
    pub fn is_black(self) -> bool {
        self == Self::BLACK
    }

    /// Whether no channel is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }
}

impl From<f64> for Rgb {
    fn from(value: f64) -> Self {
        Self::grey(value)
    }
}

impl From<[f64; 3]> for Rgb {
    fn from([r, g, b]: [f64; 3]) -> Self {
        Self { r, g, b }
    }
}

impl Add for Rgb {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.r + other.r, self.g + other.g, self.b + other.b)
    }
}

impl AddAssign for Rgb {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul for Rgb {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.r * other.r, self.g * other.g, self.b * other.b)
    }
}

impl Mul<f64> for Rgb {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.map(|channel| channel * factor)
    }
}

impl MulAssign<f64> for Rgb {
    fn mul_assign(&mut self, factor: f64) {
        *self = *self * factor;
    }
}

/// A colour for each ray of a packet, by channel as vector instructions want it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Colors([[f64; RayPacket::LANES]; 3]);

impl Colors {
    /// The same colour for all.
    #[inline(always)]
    pub fn splat(color: Rgb) -> Self {
        Self(color.to_array().map(|channel| [channel; RayPacket::LANES]))
    }

    /// That in a lane.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline(always)]
    pub fn at(&self, lane: usize) -> Rgb {
        Rgb::new(self.0[0][lane], self.0[1][lane], self.0[2][lane])
    }

    /// Puts a colour into a lane.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline(always)]
    pub fn put(&mut self, lane: usize, color: Rgb) {
        (self.0[0][lane], self.0[1][lane], self.0[2][lane]) = (color.r, color.g, color.b);
    }
}

/// Decodes one sRGB channel in [0, 1]. Source: IEC 61966-2-1.
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { portable::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Encodes one linear channel in [0, 1] as sRGB. Source: IEC 61966-2-1.
pub fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * portable::pow(linear, 1.0 / 2.4) - 0.055 }
}
