//! Boxes as the builders work on them: two registers, whose union is two minima.

use super::super::Aabb;
use glam::Vec4;

/// A box with the greater corner negated, of a primitive or of many.
///
/// The fourth lane of `low` holds the name of what is inside, that of `high` the number of primitives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

/// Keeps names and numbers from being subnormal, which arithmetic is slow on, and from being no number.
const LABEL: u32 = 1 << 30;

/// Areas from here on are alike. The sum over all primitives is still a number.
const MOST: f32 = 1e29;
/// Areas below this are alike.
const LEAST: f32 = 1e-30;

impl Extent {
    pub(super) const EMPTY: Self = Self { low: Vec4::INFINITY, high: Vec4::INFINITY };

    #[inline(always)]
    pub(super) fn new(bounds: &Aabb, name: u32) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min, bounds.max);
        Self { low: Vec4::new(a, b, c, 0.0), high: Vec4::new(-d, -e, -f, 0.0) }.labelled(name, 1)
    }

    #[inline(always)]
    #[must_use]
    pub(super) fn labelled(self, name: u32, weight: u32) -> Self {
        debug_assert!(name < LABEL && weight < LABEL);
        let label = |value: u32| f32::from_bits(value | LABEL);
        Self { low: self.low.with_w(label(name)), high: self.high.with_w(label(weight)) }
    }

    /// What it was labelled with.
    #[inline(always)]
    pub(super) fn name(&self) -> u32 {
        self.low.w.to_bits() & !LABEL
    }

    /// Primitives in it.
    #[inline(always)]
    pub(super) fn weight(&self) -> u32 {
        self.high.w.to_bits() & !LABEL
    }

    /// The box around two, without a name.
    #[inline(always)]
    #[must_use]
    pub(super) fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// Twice the centre.
    #[inline(always)]
    pub(super) fn center(&self) -> Vec4 {
        self.low - self.high
    }

    /// The box around a point.
    #[inline(always)]
    pub(super) fn point(point: Vec4) -> Self {
        Self { low: point, high: -point }
    }

    #[inline(always)]
    pub(super) fn sides(&self) -> Vec4 {
        -(self.low + self.high)
    }

    /// Half of the area of the surface, kept away from 0 and infinity: where all boxes are points or too large to
    /// be measured, the number of primitives still decides.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z, _] = self.sides().to_array();
        let area = x * y + y * z + z * x;
        (if area < MOST { area } else { MOST }) + LEAST
    }

    pub(super) fn to_aabb(self) -> Aabb {
        let ([a, b, c, _], [d, e, f, _]) = (self.low.to_array(), self.high.to_array());
        Aabb { min: [a, b, c], max: [-d, -e, -f] }
    }
}

/// The box around all.
pub(super) fn around(items: &[Extent]) -> Extent {
    items.iter().fold(Extent::EMPTY, |sum, item| sum.union(item))
}

/// The box around the centres of all, at twice the scale.
pub(super) fn around_centers(items: &[Extent]) -> Extent {
    items.iter().fold(Extent::EMPTY, |sum, item| sum.union(&Extent::point(item.center())))
}
