//! Camera rays that are traced together.

use crate::camera::Projection;
use crate::geometry::{Ray, RayPacket};
use crate::sampling::Key;

const LANES: usize = RayPacket::LANES;

/// A row or a column of the subpixels of some pixels.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The row or the column of its pixels, from that of the first.
    pub pixel: u32,
    /// Which it is within its pixels.
    pub subpixel: u32,
    /// Its centre, in pixels from where its pixels start.
    pub center: f64,
}

/// Up to sixteen camera rays, and the keys of their random numbers.
#[derive(Clone, Debug)]
pub struct CameraRays {
    packet: RayPacket,
    keys: [Key; LANES],
    count: usize,
}

impl CameraRays {
    /// Aims a ray at the centre of each subpixel in which one of the rows crosses one of the columns, row by row. The
    /// first pixel is `corner`, and pixels have `samples` by `samples` subpixels.
    ///
    /// # Panics
    /// Where there are more than [`RayPacket::LANES`].
    pub fn aim(
        &mut self,
        projection: &Projection,
        corner: (u32, u32),
        samples: u32,
        rows: &[Line],
        columns: &[Line],
    ) {
        let (mut across, mut down) = ([0.0; LANES], [0.0; LANES]);
        self.count = 0;
        for row in rows {
            for column in columns {
                let (x, y) = (corner.0 + column.pixel, corner.1 + row.pixel);
                across[self.count] = f64::from(x) + column.center;
                down[self.count] = f64::from(y) + row.center;
                self.keys[self.count] = Key::camera(x, y, row.subpixel * samples + column.subpixel);
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

    /// The rays, in the order of their subpixels.
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
