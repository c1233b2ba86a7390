//! A k-d tree: binary, axis-aligned split planes, primitives at the leaves.
//!
//! One tree serves both levels of a world: the triangles of a mesh and the objects of a scene. It finds
//! candidates and decides no hit, so a picture does not depend on its shape.
//!
//! Source: Wald, Havran, "On building fast kd-trees for ray tracing, and on doing that in O(N log N)" (2006),
//! for the surface area heuristic, clipped ("perfect") splits and the traversal; Hunt, Mark, Stoll, "Fast
//! kd-tree construction with an adaptive error-bounded heuristic" (2006), for the bins of large nodes.

mod build;
mod cells;
mod node;
mod split;
#[cfg(test)]
mod tests;
mod traverse;
mod validate;

pub use split::{STEP_COST, TEST_COST};
pub use validate::{Defect, NodeKind, NodeVisit};

use super::{Aabb, Primitives};
use crate::cancel::CancelToken;
use node::Node;

/// The two numbers that bound a tree. `None` leaves a number to the renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KdSettings {
    /// A node with this many primitives or fewer becomes a leaf.
    pub leaf: Option<u32>,
    /// The depth at which every node becomes a leaf; the root has depth 0. At most [`KdTree::MAX_DEPTH`].
    pub depth: Option<u32>,
}

/// Why no tree was built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// More primitives than a node can name.
    #[error("{count} primitives are more than a k-d tree can hold ({})", KdTree::MAX_PRIMITIVES)]
    TooManyPrimitives {
        /// How many there are.
        count: usize,
    },
    /// It was cancelled.
    #[error("the build was cancelled")]
    Cancelled,
}

/// A k-d tree over primitives that are named by their index.
#[derive(Clone, Debug)]
pub struct KdTree {
    bounds: Aabb,
    /// Depth first: the child below the plane follows its parent.
    nodes: Vec<Node>,
    /// The primitives of the leaves, leaf after leaf.
    references: Vec<u32>,
    depth: u32,
}

impl KdTree {
    /// The deepest tree: it bounds the stack of a traversal.
    pub const MAX_DEPTH: u32 = 64;

    /// The most primitives. Ten nodes for each, two for each of five splits, must be told apart by 30 bits, and six
    /// references by 32.
    pub const MAX_PRIMITIVES: usize = 100_000_000;

    /// Builds the tree, on the threads of the current rayon pool; it does not depend on their number.
    ///
    /// Takes O(n log n) time. Memory is linear: at most 6 references and 10 nodes a primitive.
    ///
    /// # Errors
    /// [`BuildError::TooManyPrimitives`].
    pub fn build(primitives: &impl Primitives, settings: KdSettings) -> Result<Self, BuildError> {
        Self::build_with(primitives, settings, &CancelToken::default())
    }

    /// As [`KdTree::build`], until it is cancelled.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn build_with(
        primitives: &impl Primitives,
        settings: KdSettings,
        cancel: &CancelToken,
    ) -> Result<Self, BuildError> {
        build::build(primitives, settings, cancel)
    }

    /// The box around all primitives, rounded outward to `f32`; a point at the origin where there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The depth of the deepest leaf.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// The number of nodes, leaves included.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The number of entries in all leaves; a primitive that spans several leaves counts once in each.
    pub fn reference_count(&self) -> usize {
        self.references.len()
    }

    /// Bytes held by nodes and references, without the primitives themselves.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.references[..])
    }
}
