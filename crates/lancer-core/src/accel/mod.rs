//! Structures that find what a ray may meet. They know no material, camera or pixel.

mod aabb;
mod bits;
pub mod bvh;
pub mod kd_tree;
mod tally;
pub(crate) mod triangles;

pub use aabb::Aabb;
pub(crate) use bits::bits;
pub use bvh::{Bvh, Quality};
pub use kd_tree::{BuildError, KdSettings, KdTree};
pub use tally::{Tally, Uncounted, Visits};

/// Which structure finds hits. It changes the time that a picture takes, and nothing in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Accelerator {
    /// Hierarchies of boxes, eight to a node, searched by vector instructions. The fastest.
    #[default]
    Bvh,
    /// A k-d tree over the objects, and one over the triangles of each mesh.
    KdTree,
    /// None: every ray is tested against every object and every triangle. The oracle of the tests.
    BruteForce,
}

impl Accelerator {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Bvh, Self::KdTree, Self::BruteForce];

    /// The name by which the command line's `--accel` chooses it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bvh => "bvh",
            Self::KdTree => "kd-tree",
            Self::BruteForce => "brute-force",
        }
    }
}

/// Things with boxes, over which a tree is built.
pub trait Primitives: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// The box around one.
    fn bounds(&self, primitive: u32) -> Aabb;

    /// The box around the part of a primitive inside of `cell`, itself inside of `cell`; none where they do not
    /// meet. It may be larger than that part, and never smaller.
    fn clip(&self, primitive: u32, cell: &Aabb) -> Option<Aabb> {
        self.bounds(primitive).intersection(cell)
    }
}
