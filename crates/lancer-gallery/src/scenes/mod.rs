//! One scene a file.

mod bezier;
pub(crate) mod mirror_room;
mod sky;
pub(crate) mod sphereflake;
pub(crate) mod teapot;
pub(crate) mod ten_thousand;
pub(crate) mod whitted;
