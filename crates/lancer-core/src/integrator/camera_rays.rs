//! Camera rays that are traced together.

use crate::camera::Projection;
use crate::geometry::{Ray, RayPacket};
use crate::sampling::Key;
use std::ops::Range;

const LANES: usize = RayPacket::LANES;

/// Up to sixteen camera rays, and the keys of their random numbers.
#[derive(Clone, Debug)]
pub struct CameraRays {
    packet: RayPacket,
    keys: [Key; LANES],
    count: usize,
}

impl CameraRays {
    /// Aims a ray at the same subpixel of each pixel of a rectangle: at `offset` from their top left corners.
    ///
    /// # Panics
    /// Where there are more than [`RayPacket::LANES`].
    pub fn aim(
        &mut self,
        projection: &Projection,
        columns: Range<u32>,
        rows: Range<u32>,
        subpixel: u32,
        offset: (f64, f64),
    ) {
        let (mut across, mut down) = ([0.0; LANES], [0.0; LANES]);
        self.count = 0;
        for y in rows {
            for x in columns.clone() {
                across[self.count] = f64::from(x) + offset.0;
                down[self.count] = f64::from(y) + offset.1;
                self.keys[self.count] = Key::camera(x, y, subpixel);
                self.count += 1;
            }
        }
        projection.rays(&across, &down, &mut self.packet);
    }

    /// A ray alone.
    pub(super) fn one(ray: &Ray, key: Key) -> Self {
        Self { packet: RayPacket::splat(ray), keys: [key; LANES], count: 1 }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The rays, in the order in which their pixels are read.
    pub fn iter(&self) -> impl Iterator<Item = (Ray, Key)> {
        (0..self.count).map(|lane| (self.packet.ray(lane), self.keys[lane]))
    }

    /// The rays, in the first lanes.
    pub(super) fn packet(&self) -> &RayPacket {
        &self.packet
    }

    /// Their keys.
    pub(super) fn keys(&self) -> &[Key; LANES] {
        &self.keys
    }

    /// A bit for each.
    pub(super) fn lanes(&self) -> u32 {
        (1 << self.count) - 1
    }
}

impl Default for CameraRays {
    fn default() -> Self {
        Self { packet: RayPacket::default(), keys: [Key::camera(0, 0, 0); LANES], count: 0 }
    }
}
