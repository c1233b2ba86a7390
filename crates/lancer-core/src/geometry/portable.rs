//! The elementary functions, from one implementation that gives the same bits on every machine.
//!
//! `f64::sin` and its siblings call the platform's C library, whose last bits differ between systems; an
//! image must not. `sqrt`, `abs`, `floor` and the four operations are exact by IEEE 754 and are used as they
//! are. Source: the `libm` crate, a port of musl's.

/// Sine and cosine of `radians`.
pub fn sin_cos(radians: f64) -> (f64, f64) {
    libm::sincos(radians)
}

/// Tangent of `radians`.
pub fn tan(radians: f64) -> f64 {
    libm::tan(radians)
}

/// Angle of the vector (`x`, `y`) from the x axis, in (-pi, pi].
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc cosine in [0, pi]; `x` is first clamped to [-1, 1].
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}

/// `base` to the power `exponent`.
pub fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// Two to the power `exponent`.
pub fn exp2(exponent: f64) -> f64 {
    libm::exp2(exponent)
}
