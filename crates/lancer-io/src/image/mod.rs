//! Images from and to files.
//!
//! [`load_texture`] reads what materials use; [`encode`] writes what was rendered, and [`read_picture`] reads it back.

pub mod animation;
pub mod cutout;
mod decode;
pub mod encode;
mod exif;
mod format;
mod guard;
pub mod layers;
mod metadata;
mod read;

pub use decode::load_texture;
pub(crate) use decode::texture_of_bytes;
pub use format::{Compression, Encoding, EncodingChoice, EncodingError, ImageFormat, UnknownImageFormat};
pub use metadata::{Metadata, Window};
pub use read::{Picture, decode_picture, provenance_of, read_picture};

/// The variable in the header of a Radiance HDR file that says how the picture was made.
const HDR_PROVENANCE: &str = "LANCER";
