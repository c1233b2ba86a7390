//! x^2 + y^2 + z^2 = 1.

use super::{Chord, Hit, ON_UNIT_BALL, SurfacePoint, turn_about_y, unit_ball_chord};
use crate::color::Rgb;
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec2, DVec3, Ray, portable};
use std::f64::consts::PI;

/// The box around it, in its own space.
pub fn bounds() -> Bounds {
    Bounds::new(DVec3::NEG_ONE, DVec3::ONE)
}

/// The nearest hit with t in (0, `t_max`) of a ray in the sphere's space, from outside or from inside.
/// `primitive` is 0.
pub fn intersect(ray: &Ray) -> Option<Hit> {
    nearest(ray).found()
}

/// That hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray) -> Hit {
    let (o, d) = (ray.origin, ray.direction);
    let (oo, od, dd) = (o.dot(o), o.dot(d), d.dot(d));
    let ends = unit_ball_chord(oo, od, dd, (o - d * (od / dd)).length_squared());
    let leads_away = (oo >= 1.0) & (od >= 0.0);
    Chord::new(ends, [0, 0]).first_hit(ray.t_max, |_| !leads_away)
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit. u turns about y from +z toward +x, v rises from the south pole to the north pole.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let surface = plain_surface(ray, hit);
    SurfacePoint { uv: uv(surface.point), ..surface }
}

/// The same without its texture coordinates, which cost more than the rest, and without branches.
#[inline(always)]
pub(crate) fn plain_surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let point = ray.at(hit.t).normalize();
    SurfacePoint {
        point,
        point_error: DVec3::splat(gamma(ON_UNIT_BALL)),
        geometric_normal: point,
        shading_normal: point,
        uv: DVec2::ZERO,
        vertex_color: Rgb::WHITE,
    }
}

/// The texture coordinates of a point on the sphere.
pub(crate) fn uv(point: DVec3) -> DVec2 {
    DVec2::new(turn_about_y(point.x, point.z), 1.0 - portable::acos(point.y) / PI)
}
