//! The canonical shapes, each in a file of its own.
//!
//! In: a ray in the shape's space. Out: the nearest t, then, for the one hit that counts, the surface there.
//! They know no accelerator, material or light.
//!
//! Every shape promises two things that the rest of the renderer builds on. The side of the surface on which
//! a ray starts is decided without rounding error that matters, so that a ray which starts off the surface by
//! the error bound of [`SurfacePoint`] never meets it again. And closed shapes have no cracks: what enters
//! leaves.

pub mod cube;
pub mod cylinder;
pub mod plane;
pub mod sphere;
pub mod triangle;

#[cfg(test)]
mod tests;

use crate::color::{Colors, Rgb};
use crate::geometry::{DVec2, DVec3, RayPacket, Vectors, packet};

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter there.
    pub t: f64,
    /// Which face of the shape, or which triangle of the mesh.
    pub primitive: u32,
}

/// The surface at a hit, in the shape's space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, put back onto the surface as well as rounding allows.
    pub point: DVec3,
    /// How far from the surface it may still lie, by axis.
    pub point_error: DVec3,
    /// The outward normal of the surface; any length but zero.
    pub geometric_normal: DVec3,
    /// The normal for shading, on the same side; any length but zero.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
    /// The colour that the shape itself has here; white but for meshes with vertex colours.
    pub vertex_color: Rgb,
}

/// The surfaces at the hits of a packet, lane by lane as vector instructions want them.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfacePoints {
    pub(crate) point: Vectors,
    pub(crate) point_error: Vectors,
    pub(crate) geometric_normal: Vectors,
    pub(crate) shading_normal: Vectors,
    pub(crate) uv: [[f64; RayPacket::LANES]; 2],
    pub(crate) vertex_color: Colors,
}

impl SurfacePoints {
    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> SurfacePoint {
        SurfacePoint {
            point: packet::at(&self.point, lane),
            point_error: packet::at(&self.point_error, lane),
            geometric_normal: packet::at(&self.geometric_normal, lane),
            shading_normal: packet::at(&self.shading_normal, lane),
            uv: DVec2::new(self.uv[0][lane], self.uv[1][lane]),
            vertex_color: self.vertex_color.at(lane),
        }
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, surface: &SurfacePoint) {
        packet::put(&mut self.point, lane, surface.point);
        packet::put(&mut self.point_error, lane, surface.point_error);
        packet::put(&mut self.geometric_normal, lane, surface.geometric_normal);
        packet::put(&mut self.shading_normal, lane, surface.shading_normal);
        (self.uv[0][lane], self.uv[1][lane]) = (surface.uv.x, surface.uv.y);
        self.vertex_color.put(lane, surface.vertex_color);
    }
}

impl Hit {
    /// None, where vector code wants something all the same.
    const NONE: Self = Self { t: f64::INFINITY, primitive: 0 };

    /// What a shape's `nearest` found.
    pub(crate) fn found(self) -> Option<Self> {
        (self.t != f64::INFINITY).then_some(self)
    }
}

/// The hits of a packet with a shape, lane by lane as vector instructions want them; infinite where there is none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hits {
    pub(crate) t: [f64; RayPacket::LANES],
    pub(crate) primitive: [u32; RayPacket::LANES],
}

impl Hits {
    pub(crate) const NONE: Self =
        Self { t: [f64::INFINITY; RayPacket::LANES], primitive: [0; RayPacket::LANES] };

    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> Hit {
        Hit { t: self.t[lane], primitive: self.primitive[lane] }
    }

    /// The rays that hit, a bit for each.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> u32 {
        (0..RayPacket::LANES).fold(0, |set, lane| set | u32::from(self.t[lane] < f64::INFINITY) << lane)
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, hit: Hit) {
        (self.t[lane], self.primitive[lane]) = (hit.t, hit.primitive);
    }

    #[inline]
    pub(crate) fn put_found(&mut self, lane: usize, hit: Option<Hit>) {
        self.put(lane, hit.unwrap_or(Hit::NONE));
    }
}

/// The stretch of a line inside of a convex shape, with the faces at its ends; empty where it ends before it begins.
/// Without branches, so that vector code can be made of it.
#[derive(Clone, Copy, Debug)]
struct Chord {
    enter: Hit,
    exit: Hit,
}

impl Chord {
    /// The whole line.
    const LINE: Self = Self::new([f64::NEG_INFINITY, f64::INFINITY], [0, 0]);

    const EMPTY: Self = Self::new([f64::INFINITY, f64::NEG_INFINITY], [0, 0]);

    #[inline(always)]
    const fn new([enter, exit]: [f64; 2], [near, far]: [u32; 2]) -> Self {
        Self { enter: Hit { t: enter, primitive: near }, exit: Hit { t: exit, primitive: far } }
    }

    /// The part of the chord in another convex shape. Where faces meet, the earlier shape's is kept.
    #[inline(always)]
    fn clip(self, other: Self) -> Self {
        Self {
            enter: if other.enter.t > self.enter.t { other.enter } else { self.enter },
            exit: if other.exit.t < self.exit.t { other.exit } else { self.exit },
        }
    }

    /// The part of a line between the planes -1 and 1 of one coordinate, with the faces `low` and `high`.
    ///
    /// The signs of the two parameters are exact, since those of the differences are.
    #[inline(always)]
    fn slab(origin: f64, direction: f64, low: u32, high: u32) -> Self {
        let (below, above) = ((-1.0 - origin) / direction, (1.0 - origin) / direction);
        let forward = direction > 0.0;
        let ends = if forward { [below, above] } else { [above, below] };
        let faces = if forward { [low, high] } else { [high, low] };
        let beside = if origin.abs() <= 1.0 { Self::LINE } else { Self::EMPTY };
        if direction == 0.0 { beside } else { Self::new(ends, faces) }
    }

    /// The first end in (0, `t_max`) that `counts`.
    #[inline(always)]
    fn first_hit(self, t_max: f64, counts: impl Fn(f64) -> bool) -> Hit {
        let Self { enter, exit } = self;
        let is_hit = |t: f64| (enter.t <= exit.t) & (t > 0.0) & (t < t_max) & counts(t);
        let exit = if is_hit(exit.t) { exit } else { Hit::NONE };
        if is_hit(enter.t) { enter } else { exit }
    }
}

/// The stretch of the line `o + t d` inside of the unit circle or sphere, for vectors of either dimension given
/// by their scalar products: `oo` = o.o, `od` = o.d, `dd` = d.d, and `nearest` = |o + (-od/dd) d|^2. Where it enters
/// and where it leaves; NaN where it passes by. Without branches, so that vector code can be made of it.
///
/// Source: Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
/// Gems, 2019). The sign of o.o - 1 alone decides whether the ray starts inside.
#[inline(always)]
fn unit_ball_chord(oo: f64, od: f64, dd: f64, nearest: f64) -> [f64; 2] {
    let outside = oo - 1.0;
    // From inside the line always leaves; the bound keeps that true under rounding.
    let half_chord_squared = (1.0 - nearest).max(-outside);
    let passes = half_chord_squared < 0.0;
    let root = if passes { f64::NAN } else { (dd * half_chord_squared).sqrt() };
    let q = if od < 0.0 { root - od } else { -od - root };
    let q = if q == 0.0 { f64::NAN } else { q };
    let (a, b) = (outside / q, q / dd);
    if a < b { [a, b] } else { [b, a] }
}

/// Relative error of a coordinate that was put back onto a unit sphere or circle, as a number of roundings;
/// generous, since it also keeps grazing rays that just left from finding the far side of a chord of rounding
/// noise.
const ON_UNIT_BALL: u32 = 24;

/// The angle of (`x`, `z`) about the y axis as a fraction of a turn in [0, 1), from +z toward +x.
fn turn_about_y(x: f64, z: f64) -> f64 {
    let turn = crate::geometry::portable::atan2(x, z) / std::f64::consts::TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}
