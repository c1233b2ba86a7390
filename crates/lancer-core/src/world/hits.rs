//! The nearest hits of rays that are traced together.

use super::{Hit, ObjectId};
use crate::geometry::RayPacket;
use crate::shape;

const LANES: usize = RayPacket::LANES;

/// Where each ray of a packet meets the world, lane by lane as vector instructions want it.
#[derive(Clone, Debug)]
pub struct Hits {
    nearest: shape::Hits,
    /// What is hit, where anything is.
    object: [ObjectId; LANES],
}

impl Hits {
    /// Of rays that meet nothing.
    pub(super) const NONE: Self = Self { nearest: shape::Hits::NONE, object: [ObjectId(0); LANES] };

    /// What a ray hits.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline]
    pub fn at(&self, lane: usize) -> Option<Hit> {
        let shape::Hit { t, primitive } = self.nearest.at(lane).found()?;
        Some(Hit { t, object: self.object[lane], primitive })
    }

    /// The rays that hit anything, a bit for each.
    #[inline]
    pub fn lanes(&self) -> u32 {
        self.nearest.lanes()
    }

    /// Puts what a ray hits in the place of what was there.
    #[inline]
    pub(crate) fn put(&mut self, lane: usize, hit: Option<Hit>) {
        self.nearest.put_found(lane, hit.map(|Hit { t, primitive, .. }| shape::Hit { t, primitive }));
        self.object[lane] = hit.map_or(ObjectId(0), |hit| hit.object);
    }

    /// The rays that hit an object.
    #[inline]
    pub(super) fn on(&self, object: ObjectId) -> u32 {
        (0..LANES).fold(0, |set, lane| set | u32::from(self.object[lane] == object) << lane) & self.lanes()
    }

    /// The hits in some lanes, which are with one object; in the others, one of them.
    #[inline(always)]
    pub(super) fn on_object(&self, lanes: u32) -> shape::Hits {
        let first = self.nearest.at(lanes.trailing_zeros() as usize);
        let mut hits = shape::Hits::NONE;
        for lane in 0..LANES {
            hits.put(lane, if lanes >> lane & 1 == 1 { self.nearest.at(lane) } else { first });
        }
        hits
    }

    /// Keeps those in some lanes of an object's hits that are nearer, or as near and of a lower object. Hits then count
    /// up to `t_max`; up to `up_to`, those at the same t are still looked at.
    #[inline(always)]
    pub(super) fn keep_nearer(
        &mut self,
        object: ObjectId,
        hits: &shape::Hits,
        lanes: u32,
        t_max: &mut [f64; LANES],
        up_to: &mut [f64; LANES],
    ) {
        for lane in 0..LANES {
            let (hit, known) = (hits.at(lane), self.nearest.at(lane));
            let t = hit.t;
            let is_nearer = (t < known.t) | ((t == known.t) & (object < self.object[lane]));
            let is_kept = (lanes >> lane & 1 == 1) & (t < f64::INFINITY) & is_nearer;
            self.nearest.put(lane, if is_kept { hit } else { known });
            self.object[lane] = if is_kept { object } else { self.object[lane] };
            t_max[lane] = if is_kept { t } else { t_max[lane] };
            up_to[lane] = if is_kept { t.next_up() } else { up_to[lane] };
        }
    }
}

impl Default for Hits {
    fn default() -> Self {
        Self::NONE
    }
}
