//! From primitives to a tree.
//!
//! Top down: each node tries the planes of `split`, hands its primitives to its children, clipped to their
//! cells, and gives up where no plane is worth its step. Every level touches each reference a bounded number of
//! times, which makes O(n log n) in all.

use super::super::{Aabb, Primitives};
use super::node::{MAX_INDEX, Node};
use super::split::{Reference, Split, best_split, leaf_cost};
use super::{BuildError, KdSettings, KdTree};
use crate::cancel::CancelToken;

/// The most references a tree holds for each primitive, on average; one less bounds its splits. Past that nodes
/// become leaves: memory stays linear in the input however the primitives lie. Ordinary meshes need 2 to 3 of each.
pub(super) const REFERENCES_PER_PRIMITIVE: usize = 6;

/// Nodes above this size build their children in parallel.
const PARALLEL: usize = 4096;

/// How many splits in a row may cost more than a leaf: some gain only by what they allow below them.
const PATIENCE: u32 = 2;

/// Primitives in a leaf where the user does not say. On a scanned mesh 1 doubles the memory and gains nothing, 8
/// costs a tenth of the rays per second.
const DEFAULT_LEAF: u32 = 3;

pub(super) fn build(
    primitives: &impl Primitives,
    settings: KdSettings,
    cancel: &CancelToken,
) -> Result<KdTree, BuildError> {
    let count = primitives.count();
    if count > KdTree::MAX_PRIMITIVES {
        return Err(BuildError::TooManyPrimitives { count });
    }
    let references = (0..count as u32)
        .map(|primitive| Reference { bounds: primitives.bounds(primitive), primitive })
        .collect::<Vec<_>>();
    let bounds = references
        .iter()
        .map(|reference| reference.bounds)
        .reduce(|a, b| a.union(&b))
        .unwrap_or(Aabb { min: [0.0; 3], max: [0.0; 3] });
    let builder = Builder {
        primitives,
        leaf: settings.leaf.unwrap_or(DEFAULT_LEAF) as usize,
        max_depth: settings.depth.unwrap_or_else(|| default_depth(count)).min(KdTree::MAX_DEPTH),
        cancel,
    };
    let spare = count.saturating_mul(REFERENCES_PER_PRIMITIVE - 1);
    let mut tree = Subtree::default();
    builder.build(Cell { references, bounds, depth: 0, spare, setbacks: 0 }, &mut tree);
    if cancel.is_cancelled() {
        return Err(BuildError::Cancelled);
    }
    tree.nodes.shrink_to_fit();
    tree.references.shrink_to_fit();
    Ok(KdTree { bounds, nodes: tree.nodes, references: tree.references, depth: tree.depth })
}

/// The depth where the user sets none: 8 + 1.3 log2 n. Source: Havran, "Heuristic Ray Shooting Algorithms"
/// (thesis, 2000), section 4.5.
fn default_depth(count: usize) -> u32 {
    8 + 13 * (count + 1).ilog2() / 10
}

/// A node to be: what it holds, and how much it may still spend.
struct Cell {
    references: Vec<Reference>,
    bounds: Aabb,
    depth: u32,
    /// How many splits and references may be added below here.
    spare: usize,
    /// How many splits in a row have cost more than a leaf.
    setbacks: u32,
}

/// A part of the tree under construction; indices count from its own start.
#[derive(Default)]
struct Subtree {
    nodes: Vec<Node>,
    references: Vec<u32>,
    depth: u32,
}

impl Subtree {
    fn push_leaf(&mut self, cell: &Cell) {
        let first = self.references.len() as u32;
        self.references.extend(cell.references.iter().map(|reference| reference.primitive));
        self.nodes.push(Node::leaf(first, cell.references.len() as u32));
        self.depth = self.depth.max(cell.depth);
    }

    fn append(&mut self, other: Self) {
        let (nodes, references) = (self.nodes.len() as u32, self.references.len() as u32);
        assert!(
            nodes as usize + other.nodes.len() < MAX_INDEX as usize,
            "the bound on references bounds nodes"
        );
        self.nodes.extend(other.nodes.iter().map(|node| node.shifted(nodes, references)));
        self.references.extend(other.references);
        self.depth = self.depth.max(other.depth);
    }
}

struct Builder<'a, P> {
    primitives: &'a P,
    leaf: usize,
    max_depth: u32,
    /// Once it is cancelled all nodes become leaves: the rest of the tree takes no time, and is thrown away.
    cancel: &'a CancelToken,
}

impl<P: Primitives> Builder<'_, P> {
    /// Appends the subtree of a cell.
    fn build(&self, cell: Cell, out: &mut Subtree) {
        let Some((split, [below, above])) = self.divide(&cell) else {
            return out.push_leaf(&cell);
        };
        let large = cell.references.len() > PARALLEL;
        drop(cell);
        let parent = out.nodes.len();
        out.nodes.push(Node::leaf(0, 0));
        if large {
            let build_above = || {
                let mut other = Subtree::default();
                self.build(above, &mut other);
                other
            };
            let ((), other) = rayon::join(|| self.build(below, out), build_above);
            out.nodes[parent] = Node::inner(split.axis, split.position, out.nodes.len() as u32);
            out.append(other);
        } else {
            self.build(below, out);
            out.nodes[parent] = Node::inner(split.axis, split.position, out.nodes.len() as u32);
            self.build(above, out);
        }
    }

    /// The best split and the two cells that it makes; none where the cell should be a leaf.
    fn divide(&self, cell: &Cell) -> Option<(Split, [Cell; 2])> {
        let count = cell.references.len();
        if count <= self.leaf || cell.depth >= self.max_depth || self.cancel.is_cancelled() {
            return None;
        }
        let split = best_split(&cell.references, &cell.bounds)?;
        let setbacks = if split.cost < leaf_cost(count) { 0 } else { cell.setbacks + 1 };
        if setbacks > PATIENCE || split.cost > 4.0 * leaf_cost(count) {
            return None;
        }
        let [below, above] = self.partition(&cell.references, &cell.bounds, &split);
        // The split itself is paid for too: a cut through empty space adds no reference, but it adds two nodes.
        let spare = (cell.spare + count).checked_sub(below.len() + above.len() + 1)?;
        let share = spare as u128 * below.len() as u128 / (below.len() + above.len()).max(1) as u128;
        let spare_below = share as usize;
        let [bounds_below, bounds_above] = cell.bounds.split(split.axis, split.position);
        let child =
            |references, bounds, spare| Cell { references, bounds, depth: cell.depth + 1, spare, setbacks };
        Some((
            split,
            [child(below, bounds_below, spare_below), child(above, bounds_above, spare - spare_below)],
        ))
    }

    /// The references on either side of a plane; those that it cuts are on both, clipped.
    fn partition(&self, references: &[Reference], cell: &Aabb, split: &Split) -> [Vec<Reference>; 2] {
        let (axis, position) = (split.axis, split.position);
        let halves = cell.split(axis, position);
        let mut sides = [Vec::with_capacity(references.len() / 2), Vec::with_capacity(references.len() / 2)];
        for reference in references {
            let (min, max) = (reference.bounds.min[axis], reference.bounds.max[axis]);
            if min == position && max == position {
                sides[usize::from(!split.flat_below)].push(*reference);
            } else if max <= position {
                sides[0].push(*reference);
            } else if min >= position {
                sides[1].push(*reference);
            } else {
                for (side, half) in sides.iter_mut().zip(&halves) {
                    // The box already clipped by the planes above is inside of the cell on the other axes.
                    let part = reference.bounds.intersection(half);
                    let clipped = part.and_then(|part| self.primitives.clip(reference.primitive, &part));
                    side.extend(clipped.map(|bounds| Reference { bounds, ..*reference }));
                }
            }
        }
        sides
    }
}
