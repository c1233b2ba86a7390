//! The surface of [-1, 1]^3.

use super::{Chord, Hit, SurfacePoint};
use crate::color::Rgb;
use crate::geometry::{Bounds, DVec2, DVec3, Ray};

/// The box around it, in its own space.
pub fn bounds() -> Bounds {
    Bounds::new(DVec3::NEG_ONE, DVec3::ONE)
}

/// The nearest hit with t in (0, `t_max`) of a ray in the cube's space, from outside or from inside.
/// `primitive` is twice the axis of the face, plus 1 on its positive side.
pub fn intersect(ray: &Ray) -> Option<Hit> {
    nearest(ray).found()
}

/// That hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray) -> Hit {
    let (o, d) = (ray.origin, ray.direction);
    Chord::slab(o.x, d.x, 0, 1)
        .clip(Chord::slab(o.y, d.y, 2, 3))
        .clip(Chord::slab(o.z, d.z, 4, 5))
        .first_hit(ray.t_max, |_| true)
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit. Seen from outside with +y up, u runs to the right and v upward over each side face;
/// over the top and the bottom, u runs along +x.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let surface = plain_surface(ray, hit);
    SurfacePoint { uv: uv(surface.point, hit.primitive), ..surface }
}

/// The same without its texture coordinates, and without branches.
#[inline(always)]
pub(crate) fn plain_surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let sign = if hit.primitive % 2 == 1 { 1.0 } else { -1.0 };
    let on = |axis: u32| hit.primitive / 2 == axis;
    let on_ray = ray.at(hit.t).clamp(DVec3::NEG_ONE, DVec3::ONE);
    let point = DVec3::new(
        if on(0) { sign } else { on_ray.x },
        if on(1) { sign } else { on_ray.y },
        if on(2) { sign } else { on_ray.z },
    );
    let normal_along = |axis: u32| if on(axis) { sign } else { 0.0 };
    let normal = DVec3::new(normal_along(0), normal_along(1), normal_along(2));
    SurfacePoint {
        point,
        point_error: DVec3::ZERO,
        geometric_normal: normal,
        shading_normal: normal,
        uv: DVec2::ZERO,
        vertex_color: Rgb::WHITE,
    }
}

/// The texture coordinates of a point on a face.
pub(crate) fn uv(point: DVec3, face: u32) -> DVec2 {
    let sign = if face % 2 == 1 { 1.0 } else { -1.0 };
    let across = match face / 2 {
        0 => DVec2::new(-sign * point.z, point.y),
        1 => DVec2::new(point.x, -sign * point.z),
        _ => DVec2::new(sign * point.x, point.y),
    };
    (across + DVec2::ONE) * 0.5
}
