//! The nearest hits of rays that are traced together.

use super::{Hit, ObjectId};
use crate::geometry::RayPacket;
use crate::shape;

const LANES: usize = RayPacket::LANES;

/// Where each ray of a packet meets the world, lane by lane as vector instructions want it.
#[derive(Clone, Debug)]
pub struct Hits {
    /// Infinite where a ray meets nothing.
    t: [f64; LANES],
    object: [ObjectId; LANES],
    primitive: [u32; LANES],
}

impl Hits {
    /// Of rays that meet nothing.
    pub(super) const NONE: Self =
        Self { t: [f64::INFINITY; LANES], object: [ObjectId(0); LANES], primitive: [0; LANES] };

    /// What a ray hits.
    ///
    /// # Panics
    /// Where `lane` is not below [`RayPacket::LANES`].
    #[inline]
    pub fn at(&self, lane: usize) -> Option<Hit> {
        let hit = Hit { t: self.t[lane], object: self.object[lane], primitive: self.primitive[lane] };
        (hit.t < f64::INFINITY).then_some(hit)
    }

    /// The rays that hit anything, a bit for each.
    #[inline]
    pub fn lanes(&self) -> u32 {
        (0..LANES).fold(0, |set, lane| set | u32::from(self.t[lane] < f64::INFINITY) << lane)
    }

    /// Puts what a ray hits in the place of what was there.
    #[inline]
    pub(crate) fn put(&mut self, lane: usize, hit: Option<Hit>) {
        let Hit { t, object, primitive } =
            hit.unwrap_or(Hit { t: f64::INFINITY, object: ObjectId(0), primitive: 0 });
        (self.t[lane], self.object[lane], self.primitive[lane]) = (t, object, primitive);
    }

    /// The rays that hit an object.
    #[inline]
    pub(super) fn on(&self, object: ObjectId) -> u32 {
        (0..LANES).fold(0, |set, lane| set | u32::from(self.object[lane] == object) << lane) & self.lanes()
    }

    /// The hits in some lanes, which are with one object; in the others, one of them.
    #[inline(always)]
    pub(super) fn on_object(&self, lanes: u32) -> shape::Hits {
        let first = lanes.trailing_zeros() as usize;
        let mut hits = shape::Hits::NONE;
        for lane in 0..LANES {
            let is_there = lanes >> lane & 1 == 1;
            hits.t[lane] = if is_there { self.t[lane] } else { self.t[first] };
            hits.primitive[lane] = if is_there { self.primitive[lane] } else { self.primitive[first] };
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
            let t = hits.t[lane];
            let is_nearer = (t < self.t[lane]) | ((t == self.t[lane]) & (object < self.object[lane]));
            let is_kept = (lanes >> lane & 1 == 1) & (t < f64::INFINITY) & is_nearer;
            self.t[lane] = if is_kept { t } else { self.t[lane] };
            self.object[lane] = if is_kept { object } else { self.object[lane] };
            self.primitive[lane] = if is_kept { hits.primitive[lane] } else { self.primitive[lane] };
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
