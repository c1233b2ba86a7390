//! c_a = (4 / N) sum_i V(x, w_i) (n . w_i)+, with w_i uniform on the whole sphere.
//!
//! The factor is 4 because the mean of (n . w)+ over the sphere is 1/4: with nothing in reach the mean of c_a
//! is 1. Half of the directions have no weight and are not traced.

use super::RayCounts;
use crate::accel::{Tally, Uncounted, bits};
use crate::cancel::CancelToken;
use crate::geometry::DirectionFan;
use crate::sampling::{HemisphereLattice, Key};
use crate::scene::AmbientOcclusion;
use crate::world::{FanScratch, Intersection, World};

/// Memory that points leave to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct OcclusionScratch {
    directions: DirectionFan,
    fans: FanScratch,
}

/// Estimates c_a at one point after another.
#[derive(Clone, Debug)]
pub struct AmbientOcclusionSampler {
    lattice: HemisphereLattice,
    distance: f64,
    cancel: CancelToken,
}

impl AmbientOcclusionSampler {
    /// A sampler for N and D.
    pub fn new(settings: &AmbientOcclusion) -> Self {
        let lattice = HemisphereLattice::new(settings.samples);
        Self { lattice, distance: settings.distance, cancel: CancelToken::default() }
    }

    /// The same, until it is cancelled: what it returns after that is unfinished.
    #[must_use]
    pub fn until(self, cancel: &CancelToken) -> Self {
        Self { cancel: cancel.clone(), ..self }
    }

    /// Whether N is not 0.
    pub(super) fn is_wanted(&self) -> bool {
        self.lattice.samples() > 0
    }

    /// c_a at a point; 1 where N is 0. It may exceed 1, since it is not clamped.
    pub fn factor(&self, world: &World, at: &Intersection, key: Key, counts: &mut RayCounts) -> f64 {
        self.factor_with(world, at, key, counts, &mut OcclusionScratch::default(), &Uncounted)
    }

    /// As [`AmbientOcclusionSampler::factor`], with memory from before, and tells what the search looks at.
    pub(super) fn factor_with(
        &self,
        world: &World,
        at: &Intersection,
        key: Key,
        counts: &mut RayCounts,
        scratch: &mut OcclusionScratch,
        tally: &impl Tally,
    ) -> f64 {
        if !self.is_wanted() {
            return 1.0;
        }
        let OcclusionScratch { directions, fans } = scratch;
        let mut sum = 0.0;
        self.lattice.visit_around(at.facing_normal(), &mut key.stream(), directions, |fan| {
            if self.cancel.is_cancelled() {
                return;
            }
            counts.ao += fan.count as u64;
            let occluded = world.occluded_fan_tallied(at, fan, self.distance, fans, tally);
            for visible in bits(fan.all() & !occluded) {
                sum += fan.elevation(visible);
            }
        });
        4.0 * sum / f64::from(self.lattice.samples())
    }
}
