//! What the rays of a packet may hit first, until the canonical test decides.

use super::TriangleTree;
use super::block::Verdict;
use super::packet::{DONE, LANES, Lane, mask};
use super::ray::UNIT_ROUNDOFF;
use super::single::Candidate;
use crate::accel::bits;
use crate::geometry::RayPacket;
use crate::geometry::packet::TOGETHER;
use crate::shape::Hits;
use crate::shape::triangle::{self, Corners, Nearest};
use arrayvec::ArrayVec;
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u32x16};

/// For each ray of a packet, the triangles that may be its nearest hit.
pub(super) struct Nearby {
    /// One of them, most often the only one, by its place in the blocks; and where it is hit at the soonest, which is
    /// not after the ray's end: infinite where there is none.
    place: [u32; LANES],
    earliest: Lane,
    /// Others, each with its ray, and which rays have any: where triangles lie within rounding of each other, as at
    /// an edge.
    others: ArrayVec<(usize, Candidate), { Self::OTHERS }>,
    crowded: u32,
    /// Rays that had no room for all of theirs.
    pub(super) left_over: u32,
}

impl Nearby {
    /// More others than this are not kept for a packet.
    const OTHERS: usize = 64;

    #[inline(always)]
    pub(super) fn new() -> Self {
        let (place, earliest) = ([0; LANES], [f32::INFINITY; LANES]);
        Self { place, earliest, others: ArrayVec::new(), crowded: 0, left_over: 0 }
    }

    /// Adds a triangle, by its place, for the rays that may hit it before their `end`. Where one hits it for sure, its
    /// end is then no later than that.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, place: u32, verdict: &Verdict<f32x16<S>>, end: &mut Lane) {
        let (earliest, latest) = range(simd, verdict);
        let ends = f32x16::load_array_ref(simd, end);
        let ends = mask(simd, verdict.sure).select(ends.min(latest), ends);
        let known = f32x16::load_array_ref(simd, &self.earliest);
        let first = known.simd_gt(ends) & mask(simd, verdict.maybe);
        let places = u32x16::load_array_ref(simd, &self.place);
        self.place = first.select(u32x16::splat(simd, place), places).into();
        self.earliest = first.select(earliest, known).into();
        *end = ends.into();
        let others = verdict.maybe & !first.to_bitmask() as u32;
        if others != 0 {
            let earliest: Lane = earliest.into();
            for lane in bits(others) {
                self.crowd(lane, Candidate { place, earliest: earliest[lane] }, &mut end[lane]);
            }
        }
    }

    /// The same for one ray, which hits it `latest` at the latest if that is known.
    #[inline(always)]
    pub(super) fn add_to(&mut self, lane: usize, candidate: Candidate, latest: Option<f32>, end: &mut f32) {
        if let Some(latest) = latest {
            *end = end.min(latest);
        }
        if self.earliest[lane] > *end {
            (self.place[lane], self.earliest[lane]) = (candidate.place, candidate.earliest);
        } else {
            self.crowd(lane, candidate, end);
        }
    }

    /// Adds to the others of a ray.
    #[inline]
    fn crowd(&mut self, lane: usize, candidate: Candidate, end: &mut f32) {
        self.crowded |= 1 << lane;
        if self.others.try_push((lane, candidate)).is_err() {
            self.left_over |= 1 << lane;
            *end = DONE;
        }
    }

    /// Lets the canonical test decide for the rays `wanted`: for all at once that have but one triangle, as most do.
    #[inline(always)]
    pub(super) fn settle<S: Simd>(
        &mut self,
        simd: S,
        tree: &TriangleTree,
        rays: &RayPacket,
        ends: &Lane,
        wanted: u32,
    ) -> Hits {
        let mut hits = Hits::NONE;
        let infinite = f32x16::splat(simd, f32::INFINITY);
        let some =
            f32x16::load_array_ref(simd, &self.earliest).simd_lt(infinite).to_bitmask() as u32 & wanted;
        let mut single = some & !self.crowded;
        if single.count_ones() < TOGETHER {
            single = 0;
        } else {
            let mut ids = [0; LANES];
            let mut triangles = Corners::ZERO;
            for lane in bits(single) {
                let (id, triangle) = tree.triangle_at(self.place[lane]);
                triangles.put(lane, &triangle);
                ids[lane] = id;
            }
            hits = Hits { t: triangle::nearest(rays, &triangles), primitive: ids };
        }
        for lane in bits(some & !single) {
            let ray = rays.ray(lane);
            let mut nearest = Nearest::new(&ray);
            let (id, triangle) = tree.triangle_at(self.place[lane]);
            nearest.consider(id, &triangle);
            for (_, other) in
                self.others.iter().filter(|(of, other)| *of == lane && other.earliest <= ends[lane])
            {
                let (id, triangle) = tree.triangle_at(other.place);
                nearest.consider(id, &triangle);
            }
            hits.put_found(lane, nearest.found());
        }
        hits
    }
}

/// Where each ray that may hit a triangle hits it at the soonest, and each that does for sure at the latest.
#[inline(always)]
fn range<S: Simd>(simd: S, verdict: &Verdict<f32x16<S>>) -> (f32x16<S>, f32x16<S>) {
    let &Verdict { numerator, numerator_error, denominator, denominator_error, .. } = verdict;
    let zero = f32x16::splat(simd, 0.0);
    let low = (numerator - numerator_error).max(zero);
    let earliest = low / (denominator + denominator_error) * (1.0 - 4.0 * UNIT_ROUNDOFF);
    let known = denominator.simd_gt(denominator_error);
    let latest =
        (numerator + numerator_error) / (denominator - denominator_error) * (1.0 + 4.0 * UNIT_ROUNDOFF);
    (known.select(earliest, zero), latest)
}
