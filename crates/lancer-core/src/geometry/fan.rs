//! Directions in a bundle, around a normal.

use super::DVec3;

/// Up to 64 unit directions above a plane, sorted by elevation: the cosine to the plane's normal.
///
/// Their elevations are `lowest`, `lowest + step` and so on, all in (0, 1], but for rounding. Shape:
/// `components: [3][64]` by axis; entries from `count` on are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionFan {
    /// The directions' coordinates, by axis.
    pub components: [[f64; Self::CAPACITY]; 3],
    /// The elevation of the first direction.
    pub lowest: f64,
    /// How much higher each stands than the one before.
    pub step: f64,
    /// How many there are.
    pub count: usize,
}

impl Default for DirectionFan {
    /// No directions.
    fn default() -> Self {
        Self { components: [[0.0; Self::CAPACITY]; 3], lowest: 0.0, step: 0.0, count: 0 }
    }
}

impl DirectionFan {
    /// The most directions: one bit of a `u64` each.
    pub const CAPACITY: usize = 64;

    /// A direction.
    ///
    /// # Panics
    /// Where `i` is not below [`DirectionFan::CAPACITY`].
    pub fn direction(&self, i: usize) -> DVec3 {
        let [x, y, z] = &self.components;
        DVec3::new(x[i], y[i], z[i])
    }

    /// The elevation of a direction.
    pub fn elevation(&self, i: usize) -> f64 {
        self.lowest + self.step * i as f64
    }

    /// The directions whose product with a vector is negative, a bit for each.
    #[inline(always)]
    pub(crate) fn against(&self, vector: DVec3) -> u64 {
        let [x, y, z] = &self.components;
        let mut against = [false; Self::CAPACITY];
        for i in 0..Self::CAPACITY {
            against[i] = vector.x * x[i] + vector.y * y[i] + vector.z * z[i] < 0.0;
        }
        (0..Self::CAPACITY).fold(0, |set, i| set | u64::from(against[i]) << i) & self.all()
    }

    /// A bit for each direction.
    pub fn all(&self) -> u64 {
        if self.count == 0 { 0 } else { u64::MAX >> (Self::CAPACITY - self.count) }
    }
}
