//! Directions spread evenly over the whole sphere.
//!
//! Each point that is shaded gets the same lattice, turned at random. A turned lattice keeps its even spacing,
//! and each of its directions alone is uniform on the sphere, so that every estimate of an integral is unbiased.
//!
//! Source: the spherical Fibonacci lattice, in Marques, Bouville, Ribardière, Santos, Bouatouch, "Spherical
//! Fibonacci Point Sets for Illumination Integrals" (Computer Graphics Forum 32(8), 2013), section 3.

use super::Stream;
use crate::geometry::{DMat3, DVec3, portable};
use std::f64::consts::TAU;

/// A spherical Fibonacci lattice.
#[derive(Clone, Debug)]
pub struct SphereLattice {
    directions: Vec<DVec3>,
}

impl SphereLattice {
    /// The lattice of `n` unit directions.
    pub fn new(n: u32) -> Self {
        let golden_ratio = 0.5 * (1.0 + 5.0_f64.sqrt());
        let direction = |i: u32| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
            let radius = (1.0 - z * z).sqrt();
            let (sin, cos) = portable::sin_cos(TAU * (f64::from(i) / golden_ratio).fract());
            DVec3::new(radius * cos, radius * sin, z)
        };
        Self { directions: (0..n).map(direction).collect() }
    }

    /// How many directions there are.
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.directions.is_empty()
    }

    /// The directions as they are.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// The directions, turned.
    pub fn turned(&self, rotation: &Rotation) -> impl Iterator<Item = DVec3> {
        self.directions.iter().map(|&direction| rotation.0 * direction)
    }
}

/// A rotation about the origin.
#[derive(Clone, Copy, Debug)]
pub struct Rotation(DMat3);

impl Rotation {
    /// It as a matrix, to be multiplied from the left.
    pub fn matrix(&self) -> DMat3 {
        self.0
    }

    /// A rotation from the uniform distribution over all of them.
    ///
    /// Source: Marsaglia, "Choosing a point from the surface of a sphere" (1972), for a uniform unit quaternion
    /// without sines.
    pub fn random(stream: &mut Stream) -> Self {
        let (x, y, s) = point_in_disc(stream);
        let (z, w, r) = point_in_disc(stream);
        let scale = ((1.0 - s) / r).sqrt();
        let (z, w) = (z * scale, w * scale);
        Self(DMat3::from_cols(
            DVec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
            DVec3::new(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
            DVec3::new(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)),
        ))
    }
}

/// A uniform point of the unit disc without its centre, and the square of its distance from there.
fn point_in_disc(stream: &mut Stream) -> (f64, f64, f64) {
    loop {
        let (x, y) = (2.0 * stream.next_unit() - 1.0, 2.0 * stream.next_unit() - 1.0);
        let s = x * x + y * y;
        if s > 0.0 && s < 1.0 {
            return (x, y, s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Key;

    #[test]
    fn turning_keeps_lengths_and_angles() {
        let rotation = Rotation::random(&mut Key::camera(1, 2, 3).stream());
        let gram = rotation.0.transpose() * rotation.0;
        for (column, unit) in [gram.x_axis, gram.y_axis, gram.z_axis].into_iter().zip(DVec3::AXES) {
            assert!((column - unit).length() < 1e-15);
        }
        assert!((rotation.0.determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_direction_turned_at_random_is_uniform_on_the_sphere() {
        let lattice = SphereLattice::new(7);
        let n = 20_000;
        let mut mean = [DVec3::ZERO; 7];
        let mut second = [DVec3::ZERO; 7];
        for x in 0..n {
            let rotation = Rotation::random(&mut Key::camera(x, 0, 0).stream());
            for (i, direction) in lattice.turned(&rotation).enumerate() {
                mean[i] += direction / f64::from(n);
                second[i] += direction * direction / f64::from(n);
            }
        }
        // Five standard errors: the variance of a coordinate is 1/3, of its square 4/45.
        for (mean, second) in mean.into_iter().zip(second) {
            assert!(mean.abs().max_element() < 5.0 * (1.0 / 3.0 / f64::from(n)).sqrt());
            assert!((second - 1.0 / 3.0).abs().max_element() < 5.0 * (4.0 / 45.0 / f64::from(n)).sqrt());
        }
    }
}
