//! Where to sample: pixels, and the directions around a point.
//!
//! Every number is drawn from a stream that is keyed by pixel, subpixel and ray, so a picture does not depend on
//! threads, tiles or the order of work. This room knows nothing of scenes, materials or lights.

mod hemisphere;
mod key;

pub use hemisphere::HemisphereLattice;
pub use key::{Branch, Key, Stream};

/// Where the centre of the `i`-th of `n` subpixels lies along a pixel's side, from 0 to 1.
pub fn subpixel_center(i: u32, n: u32) -> f64 {
    (f64::from(i) + 0.5) / f64::from(n)
}
