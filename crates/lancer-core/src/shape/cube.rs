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
    let (o, d) = (ray.origin, ray.direction);
    Chord::slab(o.x, d.x, 0, 1)?
        .clip(Chord::slab(o.y, d.y, 2, 3)?)?
        .clip(Chord::slab(o.z, d.z, 4, 5)?)?
        .first_hit(ray.t_max)
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit. Seen from outside with +y up, u runs to the right and v upward over each side face;
/// over the top and the bottom, u runs along +x.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let (axis, positive) = ((hit.primitive / 2) as usize, hit.primitive % 2 == 1);
    let sign = if positive { 1.0 } else { -1.0 };
    let mut point = ray.at(hit.t).clamp(DVec3::NEG_ONE, DVec3::ONE);
    point[axis] = sign;
    let mut normal = DVec3::ZERO;
    normal[axis] = sign;
    let across = match axis {
        0 => DVec2::new(-sign * point.z, point.y),
        1 => DVec2::new(point.x, -sign * point.z),
        _ => DVec2::new(sign * point.x, point.y),
    };
    SurfacePoint {
        point,
        point_error: DVec3::ZERO,
        geometric_normal: normal,
        shading_normal: normal,
        uv: (across + DVec2::ONE) * 0.5,
        vertex_color: Rgb::WHITE,
    }
}
