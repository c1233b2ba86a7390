//! A hierarchy of boxes, eight to a node.
//!
//! It is built over the boxes of primitives and knows nothing else of them. A binary tree is grown from the root
//! by the surface area heuristic (`grow`, `split`), its top over cells that stand in for primitives (`lattice`).
//! Then its nodes are gathered into leaves and nodes of eight children so that the expected cost is least
//! (`binary`, `collapse`).
//!
//! Source: Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007), for the bins; Ylitie,
//! Karras, Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs" (2017), section 3.1,
//! for the collapse.

mod binary;
mod boxes;
mod collapse;
mod cost;
mod extent;
mod grow;
mod lattice;
mod node;
mod split;
#[cfg(test)]
mod tests;
mod validate;

pub(crate) use boxes::{boxes_around_all, boxes_at};
pub(crate) use node::LEAF;
pub use node::{Child, MAX_LEAF, WIDTH, WideNode};
pub use validate::Defect;

use super::Aabb;
use crate::cancel::CancelToken;

/// How much time a build may take for how good a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Splits are looked for on all axes: for trees that many rays go through.
    #[default]
    High,
    /// Splits are looked for on the axis along which centres lie furthest apart, in about 6 tenths of the time and
    /// at 2 to 4 percent more expected cost: for trees that are soon replaced.
    Fast,
}

/// What lies in the leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// Triangles, of which four are tested at once and cheaply: leaves hold up to eight.
    Triangles,
    /// Objects, which are searched one by one and may have trees of their own: leaves hold one, unless their boxes are
    /// alike.
    Objects,
}

/// Why no hierarchy was built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// More primitives than a leaf can name.
    #[error("{count} primitives are more than a hierarchy of boxes can hold ({})", Bvh::MAX_PRIMITIVES)]
    TooManyPrimitives {
        /// How many there are.
        count: usize,
    },
    /// It was cancelled.
    #[error("the build was cancelled")]
    Cancelled,
}

/// A hierarchy of boxes over primitives that are named by their index.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Depth first; the first is the root.
    nodes: Vec<WideNode>,
    /// The primitives of the leaves, leaf after leaf: each once.
    order: Vec<u32>,
    bounds: Aabb,
    depth: u32,
    contents: Contents,
}

impl Bvh {
    /// The deepest hierarchy: no node is more steps away from the root.
    pub const MAX_DEPTH: u32 = 64;

    /// The most primitives. Their places in the order must be told apart by 28 bits.
    pub const MAX_PRIMITIVES: usize = 100_000_000;

    /// Builds the hierarchy, on the threads of the current rayon pool; it does not depend on their number.
    ///
    /// Takes O(n log n) time and linear memory: some 60 bytes a primitive while it builds. Boxes that are not finite cost quality and nothing else.
    ///
    /// # Errors
    /// [`BuildError::TooManyPrimitives`].
    pub fn build(boxes: &[Aabb], contents: Contents, quality: Quality) -> Result<Self, BuildError> {
        Self::build_with(boxes, contents, quality, &CancelToken::default())
    }

    /// As [`Bvh::build`], until it is cancelled.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn build_with(
        boxes: &[Aabb],
        contents: Contents,
        quality: Quality,
        cancel: &CancelToken,
    ) -> Result<Self, BuildError> {
        let count = boxes.len();
        if count > Self::MAX_PRIMITIVES {
            return Err(BuildError::TooManyPrimitives { count });
        }
        let grown = grow::grow(boxes, contents, quality, cancel).ok_or(BuildError::Cancelled)?;
        Ok(collapse::collapse(grown, contents))
    }

    /// The nodes and the primitives in the order of the leaves.
    pub(crate) fn into_parts(self) -> (Vec<WideNode>, Vec<u32>) {
        (self.nodes, self.order)
    }

    /// The nodes. The first is the root; it is there even where there is no primitive.
    pub fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    /// The primitives, in the order of the leaves.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The box around all primitives.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Steps from the root to the node furthest from it.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.order[..])
    }
}
