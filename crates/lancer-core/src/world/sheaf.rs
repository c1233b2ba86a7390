//! Rays of a packet against boxes, all at once.

use crate::geometry::{Bounds, DVec3, RayPacket, Vectors};
use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

const LANES: usize = RayPacket::LANES;

/// What holds some rays of a packet: the intervals of their origins and of their directions, and the latest of their
/// ends.
///
/// Source: Boulos, Wald, Shirley, "Geometric and arithmetic culling methods for entire ray packets" (2006).
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheaf {
    origin: Bounds,
    direction: Bounds,
    t_max: f64,
}

impl Sheaf {
    /// Around the rays `wanted`, of which there is one, each up to its `t_max`. Those with a coordinate that is no number
    /// do not count: they meet nothing.
    #[inline(always)]
    pub(super) fn around<S: Simd>(simd: S, rays: &RayPacket, t_max: &[f64; LANES], wanted: u32) -> Self {
        Self {
            origin: bounds(simd, &rays.origin, wanted),
            direction: bounds(simd, &rays.direction, wanted),
            t_max: interval(simd, t_max, wanted).1,
        }
    }

    /// Whether one of the rays may meet what lies in a box; never false where it does.
    #[inline(always)]
    pub(super) fn may_meet(&self, bounds: &Bounds) -> bool {
        let Self { origin, direction, t_max } = self;
        // All rounding in f64, here and in the canonical tests, is below this.
        let size = origin.magnitude().max_element() + bounds.magnitude().max_element();
        let slack = size * (256.0 * f64::EPSILON);
        let (min, max) = (bounds.min - slack, bounds.max + slack);
        // The box is ahead of rays that go up an axis, or down. Where none goes there they never get to it.
        let up = (min - origin.max) / direction.max.max(DVec3::ZERO);
        let down = (origin.min - max) / (-direction.min).max(DVec3::ZERO);
        let enter = up.max(down).max_element();
        let leave = |axis: usize| {
            if direction.min[axis] > 0.0 {
                (max[axis] - origin.min[axis]) / direction.min[axis]
            } else if direction.max[axis] < 0.0 {
                (min[axis] - origin.max[axis]) / direction.max[axis]
            } else {
                f64::INFINITY
            }
        };
        let leave = leave(0).min(leave(1)).min(leave(2)).min(*t_max);
        let misses = enter > leave || leave < 0.0;
        !misses
    }
}

/// The box around the vectors in some lanes.
#[inline(always)]
fn bounds<S: Simd>(simd: S, [x, y, z]: &Vectors, wanted: u32) -> Bounds {
    let (x, y, z) = (interval(simd, x, wanted), interval(simd, y, wanted), interval(simd, z, wanted));
    Bounds { min: DVec3::new(x.0, y.0, z.0), max: DVec3::new(x.1, y.1, z.1) }
}

/// The least and the greatest of the values in some lanes.
#[inline(always)]
fn interval<S: Simd>(simd: S, values: &[f64; LANES], wanted: u32) -> (f64, f64) {
    // The other lanes are like one of them.
    let first = f64x8::splat(simd, values[wanted.trailing_zeros() as usize]);
    let (lower, upper) = values.split_at(LANES / 2);
    let lower = mask(simd, wanted).select(f64x8::from_slice(simd, lower), first);
    let upper = mask(simd, wanted >> (LANES / 2)).select(f64x8::from_slice(simd, upper), first);
    (lower.min_precise(upper).reduce_min_precise(), lower.max_precise(upper).reduce_max_precise())
}

/// The lanes whose bits are set among the lowest eight.
#[inline(always)]
fn mask<S: Simd>(simd: S, lanes: u32) -> mask64x8<S> {
    mask64x8::from_bitmask(simd, u64::from(lanes & 0xff))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::bits;
    use crate::geometry::Ray;
    use crate::simd::InstructionSet;
    use crate::testing::Random;
    use fearless_simd::{Level, dispatch};

    fn around(level: Level, rays: &RayPacket, wanted: u32) -> Sheaf {
        dispatch!(level, simd => Sheaf::around(simd, rays, &rays.t_max, wanted))
    }

    fn levels() -> impl Iterator<Item = Level> {
        InstructionSet::ALL.into_iter().filter_map(InstructionSet::level)
    }

    /// A box, some of them flat.
    fn any_box(random: &mut Random) -> Bounds {
        let mut bounds = Bounds::of_points([random.point(3.0), random.point(3.0)]);
        if random.below(4) == 0 {
            let axis = random.below(3);
            bounds.max[axis] = bounds.min[axis];
        }
        bounds
    }

    fn point_in(bounds: &Bounds, random: &mut Random) -> DVec3 {
        let part = DVec3::new(random.between(0.0, 1.0), random.between(0.0, 1.0), random.between(0.0, 1.0));
        bounds.min + bounds.extent() * part
    }

    #[test]
    fn a_box_that_a_ray_meets_is_never_missed() {
        let mut random = Random::new(11);
        for round in 0..4000 {
            let bounds = any_box(&mut random);
            let mut rays = RayPacket::splat(&Ray::new(DVec3::NAN, DVec3::NAN));
            let wanted = 1 + random.below(0xffff) as u32;
            let meets = bits(wanted).nth(random.below(wanted.count_ones() as usize)).unwrap();
            for lane in bits(wanted) {
                let size = if round % 2 == 0 { 1e6 } else { 5.0 };
                rays.set(lane, &random.ray(size));
                // Sometimes a ray that could meet nothing.
                rays.origin[random.below(3)][lane] *= if random.below(16) == 0 { f64::NAN } else { 1.0 };
            }
            let target = point_in(&bounds, &mut random);
            let origin = if round % 3 == 0 { target } else { random.ray(8.0).origin };
            // One that ends just there, one that goes on, and one along an axis.
            let segment = Ray::between(origin, target);
            let ray = match random.below(3) {
                0 => segment,
                1 => Ray { t_max: f64::INFINITY, ..segment },
                _ => {
                    let direction = random.ray(1.0).direction;
                    Ray { t_max: 4.0, ..Ray::new(target - direction * 4.0, direction) }
                }
            };
            rays.set(meets, &ray);
            for level in levels() {
                assert!(around(level, &rays, wanted).may_meet(&bounds), "{ray:?} meets {bounds:?}");
            }
        }
    }

    #[test]
    fn rays_that_all_pass_by_are_told() {
        let bounds = Bounds::new(DVec3::splat(-1.0), DVec3::splat(1.0));
        let eye = DVec3::new(0.0, 0.0, 10.0);
        let towards = |target: DVec3, t_max: f64| {
            let mut rays = RayPacket::default();
            for lane in 0..LANES {
                let aside = DVec3::new((lane % 4) as f64, (lane / 4) as f64, 0.0) * 0.1;
                rays.set(lane, &Ray { t_max, ..Ray::between(eye, target + aside) });
            }
            rays
        };
        for level in levels() {
            let meets = |rays: &RayPacket| around(level, rays, 0xffff).may_meet(&bounds);
            assert!(meets(&towards(DVec3::ZERO, f64::INFINITY)));
            assert!(!meets(&towards(DVec3::X * 3.0, f64::INFINITY)), "they go past it on the right");
            assert!(!meets(&towards(DVec3::Z * 3.0, 1.0)), "they end before it");
            assert!(!meets(&towards(DVec3::Z * 20.0, f64::INFINITY)), "they go away from it");
            // The rays that do not count are those that would meet it.
            let mut rays = towards(DVec3::X * 3.0, f64::INFINITY);
            rays.set(3, &Ray::between(eye, DVec3::ZERO));
            assert!(!around(level, &rays, 0xffff & !(1 << 3)).may_meet(&bounds));
            assert!(around(level, &rays, 1 << 3).may_meet(&bounds));
        }
    }
}
