//! Bytes to scenes, and images to bytes.
//!
//! It knows neither traversal nor threads.

pub mod diagnostics;
pub mod image;
pub mod limits;
pub mod model;
pub mod output;
pub mod resolver;
pub mod showcase;
