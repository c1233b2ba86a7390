//! Embree, the ray tracing library that Lancer is measured against; it knows nothing of Lancer's worlds.

pub(crate) mod device;
pub(crate) mod ffi;
pub(crate) mod occlusion;
pub(crate) mod renderer;
