//! A few directions of a fan, each on its own way through the tree.
//!
//! What is left of a search where few directions go one way is short: on a detailed mesh a direction looks into two
//! nodes and one leaf more. A walk with a stack for each would spend most of its time on branches that no processor
//! predicts: leaf or node, how many children, whether it ends. So pairs of a direction and a node are kept in a list
//! and worked off in batches, without such branches; what they meet goes to the ends of two lists, of nodes and leaves.

use super::{ALONE, APART, FAN, Fan};
use crate::accel::bits;
use crate::accel::bvh::{Bvh, Child, LEAF, WIDTH, WideNode};
use crate::accel::tally::Tally;
use crate::accel::triangles::TriangleTree;
use crate::accel::triangles::block::{BLOCK, Block, TestRays, TestTriangles};
use crate::accel::triangles::lanes::{joined, splat3};
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f32x16, mask32x8, u32x4, u32x8};

/// Pairs that go a step together: as many as hide how long one takes.
const BATCH: usize = 16;

/// So many pairs are worth a batch. Fewer would not fill it; with more, directions that are stopped by what is near go
/// on to what is far.
const ENOUGH: usize = 6;

/// Nodes that may wait before they are taken one by one, which is depth first: no more than [`DEEPEST`] then join them.
const WAITING: usize = ENOUGH + ALONE as usize + 2 * BATCH * (WIDTH - 1);
const DEEPEST: usize = (WIDTH - 1) * (Bvh::MAX_DEPTH as usize + 1);

/// Leaves that may wait: those of a batch, and those that are added before it.
const LEAVES: usize = BATCH * WIDTH + BATCH + APART as usize;

/// Blocks of triangles that are tested at once, each with its direction.
const TOGETHER: usize = 4;

/// Pairs of a direction and a node or a leaf that it may meet. The last [`WIDTH`] places are kept free.
#[derive(Clone, Debug)]
struct List<const ROOM: usize> {
    /// As [`WideNode::words`].
    children: [u32; ROOM],
    directions: [u32; ROOM],
    count: usize,
}

impl<const ROOM: usize> List<ROOM> {
    const EMPTY: Self = Self { children: [0; ROOM], directions: [0; ROOM], count: 0 };

    /// Adds the directions set in `mask` with a child.
    #[inline(always)]
    fn add(&mut self, child: Child, mask: u64) {
        for direction in bits(mask) {
            self.children[self.count] = child.word();
            self.directions[self.count] = direction as u32;
            self.count += 1;
        }
    }

    /// Adds a direction with those of eight children that it has met, without a branch for each.
    #[inline(always)]
    fn append<S: Simd>(&mut self, direction: u32x8<S>, children: u32x8<S>, met: mask32x8<S>) {
        direction.store_slice(&mut self.directions[self.count..self.count + WIDTH]);
        let places = &mut self.children[self.count..self.count + WIDTH];
        if S::u32s::LEN >= WIDTH {
            children.compress(met).store_slice(places);
            self.count += met.to_bitmask().count_ones() as usize;
        } else {
            let mut count = 0;
            for i in 0..WIDTH {
                places[count] = children[i];
                count += (met.to_bitmask() >> i & 1) as usize;
            }
            self.count += count;
        }
    }

    #[inline(always)]
    fn at(&self, place: usize) -> (Child, usize) {
        (Child::of_word(self.children[place]), self.directions[place] as usize % FAN)
    }
}

/// The pairs of a fan that wait for their turn.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    nodes: List<{ WAITING + DEEPEST + WIDTH }>,
    leaves: List<{ LEAVES + WIDTH }>,
    /// One for each block of the leaves: no more than two for each.
    tests: [Test; 2 * LEAVES],
}

impl Default for Pairs {
    fn default() -> Self {
        let none = Test { block: 0, count: 0, direction: 0 };
        Self { nodes: List::EMPTY, leaves: List::EMPTY, tests: [none; 2 * LEAVES] }
    }
}

impl Pairs {
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        (self.nodes.count, self.leaves.count) = (0, 0);
    }

    /// Adds the directions set in `mask`, at most [`ALONE`], with a node. Says whether there are enough to follow.
    #[inline(always)]
    pub(super) fn add(&mut self, node: Child, mask: u64) -> bool {
        self.nodes.add(node, mask);
        self.nodes.count >= ENOUGH
    }

    /// Adds the directions set in `mask`, at most [`APART`], with a leaf. Says whether there are enough to be tested.
    #[inline(always)]
    pub(super) fn add_leaf(&mut self, leaf: Child, mask: u64) -> bool {
        self.leaves.add(leaf, mask);
        self.leaves.count >= BATCH
    }

    /// Follows all to their ends. Returns the directions that meet a triangle.
    #[inline(always)]
    pub(super) fn follow<S: Simd>(
        &mut self,
        simd: S,
        tree: &TriangleTree,
        fan: &Fan,
        tally: &impl Tally,
        decide: &mut impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
    ) -> u64 {
        let mut hit = 0;
        while self.nodes.count + self.leaves.count > 0 {
            let room = WAITING.saturating_sub(self.nodes.count) / (WIDTH - 1);
            let count = self.nodes.count.min(room.clamp(1, BATCH));
            self.nodes.count -= count;
            // What is met takes the places of those that met it.
            let mut batch = [(Child::NONE, 0); BATCH];
            for (i, pair) in batch[..count].iter_mut().enumerate() {
                *pair = self.nodes.at(self.nodes.count + i);
            }
            for &(child, direction) in &batch[..count] {
                if hit >> direction & 1 == 1 {
                    continue;
                }
                tally.node();
                let node = &tree.nodes[child.node()];
                let met = boxes(simd, fan, node, direction);
                let children = u32x8::load_array_ref(simd, &node.words());
                let leaves = children.simd_ge(u32x8::splat(simd, LEAF));
                let direction = u32x8::splat(simd, direction as u32);
                self.nodes.append(direction, children, met & !leaves);
                self.leaves.append(direction, children, met & leaves);
            }
            hit = self.test_leaves(simd, tree, fan, hit, tally, decide);
        }
        hit
    }

    /// Tests the leaves that wait, and adds to those that `hit` a triangle the directions that do.
    #[inline(always)]
    pub(super) fn test_leaves<S: Simd>(
        &mut self,
        simd: S,
        tree: &TriangleTree,
        fan: &Fan,
        mut hit: u64,
        tally: &impl Tally,
        decide: &mut impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
    ) -> u64 {
        // Most leaves have one block; two are written whether there are or not.
        let mut count = 0;
        for place in 0..self.leaves.count {
            let (leaf, direction) = self.leaves.at(place);
            let (block, triangles, direction) = (leaf.first() as u32, leaf.count() as u8, direction as u8);
            let places = &mut self.tests[count..count + 2];
            places[0] = Test { block, count: triangles.min(BLOCK as u8), direction };
            places[1] = Test { block: block + 1, count: triangles.saturating_sub(BLOCK as u8), direction };
            count += 1 + usize::from(triangles > BLOCK as u8);
        }
        self.leaves.count = 0;
        for tests in self.tests[..count].chunks(TOGETHER) {
            hit = test(simd, tree, fan, tests, hit, tally, decide);
        }
        hit
    }
}

/// A direction, and a block of triangles that it may meet.
#[derive(Clone, Copy, Debug)]
struct Test {
    block: u32,
    count: u8,
    direction: u8,
}

/// Adds to those that `hit` a triangle the directions of up to [`TOGETHER`] tests that do.
#[inline(always)]
fn test<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    fan: &Fan,
    tests: &[Test],
    mut hit: u64,
    tally: &impl Tally,
    decide: &mut impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
) -> u64 {
    let mut present = 0;
    for (i, test) in tests.iter().enumerate() {
        if hit >> test.direction & 1 == 0 {
            tally.triangles(usize::from(test.count));
            present |= ((1 << test.count) - 1) << (BLOCK * i);
        }
    }
    if present == 0 {
        return hit;
    }
    // Where there are fewer, the last one is repeated.
    let last = tests.len() - 1;
    let tests = [tests[0], tests[last.min(1)], tests[last.min(2)], tests[last]];
    let mut directions = [0; TOGETHER];
    let mut blocks = [&tree.blocks[tests[0].block as usize]; TOGETHER];
    for i in 0..TOGETHER {
        directions[i] = usize::from(tests[i].direction) % FAN;
        blocks[i] = &tree.blocks[tests[i].block as usize];
    }
    let rays = TestRays {
        origin: splat3(simd, fan.point),
        origin_rest: splat3(simd, fan.point_rest),
        direction: along(simd, fan, directions),
        origin_error: f32x16::splat(simd, fan.error),
    };
    let triangles =
        TestTriangles::new([corner(simd, blocks, 0), corner(simd, blocks, 1), corner(simd, blocks, 2)]);
    let verdict = rays.test(simd, &triangles, present, f32x16::splat(simd, fan.reach));
    // The reach is rounded up, by less than a part in 10^5.
    let sure_end = fan.reach * (1.0 - 1e-5);
    let latest = (verdict.numerator + verdict.numerator_error) * (1.0 + 1e-6);
    let soon = latest.simd_lt((verdict.denominator - verdict.denominator_error) * sure_end);
    let others = !places_of(simd, blocks, fan.own);
    let sure = verdict.sure & others & soon.to_bitmask() as u32;
    for (i, direction) in directions.into_iter().enumerate() {
        hit |= u64::from(sure >> (BLOCK * i) & 0xf != 0) << direction;
    }
    for lane in bits(verdict.maybe & others & !sure) {
        let (i, triangle) = (lane / BLOCK, lane % BLOCK);
        if hit >> directions[i] & 1 == 0 && decide(directions[i], &blocks[i].triangle(triangle)) {
            hit |= 1 << directions[i];
        }
    }
    hit
}

/// The directions of four tests, each for all triangles of a block.
#[inline(always)]
fn along<S: Simd>(simd: S, fan: &Fan, directions: [usize; TOGETHER]) -> [f32x16<S>; 3] {
    [
        along_axis(simd, &fan.direction[0], directions),
        along_axis(simd, &fan.direction[1], directions),
        along_axis(simd, &fan.direction[2], directions),
    ]
}

#[inline(always)]
fn along_axis<S: Simd>(simd: S, values: &[f32; FAN], [a, b, c, d]: [usize; TOGETHER]) -> f32x16<S> {
    joined([
        f32x4::splat(simd, values[a]),
        f32x4::splat(simd, values[b]),
        f32x4::splat(simd, values[c]),
        f32x4::splat(simd, values[d]),
    ])
}

/// A corner of the triangles of four blocks.
#[inline(always)]
fn corner<S: Simd>(simd: S, blocks: [&Block; TOGETHER], corner: usize) -> [f32x16<S>; 3] {
    [
        coordinate(simd, blocks, corner, 0),
        coordinate(simd, blocks, corner, 1),
        coordinate(simd, blocks, corner, 2),
    ]
}

#[inline(always)]
fn coordinate<S: Simd>(simd: S, [a, b, c, d]: [&Block; TOGETHER], corner: usize, axis: usize) -> f32x16<S> {
    joined([
        f32x4::load_array_ref(simd, &a.corners[corner][axis]),
        f32x4::load_array_ref(simd, &b.corners[corner][axis]),
        f32x4::load_array_ref(simd, &c.corners[corner][axis]),
        f32x4::load_array_ref(simd, &d.corners[corner][axis]),
    ])
}

/// Which boxes of a node a direction meets.
#[inline(always)]
fn boxes<S: Simd>(simd: S, fan: &Fan, node: &WideNode, direction: usize) -> mask32x8<S> {
    let splat = |x: f32| f32x8::splat(simd, x);
    let mut enter = splat(0.0);
    let mut leave = splat(fan.reach);
    for axis in 0..3 {
        let inverse = fan.inverse[axis][direction];
        let (near, far) = match inverse < 0.0 {
            true => (&node.max[axis], &node.min[axis]),
            false => (&node.min[axis], &node.max[axis]),
        };
        let (near, far) = (f32x8::load_array_ref(simd, near), f32x8::load_array_ref(simd, far));
        enter = enter.max(near.mul_add(splat(inverse), splat(fan.enter_offset[axis][direction])));
        leave = leave.min(far.mul_add(splat(inverse), splat(fan.leave_offset[axis][direction])));
    }
    enter.simd_le(leave)
}

/// Where a triangle stands in four blocks, a bit for each place.
#[inline(always)]
fn places_of<S: Simd>(simd: S, blocks: [&Block; TOGETHER], id: u32) -> u32 {
    let mut places = 0;
    for (i, block) in blocks.into_iter().enumerate() {
        let here = u32x4::load_array_ref(simd, &block.ids).simd_eq(u32x4::splat(simd, id));
        places |= (here.to_bitmask() as u32) << (BLOCK * i);
    }
    places
}
