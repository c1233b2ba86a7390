//! A node in eight bytes.

/// An inner node or a leaf.
///
/// | | `low` | `high`, upper 30 bits | `high`, lower 2 bits |
/// |---|---|---|---|
/// | inner | the split plane, as the bits of an `f32` | index of the child above the plane | the axis, 0 to 2 |
/// | leaf | index of the first reference | number of references | 3 |
///
/// The child below the plane follows its parent. Half as large as with two child indices, so that a cache line
/// holds eight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    low: u32,
    high: u32,
}

/// A node, unpacked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Inner { axis: usize, position: f32, above: u32 },
    Leaf { first: u32, count: u32 },
}

const LEAF: u32 = 3;

/// Indices and counts must stay below this to fit.
pub(super) const MAX_INDEX: u32 = 1 << 30;

impl Node {
    pub(super) fn leaf(first: u32, count: u32) -> Self {
        debug_assert!(count < MAX_INDEX);
        Self { low: first, high: count << 2 | LEAF }
    }

    pub(super) fn inner(axis: usize, position: f32, above: u32) -> Self {
        debug_assert!(axis < 3 && above < MAX_INDEX);
        Self { low: position.to_bits(), high: above << 2 | axis as u32 }
    }

    #[inline]
    pub(super) fn kind(self) -> Kind {
        let (index, tag) = (self.high >> 2, self.high & 3);
        if tag == LEAF {
            Kind::Leaf { first: self.low, count: index }
        } else {
            Kind::Inner { axis: tag as usize, position: f32::from_bits(self.low), above: index }
        }
    }

    /// The node as part of a larger tree, in which its nodes and references start at these places.
    pub(super) fn shifted(self, nodes: u32, references: u32) -> Self {
        match self.kind() {
            Kind::Inner { axis, position, above } => Self::inner(axis, position, above + nodes),
            Kind::Leaf { first, count } => Self::leaf(first + references, count),
        }
    }
}
