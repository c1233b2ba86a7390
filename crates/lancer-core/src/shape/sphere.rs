//! x^2 + y^2 + z^2 = 1.

use super::{Hit, ON_UNIT_BALL, SurfacePoint, hit_at, turn_about_y, unit_ball_chord};
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
    hit_at(nearest(ray))
}

/// The t of that hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray) -> f64 {
    let (o, d) = (ray.origin, ray.direction);
    let (oo, od, dd) = (o.dot(o), o.dot(d), d.dot(d));
    let [enter, exit] = unit_ball_chord(oo, od, dd, (o - d * (od / dd)).length_squared());
    let leads_away = (oo >= 1.0) & (od >= 0.0);
    let counts = |t: f64| !leads_away & (t > 0.0) & (t < ray.t_max);
    let exit = if counts(exit) { exit } else { f64::INFINITY };
    if counts(enter) { enter } else { exit }
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit. u turns about y from +z toward +x, v rises from the south pole to the north pole.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let surface = plain_surface(ray, hit.t);
    SurfacePoint { uv: uv(surface.point), ..surface }
}

/// The same without its texture coordinates, which cost more than the rest, and without branches.
#[inline(always)]
pub(crate) fn plain_surface(ray: &Ray, t: f64) -> SurfacePoint {
    let point = ray.at(t).normalize();
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
