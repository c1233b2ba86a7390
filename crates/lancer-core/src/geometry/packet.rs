//! Rays that are traced together.

use super::{DVec3, Ray};

/// A vector for each of sixteen rays. Shape: `[axis][lane]`.
pub type Vectors = [[f64; RayPacket::LANES]; 3];

/// The vector in a lane.
#[inline(always)]
pub(crate) fn at(vectors: &Vectors, lane: usize) -> DVec3 {
    DVec3::new(vectors[0][lane], vectors[1][lane], vectors[2][lane])
}

/// Puts a vector into a lane.
#[inline(always)]
pub(crate) fn put(vectors: &mut Vectors, lane: usize, vector: DVec3) {
    for axis in 0..3 {
        vectors[axis][lane] = vector[axis];
    }
}

/// So many lanes are worth vector code; fewer go one by one. Untuned.
pub(crate) const TOGETHER: u32 = 3;

/// Sixteen rays by coordinate, as vector instructions want them.
///
/// Shape: `[axis][lane]`. Which lanes hold a ray is for whoever made the packet to know, as a mask of a bit a lane.
#[derive(Clone, Debug, Default)]
pub struct RayPacket {
    /// See [`Ray::origin`].
    pub origin: Vectors,
    /// See [`Ray::direction`].
    pub direction: Vectors,
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
        Ray { origin: at(&self.origin, lane), direction: at(&self.direction, lane), t_max: self.t_max[lane] }
    }

    /// Puts a ray into a lane.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        put(&mut self.origin, lane, ray.origin);
        put(&mut self.direction, lane, ray.direction);
        self.t_max[lane] = ray.t_max;
    }
}
