//! Four triangles of a leaf, tested at once.
//!
//! Source of the test: Möller, Trumbore, "Fast, minimum storage ray/triangle intersection" (1997). Its results
//! are compared with bounds on their error, so that they are known to be true, known to be false, or left to the
//! canonical test in `f64`.

use super::lanes::{add, at, cross, dot, largest, load3, splat3, sub};
use super::ray::{NarrowRay, UNDERFLOW, UNIT_ROUNDOFF};
use crate::accel::bvh::Child;
use fearless_simd::f32x4;
use fearless_simd::prelude::*;

/// Triangles in a block.
pub(super) const BLOCK: usize = 4;

/// The corners of four triangles as a structure of arrays; and which triangles they are.
///
/// Where there are fewer, the last one is repeated, and `count` of the leaf says so.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// By corner, then by axis, then by triangle.
    pub(super) corners: [[[f32; BLOCK]; 3]; 3],
    pub(super) ids: [u32; BLOCK],
}

/// The places of a leaf's blocks, each with the number of its triangles.
#[inline(always)]
pub(super) fn blocks_of(leaf: Child) -> impl Iterator<Item = (usize, usize)> {
    (0..leaf.count().div_ceil(BLOCK)).map(move |i| (leaf.first() + i, (leaf.count() - i * BLOCK).min(BLOCK)))
}

/// The place of a triangle among those of all blocks.
#[inline(always)]
pub(super) fn place_of(block: usize, triangle: usize) -> u32 {
    (block * BLOCK + triangle) as u32
}

/// What rays do with triangles, a bit for each pair of a ray and a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict<V> {
    /// Pairs that may be a hit; all others are none.
    pub(super) maybe: u32,
    /// Those of them that are a hit for sure.
    pub(super) sure: u32,
    /// Where a triangle is hit: no sooner than `numerator_low / denominator_high`, and if it is sure no later than
    /// `numerator_high / denominator_low`.
    pub(super) numerator: V,
    pub(super) numerator_error: V,
    pub(super) denominator: V,
    pub(super) denominator_error: V,
}

impl<S: Simd> Verdict<f32x4<S>> {
    /// Where a triangle is hit at the soonest: at 0 where the denominator may vanish, since nothing is known then.
    #[inline(always)]
    pub(super) fn earliest(&self, lane: usize) -> f32 {
        if self.denominator[lane] > self.denominator_error[lane] {
            let low = (self.numerator[lane] - self.numerator_error[lane]).max(0.0);
            low / (self.denominator[lane] + self.denominator_error[lane]) * (1.0 - 4.0 * UNIT_ROUNDOFF)
        } else {
            0.0
        }
    }

    #[inline(always)]
    pub(super) fn latest(&self, lane: usize) -> f32 {
        let high = self.numerator[lane] + self.numerator_error[lane];
        high / (self.denominator[lane] - self.denominator_error[lane]) * (1.0 + 4.0 * UNIT_ROUNDOFF)
    }
}

/// The parts of rays that a test wants, one ray a lane, or the same in all.
#[derive(Clone, Copy, Debug)]
pub(super) struct TestRays<V> {
    pub(super) origin: [V; 3],
    pub(super) origin_rest: [V; 3],
    pub(super) direction: [V; 3],
    pub(super) origin_error: V,
}

impl<S: Simd> TestRays<f32x4<S>> {
    /// One ray, for a block of triangles.
    #[inline(always)]
    pub(super) fn new(simd: S, ray: &NarrowRay) -> Self {
        Self {
            origin: splat3(simd, ray.origin),
            origin_rest: splat3(simd, ray.origin_rest),
            direction: splat3(simd, ray.direction),
            origin_error: f32x4::splat(simd, ray.origin_error),
        }
    }
}

/// What a test wants to know of triangles, one triangle a lane, or the same in all.
#[derive(Clone, Copy, Debug)]
pub(super) struct TestTriangles<V> {
    corner: [V; 3],
    /// To the other two.
    edges: [[V; 3]; 2],
    /// The largest component of the edges, in size.
    longest: V,
    determinant_error: V,
}

impl<V> TestTriangles<V> {
    #[inline(always)]
    pub(super) fn new<S: Simd>([a, b, c]: [[V; 3]; 3]) -> Self
    where
        V: SimdFloat<S, Element = f32>,
    {
        let edges = [sub(b, a), sub(c, a)];
        let longest = largest(edges[0]).max(largest(edges[1]));
        let determinant_error = longest * longest * (64.0 * UNIT_ROUNDOFF) + UNDERFLOW;
        Self { corner: a, edges, longest, determinant_error }
    }
}

impl<S: Simd> TestTriangles<f32x4<S>> {
    /// One of them, in all lanes.
    #[inline(always)]
    pub(super) fn splat<V>(&self, simd: S, lane: usize) -> TestTriangles<V>
    where
        V: SimdFloat<S, Element = f32>,
    {
        TestTriangles {
            corner: splat3(simd, at(self.corner, lane)),
            edges: [splat3(simd, at(self.edges[0], lane)), splat3(simd, at(self.edges[1], lane))],
            longest: V::splat(simd, self.longest[lane]),
            determinant_error: V::splat(simd, self.determinant_error[lane]),
        }
    }
}

impl<V> TestRays<V> {
    /// Tests rays against triangles, lane by lane, for hits with `s` in (0, `end`). Of the lanes, `present` count.
    #[inline(always)]
    pub(super) fn test<S: Simd>(
        &self,
        simd: S,
        triangles: &TestTriangles<V>,
        present: u32,
        end: V,
    ) -> Verdict<V>
    where
        V: SimdFloat<S, Element = f32>,
    {
        let &TestTriangles {
            corner: a,
            edges: [e1, e2],
            longest: edge,
            determinant_error: denominator_error,
        } = triangles;
        let from_a = add(sub(self.origin, a), self.origin_rest);
        let p = cross(self.direction, e2);
        let q = cross(from_a, e1);
        let determinant = dot(e1, p);
        // Everything is turned so that the determinant is positive.
        let flip = determinant.simd_lt(V::splat(simd, 0.0));
        let turn = |x: V| flip.select(-x, x);
        let denominator = turn(determinant);
        let (u, v, numerator) = (turn(dot(from_a, p)), turn(dot(self.direction, q)), turn(dot(e2, q)));

        // With S = |from_a|, E = the longer edge, both by their largest component, and e the error of the origin,
        // the errors are below 64 u S E + 8 e E of u and v, 64 u E^2 of the determinant, and E times the former of
        // the numerator. Derived in docs/how-it-works/kernels.md.
        let reach = largest(from_a);
        let error = edge * (reach * (64.0 * UNIT_ROUNDOFF) + self.origin_error * 8.0) + UNDERFLOW;
        let numerator_error = error * edge + UNDERFLOW;
        let sum_error = error * 3.0 + denominator_error * 2.0;
        let rest = denominator - u - v;
        let limit = denominator * end;
        let limit_error = denominator_error * end + limit * (8.0 * UNIT_ROUNDOFF) + numerator_error;

        let in_reach = |value: V, error: V| value.simd_ge(-error);
        let beyond = |value: V, error: V| value.simd_gt(error);
        let maybe = in_reach(u, error)
            & in_reach(v, error)
            & in_reach(rest, sum_error)
            & in_reach(numerator, numerator_error)
            & in_reach(limit - numerator, limit_error)
            | denominator.simd_le(denominator_error);
        let sure = beyond(u, error)
            & beyond(v, error)
            & beyond(rest, sum_error)
            & beyond(numerator, numerator_error)
            & beyond(limit - numerator, limit_error)
            & beyond(denominator, denominator_error);
        let maybe = maybe.to_bitmask() as u32 & present;
        Verdict {
            maybe,
            sure: sure.to_bitmask() as u32 & maybe,
            numerator,
            numerator_error,
            denominator,
            denominator_error,
        }
    }
}

impl Block {
    /// A block of one to four triangles.
    pub(super) fn new(ids: &[u32], vertices: impl Fn(u32) -> [[f32; 3]; 3]) -> Self {
        let ids: [u32; BLOCK] = std::array::from_fn(|lane| ids[lane.min(ids.len() - 1)]);
        let triangles = ids.map(vertices);
        let corners = std::array::from_fn(|corner| {
            std::array::from_fn(|axis| std::array::from_fn(|lane| triangles[lane][corner][axis]))
        });
        Self { corners, ids }
    }

    /// The corners of one of its triangles.
    pub(super) fn triangle(&self, lane: usize) -> [[f32; 3]; 3] {
        let corner = |c: &[[f32; BLOCK]; 3]| [c[0][lane], c[1][lane], c[2][lane]];
        let [a, b, c] = &self.corners;
        [corner(a), corner(b), corner(c)]
    }

    /// Tests a ray against the first `count` triangles, for hits with `s` in (0, `end`).
    #[inline(always)]
    pub(super) fn test<S: Simd>(
        &self,
        simd: S,
        ray: &TestRays<f32x4<S>>,
        count: usize,
        end: f32,
    ) -> Verdict<f32x4<S>> {
        ray.test(simd, &self.triangles(simd), (1 << count) - 1, f32x4::splat(simd, end))
    }

    /// Its triangles, ready to be tested.
    #[inline(always)]
    pub(super) fn triangles<S: Simd>(&self, simd: S) -> TestTriangles<f32x4<S>> {
        let corner = |c: usize| load3(simd, &self.corners[c]);
        TestTriangles::new([corner(0), corner(1), corner(2)])
    }
}
