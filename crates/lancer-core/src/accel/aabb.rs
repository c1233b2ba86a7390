//! The boxes of trees: `f32`, rounded outward, at half the memory of [`Bounds`].

use crate::geometry::Bounds;

/// A closed box with `min <= max` on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the least coordinates.
    pub min: [f32; 3],
    /// The corner with the greatest coordinates.
    pub max: [f32; 3],
}

impl Aabb {
    /// The least `f32` box around a finite, not empty one.
    pub fn around(bounds: &Bounds) -> Self {
        Self { min: bounds.min.to_array().map(round_down), max: bounds.max.to_array().map(round_up) }
    }

    /// The same box in `f64`.
    pub fn to_bounds(self) -> Bounds {
        Bounds::new(self.min.map(f64::from).into(), self.max.map(f64::from).into())
    }

    /// The least box around two.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|axis| self.min[axis].min(other.min[axis])),
            max: std::array::from_fn(|axis| self.max[axis].max(other.max[axis])),
        }
    }

    /// What two have in common, which may be flat; none where they do not touch.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let common = Self {
            min: std::array::from_fn(|axis| self.min[axis].max(other.min[axis])),
            max: std::array::from_fn(|axis| self.max[axis].min(other.max[axis])),
        };
        (0..3).all(|axis| common.min[axis] <= common.max[axis]).then_some(common)
    }

    /// The box with its corners moved into `cell`, if they are not in it.
    #[must_use]
    pub fn clamped(&self, cell: &Self) -> Self {
        let clamp = |x: f32, axis: usize| x.clamp(cell.min[axis], cell.max[axis]);
        Self {
            min: std::array::from_fn(|axis| clamp(self.min[axis], axis)),
            max: std::array::from_fn(|axis| clamp(self.max[axis], axis)),
        }
    }

    /// The parts below and above the plane `position` of an axis.
    #[must_use]
    pub fn split(&self, axis: usize, position: f32) -> [Self; 2] {
        let (mut below, mut above) = (*self, *self);
        below.max[axis] = position;
        above.min[axis] = position;
        [below, above]
    }

    /// Half of the area of its surface: what the surface area heuristic compares.
    pub fn half_area(&self) -> f32 {
        let [x, y, z] = std::array::from_fn(|axis| self.max[axis] - self.min[axis]);
        x * y + y * z + z * x
    }
}

fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

fn round_up(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}
