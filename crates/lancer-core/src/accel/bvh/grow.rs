//! A binary tree from the root down.

use super::Bvh;
use super::cost::BLOCK;
use super::extent::Extent;
use super::split::{Grid, best_split};
use crate::accel::Aabb;

/// Ranges above this size grow their halves in parallel.
const PARALLEL: usize = 4096;

/// A node of the binary tree, in depth-first order: the child below follows its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    pub(super) bounds: Aabb,
    /// Index of the child above; 0 for a leaf.
    pub(super) above: u32,
    /// Primitives in or below it.
    pub(super) count: u32,
}

/// A binary tree, and its primitives from leaf to leaf.
pub(super) struct Grown {
    pub(super) nodes: Vec<Binary>,
    pub(super) order: Vec<u32>,
}

pub(super) fn grow(boxes: &[Aabb]) -> Grown {
    let mut items =
        boxes.iter().enumerate().map(|(i, bounds)| Extent::new(bounds, i as u32)).collect::<Vec<_>>();
    let mut nodes = Vec::new();
    if !items.is_empty() {
        subtree(&mut items, 0, &mut nodes);
    }
    Grown { nodes, order: items.iter().map(Extent::primitive).collect() }
}

/// Appends the tree over a range.
fn subtree(items: &mut [Extent], depth: u32, out: &mut Vec<Binary>) {
    let around = |items: &[Extent]| items.iter().fold(Extent::EMPTY, |sum, item| sum.union(item));
    let parent = out.len();
    out.push(Binary { bounds: around(items).to_aabb(), above: 0, count: items.len() as u32 });
    if items.len() <= BLOCK {
        return;
    }
    let below = part(items, depth);
    let large = items.len() > PARALLEL;
    let (below, above) = items.split_at_mut(below);
    if large {
        let grow_above = || {
            let mut other = Vec::new();
            subtree(above, depth + 1, &mut other);
            other
        };
        let ((), other) = rayon::join(|| subtree(below, depth + 1, out), grow_above);
        let shift = out.len() as u32;
        out[parent].above = shift;
        let shifted =
            |node: &Binary| Binary { above: if node.above == 0 { 0 } else { node.above + shift }, ..*node };
        out.extend(other.iter().map(shifted));
    } else {
        subtree(below, depth + 1, out);
        out[parent].above = out.len() as u32;
        subtree(above, depth + 1, out);
    }
}

/// Orders a range so that its two parts follow each other; the length of the first.
fn part(items: &mut [Extent], depth: u32) -> usize {
    let half = items.len() / 2;
    let centers = items.iter().fold(Extent::EMPTY, |sum, item| {
        let center = item.center();
        sum.union(&Extent { low: center, high: -center })
    });
    // Halves from here on end just within the bound.
    if depth + items.len().ilog2() + 1 >= Bvh::MAX_DEPTH {
        let extent = (-(centers.low + centers.high)).truncate();
        let axis = extent.max_position();
        items.select_nth_unstable_by(half, |a, b| a.center()[axis].total_cmp(&b.center()[axis]));
        return half;
    }
    let grid = Grid::new(&centers, 16);
    let Some(split) = best_split(items, &grid) else { return half };
    let (mut start, mut end) = (0, items.len());
    while start < end {
        if grid.places(&items[start])[split.axis] < split.bin {
            start += 1;
        } else {
            end -= 1;
            items.swap(start, end);
        }
    }
    debug_assert_eq!(start, split.below);
    start
}
