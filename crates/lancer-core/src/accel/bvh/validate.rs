//! What must be true of every hierarchy.

use super::node::{Child, WIDTH, WideNode};
use super::{Aabb, Bvh};

/// What is wrong with a hierarchy. None that [`Bvh::build`] made has any.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// An index points out of the hierarchy, or a node is reached twice or never.
    #[error("node {node} is not reached exactly once")]
    Structure {
        /// The node.
        node: usize,
    },
    /// A node's children do not come first, or one that is not there has a box.
    #[error("the children of node {node} do not come before its empty places")]
    Children {
        /// The node.
        node: usize,
    },
    /// A box does not contain what is below it.
    #[error("the box of child {child} of node {node} does not contain all that is below it")]
    Bounds {
        /// The node.
        node: usize,
        /// The place of the child in it.
        child: usize,
    },
    /// A node is deeper than the hierarchy says, or than any may be.
    #[error("node {node} is too deep")]
    Depth {
        /// The node.
        node: usize,
    },
    /// A place in the order is in no leaf, or in several.
    #[error("place {place} of the order is not in exactly one leaf")]
    Place {
        /// The place.
        place: usize,
    },
    /// A primitive is not in the order exactly once.
    #[error("primitive {primitive} is not in the order exactly once")]
    Primitive {
        /// The primitive.
        primitive: usize,
    },
}

impl Bvh {
    /// Checks the hierarchy over these boxes; for tests and debugging, in O(n).
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self, boxes: &[Aabb]) -> Result<(), Defect> {
        let once = |times: &[u32]| times.iter().position(|&times| times != 1);
        let mut named = vec![0; boxes.len()];
        for &primitive in &self.order {
            *named
                .get_mut(primitive as usize)
                .ok_or(Defect::Primitive { primitive: primitive as usize })? += 1;
        }
        if let Some(primitive) = once(&named) {
            return Err(Defect::Primitive { primitive });
        }
        let mut walk =
            Walk { bvh: self, boxes, reached: vec![0; self.nodes.len()], placed: vec![0; self.order.len()] };
        walk.node(0, 0)?;
        if let Some(node) = once(&walk.reached) {
            return Err(Defect::Structure { node });
        }
        once(&walk.placed).map_or(Ok(()), |place| Err(Defect::Place { place }))
    }
}

struct Walk<'a> {
    bvh: &'a Bvh,
    boxes: &'a [Aabb],
    /// How often each node was reached.
    reached: Vec<u32>,
    /// How often each place of the order was in a leaf.
    placed: Vec<u32>,
}

impl Walk<'_> {
    /// Checks a node and all below; the box around them.
    fn node(&mut self, index: usize, depth: u32) -> Result<Option<Aabb>, Defect> {
        let node = *self.bvh.nodes.get(index).ok_or(Defect::Structure { node: index })?;
        self.reached[index] += 1;
        if self.reached[index] > 1 {
            return Err(Defect::Structure { node: index });
        }
        if depth > self.bvh.depth.min(Bvh::MAX_DEPTH) {
            return Err(Defect::Depth { node: index });
        }
        let present = (0..WIDTH).position(|child| node.child(child).is_none()).unwrap_or(WIDTH);
        if (present..WIDTH).any(|child| !is_absent(&node, child)) {
            return Err(Defect::Children { node: index });
        }
        let mut around = None;
        for child in 0..present {
            let inside = self.child(node.child(child), depth)?;
            let bounds = node.bounds(child);
            if inside.is_none_or(|inside| inside.union(&bounds) != bounds) {
                return Err(Defect::Bounds { node: index, child });
            }
            around = join(around, bounds);
        }
        Ok(around)
    }

    /// Checks a child; the box around what is below it.
    fn child(&mut self, child: Child, depth: u32) -> Result<Option<Aabb>, Defect> {
        if !child.is_leaf() {
            return self.node(child.node(), depth + 1);
        }
        let mut around = None;
        for place in child.first()..child.first() + child.count() {
            *self.placed.get_mut(place).ok_or(Defect::Place { place })? += 1;
            around = join(around, self.boxes[self.bvh.order[place] as usize]);
        }
        Ok(around)
    }
}

fn join(around: Option<Aabb>, bounds: Aabb) -> Option<Aabb> {
    Some(around.map_or(bounds, |around| around.union(&bounds)))
}

fn is_absent(node: &WideNode, child: usize) -> bool {
    let bounds = node.bounds(child);
    node.child(child).is_none() && bounds.min == [f32::INFINITY; 3] && bounds.max == [f32::NEG_INFINITY; 3]
}
