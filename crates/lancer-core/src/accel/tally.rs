//! How much a search looks at, for whoever wants to know.

use std::cell::Cell;

/// Is told what a search looks at. Both methods do nothing unless they are written, and then cost nothing.
///
/// What a search looks at depends on the accelerator, how it was built and, by rounding, on the vector
/// instructions; it does not depend on threads.
pub trait Tally {
    /// A node of a tree was looked at, with all of its children. Directions that are searched together count once.
    #[inline(always)]
    fn node(&self) {}

    /// So many triangles were tested. Directions that are tested together count once.
    #[inline(always)]
    fn triangles(&self, _count: usize) {}
}

/// Counts nothing: a plain search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncounted;

impl Tally for Uncounted {}

/// Counts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    nodes: Cell<u64>,
    triangles: Cell<u64>,
}

impl Visits {
    /// Nodes looked at so far.
    pub fn nodes(&self) -> u64 {
        self.nodes.get()
    }

    /// Triangles tested so far.
    pub fn triangles(&self) -> u64 {
        self.triangles.get()
    }
}

impl Tally for Visits {
    fn node(&self) {
        self.nodes.set(self.nodes.get() + 1);
    }

    fn triangles(&self, count: usize) {
        self.triangles.set(self.triangles.get() + count as u64);
    }
}
