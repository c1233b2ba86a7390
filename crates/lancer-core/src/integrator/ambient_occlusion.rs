//! c_a = (4 / N) sum_i V(x, w_i) (n . w_i)+, with w_i uniform on the whole sphere.
//!
//! The factor is 4 because the mean of (n . w)+ over the sphere is 1/4: with nothing in reach the mean of c_a
//! is 1. Half of the directions have no weight and are not traced.

use super::RayCounts;
use crate::sampling::{Key, Rotation, SphereLattice};
use crate::scene::AmbientOcclusion;
use crate::world::{Intersection, World};

/// Estimates c_a at one point after another.
#[derive(Clone, Debug)]
pub struct AmbientOcclusionSampler {
    lattice: SphereLattice,
    distance: f64,
}

impl AmbientOcclusionSampler {
    /// A sampler for N and D.
    pub fn new(settings: &AmbientOcclusion) -> Self {
        Self { lattice: SphereLattice::new(settings.samples), distance: settings.distance }
    }

    /// c_a at a point; 1 where N is 0. It may exceed 1, since it is not clamped.
    pub fn factor(&self, world: &World, at: &Intersection, key: Key, counts: &mut RayCounts) -> f64 {
        if self.lattice.is_empty() {
            return 1.0;
        }
        let normal = at.facing_normal();
        let rotation = Rotation::random(&mut key.stream());
        let mut sum = 0.0;
        for direction in self.lattice.turned(&rotation) {
            let weight = normal.dot(direction);
            if weight > 0.0 {
                counts.ao += 1;
                let mut ray = at.spawn(direction);
                ray.t_max = self.distance;
                if !world.occluded(&ray) {
                    sum += weight;
                }
            }
        }
        4.0 * sum / self.lattice.len() as f64
    }
}
