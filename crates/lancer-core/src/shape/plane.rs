//! y = 0, unbounded, with the normal +Y.

use super::{Hit, SurfacePoint, hit_at};
use crate::color::Rgb;
use crate::geometry::{Bounds, DVec2, DVec3, Ray};

/// All of space: it has no finite box.
pub fn bounds() -> Bounds {
    Bounds::UNBOUNDED
}

/// The nearest hit with t in (0, `t_max`) of a ray in the plane's space, from either side. `primitive` is 0.
///
/// A ray along the plane does not meet it, even from within.
pub fn intersect(ray: &Ray) -> Option<Hit> {
    hit_at(nearest(ray))
}

/// The t of that hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray) -> f64 {
    let t = -ray.origin.y / ray.direction.y;
    let counts = (t > 0.0) & (t < ray.t_max);
    if counts { t } else { f64::INFINITY }
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit; u = x and v = -z, so that seen from above with +x to the right, v runs upward.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    surface_at(ray, hit.t)
}

/// The same, without branches.
#[inline(always)]
pub(crate) fn surface_at(ray: &Ray, t: f64) -> SurfacePoint {
    let on_ray = ray.at(t);
    SurfacePoint {
        point: DVec3::new(on_ray.x, 0.0, on_ray.z),
        point_error: DVec3::ZERO,
        geometric_normal: DVec3::Y,
        shading_normal: DVec3::Y,
        uv: DVec2::new(on_ray.x, -on_ray.z),
        vertex_color: Rgb::WHITE,
    }
}
