//! A ray in `f32`, with bounds on what that loses.

use crate::geometry::{Bounds, DVec3, Ray};
use crate::shape::triangle::widened;

/// Half the distance from 1 to the next `f32`: the relative error of one operation.
pub(super) const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// What a few products that are too small for `f32` may lose: far above the least `f32`, far below any error of a
/// triangle worth seeing.
pub(super) const UNDERFLOW: f32 = 1e-36;

/// A ray made ready for the boxes and triangles within certain bounds.
///
/// It is scaled so that its direction's largest component is 1 in size, and starts near the bounds even if the
/// ray starts far away, so that `f32` is spent on the part of the ray that counts. Parameters along it, `s`, are
/// therefore not the ray's own t; see [`NarrowRay::up_to`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct NarrowRay {
    /// Where it starts, rounded, and the remainder, rounded.
    pub(super) origin: [f32; 3],
    pub(super) origin_rest: [f32; 3],
    pub(super) direction: [f32; 3],
    /// 1 / direction, with components too small for that enlarged.
    pub(super) inverse: [f32; 3],
    /// What is added to a plane's coordinate times `inverse`: for the planes that the ray enters by, and leaves
    /// by. Each is moved outward by more than all rounding in a slab test, so that no box that the ray meets is
    /// missed.
    pub(super) enter_offset: [f32; 3],
    pub(super) leave_offset: [f32; 3],
    /// What those offsets hold for that, as a distance.
    pub(super) margin: f32,
    /// How far its start may lie from the true one.
    pub(super) origin_error: f32,
    /// Up to which `s` hits count. May exceed the bounds.
    pub(super) end: f32,
    /// The ray's t at `s` = 0, and the `s` of a unit of t.
    pub(super) start: f64,
    pub(super) scale: f64,
}

/// What becomes of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Narrowed {
    /// It does not meet the bounds.
    Misses,
    /// It can be traced in `f32`.
    Ready(NarrowRay),
    /// Its numbers are too large or too small for `f32`, or its origin too far away.
    OutOfRange,
}

/// Sizes of coordinates for which no product of a kernel leaves the range of `f32`.
const SIZES: std::ops::Range<f64> = 1e-9..1e9;

/// A component of a direction below this is taken for it, so that its inverse is finite: the slab test makes room for
/// how far that moves the ray. Larger would let rays be tried that pass by; smaller would leave the range of `f32`.
pub(super) const LEAST_COMPONENT: f64 = 1.0 / (1_u64 << 40) as f64;

impl NarrowRay {
    /// Prepares a ray for what lies within `bounds`, which are finite and not empty.
    #[inline(always)]
    pub(crate) fn prepare(ray: &Ray, bounds: &Bounds) -> Narrowed {
        let clipped = Clipped::new(ray, bounds);
        if !clipped.fits {
            Narrowed::OutOfRange
        } else if !clipped.meets {
            Narrowed::Misses
        } else {
            Narrowed::Ready(clipped.narrow())
        }
    }

    /// A ray whose parameter is its own t, of numbers that are known to be in range. `margin` bounds the error of
    /// a slab test by that of a coordinate.
    #[inline(always)]
    pub(super) fn from_narrow(
        origin: [f32; 3],
        origin_rest: [f32; 3],
        direction: [f32; 3],
        inverse: [f32; 3],
        margin: f32,
        origin_error: f32,
        end: f32,
    ) -> Self {
        let base = |axis: usize| -origin[axis] * inverse[axis];
        let slack = |axis: usize| margin * inverse[axis].abs();
        Self {
            origin,
            origin_rest,
            direction,
            inverse,
            enter_offset: [base(0) - slack(0), base(1) - slack(1), base(2) - slack(2)],
            leave_offset: [base(0) + slack(0), base(1) + slack(1), base(2) + slack(2)],
            margin,
            origin_error,
            end,
            start: 0.0,
            scale: 1.0,
        }
    }

    /// The parameter of a t of the ray, not less than the true one and not less than 0.
    #[inline]
    pub(crate) fn up_to(&self, t: f64) -> f32 {
        let s = t * self.scale - self.start;
        let s = (s as f32).max(0.0) * (1.0 + 4.0 * UNIT_ROUNDOFF) + self.origin_error;
        s.min(self.end)
    }
}

/// The part of a ray that lies within bounds, still in `f64`. Without branches, so that many can be made at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clipped {
    /// Where the part starts, a little before the bounds.
    origin: DVec3,
    /// Its largest component is 1 in size.
    direction: DVec3,
    /// How long it is, and how far from the ray's origin it starts, in lengths of `direction`.
    end: f64,
    start: f64,
    /// The length of the ray's own direction in that measure.
    length: f64,
    /// What bounds its coordinates, and all rounding in `f64`.
    size: f64,
    slack: f64,
    /// Whether the ray meets the bounds.
    pub(super) meets: bool,
    /// Whether its numbers suit `f32`.
    pub(super) fits: bool,
}

impl Clipped {
    #[inline(always)]
    pub(super) fn new(ray: &Ray, bounds: &Bounds) -> Self {
        let length = ray.direction.abs().max_element();
        let scale = 1.0 / length;
        let direction = ray.direction * scale;
        let size = size_of(bounds);
        let distance = ray.origin.abs().max_element();
        // All rounding in f64, here and in the canonical test, is below this.
        let slack = (distance + size) * (256.0 * f64::EPSILON);
        // A component that is taken for more than it is moves the ray by no more than this.
        let moved = (distance + size) * LEAST_COMPONENT;
        let inverse = safe_inverse(direction);
        let low = (bounds.min - (slack + moved) - ray.origin) * inverse;
        let high = (bounds.max + (slack + moved) - ray.origin) * inverse;
        let enter = low.min(high).max_element().max(0.0);
        let leave = low.max(high).min_element();
        let last = ray.t_max * length;
        // A little before the bounds, so that a hit on their face is clearly ahead.
        let start = (enter - size * (1.0 / 64.0)).max(0.0);
        Self {
            origin: ray.origin + direction * start,
            direction,
            end: (last - start).min(2.0 * (leave - start) + size),
            start,
            length,
            size,
            slack,
            meets: (enter <= leave) & (enter <= last),
            fits: in_range(bounds, ray.origin) & scale.is_finite() & (length < 1e100),
        }
    }

    /// The ray in `f32`, where it meets the bounds and fits.
    #[inline(always)]
    pub(super) fn narrow(&self) -> NarrowRay {
        let size = self.size.max(self.origin.abs().max_element());
        let narrow = narrowed(self.origin);
        // A slab test computes b * inverse + offset. The sum of its errors is below 12 units of roundoff of
        // |b| + |origin|, each at most `size`. Derived in docs/how-it-works/kernels.md.
        let margin = 24.0 * UNIT_ROUNDOFF * size as f32 + self.slack as f32;
        let ray = NarrowRay::from_narrow(
            narrow,
            narrowed(self.origin - widened(narrow)),
            narrowed(self.direction),
            narrowed(safe_inverse(self.direction)),
            margin,
            self.slack as f32,
            self.end as f32,
        );
        NarrowRay { start: self.start, scale: self.length, ..ray }
    }
}

/// The largest coordinate within `bounds`, in size.
#[inline(always)]
pub(super) fn size_of(bounds: &Bounds) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}

/// Whether kernels can work within `bounds` on rays from `origin`.
#[inline(always)]
pub(super) fn in_range(bounds: &Bounds, origin: DVec3) -> bool {
    let size = size_of(bounds);
    SIZES.contains(&size) & (origin.abs().max_element() < size * 1e6)
}

#[inline(always)]
fn safe_inverse(direction: DVec3) -> DVec3 {
    direction.abs().max(DVec3::splat(LEAST_COMPONENT)).copysign(direction).recip()
}

#[inline(always)]
pub(super) fn narrowed(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
