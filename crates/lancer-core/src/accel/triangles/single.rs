//! One ray against the triangles of a mesh.

use super::TriangleTree;
use super::block::{BLOCK, BlockRay};
use super::ray::NarrowRay;
use super::walk::walk;
use crate::accel::tally::Tally;
use crate::geometry::Ray;
use crate::shape::Hit;
use crate::shape::triangle::{Canonical, Nearest};
use arrayvec::ArrayVec;
use fearless_simd::Simd;

/// Triangles that may be the nearest hit, kept until the walk has ended. More than one are kept only where two
/// lie within rounding of each other, as at an edge.
const CANDIDATES: usize = 8;

#[derive(Clone, Copy)]
struct Candidate {
    block: u32,
    lane: u32,
    earliest: f32,
}

/// The nearest hit.
#[inline(always)]
pub(super) fn intersect<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    ray: &Ray,
    narrow: &NarrowRay,
    tally: &impl Tally,
) -> Option<Hit> {
    let block_ray = BlockRay::new(simd, narrow);
    let mut nearest: Option<Nearest> = None;
    let mut candidates = ArrayVec::<Candidate, CANDIDATES>::new();
    let mut end = narrow.end;
    walk::<S, true>(simd, &tree.nodes, narrow, tally, |leaf| {
        let mut left = leaf.count();
        let mut index = leaf.first();
        while left > 0 {
            tally.triangles(left.min(BLOCK));
            let verdict = tree.blocks[index].test(simd, &block_ray, left.min(BLOCK), end);
            let mut maybe = verdict.maybe;
            while maybe != 0 {
                let lane = maybe.trailing_zeros() as usize;
                let sure = verdict.sure >> lane & 1 == 1;
                maybe &= maybe - 1;
                let earliest = verdict.earliest(lane);
                if sure {
                    end = end.min(verdict.latest(lane));
                }
                if candidates.is_full() {
                    candidates.retain(|candidate| candidate.earliest <= end);
                }
                if candidates.is_full() {
                    let nearest = nearest.get_or_insert_with(|| Nearest::new(ray));
                    settle(tree, nearest, &mut candidates, end);
                    if nearest.found().is_some() {
                        end = end.min(narrow.up_to(nearest.t()));
                    }
                }
                candidates.push(Candidate { block: index as u32, lane: lane as u32, earliest });
            }
            left = left.saturating_sub(BLOCK);
            index += 1;
        }
        end
    });
    if !candidates.is_empty() {
        settle(tree, nearest.get_or_insert_with(|| Nearest::new(ray)), &mut candidates, end);
    }
    nearest.and_then(|nearest| nearest.found())
}

/// Lets the canonical test decide between the candidates.
#[inline(never)]
fn settle(
    tree: &TriangleTree,
    nearest: &mut Nearest,
    candidates: &mut ArrayVec<Candidate, CANDIDATES>,
    end: f32,
) {
    for candidate in candidates.drain(..).filter(|candidate| candidate.earliest <= end) {
        let block = &tree.blocks[candidate.block as usize];
        let lane = candidate.lane as usize;
        nearest.consider(block.ids[lane], &block.triangle(lane));
    }
}

/// Whether anything is hit.
#[inline(always)]
pub(super) fn occluded<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    ray: &Ray,
    narrow: &NarrowRay,
    tally: &impl Tally,
) -> bool {
    let block_ray = BlockRay::new(simd, narrow);
    let mut found = false;
    let mut canonical = Canonical::new(ray);
    walk::<S, true>(simd, &tree.nodes, narrow, tally, |leaf| {
        let mut left = leaf.count();
        let mut index = leaf.first();
        while left > 0 {
            let block = &tree.blocks[index];
            tally.triangles(left.min(BLOCK));
            let verdict = block.test(simd, &block_ray, left.min(BLOCK), narrow.end);
            let mut unsure = verdict.maybe;
            if verdict.sure != 0 {
                found = true;
                return -1.0;
            }
            while unsure != 0 {
                let lane = unsure.trailing_zeros() as usize;
                unsure &= unsure - 1;
                if canonical.hits(&block.triangle(lane)) {
                    found = true;
                    return -1.0;
                }
            }
            left = left.saturating_sub(BLOCK);
            index += 1;
        }
        narrow.end
    });
    found
}
