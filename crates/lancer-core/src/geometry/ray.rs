//! A ray and the stretch of it that counts.

use super::DVec3;

/// The points `origin + t * direction` with t in (0, `t_max`).
///
/// `direction` need not have length 1: a ray carried into an object's space keeps its parameter, so that t
/// means the same in both. A hit exactly at an end of the interval may or may not be reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: DVec3,
    /// Where it goes; any length but zero.
    pub direction: DVec3,
    /// The end of the interval; `f64::INFINITY` for a ray without one.
    pub t_max: f64,
}

impl Ray {
    /// A ray without an end; `direction` has any length but zero, and t counts in lengths of it.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, t_max: f64::INFINITY }
    }

    /// The open segment between two points; t runs from 0 to 1.
    pub fn between(from: DVec3, to: DVec3) -> Self {
        Self { origin: from, direction: to - from, t_max: 1.0 }
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
