//! The directions of ambient occlusion at a pixel: the one place that knows how Lancer chooses them.

use lancer_core::geometry::{DMat3, DVec3};
use lancer_core::sampling::{Key, Rotation, SphereLattice};

/// How the lattice is turned for the point that the camera sees in a pixel, as
/// [`AmbientOcclusionSampler`](lancer_core::integrator::AmbientOcclusionSampler) does.
pub(crate) fn rotation(x: u32, y: u32) -> Rotation {
    Rotation::random(&mut Key::camera(x, y, 0).stream())
}

/// The rotation as a matrix.
pub(crate) fn matrix(x: u32, y: u32) -> DMat3 {
    rotation(x, y).matrix()
}

/// The lattice of a pixel.
pub(crate) fn turned(lattice: &SphereLattice, x: u32, y: u32) -> impl Iterator<Item = DVec3> {
    let matrix = matrix(x, y);
    lattice.directions().iter().map(move |&direction| matrix * direction)
}
