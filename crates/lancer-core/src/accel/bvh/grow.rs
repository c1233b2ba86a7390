//! A binary tree from the root down.
//!
//! Large ranges are first sorted into the cells of a lattice, and parted by cells until few are left in a range;
//! those small ranges are then parted by primitives, each on its own.

use super::binary::{Binary, Choice, Costs, inner, leaf};
use super::cost::{OBJECTS, TRIANGLES};
use super::extent::{Extent, around};
use super::lattice::Cells;
use super::split::{Parts, part, part_at_median};
use super::{Bvh, Contents, Quality};
use crate::accel::Aabb;
use crate::cancel::CancelToken;
use rayon::prelude::*;

/// Ranges above this size are sorted into cells.
const LARGE: usize = 1 << 15;

/// Primitives for each cell of a lattice, empty ones included; on surfaces most are empty. Less makes tables that do
/// not fit caches, which costs more time than it saves; more leaves coarse borders to part at.
const PRIMITIVES_PER_CELL: usize = 8;

/// Ranges of fewer cells are parted by primitives: the borders of cells are too few.
const FEW_CELLS: usize = 32;

/// Ranges of fewer primitives are parted by primitives.
const FEW_PRIMITIVES: usize = 512;

/// Smaller ranges are not worth a look at whether the build is cancelled; they take microseconds.
const COARSE: usize = 128;

/// A binary tree in pieces, and its primitives from leaf to leaf.
pub(super) struct Grown {
    /// The first has the root; none where there are no primitives.
    pub(super) pieces: Vec<Vec<Binary>>,
    pub(super) order: Vec<u32>,
}

/// The tree over some boxes; none where it was cancelled.
pub(super) fn grow(
    boxes: &[Aabb],
    contents: Contents,
    quality: Quality,
    cancel: &CancelToken,
) -> Option<Grown> {
    match contents {
        Contents::Triangles => Grower::<TRIANGLES> { quality, cancel }.grow(boxes),
        Contents::Objects => Grower::<OBJECTS> { quality, cancel }.grow(boxes),
    }
}

/// A part of the tree under construction.
enum Tree {
    Fork(Box<(Extent, usize, Self, Self)>),
    Piece(Vec<Binary>, Costs),
}

impl Tree {
    /// Appends the forks to the crown and the others to the pieces.
    fn take_apart<const BLOCK: usize>(self, crown: &mut Vec<Binary>, pieces: &mut Vec<Vec<Binary>>) -> Costs {
        match self {
            Self::Piece(nodes, costs) => {
                crown.push(Binary { above: pieces.len() as u32, choice: Choice::LINK, ..nodes[0] });
                pieces.push(nodes);
                costs
            }
            Self::Fork(fork) => {
                let (bounds, count, below, above) = *fork;
                let parent = crown.len();
                crown.push(Binary { bounds: bounds.to_aabb(), above: 0, choice: Choice::LINK });
                let below = below.take_apart::<BLOCK>(crown, pieces);
                crown[parent].above = crown.len() as u32;
                let above = above.take_apart::<BLOCK>(crown, pieces);
                let (costs, choice) = inner::<BLOCK>(bounds.half_area(), count, &below, &above);
                crown[parent].choice = choice;
                costs
            }
        }
    }
}

/// Whether only halves are sure to end within the bound on depth.
fn is_deep(depth: u32, count: usize) -> bool {
    depth + count.ilog2() + 2 >= Bvh::MAX_DEPTH
}

/// How a range is parted by cells.
enum Plan {
    Fork { bounds: Extent, count: usize, parts: Box<[Self; 2]> },
    Rest { count: usize },
}

impl Plan {
    fn count(&self) -> usize {
        match self {
            Self::Fork { count, .. } | Self::Rest { count } => *count,
        }
    }
}

/// `BLOCK` primitives of a leaf are tested at once.
struct Grower<'a, const BLOCK: usize> {
    quality: Quality,
    /// Once it is cancelled nothing is parted any more: the rest of the tree takes no time, and is thrown away.
    cancel: &'a CancelToken,
}

impl<const BLOCK: usize> Grower<'_, BLOCK> {
    /// The tree over some boxes; none where it was cancelled.
    fn grow(&self, boxes: &[Aabb]) -> Option<Grown> {
        if boxes.is_empty() {
            return Some(Grown { pieces: Vec::new(), order: Vec::new() });
        }
        let mut items = vec![Extent::EMPTY; boxes.len()];
        let tree = self.range(|i| Extent::new(&boxes[i], i as u32), &mut items, 0);
        if self.cancel.is_cancelled() {
            return None;
        }
        let order = items.par_iter().with_min_len(1 << 14).map(Extent::name).collect();
        let mut pieces = vec![Vec::new()];
        let mut crown = Vec::new();
        tree.take_apart::<BLOCK>(&mut crown, &mut pieces);
        pieces[0] = crown;
        Some(Grown { pieces, order })
    }

    /// The tree over all items, which are written in the order of its leaves.
    fn range(&self, items: impl Fn(usize) -> Extent + Sync, out: &mut [Extent], depth: u32) -> Tree {
        let count = out.len();
        if count > LARGE && !is_deep(depth, count) && !self.cancel.is_cancelled() {
            let mut cells = Cells::new(&items, count, count / PRIMITIVES_PER_CELL);
            if cells.boxes.len() > 1 {
                let plan = self.plan(&mut cells.boxes, count, depth, true);
                cells.scatter(&items, out);
                drop((items, cells));
                return self.follow(plan, out, depth);
            }
        }
        for (i, out) in out.iter_mut().enumerate() {
            *out = items(i);
        }
        self.piece(out, depth)
    }

    fn plan(&self, cells: &mut [Extent], count: usize, depth: u32, is_first: bool) -> Plan {
        let few = cells.len() < FEW_CELLS || count < FEW_PRIMITIVES;
        let ends = (few && !is_first) || self.cancel.is_cancelled();
        if cells.len() == 1 || ends || is_deep(depth, count) {
            return Plan::Rest { count };
        }
        let bounds = around(cells);
        let Parts { length, .. } = part::<BLOCK>(cells, Quality::High);
        let (below, above) = cells.split_at_mut(length);
        let count_below = below.iter().map(|cell| cell.weight() as usize).sum();
        let mut grow_below = || self.plan(below, count_below, depth + 1, false);
        let mut grow_above = || self.plan(above, count - count_below, depth + 1, false);
        let (below, above) = if length > FEW_CELLS {
            rayon::join(grow_below, grow_above)
        } else {
            (grow_below(), grow_above())
        };
        Plan::Fork { bounds, count, parts: Box::new([below, above]) }
    }

    fn follow(&self, plan: Plan, items: &mut [Extent], depth: u32) -> Tree {
        match plan {
            Plan::Rest { count } if count > LARGE => {
                let copy = items.to_vec();
                self.range(move |i| copy[i], items, depth)
            }
            Plan::Rest { .. } => self.piece(items, depth),
            Plan::Fork { bounds, count, parts } => {
                let [below, above] = *parts;
                let (items_below, items_above) = items.split_at_mut(below.count());
                let (below, above) = rayon::join(
                    || self.follow(below, items_below, depth + 1),
                    || self.follow(above, items_above, depth + 1),
                );
                Tree::Fork(Box::new((bounds, count, below, above)))
            }
        }
    }

    fn piece(&self, items: &mut [Extent], depth: u32) -> Tree {
        let mut nodes = Vec::with_capacity(items.len() * 5 / 8);
        let bounds = around(items);
        let costs = self.subtree(items, &bounds, depth, &mut nodes);
        Tree::Piece(nodes, costs)
    }

    /// Appends the tree over a range.
    fn subtree(&self, items: &mut [Extent], bounds: &Extent, depth: u32, out: &mut Vec<Binary>) -> Costs {
        let (parent, count) = (out.len(), items.len());
        let area = bounds.half_area();
        let (costs, choice) = leaf::<BLOCK>(area, count);
        out.push(Binary { bounds: bounds.to_aabb(), above: 0, choice });
        if count <= BLOCK || (count >= COARSE && self.cancel.is_cancelled()) {
            return costs;
        }
        let parts =
            if is_deep(depth, count) { part_at_median(items) } else { part::<BLOCK>(items, self.quality) };
        let (below, above) = items.split_at_mut(parts.length);
        let below = self.subtree(below, &parts.bounds[0], depth + 1, out);
        out[parent].above = out.len() as u32;
        let above = self.subtree(above, &parts.bounds[1], depth + 1, out);
        let (costs, choice) = inner::<BLOCK>(area, count, &below, &above);
        out[parent].choice = choice;
        costs
    }
}
