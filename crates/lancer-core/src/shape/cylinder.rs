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
    nearest(ray, capped).found()
}

/// That hit, infinite where there is none; without branches.
#[inline(always)]
pub(crate) fn nearest(ray: &Ray, capped: bool) -> Hit {
    let side = side_chord(ray);
    if capped {
        let caps = Chord::slab(ray.origin.y, ray.direction.y, BOTTOM, TOP);
        side.clip(caps).first_hit(ray.t_max, |_| true)
    } else {
        side.first_hit(ray.t_max, |t| ray.at(t).y.abs() <= 1.0)
    }
}

/// Whether the ray, in the shape's space, meets it at any t in (0, `t_max`).
pub fn occluded(ray: &Ray, capped: bool) -> bool {
    intersect(ray, capped).is_some()
}

/// The stretch of the ray's line inside of the unbounded cylinder.
#[inline(always)]
fn side_chord(ray: &Ray) -> Chord {
    let o = DVec2::new(ray.origin.x, ray.origin.z);
    let d = DVec2::new(ray.direction.x, ray.direction.z);
    let (oo, od, dd) = (o.dot(o), o.dot(d), d.dot(d));
    let nearest = (o - d * (od / dd)).length_squared();
    let ends = unit_ball_chord(oo, od, dd, nearest);
    let passes = ends[0].is_nan() | ((oo >= 1.0) & (od >= 0.0));
    let crossing = if passes { Chord::EMPTY } else { Chord::new(ends, [SIDE, SIDE]) };
    let beside = if oo <= 1.0 { Chord::LINE } else { Chord::EMPTY };
    if dd == 0.0 { beside } else { crossing }
}

/// The surface at a hit. On the side u turns about y from +z toward +x and v rises with y; the discs carry the
/// texture's inscribed circle.
pub fn surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let surface = plain_surface(ray, hit);
    SurfacePoint { uv: uv(surface.point, hit.primitive), ..surface }
}

/// The same without its texture coordinates, and without branches.
#[inline(always)]
pub(crate) fn plain_surface(ray: &Ray, hit: &Hit) -> SurfacePoint {
    let on_ray = ray.at(hit.t);
    let around = DVec2::new(on_ray.x, on_ray.z).normalize();
    let on_side = DVec3::new(around.x, on_ray.y.clamp(-1.0, 1.0), around.y);
    let cap = if hit.primitive == TOP { 1.0 } else { -1.0 };
    let on_cap = DVec3::new(on_ray.x, cap, on_ray.z);
    let is_side = hit.primitive == SIDE;
    let normal = if is_side { DVec3::new(around.x, 0.0, around.y) } else { DVec3::new(0.0, cap, 0.0) };
    let error = if is_side { gamma(ON_UNIT_BALL) } else { 0.0 };
    SurfacePoint {
        point: if is_side { on_side } else { on_cap },
        point_error: DVec3::new(error, 0.0, error),
        geometric_normal: normal,
        shading_normal: normal,
        uv: DVec2::ZERO,
        vertex_color: Rgb::WHITE,
    }
}

/// The texture coordinates of a point on the side or on a disc.
pub(crate) fn uv(point: DVec3, face: u32) -> DVec2 {
    if face == SIDE {
        DVec2::new(turn_about_y(point.x, point.z), 0.5 * (point.y + 1.0))
    } else {
        0.5 * (DVec2::new(point.x, -point.y * point.z) + DVec2::ONE)
    }
}
