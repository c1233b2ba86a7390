//! Rays that are traced together.

use super::{DVec3, Ray};

/// Sixteen rays by coordinate, as vector instructions want them.
///
/// Shape: `[axis][lane]`. Which lanes hold a ray is for whoever made the packet to know, as a mask of a bit a lane.
#[derive(Clone, Debug)]
pub struct RayPacket {
    /// See [`Ray::origin`].
    pub origin: [[f64; Self::LANES]; 3],
    /// See [`Ray::direction`].
    pub direction: [[f64; Self::LANES]; 3],
    /// See [`Ray::t_max`].
    pub t_max: [f64; Self::LANES],
}

impl RayPacket {
    /// Rays in a packet.
    pub const LANES: usize = 16;

    /// A packet of sixteen rays alike.
    pub fn splat(ray: &Ray) -> Self {
        let all = |v: DVec3| v.to_array().map(|x| [x; Self::LANES]);
        Self { origin: all(ray.origin), direction: all(ray.direction), t_max: [ray.t_max; Self::LANES] }
    }

    /// The ray in a lane.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        let at = |v: &[[f64; Self::LANES]; 3]| DVec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Ray { origin: at(&self.origin), direction: at(&self.direction), t_max: self.t_max[lane] }
    }

    /// Puts a ray into a lane.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.direction[axis][lane] = ray.direction[axis];
        }
        self.t_max[lane] = ray.t_max;
    }
}
