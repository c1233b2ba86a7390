//! Bytes to scenes, and images to bytes.
//!
//! It knows neither traversal nor threads. [`load`] reads whatever a user names; the modules read and write one
//! kind of file each.

pub mod diagnostics;
pub mod image;
pub mod limits;
mod load;
pub mod model;
pub mod output;
pub mod progress;
pub mod resolver;
pub mod scene_file;
pub mod showcase;

pub use load::{LoadOptions, Loaded, SCENE_EXTENSIONS, is_scene_file, load};
