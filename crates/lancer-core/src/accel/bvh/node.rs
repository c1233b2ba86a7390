//! A node of eight children: their boxes as a structure of arrays, and what each child is.

use super::super::Aabb;

/// The children of a node.
pub const WIDTH: usize = 8;

/// The most primitives in a leaf: three bits of a [`Child`].
pub const MAX_LEAF: usize = 8;

/// Eight boxes, and what is in them.
///
/// Children that are there come first. The others have the box `min = +inf`, `max = -inf`, which nothing meets.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WideNode {
    /// By axis, then by child.
    pub(crate) min: [[f32; WIDTH]; 3],
    /// By axis, then by child.
    pub(crate) max: [[f32; WIDTH]; 3],
    pub(crate) children: [Child; WIDTH],
}

impl WideNode {
    /// A node without children.
    pub(crate) const EMPTY: Self = Self {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
        children: [Child::NONE; WIDTH],
    };

    /// What a child is.
    pub fn child(&self, child: usize) -> Child {
        self.children[child]
    }

    /// The box of a child.
    pub fn bounds(&self, child: usize) -> Aabb {
        Aabb { min: self.min.map(|axis| axis[child]), max: self.max.map(|axis| axis[child]) }
    }

    /// The children as words; see [`Child`].
    #[inline(always)]
    pub(crate) fn words(&self) -> [u32; WIDTH] {
        let mut words = [0; WIDTH];
        for (word, child) in words.iter_mut().zip(&self.children) {
            *word = child.0;
        }
        words
    }

    pub(super) fn set(&mut self, child: usize, bounds: &Aabb, what: Child) {
        for axis in 0..3 {
            self.min[axis][child] = bounds.min[axis];
            self.max[axis][child] = bounds.max[axis];
        }
        self.children[child] = what;
    }
}

/// What is below one of a node's boxes, in four bytes.
///
/// | | bit 31 | bits 28 to 30 | bits 0 to 27 |
/// |---|---|---|---|
/// | inner node | 0 | its index, with the bits to the right | |
/// | leaf | 1 | number of primitives - 1 | first place in the order |
/// | none | 1 | 7 | all ones: no leaf ends past 2^28 |
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u32);

/// The least word that is a leaf, or none.
pub(crate) const LEAF: u32 = 1 << 31;
const FIRST: u32 = (1 << 28) - 1;

impl Child {
    /// No child.
    pub const NONE: Self = Self(u32::MAX);

    pub(crate) fn inner(node: u32) -> Self {
        debug_assert!(node < LEAF);
        Self(node)
    }

    pub(crate) fn leaf(first: u32, count: u32) -> Self {
        debug_assert!(first < FIRST && (1..=MAX_LEAF as u32).contains(&count));
        Self(LEAF | (count - 1) << 28 | first)
    }

    /// The child of a word of [`WideNode::words`].
    #[inline(always)]
    pub(crate) fn of_word(word: u32) -> Self {
        Self(word)
    }

    /// Its word.
    #[inline(always)]
    pub(crate) fn word(self) -> u32 {
        self.0
    }

    /// Whether it is a leaf; [`Child::NONE`] claims so too.
    #[inline]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// Whether there is no child.
    #[inline]
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// The index of an inner node.
    #[inline]
    pub fn node(self) -> usize {
        self.0 as usize
    }

    /// The first place of a leaf in the order.
    #[inline]
    pub fn first(self) -> usize {
        (self.0 & FIRST) as usize
    }

    /// The number of primitives of a leaf.
    #[inline]
    pub fn count(self) -> usize {
        (self.0 >> 28 & 7) as usize + 1
    }

    /// The same child where nodes and places are counted from further back.
    pub(super) fn shifted(self, nodes: u32, places: u32) -> Self {
        match self {
            Self::NONE => self,
            leaf if leaf.is_leaf() => Self(leaf.0 + places),
            Self(node) => Self(node + nodes),
        }
    }
}
