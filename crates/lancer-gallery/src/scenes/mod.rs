//! One scene a file.

mod bezier;
mod sky;
pub(crate) mod sphereflake;
pub(crate) mod teapot;
pub(crate) mod whitted;
