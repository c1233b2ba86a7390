//! Axis-aligned boxes.

use super::DVec3;

/// The closed box `min..max`; empty where `min` exceeds `max` on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the least coordinates.
    pub min: DVec3,
    /// The corner with the greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing, and that joins with any other to that other.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box that holds all of space.
    pub const UNBOUNDED: Self = Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The box between two corners; empty where `min` exceeds `max` on any axis.
    pub fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The least box around some points; [`Bounds::EMPTY`] where there are none.
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::including)
    }

    /// The least box around this one and a point.
    pub fn including(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The least box around two. An empty one counts for nothing.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether no point lies in it.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Whether it has finite corners.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// The middle. Not finite where the box is empty or unbounded.
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The lengths of the edges, by axis; negative where the box is empty.
    pub fn extent(&self) -> DVec3 {
        self.max - self.min
    }

    /// The length from corner to corner, in units of the space that the box is in.
    pub fn diagonal(&self) -> f64 {
        self.extent().length()
    }

    /// The eight corners: bit 0 of the place says whether x is the greater one, bit 1 y, bit 2 z.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, min: f64, max: f64| if i >> bit & 1 == 0 { min } else { max };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// The greatest magnitude of any coordinate in the box, by axis.
    pub fn magnitude(&self) -> DVec3 {
        self.min.abs().max(self.max.abs())
    }
}
