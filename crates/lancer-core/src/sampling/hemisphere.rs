//! Directions spread evenly over the half of the sphere above a plane.
//!
//! N directions are a spherical Fibonacci lattice of the whole sphere about the normal: the i-th has the
//! elevation z = 1 - 2 (i + u) / N and the azimuth 2 pi (i / golden ratio + v), with u and v uniform in [0, 1) and
//! drawn anew for each point. Each stratum of elevations, and so each direction within it, is uniform on the
//! sphere, so that every estimate of an integral over it is unbiased. Those with z <= 0 have no weight in such an
//! integral over the upper half and are left out.
//!
//! Source: Marques, Bouville, Ribardière, Santos, Bouatouch, "Spherical Fibonacci Point Sets for Illumination
//! Integrals" (Computer Graphics Forum 32(8), 2013), section 3. The random shifts are those of Cranley, Patterson,
//! "Randomization of number theoretic methods for multiple integration" (1976).

use super::Stream;
use crate::geometry::{DVec3, DirectionFan, portable};
use fearless_simd::{Level, dispatch};
use std::f64::consts::TAU;

/// The upper half of N evenly spread directions, ready to be shifted for any number of points.
#[derive(Clone, Debug)]
pub struct HemisphereLattice {
    samples: u32,
    /// The cosines and the sines of the azimuths, lowest direction first.
    cosines: Vec<f64>,
    sines: Vec<f64>,
    level: Level,
}

impl HemisphereLattice {
    /// The lattice of `samples` directions on the whole sphere; empty for 0.
    pub fn new(samples: u32) -> Self {
        let golden_ratio = 0.5 * (1.0 + 5.0_f64.sqrt());
        let (sines, cosines) = (0..samples.div_ceil(2))
            .rev()
            .map(|i| portable::sin_cos(TAU * (f64::from(i) / golden_ratio).fract()))
            .unzip();
        Self { samples, cosines, sines, level: Level::new() }
    }

    /// N.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The cosine and the sine of the azimuth of each direction that may have weight, the highest first.
    pub fn azimuths(&self) -> impl Iterator<Item = [f64; 2]> {
        self.cosines.iter().zip(&self.sines).rev().map(|(&cos, &sin)| [cos, sin])
    }

    /// The directions around a unit `normal`, from the lowest to the highest, shifted by two numbers of `stream`.
    pub fn around<'a>(
        &'a self,
        normal: DVec3,
        stream: &mut Stream,
    ) -> impl Iterator<Item = DirectionFan> + use<'a> {
        let shift = Shift::new(self, normal, stream);
        shift.ends().map(move |end| {
            let mut fan = DirectionFan::default();
            shift.fill(&mut fan, end);
            fan
        })
    }

    /// Shows the same fans, in memory from before.
    pub(crate) fn visit_around(
        &self,
        normal: DVec3,
        stream: &mut Stream,
        fan: &mut DirectionFan,
        mut visit: impl FnMut(&DirectionFan),
    ) {
        let shift = Shift::new(self, normal, stream);
        for end in shift.ends() {
            shift.fill(fan, end);
            visit(fan);
        }
    }
}

/// The lattice about one normal.
struct Shift<'a> {
    lattice: &'a HemisphereLattice,
    /// Tangent, bitangent, normal.
    frame: [DVec3; 3],
    u: f64,
    turn: [f64; 2],
    step: f64,
}

impl<'a> Shift<'a> {
    fn new(lattice: &'a HemisphereLattice, normal: DVec3, stream: &mut Stream) -> Self {
        let (u, v) = (stream.next_unit(), stream.next_unit());
        let (sin, cos) = portable::sin_cos(TAU * v);
        let (tangent, bitangent) = tangents(normal);
        Self {
            lattice,
            frame: [tangent, bitangent, normal],
            u,
            turn: [cos, sin],
            step: 2.0 / f64::from(lattice.samples),
        }
    }

    fn elevation(&self, i: usize) -> f64 {
        1.0 - (i as f64 + self.u) * self.step
    }

    /// How many directions have weight.
    fn above(&self) -> usize {
        let mut count = self.lattice.cosines.len();
        while count > 0 && self.elevation(count - 1) <= 0.0 {
            count -= 1;
        }
        count
    }

    /// Where fans end that hold all of these together, the lowest fan's first.
    fn ends(&self) -> impl Iterator<Item = usize> + use<> {
        let above = self.above();
        (0..above).step_by(DirectionFan::CAPACITY).map(move |first| above - first)
    }

    /// Fills a fan with directions from the one before number `end` of the lattice upward.
    fn fill(&self, fan: &mut DirectionFan, end: usize) {
        let count = end.min(DirectionFan::CAPACITY);
        (fan.lowest, fan.step, fan.count) = (self.elevation(end - 1), self.step, count);
        let [tangent, bitangent, normal] = self.frame;
        let [turn_cos, turn_sin] = self.turn;
        let [xs, ys, zs] = &mut fan.components;
        let first = self.lattice.cosines.len() - end;
        let cosines = &self.lattice.cosines[first..first + count];
        let sines = &self.lattice.sines[first..first + count];
        for axis in [&mut *xs, ys, zs] {
            axis[count..].fill(0.0);
        }
        let (xs, ys, zs) = (&mut xs[..count], &mut ys[..count], &mut zs[..count]);
        let lowest = fan.lowest;
        dispatch!(self.lattice.level, _simd => {
            for i in 0..count {
                let elevation = lowest + self.step * i as f64;
                let radius = (1.0 - elevation * elevation).max(0.0).sqrt();
                let across = radius * (cosines[i] * turn_cos - sines[i] * turn_sin);
                let along = radius * (sines[i] * turn_cos + cosines[i] * turn_sin);
                xs[i] = tangent.x * across + bitangent.x * along + normal.x * elevation;
                ys[i] = tangent.y * across + bitangent.y * along + normal.y * elevation;
                zs[i] = tangent.z * across + bitangent.z * along + normal.z * elevation;
            }
        });
    }
}

/// Two unit vectors that make a right-handed frame with a unit normal.
///
/// Source: Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin, "Building an Orthonormal Basis, Revisited"
/// (JCGT 6(1), 2017).
fn tangents(normal: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    (
        DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Key;

    fn directions(samples: u32, normal: DVec3, key: u32) -> Vec<(DVec3, f64)> {
        let lattice = HemisphereLattice::new(samples);
        lattice
            .around(normal, &mut Key::camera(key, 0, 0).stream())
            .flat_map(|fan| {
                (0..fan.count).map(move |i| (fan.direction(i), fan.elevation(i))).collect::<Vec<_>>()
            })
            .collect()
    }

    #[test]
    fn directions_have_length_one_and_the_elevations_they_claim() {
        for (key, normal) in
            [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(0.6, 0.0, -0.8)].into_iter().enumerate()
        {
            for samples in [1, 2, 7, 128, 1000] {
                let found = directions(samples, normal, key as u32);
                assert!(found.len().abs_diff(samples as usize / 2) <= 1);
                for pair in found.windows(2) {
                    assert!(pair[0].1 < pair[1].1 + 1e-12 || pair.len() == 64);
                }
                for (direction, elevation) in found {
                    assert!((direction.length() - 1.0).abs() < 1e-14);
                    assert!((direction.dot(normal) - elevation).abs() < 1e-14);
                    assert!(elevation > 0.0 && elevation <= 1.0);
                }
            }
        }
    }

    #[test]
    fn with_nothing_in_reach_the_factor_is_within_two_over_n_of_one() {
        for samples in [2, 16, 64, 256] {
            for key in 0..200 {
                let sum: f64 =
                    directions(samples, DVec3::Y, key).iter().map(|(_, elevation)| elevation).sum();
                let (n, shift) = (f64::from(samples), Key::camera(key, 0, 0).stream().next_unit());
                let factor = 4.0 * sum / n;
                assert!((factor - (1.0 + (2.0 - 4.0 * shift) / n)).abs() < 1e-12, "N = {samples}: {factor}");
            }
        }
    }

    #[test]
    fn sums_over_the_directions_are_unbiased() {
        // Over the whole sphere, with n the normal: the mean of (n . w)+ is 1/4, and of (n . w)+ (t . w)^2 for a
        // tangent t it is 1/16.
        let normal = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let (tangent, _) = tangents(normal);
        for samples in [1, 2, 5, 16] {
            let estimates = 20_000;
            let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
            for key in 0..estimates {
                let mut estimate = [0.0; 2];
                for (direction, elevation) in directions(samples, normal, key) {
                    estimate[0] += elevation / f64::from(samples);
                    let across = tangent.dot(direction);
                    estimate[1] += elevation * across * across / f64::from(samples);
                }
                for i in 0..2 {
                    sums[i] += estimate[i];
                    squares[i] += estimate[i] * estimate[i];
                }
            }
            for (i, expected) in [0.25, 1.0 / 16.0].into_iter().enumerate() {
                let n = f64::from(estimates);
                let mean = sums[i] / n;
                let error = ((squares[i] / n - mean * mean).max(0.0) / n).sqrt();
                assert!(
                    (mean - expected).abs() < 5.0 * error + 1e-12,
                    "N = {samples}: {mean} is not {expected}"
                );
            }
        }
    }
}
