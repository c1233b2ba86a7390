//! x^2 + y^2 + z^2 = 1.

use super::{Chord, Hit, ON_UNIT_BALL, SurfacePoint, turn_about_y, unit_ball_chord};
use crate::color::Rgb;
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec2, DVec3, Ray, RayPacket, portable};
use std::f64::consts::PI;

/// The box around it, in its own space.
pub fn bounds() -> Bounds {
    Bounds::new(DVec3::NEG_ONE, DVec3::ONE)
}

/// The nearest hit with t in (0, `t_max`) of a ray in the sphere's space, from outside or from inside.
/// `primitive` is 0.
pub fn intersect(ray: &Ray) -> Option<Hit> {
    let Approach { oo, od, dd, nearest } = Approach::new(ray);
    if oo >= 1.0 && od >= 0.0 {
        return None;
    }
    let [enter, exit] = unit_ball_chord(oo, od, dd, nearest)?;
    let hit = |t| Hit { t, primitive: 0 };
    Chord { enter: hit(enter), exit: hit(exit) }.first_hit(ray.t_max)
}

/// How a ray's line passes the centre: scalar products of its origin o and direction d, and the square of the line's
/// least distance.
struct Approach {
    oo: f64,
    od: f64,
    dd: f64,
    nearest: f64,
}

impl Approach {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let (o, d) = (ray.origin, ray.direction);
        let (od, dd) = (o.dot(d), d.dot(d));
        Self { oo: o.dot(o), od, dd, nearest: (o - d * (od / dd)).length_squared() }
    }
}

/// The lanes of a packet that may hold a hit: the others start outside and lead away or pass by, and [`intersect`]
/// finds nothing for them.
pub(crate) fn may_meet(rays: &RayPacket) -> u32 {
    let mut misses = [false; RayPacket::LANES];
    for (lane, misses) in misses.iter_mut().enumerate() {
        let Approach { oo, od, nearest, .. } = Approach::new(&rays.ray(lane));
        *misses = (oo >= 1.0) & (od >= 0.0) | (oo > 1.0) & (nearest > 1.0);
    }
    misses.iter().rev().fold(0, |lanes, &misses| lanes << 1 | u32::from(!misses))
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
