//! Binary trees in pieces, and at what cost each node could be gathered into wide ones.

use super::Aabb;
use super::cost::{NODE_COST, leaf_cost};
use super::node::{MAX_LEAF, WIDTH};

/// A node of a binary tree, in depth-first order: the child below follows its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    pub(super) bounds: Aabb,
    /// Index of the child above, 0 for a leaf. The number of the piece, for a node that stands for its root.
    pub(super) above: u32,
    pub(super) choice: Choice,
}

/// The least cost of all below a node where it may take up to 1, 2, .. 7 of the places in its parent. One place
/// holds a leaf or a node; more are shared out between the two children.
pub(super) type Costs = [f32; WIDTH - 1];

/// What makes up the least costs of a node.
///
/// | bits | |
/// |---|---|
/// | 3 (j - 2) to 3 (j - 2) + 2 | how many of j places the child below takes; 0 where j - 1 places do as well |
/// | 24 to 27 | primitives, where a leaf can hold them |
/// | 30 | the node stands for the root of another piece |
/// | 31 | a leaf is the best use of one place |
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice(u32);

const COUNT: u32 = 24;
const LINK: u32 = 1 << 30;
const LEAF: u32 = 1 << 31;

impl Choice {
    pub(super) const LINK: Self = Self(LINK);

    pub(super) fn below(self, places: usize) -> usize {
        (self.0 >> (3 * (places - 2)) & 7) as usize
    }

    pub(super) fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    pub(super) fn is_link(self) -> bool {
        self.0 & LINK != 0
    }

    /// Primitives of a leaf.
    pub(super) fn count(self) -> u32 {
        self.0 >> COUNT & 15
    }
}

/// The costs of a node that is not divided.
pub(super) fn leaf<const BLOCK: usize>(area: f32, count: usize) -> (Costs, Choice) {
    ([area * leaf_cost::<BLOCK>(count as u32); WIDTH - 1], Choice(LEAF | (count as u32) << COUNT))
}

/// The costs of a node over two children.
///
/// Costs that are no numbers choose badly, but never wrongly.
#[inline]
pub(super) fn inner<const BLOCK: usize>(
    area: f32,
    count: usize,
    below: &Costs,
    above: &Costs,
) -> (Costs, Choice) {
    let share = |places: usize| {
        let mut best = (below[0] + above[places - 2], 1_u32);
        for k in 2..places {
            let cost = below[k - 1] + above[places - k - 1];
            best = if cost < best.0 { (cost, k as u32) } else { best };
        }
        best
    };
    let (cost, k) = share(WIDTH);
    let mut choice = k << (3 * (WIDTH - 2));
    let as_node = cost + area * NODE_COST;
    let mut costs = [as_node; WIDTH - 1];
    if count <= MAX_LEAF {
        choice |= (count as u32) << COUNT;
        let as_leaf = area * leaf_cost::<BLOCK>(count as u32);
        if as_leaf <= as_node {
            costs[0] = as_leaf;
            choice |= LEAF;
        }
    }
    for places in 2..WIDTH {
        costs[places - 1] = costs[places - 2];
        let (cost, k) = share(places);
        if cost < costs[places - 1] {
            costs[places - 1] = cost;
            choice |= k << (3 * (places - 2));
        }
    }
    (costs, Choice(choice))
}
