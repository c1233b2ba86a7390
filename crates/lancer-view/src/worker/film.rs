//! What comes while an image is traced, told as often as a person can follow.

use lancer_core::film::Image;
use lancer_core::integrator::RayCounts;
use lancer_core::render::Tile;
use std::time::{Duration, Instant};

/// The time between two images of one that is under way: some 15 a second look alive, and each costs the window
/// as much as a finished one.
const INTERVAL: Duration = Duration::from_millis(66);

/// Tracing is held up while the film is copied: at most this part of the time.
const COPYING: u32 = 20;

/// Counts what is done, and says when to tell of it.
pub(super) struct Count {
    pixels: u64,
    done: u64,
    pub(super) rays: RayCounts,
    pub(super) start: Instant,
    next: Instant,
}

impl Count {
    pub(super) fn of(pixels: u64) -> Self {
        let start = Instant::now();
        Self { pixels, done: 0, rays: RayCounts::default(), start, next: start + INTERVAL }
    }

    /// The part that is done, 0 to 1.
    pub(super) fn part(&self) -> f32 {
        (self.done as f64 / self.pixels.max(1) as f64) as f32
    }

    /// Counts a tile. Returns whether it is time to tell.
    pub(super) fn add(&mut self, tile: &Tile, rays: &RayCounts) -> bool {
        self.done += tile.pixels.len() as u64;
        self.rays += *rays;
        let now = Instant::now();
        let due = now >= self.next;
        if due {
            self.next = now + INTERVAL;
        }
        due
    }
}

/// An image under way: what is traced over what was shown before.
pub(super) struct Film {
    image: Image,
    pub(super) count: Count,
}

impl Film {
    pub(super) fn over(image: Image) -> Self {
        let pixels = u64::from(image.width()) * u64::from(image.height());
        Self { image, count: Count::of(pixels) }
    }

    /// Puts a tile in. Returns a copy of the film when it is time to show it.
    pub(super) fn put(&mut self, tile: &Tile, rays: &RayCounts) -> Option<Image> {
        self.image.put(tile.x, tile.y, tile.width, &tile.pixels);
        self.count.add(tile, rays).then(|| {
            let start = Instant::now();
            let copy = self.image.clone();
            self.count.next += start.elapsed() * COPYING;
            copy
        })
    }
}
