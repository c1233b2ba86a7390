//! One ray through a hierarchy of boxes, eight at a time.

use super::lanes::splat3;
use super::ray::NarrowRay;
use crate::accel::bvh::{Bvh, Child, WIDTH, WideNode};
use crate::accel::tally::Tally;
use arrayvec::ArrayVec;
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// Room for all that can wait: each level of the tree leaves seven children behind.
pub(super) const STACK: usize = (WIDTH - 1) * (Bvh::MAX_DEPTH as usize + 1) + 1;

/// Who is shown the leaves that a ray meets.
pub(crate) trait LeafVisitor {
    /// Looks at a leaf. Returns the `s` up to which hits still count; a negative one ends the walk.
    fn leaf(&mut self, leaf: Child) -> f32;
}

/// For what holds no vector code: a closure is not always inlined, and that must be.
impl<F: FnMut(Child) -> f32> LeafVisitor for F {
    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> f32 {
        self(leaf)
    }
}

/// Shows a visitor the leaves that a ray meets: those that are entered sooner come sooner, by the order of each node's
/// children.
#[inline(always)]
pub(crate) fn walk<S: Simd>(
    simd: S,
    nodes: &[WideNode],
    ray: &NarrowRay,
    tally: &impl Tally,
    visitor: &mut impl LeafVisitor,
) {
    walk_from(simd, nodes, Child::inner(0), ray, tally, visitor);
}

/// As [`walk`], through the part of the hierarchy below `start`.
#[inline(always)]
pub(super) fn walk_from<S: Simd>(
    simd: S,
    nodes: &[WideNode],
    start: Child,
    ray: &NarrowRay,
    tally: &impl Tally,
    visitor: &mut impl LeafVisitor,
) {
    let inverse: [f32x8<S>; 3] = splat3(simd, ray.inverse);
    let enter_offset: [f32x8<S>; 3] = splat3(simd, ray.enter_offset);
    let leave_offset: [f32x8<S>; 3] = splat3(simd, ray.leave_offset);
    let backward = [ray.inverse[0] < 0.0, ray.inverse[1] < 0.0, ray.inverse[2] < 0.0];
    let zero = f32x8::splat(simd, 0.0);
    let mut end = ray.end;
    let mut stack = ArrayVec::<(Child, f32), STACK>::new();
    let mut current = start;
    loop {
        if current.is_leaf() {
            end = visitor.leaf(current);
            if end < 0.0 {
                return;
            }
        } else {
            tally.node();
            let node = &nodes[current.node()];
            let enter = plane(simd, node, 0, backward[0], inverse[0], enter_offset[0])
                .max(plane(simd, node, 1, backward[1], inverse[1], enter_offset[1]))
                .max(plane(simd, node, 2, backward[2], inverse[2], enter_offset[2]).max(zero));
            let leave = plane(simd, node, 0, !backward[0], inverse[0], leave_offset[0])
                .min(plane(simd, node, 1, !backward[1], inverse[1], leave_offset[1]))
                .min(
                    plane(simd, node, 2, !backward[2], inverse[2], leave_offset[2])
                        .min(f32x8::splat(simd, end)),
                );
            let mut met = enter.simd_le(leave).to_bitmask() as u32;
            if met != 0 {
                let first = met.trailing_zeros() as usize;
                met &= met - 1;
                let mut next = (node.children[first], enter[first]);
                let waiting = stack.len();
                while met != 0 {
                    let child = met.trailing_zeros() as usize;
                    met &= met - 1;
                    let mut other = (node.children[child], enter[child]);
                    if other.1 < next.1 {
                        std::mem::swap(&mut other, &mut next);
                    }
                    stack.push(other);
                    nearest_last(&mut stack[waiting..], |&(_, enter)| enter);
                }
                current = next.0;
                continue;
            }
        }
        loop {
            match stack.pop() {
                None => return,
                Some((child, enter)) if enter <= end => {
                    current = child;
                    break;
                }
                Some(_) => {}
            }
        }
    }
}

/// Gives the last of a node's children its place among those before it, which wait in order, the nearest last; there
/// are few of them.
#[inline(always)]
pub(super) fn nearest_last<T>(waiting: &mut [T], distance: impl Fn(&T) -> f32) {
    let mut place = waiting.len() - 1;
    while place > 0 && distance(&waiting[place - 1]) < distance(&waiting[place]) {
        waiting.swap(place - 1, place);
        place -= 1;
    }
}

/// Where a ray meets the upper or lower planes of an axis.
#[inline(always)]
fn plane<S: Simd>(
    simd: S,
    node: &WideNode,
    axis: usize,
    upper: bool,
    inverse: f32x8<S>,
    offset: f32x8<S>,
) -> f32x8<S> {
    let side = if upper { &node.max[axis] } else { &node.min[axis] };
    f32x8::load_array_ref(simd, side).mul_add(inverse, offset)
}
