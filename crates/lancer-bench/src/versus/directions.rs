//! The directions of ambient occlusion at a pixel: the one place that knows how Lancer chooses them.

use lancer_core::geometry::{DVec3, DirectionFan, portable};
use lancer_core::sampling::{HemisphereLattice, Key};
use std::f64::consts::TAU;

/// How the lattice is shifted at the point that the camera sees in a pixel: the shift of its elevations, in [0, 1),
/// and the cosine and sine of the angle that it is turned by.
pub(crate) fn shift(x: u32, y: u32) -> [f32; 3] {
    let mut stream = Key::camera(x, y, 0).stream();
    let (u, v) = (stream.next_unit(), stream.next_unit());
    let (sin, cos) = portable::sin_cos(TAU * v);
    [u as f32, cos as f32, sin as f32]
}

/// The directions of a pixel above the horizon, from the lowest to the highest.
pub(crate) fn around(lattice: &HemisphereLattice, normal: DVec3, x: u32, y: u32) -> Vec<DirectionFan> {
    lattice.around(normal, &mut Key::camera(x, y, 0).stream()).collect()
}
