//! Boxes as the builders work on them: two registers, whose union is two minima.

use super::super::Aabb;
use glam::Vec4;

/// A box, with the greater corner negated.
///
/// The fourth lane of `low` may name a primitive; that of `high` is not used. Neither enters a result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

/// Keeps names from being subnormal numbers, which arithmetic is slow on, and leaves all of them numbers.
const NAME: u32 = 1 << 30;

impl Extent {
    pub(super) const EMPTY: Self = Self { low: Vec4::INFINITY, high: Vec4::INFINITY };

    pub(super) fn new(bounds: &Aabb, primitive: u32) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min, bounds.max);
        Self { low: Vec4::new(a, b, c, f32::from_bits(primitive | NAME)), high: Vec4::new(-d, -e, -f, 0.0) }
    }

    /// The primitive that it was made for.
    pub(super) fn primitive(&self) -> u32 {
        self.low.w.to_bits() & !NAME
    }

    #[inline(always)]
    pub(super) fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// Twice the centre.
    #[inline(always)]
    pub(super) fn center(&self) -> Vec4 {
        self.low - self.high
    }

    /// Half of the area of the surface.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z, _] = (-(self.low + self.high)).to_array();
        x * y + y * z + z * x
    }

    pub(super) fn to_aabb(self) -> Aabb {
        let ([a, b, c, _], [d, e, f, _]) = (self.low.to_array(), self.high.to_array());
        Aabb { min: [a, b, c], max: [-d, -e, -f] }
    }
}
