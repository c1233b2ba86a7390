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
///
/// A whole exponent up to 1024, as most shininesses are, is reached by squaring: within 2^-42 of the true value,
/// and several times as fast.
pub fn pow(base: f64, exponent: f64) -> f64 {
    if (0.0..=1024.0).contains(&exponent) && exponent.trunc() == exponent {
        whole_power(base, exponent as u32)
    } else {
        libm::pow(base, exponent)
    }
}

fn whole_power(base: f64, mut exponent: u32) -> f64 {
    let (mut power, mut square) = (1.0, base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            power *= square;
        }
        square *= square;
        exponent >>= 1;
    }
    power
}

/// Two to the power `exponent`.
pub fn exp2(exponent: f64) -> f64 {
    libm::exp2(exponent)
}

/// The logarithm of `x` to the base 10.
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_powers_agree_with_the_general_ones() {
        for exponent in [0, 1, 2, 3, 10, 50, 127, 1000, 1024] {
            for i in 0..=100 {
                let base = f64::from(i) / 100.0;
                let (fast, general) = (pow(base, f64::from(exponent)), libm::pow(base, f64::from(exponent)));
                assert!(
                    (fast - general).abs() <= general * exp2(-42.0),
                    "{base}^{exponent}: {fast}, {general}"
                );
            }
        }
    }
}
