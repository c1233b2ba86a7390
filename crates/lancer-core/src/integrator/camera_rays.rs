//! Camera rays that are traced together.

use crate::geometry::{DVec3, Ray, RayPacket};
use crate::sampling::Key;

/// Up to sixteen camera rays, and the keys of their random numbers.
#[derive(Clone, Debug)]
pub struct CameraRays {
    packet: RayPacket,
    keys: [Key; RayPacket::LANES],
    count: usize,
}

impl CameraRays {
    /// Adds a ray.
    ///
    /// # Panics
    /// Where there are [`RayPacket::LANES`] already.
    #[inline]
    pub fn push(&mut self, ray: &Ray, key: Key) {
        self.packet.set(self.count, ray);
        self.keys[self.count] = key;
        self.count += 1;
    }

    /// Forgets all rays.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The rays, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (Ray, Key)> {
        (0..self.count).map(|lane| (self.packet.ray(lane), self.keys[lane]))
    }

    /// The rays, in the first lanes.
    pub(super) fn packet(&self) -> &RayPacket {
        &self.packet
    }

    /// Their keys.
    pub(super) fn keys(&self) -> &[Key] {
        &self.keys[..self.count]
    }

    /// A bit for each.
    pub(super) fn lanes(&self) -> u32 {
        (1 << self.count) - 1
    }
}

impl Default for CameraRays {
    fn default() -> Self {
        let packet = RayPacket::splat(&Ray::new(DVec3::ZERO, DVec3::ONE));
        Self { packet, keys: [Key::camera(0, 0, 0); RayPacket::LANES], count: 0 }
    }
}
