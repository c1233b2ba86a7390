//! The boxes of a hierarchy, level by level.

use super::node::{Child, WIDTH, WideNode};
use crate::accel::Aabb;
use std::collections::VecDeque;

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
            let children = children(&nodes[child.node()]);
            pending.extend(children.rev().map(|(child, bounds)| (child, bounds, depth + 1)));
        }
    }
    boxes
}

/// Boxes that together hold all that the root's holds: the smallest of the hierarchy of which there are at most `most`.
pub(crate) fn boxes_around_all(nodes: &[WideNode], root: Aabb, most: usize) -> Vec<Aabb> {
    let mut boxes = Vec::new();
    let mut pending = VecDeque::from([(Child::inner(0), root)]);
    while let Some((child, bounds)) = pending.pop_front() {
        if child.is_leaf() || boxes.len() + pending.len() + WIDTH > most {
            boxes.push(bounds);
        } else {
            pending.extend(children(&nodes[child.node()]));
        }
    }
    boxes
}

fn children(node: &WideNode) -> impl DoubleEndedIterator<Item = (Child, Aabb)> {
    (0..WIDTH).filter(|&i| !node.child(i).is_none()).map(|i| (node.child(i), node.bounds(i)))
}
