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
    let (o, d) = (ray.origin, ray.direction);
    let (od, dd) = (o.dot(d), d.dot(d));
    let oo = o.dot(o);
    if oo >= 1.0 && od >= 0.0 {
        return None;
    }
    let nearest = (o - d * (od / dd)).length_squared();
    let [enter, exit] = unit_ball_chord(oo, od, dd, nearest)?;
    let hit = |t| Hit { t, primitive: 0 };
    Chord { enter: hit(enter), exit: hit(exit) }.first_hit(ray.t_max)
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray) -> bool {
    intersect(ray).is_some()
}

/// The surface at a hit. u turns about y from +z toward +x, v rises from the south pole to the north pole.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let point = ray.at(hit.t).normalize();
    let v = 1.0 - portable::acos(point.y) / PI;
    SurfacePoint {
        point,
        point_error: DVec3::splat(gamma(ON_UNIT_BALL)),
        geometric_normal: point,
        shading_normal: point,
        uv: DVec2::new(turn_about_y(point.x, point.z), v),
        vertex_color: Rgb::WHITE,
    }
}
