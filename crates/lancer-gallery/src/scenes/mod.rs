//! One scene a file.

pub(crate) mod sky;
pub(crate) mod whitted;
