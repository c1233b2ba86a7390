//! x^2 + z^2 = 1 for -1 <= y <= 1, closed by two discs or open.

use super::{Chord, Hit, ON_UNIT_BALL, SurfacePoint, turn_about_y, unit_ball_chord};
use crate::color::Rgb;
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec2, DVec3, Ray};

const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// The box around it, in its own space.
pub fn bounds() -> Bounds {
    Bounds::new(DVec3::NEG_ONE, DVec3::ONE)
}

/// The nearest hit with t in (0, `t_max`) of a ray in the cylinder's space, from outside or from inside.
/// `primitive` is 0 on the side, 1 on the bottom and 2 on the top.
pub fn intersect(ray: &Ray, capped: bool) -> Option<Hit> {
    let side = side_chord(ray)?;
    if capped {
        let (y, dy) = (ray.origin.y, ray.direction.y);
        return side.clip(Chord::slab(y, dy, BOTTOM, TOP)?)?.first_hit(ray.t_max);
    }
    [side.enter, side.exit]
        .into_iter()
        .find(|hit| hit.t > 0.0 && hit.t < ray.t_max && ray.at(hit.t).y.abs() <= 1.0)
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray, capped: bool) -> bool {
    intersect(ray, capped).is_some()
}

/// The stretch of the ray's line inside of the unbounded cylinder.
fn side_chord(ray: &Ray) -> Option<Chord> {
    let o = DVec2::new(ray.origin.x, ray.origin.z);
    let d = DVec2::new(ray.direction.x, ray.direction.z);
    let (oo, od, dd) = (o.dot(o), o.dot(d), d.dot(d));
    if dd == 0.0 {
        return (oo <= 1.0).then_some(Chord::LINE);
    }
    if oo >= 1.0 && od >= 0.0 {
        return None;
    }
    let nearest = (o - d * (od / dd)).length_squared();
    let [enter, exit] = unit_ball_chord(oo, od, dd, nearest);
    let hit = |t| Hit { t, primitive: SIDE };
    Some(Chord { enter: hit(enter), exit: hit(exit) })
}

/// The surface at a hit. On the side u turns about y from +z toward +x and v rises with y; the discs carry the
/// texture's inscribed circle.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let on_ray = ray.at(hit.t);
    let (point, error, normal, uv) = if hit.primitive == SIDE {
        let around = DVec2::new(on_ray.x, on_ray.z).normalize();
        let y = on_ray.y.clamp(-1.0, 1.0);
        let error = DVec3::new(gamma(ON_UNIT_BALL), 0.0, gamma(ON_UNIT_BALL));
        let uv = DVec2::new(turn_about_y(around.x, around.y), 0.5 * (y + 1.0));
        (DVec3::new(around.x, y, around.y), error, DVec3::new(around.x, 0.0, around.y), uv)
    } else {
        let y = if hit.primitive == TOP { 1.0 } else { -1.0 };
        let uv = 0.5 * (DVec2::new(on_ray.x, -y * on_ray.z) + DVec2::ONE);
        (DVec3::new(on_ray.x, y, on_ray.z), DVec3::ZERO, DVec3::new(0.0, y, 0.0), uv)
    };
    SurfacePoint {
        point,
        point_error: error,
        geometric_normal: normal,
        shading_normal: normal,
        uv,
        vertex_color: Rgb::WHITE,
    }
}
