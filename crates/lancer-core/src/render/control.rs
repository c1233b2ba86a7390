//! How a render is watched and stopped.

use crate::cancel::CancelToken;
use crate::integrator::RayCounts;

/// A finished part of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The column of its left pixels, counted in the image that is rendered.
    pub x: u32,
    /// The row of its top pixels.
    pub y: u32,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB. Shape: `[height * width][3]`, top row first.
    pub pixels: Vec<[f32; 3]>,
}

/// Who watches a render.
pub struct Control<'a> {
    /// Stops it; looked at before every ray.
    pub cancel: CancelToken,
    /// Called with each tile when it is done, from any thread, and with the rays that it took.
    pub on_tile: &'a (dyn Fn(&Tile, &RayCounts) + Sync),
    /// The side of a tile in pixels, at least 1. It changes nothing in the image.
    pub tile_size: u32,
}

impl Control<'_> {
    /// Small enough to share a small image between threads and to show progress, large enough that a thread's
    /// turn costs nothing beside it. Untuned.
    pub const DEFAULT_TILE_SIZE: u32 = 32;
}

impl Default for Control<'_> {
    fn default() -> Self {
        Self { cancel: CancelToken::default(), on_tile: &|_, _| {}, tile_size: Self::DEFAULT_TILE_SIZE }
    }
}
