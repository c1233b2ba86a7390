//! The best renderer that we can write on Embree for Lancer's local illumination.

/// Cells along each side of the square that [`direction_bin`] lays directions out on.
const SIDE: f32 = 16.0;

/// Which of 256 cells of the sphere a direction lies in; neighbours on the sphere are mostly neighbours in number.
///
/// The sphere is unfolded by an octahedron onto a square, whose cells are numbered along a Z curve.
pub(crate) fn direction_bin([x, y, z]: [f32; 3]) -> usize {
    let scale = 1.0 / (x.abs() + y.abs() + z.abs());
    let (mut u, mut v) = (x * scale, y * scale);
    if z < 0.0 {
        (u, v) = ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v));
    }
    let cell = |w: f32| ((0.5 * w + 0.5) * SIDE).clamp(0.0, SIDE - 1.0) as usize;
    let spread = |bits: usize| (bits & 1) | (bits & 2) << 1 | (bits & 4) << 2 | (bits & 8) << 3;
    spread(cell(u)) | spread(cell(v)) << 1
}
