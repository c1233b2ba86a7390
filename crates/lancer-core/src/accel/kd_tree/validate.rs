//! What must be true of every tree, and a walk over its nodes.

use super::node::Kind;
use super::{Aabb, KdTree};

/// A node as an observer sees it.
#[derive(Clone, Copy, Debug)]
pub struct NodeVisit<'a> {
    /// The node's cell: its box, which the split planes above it cut out of the tree's.
    pub bounds: Aabb,
    /// The root has depth 0.
    pub depth: u32,
    /// What it is.
    pub kind: NodeKind<'a>,
}

/// What a node is.
#[derive(Clone, Copy, Debug)]
pub enum NodeKind<'a> {
    /// It splits its cell by a plane at `position` of `axis`.
    Inner {
        /// 0, 1 or 2.
        axis: usize,
        /// The plane's coordinate.
        position: f32,
    },
    /// It holds these primitives.
    Leaf(&'a [u32]),
}

/// What is wrong with a tree. No tree that [`KdTree::build`] made has any.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// An index points out of the tree, or a node is reached twice or never.
    #[error("node {node} is not reached exactly once")]
    Structure {
        /// The node.
        node: usize,
    },
    /// A split plane is outside of its node's cell.
    #[error("the plane of node {node} is outside of its cell")]
    Plane {
        /// The node.
        node: usize,
    },
    /// A leaf names a primitive that does not exist.
    #[error("the leaf {node} names a primitive that does not exist")]
    Reference {
        /// The node.
        node: usize,
    },
    /// A primitive is in no leaf.
    #[error("primitive {primitive} is in no leaf")]
    Lost {
        /// The primitive.
        primitive: usize,
    },
    /// A leaf is deeper than the tree says.
    #[error("leaf {node} is too deep")]
    Depth {
        /// The node.
        node: usize,
    },
}

impl KdTree {
    /// Visits every node with its box, parents before children and below before above.
    pub fn visit_nodes(&self, mut visit: impl FnMut(usize, NodeVisit<'_>)) {
        let mut pending = vec![(0, self.bounds, 0)];
        while let Some((index, bounds, depth)) = pending.pop() {
            let Some(node) = self.nodes.get(index) else { continue };
            let kind = match node.kind() {
                Kind::Inner { axis, position, above } => {
                    let [lower, upper] = bounds.split(axis, position);
                    pending.push((above as usize, upper, depth + 1));
                    pending.push((index + 1, lower, depth + 1));
                    NodeKind::Inner { axis, position }
                }
                Kind::Leaf { first, count } => {
                    let end = (first as usize).saturating_add(count as usize);
                    NodeKind::Leaf(self.references.get(first as usize..end).unwrap_or(&[]))
                }
            };
            visit(index, NodeVisit { bounds, depth, kind });
            if depth > Self::MAX_DEPTH {
                return;
            }
        }
    }

    /// Checks the tree over `primitives` primitives; for tests and debugging, in O(nodes + references).
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self, primitives: usize) -> Result<(), Defect> {
        let mut reached = vec![0_u32; self.nodes.len()];
        let mut held = vec![false; primitives];
        let mut defect = None;
        self.visit_nodes(|node, visit| {
            reached[node] += 1;
            let found = match visit.kind {
                NodeKind::Inner { axis, position } => {
                    let inside = visit.bounds.min[axis] < position && position < visit.bounds.max[axis];
                    (!inside).then_some(Defect::Plane { node })
                }
                NodeKind::Leaf(_) if visit.depth > self.depth => Some(Defect::Depth { node }),
                NodeKind::Leaf(references) => {
                    let mut wrong = None;
                    for &primitive in references {
                        match held.get_mut(primitive as usize) {
                            Some(held) => *held = true,
                            None => wrong = Some(Defect::Reference { node }),
                        }
                    }
                    wrong
                }
            };
            defect = defect.or(found);
        });
        let unreached = reached.iter().position(|&times| times != 1).map(|node| Defect::Structure { node });
        let lost = held.iter().position(|&held| !held).map(|primitive| Defect::Lost { primitive });
        defect.or(unreached).or(lost).map_or(Ok(()), Err)
    }
}
