//! Images from and to files.
//!
//! [`load_texture`] reads what materials use; [`encode`] writes what was rendered.

pub mod animation;
pub mod cutout;
mod decode;
pub mod encode;
pub mod layers;

pub use decode::load_texture;
