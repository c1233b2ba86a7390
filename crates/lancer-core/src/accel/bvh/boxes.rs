//! The boxes of a hierarchy level by level, to be looked at.

use super::node::{Child, WIDTH, WideNode};
use crate::accel::Aabb;

/// The boxes `level` steps below the root's, which is at level 0: at most `most`, in the order of the hierarchy.
pub(crate) fn boxes_at(nodes: &[WideNode], root: Aabb, level: u32, most: usize) -> Vec<Aabb> {
    let mut boxes = Vec::new();
    let mut pending = vec![(Child::inner(0), root, 0)];
    while boxes.len() < most
        && let Some((child, bounds, depth)) = pending.pop()
    {
        if depth == level {
            boxes.push(bounds);
        } else if !child.is_leaf() {
            let node = &nodes[child.node()];
            let children = (0..WIDTH).rev().filter(|&i| !node.child(i).is_none());
            pending.extend(children.map(|i| (node.child(i), node.bounds(i), depth + 1)));
        }
    }
    boxes
}
