//! The tile driver: from a world and a camera to an image, on all threads.
//!
//! It knows no kind of material and no window. Tiles are traced in any order on any number of threads; every
//! pixel is a function of the world, the camera and the settings alone.

mod control;
mod cover;
mod driver;
mod features;
pub mod passes;
#[cfg(test)]
mod tests;

pub use crate::cancel::CancelToken;
pub use control::{Control, Tile};
pub use driver::{Region, Render, RenderError, render, render_occlusion};
pub use features::{Feature, Features, feature_at, render_features};

/// Runs `work`, and all that it does in parallel, on a number of threads of its own; 0 for one a core.
///
/// # Errors
/// The system gives no more threads.
pub fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> std::io::Result<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(std::io::Error::other)?;
    Ok(pool.install(work))
}
