//! A few directions of a fan, each on its own way through the tree.
//!
//! What is left of a search where few directions go one way is short: on a detailed mesh a direction looks into two
//! nodes and one leaf more. A walk with a stack for each would spend most of its time on branches that no processor
//! predicts: leaf or node, how many children, whether it ends. So pairs of a direction and a node are kept in a list
//! and worked off in batches, without such branches; what they meet goes to the ends of two lists, of nodes and leaves.

use super::{ALONE, Fan};
use crate::accel::bits;
use crate::accel::bvh::{Bvh, Child, WIDTH, WideNode};
use crate::accel::tally::Tally;
use crate::accel::triangles::TriangleTree;
use crate::accel::triangles::block::{Block, TestRays, blocks_of};
use crate::accel::triangles::lanes::splat3;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, u32x4};

/// Pairs that go a step together: as many as hide how long one takes.
const BATCH: usize = 16;

/// So many pairs are worth a batch. Fewer would not fill it; with more, directions that are stopped by what is near go
/// on to what is far.
const ENOUGH: usize = 6;

/// Nodes that may wait before they are taken one by one, which is depth first: no more than [`DEEPEST`] then join them.
const WAITING: usize = ENOUGH + ALONE as usize + 2 * BATCH * (WIDTH - 1);
const DEEPEST: usize = (WIDTH - 1) * (Bvh::MAX_DEPTH as usize + 1);

/// A direction, and a node or a leaf that it may meet.
#[derive(Clone, Copy)]
struct Pair {
    child: Child,
    direction: u32,
}

/// Some pairs. The last [`WIDTH`] places are kept free.
struct List<const ROOM: usize> {
    pairs: [Pair; ROOM],
    count: usize,
}

impl<const ROOM: usize> List<ROOM> {
    const EMPTY: Self = Self { pairs: [Pair { child: Child::NONE, direction: 0 }; ROOM], count: 0 };

    #[inline(always)]
    fn push(&mut self, pair: Pair) {
        self.pairs[self.count] = pair;
        self.count += 1;
    }

    /// Adds a direction with those of a node's children that are set in `met`. Seldom are there more than three, so
    /// three places are written whether there are or not.
    #[inline(always)]
    fn append(&mut self, direction: u32, node: &WideNode, met: u32) {
        let places = &mut self.pairs[self.count..self.count + WIDTH];
        let mut rest = met;
        let mut next = || {
            let child = node.children[rest.trailing_zeros() as usize % WIDTH];
            rest &= rest.wrapping_sub(1);
            Pair { child, direction }
        };
        places[0] = next();
        places[1] = next();
        places[2] = next();
        let count = met.count_ones() as usize;
        for place in places.iter_mut().take(count).skip(3) {
            *place = next();
        }
        self.count += count;
    }
}

/// The pairs of a fan that wait for their turn.
pub(super) struct Pairs {
    nodes: List<{ WAITING + DEEPEST + WIDTH }>,
    leaves: List<{ (BATCH + 1) * WIDTH }>,
}

impl Pairs {
    pub(super) const EMPTY: Self = Self { nodes: List::EMPTY, leaves: List::EMPTY };

    /// Adds the directions set in `mask`, at most [`ALONE`], with a node. Says whether there are enough to follow.
    #[inline(always)]
    pub(super) fn add(&mut self, node: Child, mask: u64) -> bool {
        for direction in bits(mask) {
            self.nodes.push(Pair { child: node, direction: direction as u32 });
        }
        self.nodes.count >= ENOUGH
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
        while self.nodes.count > 0 {
            let room = WAITING.saturating_sub(self.nodes.count) / (WIDTH - 1);
            let count = self.nodes.count.min(room.clamp(1, BATCH));
            self.nodes.count -= count;
            let mut batch = [Pair { child: Child::NONE, direction: 0 }; BATCH];
            batch[..count].copy_from_slice(&self.nodes.pairs[self.nodes.count..][..count]);
            for &Pair { child, direction } in &batch[..count] {
                if hit >> direction & 1 == 1 {
                    continue;
                }
                tally.node();
                let node = &tree.nodes[child.node()];
                let met = boxes(simd, fan, node, direction as usize % super::FAN);
                let leaves = leaves_of(node);
                self.nodes.append(direction, node, met & !leaves);
                self.leaves.append(direction, node, met & leaves);
            }
            for &Pair { child, direction } in &self.leaves.pairs[..self.leaves.count] {
                if hit >> direction & 1 == 0 {
                    let met = leaf(simd, tree, fan, child, direction as usize % super::FAN, tally, decide);
                    hit |= u64::from(met) << direction;
                }
            }
            self.leaves.count = 0;
        }
        hit
    }
}

/// Which boxes of a node a direction meets.
#[inline(always)]
fn boxes<S: Simd>(simd: S, fan: &Fan, node: &WideNode, direction: usize) -> u32 {
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
    enter.simd_le(leave).to_bitmask() as u32
}

/// Which children of a node are leaves, or none at all.
#[inline(always)]
fn leaves_of(node: &WideNode) -> u32 {
    let mut leaves = 0;
    for (place, child) in node.children.iter().enumerate() {
        leaves |= u32::from(child.is_leaf()) << place;
    }
    leaves
}

/// Whether a direction meets a triangle of a leaf.
#[inline(always)]
fn leaf<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    fan: &Fan,
    leaf: Child,
    direction: usize,
    tally: &impl Tally,
    decide: &mut impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
) -> bool {
    let along = [fan.direction[0][direction], fan.direction[1][direction], fan.direction[2][direction]];
    let ray = TestRays {
        origin: splat3(simd, fan.point),
        origin_rest: splat3(simd, fan.point_rest),
        direction: splat3(simd, along),
        origin_error: f32x4::splat(simd, fan.error),
    };
    // The reach is rounded up, by less than a part in 10^5.
    let sure_end = fan.reach * (1.0 - 1e-5);
    for (block, count) in blocks_of(leaf) {
        let block = &tree.blocks[block];
        tally.triangles(count);
        let verdict = block.test(simd, &ray, count, fan.reach);
        let others = !places_of(simd, block, fan.own);
        let latest = (verdict.numerator + verdict.numerator_error) * (1.0 + 1e-6);
        let soon = latest.simd_lt((verdict.denominator - verdict.denominator_error) * sure_end);
        let sure = verdict.sure & others & soon.to_bitmask() as u32;
        if sure != 0 {
            return true;
        }
        for lane in bits(verdict.maybe & others) {
            if decide(direction, &block.triangle(lane)) {
                return true;
            }
        }
    }
    false
}

/// Where a triangle stands in a block, a bit for each place.
#[inline(always)]
fn places_of<S: Simd>(simd: S, block: &Block, id: u32) -> u32 {
    u32x4::load_array_ref(simd, &block.ids).simd_eq(u32x4::splat(simd, id)).to_bitmask() as u32
}
