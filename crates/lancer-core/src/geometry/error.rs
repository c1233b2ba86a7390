//! Bounds on floating-point error, and the rays that they keep off their own surface.
//!
//! A hit point is known to within a box; a ray that leaves it starts outside of that box, on the side that it
//! goes to. No constant is tuned: at any scale the step is a few rounding errors long.
//!
//! Source: Pharr, Jakob, Humphreys, "Physically Based Rendering" (4th ed.), section 6.8.

use super::{DVec3, Ray};

/// Half the distance from 1 to the next `f64`: the relative error of one operation.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON * 0.5;

/// The relative error after `n` operations in a row, by Higham's bound: n u / (1 - n u).
pub const fn gamma(n: u32) -> f64 {
    let nu = n as f64 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// A starting point for a ray that leaves a surface in `direction`.
///
/// `point` lies within `point_error` (by axis) of the surface whose unit normal there is `geometric_normal`.
/// Returns a point on the side of the surface that `direction` goes to, so that the ray cannot meet the
/// surface that it left. The normal may face either side.
#[inline(always)]
pub fn leave_surface(point: DVec3, point_error: DVec3, geometric_normal: DVec3, direction: DVec3) -> DVec3 {
    let distance = geometric_normal.abs().dot(point_error);
    let step = geometric_normal * distance;
    let step = if geometric_normal.dot(direction) < 0.0 { -step } else { step };
    let moved = point + step;
    DVec3::new(round_along(moved.x, step.x), round_along(moved.y, step.y), round_along(moved.z, step.z))
}

/// The ray from a surface in `direction`; see [`leave_surface`].
#[inline(always)]
pub fn ray_from_surface(point: DVec3, point_error: DVec3, geometric_normal: DVec3, direction: DVec3) -> Ray {
    Ray::new(leave_surface(point, point_error, geometric_normal, direction), direction)
}

/// The segment from a surface to `target`, with t from 0 to 1; see [`leave_surface`].
#[inline(always)]
pub fn segment_from_surface(point: DVec3, point_error: DVec3, geometric_normal: DVec3, target: DVec3) -> Ray {
    Ray::between(leave_surface(point, point_error, geometric_normal, target - point), target)
}

/// Whether `target` is clearly off the plane that touches a surface at a point: not so near to it that rounding could
/// hide on which side it is.
#[inline(always)]
pub fn stands_off(point: DVec3, point_error: DVec3, geometric_normal: DVec3, target: DVec3) -> bool {
    let height = geometric_normal.dot(target - point).abs();
    let uncertainty = geometric_normal.abs().dot(point_error);
    height > 16.0 * uncertainty
}

/// One step of `f64` further in the direction of `step`: the sum may have been rounded back.
#[inline(always)]
fn round_along(value: f64, step: f64) -> f64 {
    if step > 0.0 {
        value.next_up()
    } else if step < 0.0 {
        value.next_down()
    } else {
        value
    }
}
