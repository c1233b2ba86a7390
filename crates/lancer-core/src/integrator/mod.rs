//! Recursion over the illumination model: what a camera ray sees.
//!
//! In: a world, a ray and the key of its random numbers. Out: a radiance, and, to whoever listens, every term of
//! every ray on the way. It knows neither threads, tiles nor nodes.

mod ambient_occlusion;
mod bends;
mod camera_rays;
mod lighting;
mod listener;
#[cfg(test)]
mod tests;
mod whitted;

pub use ambient_occlusion::AmbientOcclusionSampler;
pub use camera_rays::{CameraRays, Line};
pub use listener::{Listener, RayId, RayKind, Silent, SpawnEvent};
pub use whitted::{Scratch, Whitted};

/// Rays traced, by kind, and what was cut short.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Camera rays.
    pub primary: u64,
    /// Segments to lights.
    pub shadow: u64,
    /// Directions of ambient occlusion; those below the horizon have no weight and are not traced.
    pub ao: u64,
    /// Mirror rays.
    pub reflection: u64,
    /// Refracted rays, and those reflected totally.
    pub refraction: u64,
    /// Camera rays whose tree of reflections was cut at [`Whitted::MAX_RAYS`].
    pub truncated: u64,
    /// Camera rays whose radiance no pixel can hold, which was replaced by black.
    pub replaced: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.ao + self.reflection + self.refraction
    }
}

impl std::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.ao += other.ao;
        self.reflection += other.reflection;
        self.refraction += other.refraction;
        self.truncated += other.truncated;
        self.replaced += other.replaced;
    }
}
