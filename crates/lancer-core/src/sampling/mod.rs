//! Where to sample: pixels, and the directions around a point.
//!
//! Every number is drawn from a stream that is keyed by pixel, subpixel and ray, so a picture does not depend on
//! threads, tiles or the order of work. This room knows nothing of scenes, materials or lights.

mod hemisphere;
mod key;

pub use hemisphere::HemisphereLattice;
pub use key::{Branch, Key, Stream};

/// The offsets of the centres of n x n subpixels from a pixel's top left corner, row by row.
pub fn subpixel_centers(n: u32) -> impl Iterator<Item = (f64, f64)> {
    let center = move |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..n).flat_map(move |j| (0..n).map(move |i| (center(i), center(j))))
}
