//! The cells of a tree level by level, to be looked at.

use super::node::Kind;
use super::{Aabb, KdTree};

impl KdTree {
    /// The cells at `level`, the root's being 0: at most `most`, in the order of the tree.
    pub fn cells_at(&self, level: u32, most: usize) -> Vec<Aabb> {
        let mut cells = Vec::new();
        let mut pending = vec![(0, self.bounds, 0)];
        while cells.len() < most
            && let Some((index, cell, depth)) = pending.pop()
        {
            if depth == level {
                cells.push(cell);
            } else if let Kind::Inner { axis, position, above } = self.nodes[index].kind() {
                let [lower, upper] = cell.split(axis, position);
                pending.push((above as usize, upper, depth + 1));
                pending.push((index + 1, lower, depth + 1));
            }
        }
        cells
    }
}
