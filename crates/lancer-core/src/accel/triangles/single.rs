//! One ray against the triangles of a mesh.

use super::TriangleTree;
use super::block::{TestRays, blocks_of, place_of};
use super::ray::NarrowRay;
use super::walk::{LeafVisitor, walk, walk_from};
use crate::accel::bits;
use crate::accel::bvh::Child;
use crate::accel::tally::Tally;
use crate::geometry::Ray;
use crate::shape::Hit;
use crate::shape::triangle::{Canonical, Nearest};
use arrayvec::ArrayVec;
use fearless_simd::{Simd, f32x4};

/// Triangles that may be a ray's nearest hit, kept until its walk has ended. More than one are kept only where two
/// lie within rounding of each other, as at an edge.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates(ArrayVec<Candidate, { Self::ROOM }>);

/// One of them, and where the ray hits it at the soonest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// See [`TriangleTree::triangle_at`].
    pub(super) place: u32,
    pub(super) earliest: f32,
}

impl Candidates {
    const ROOM: usize = 8;

    /// Adds one to those that lie before `end`. False where there is no room.
    #[inline(always)]
    pub(super) fn add(&mut self, candidate: Candidate, end: f32) -> bool {
        self.0.retain(|candidate| candidate.earliest <= end);
        self.0.try_push(candidate).is_ok()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Lets the canonical test decide between them.
    #[inline(never)]
    pub(super) fn settle(&mut self, tree: &TriangleTree, nearest: &mut Nearest, end: f32) {
        for candidate in self.0.drain(..).filter(|candidate| candidate.earliest <= end) {
            let (id, triangle) = tree.triangle_at(candidate.place);
            nearest.consider(id, &triangle);
        }
    }
}

/// Calls `add` with the triangles of a leaf that a ray may hit before `end`, and for those that it hits for sure up
/// to where.
#[inline(always)]
pub(super) fn add_leaf<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    ray: &TestRays<f32x4<S>>,
    leaf: Child,
    end: &mut f32,
    mut add: impl FnMut(Candidate, Option<f32>, &mut f32),
) {
    for (index, count) in blocks_of(leaf) {
        let verdict = tree.blocks[index].test(simd, ray, count, *end);
        let mut maybe = verdict.maybe;
        while maybe != 0 {
            let lane = maybe.trailing_zeros() as usize;
            maybe &= maybe - 1;
            let latest = (verdict.sure >> lane & 1 == 1).then(|| verdict.latest(lane));
            let earliest = verdict.earliest(lane);
            add(Candidate { place: place_of(index, lane), earliest }, latest, end);
        }
    }
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
    let mut search = NearestSearch {
        simd,
        tree,
        ray,
        narrow,
        block_ray: TestRays::new(simd, narrow),
        tally,
        nearest: None,
        candidates: Candidates::default(),
        end: narrow.end,
    };
    walk(simd, &tree.nodes, narrow, tally, &mut search);
    let NearestSearch { mut candidates, mut nearest, end, .. } = search;
    if !candidates.is_empty() {
        candidates.settle(tree, nearest.get_or_insert_with(|| Nearest::new(ray)), end);
    }
    nearest.and_then(|nearest| nearest.found())
}

/// A search for the nearest hit on its way.
struct NearestSearch<'a, S: Simd, T> {
    simd: S,
    tree: &'a TriangleTree,
    ray: &'a Ray,
    narrow: &'a NarrowRay,
    block_ray: TestRays<f32x4<S>>,
    tally: &'a T,
    nearest: Option<Nearest<'a>>,
    candidates: Candidates,
    end: f32,
}

impl<S: Simd, T: Tally> LeafVisitor for NearestSearch<'_, S, T> {
    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> f32 {
        self.tally.triangles(leaf.count());
        let mut end = self.end;
        add_leaf(self.simd, self.tree, &self.block_ray, leaf, &mut end, |candidate, latest, end| {
            *end = latest.map_or(*end, |latest| end.min(latest));
            if !self.candidates.add(candidate, *end) {
                let nearest = self.nearest.get_or_insert_with(|| Nearest::new(self.ray));
                self.candidates.settle(self.tree, nearest, *end);
                if nearest.found().is_some() {
                    *end = end.min(self.narrow.up_to(nearest.t()));
                }
                self.candidates.add(candidate, *end);
            }
        });
        self.end = end;
        end
    }
}

/// Whether anything below `start` is hit, other than the triangle `own`.
#[inline(always)]
pub(super) fn occluded<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    start: Child,
    ray: &Ray,
    narrow: &NarrowRay,
    own: Option<u32>,
    tally: &impl Tally,
) -> bool {
    let block_ray = TestRays::new(simd, narrow);
    let canonical = Canonical::new(ray);
    let mut search = OcclusionSearch { simd, tree, narrow, block_ray, own, tally, canonical, found: false };
    walk_from(simd, &tree.nodes, start, narrow, tally, &mut search);
    search.found
}

/// A search for any hit on its way.
struct OcclusionSearch<'a, S: Simd, T> {
    simd: S,
    tree: &'a TriangleTree,
    narrow: &'a NarrowRay,
    block_ray: TestRays<f32x4<S>>,
    own: Option<u32>,
    tally: &'a T,
    canonical: Canonical<'a>,
    found: bool,
}

impl<S: Simd, T: Tally> LeafVisitor for OcclusionSearch<'_, S, T> {
    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> f32 {
        let Self { simd, tree, own, .. } = *self;
        let end = self.narrow.end;
        self.found =
            leaf_occludes(simd, tree, leaf, &self.block_ray, end, own, &mut self.canonical, self.tally);
        if self.found { -1.0 } else { end }
    }
}

/// Whether a triangle of a leaf, other than the triangle `own`, is hit before `end`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the leaf, the ray, and who is told, each by its parts")]
pub(super) fn leaf_occludes<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    leaf: Child,
    ray: &TestRays<f32x4<S>>,
    end: f32,
    own: Option<u32>,
    canonical: &mut Canonical,
    tally: &impl Tally,
) -> bool {
    for (index, count) in blocks_of(leaf) {
        let block = &tree.blocks[index];
        tally.triangles(count);
        let verdict = block.test(simd, ray, count, end);
        let is_hit = |lane: usize| own != Some(block.ids[lane]) && canonical.hits(&block.triangle(lane));
        if verdict.sure != 0 || bits(verdict.maybe).any(is_hit) {
            return true;
        }
    }
    false
}
