//! y = 0, unbounded, with the normal +Y.

use super::{Hit, SurfacePoint};
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
    nearest(ray).found()
}

/// That hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray) -> Hit {
    let t = -ray.origin.y / ray.direction.y;
    let counts = (t > 0.0) & (t < ray.t_max);
    if counts { Hit { t, primitive: 0 } } else { Hit::NONE }
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit; u = x and v = -z, so that seen from above with +x to the right, v runs upward.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let surface = plain_surface(ray, hit);
    SurfacePoint { uv: uv(surface.point), ..surface }
}

/// The same without its texture coordinates, and without branches.
#[inline(always)]
pub(crate) fn plain_surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let on_ray = ray.at(hit.t);
    SurfacePoint {
        point: DVec3::new(on_ray.x, 0.0, on_ray.z),
        point_error: DVec3::ZERO,
        geometric_normal: DVec3::Y,
        shading_normal: DVec3::Y,
        uv: DVec2::ZERO,
        vertex_color: Rgb::WHITE,
    }
}

/// The texture coordinates of a point on the plane.
pub(crate) fn uv(point: DVec3) -> DVec2 {
    DVec2::new(point.x, -point.z)
}
