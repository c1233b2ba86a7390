//! One scene a file.

mod bezier;
pub(crate) mod glass;
pub(crate) mod highlights;
pub(crate) mod mirror_room;
pub(crate) mod mirrors;
pub(crate) mod occlusion;
pub(crate) mod primitives;
pub(crate) mod shadows;
mod sky;
pub(crate) mod sphereflake;
pub(crate) mod supersampling;
pub(crate) mod teapot;
pub(crate) mod ten_thousand;
pub(crate) mod whitted;
