//! Rendered images to files: codes for displays, or radiance as linear floats.
//!
//! In: a linear [`Image`], an [`Encoding`], a [`Tone`] and [`Metadata`]. Out: bytes, the same for the same input on
//! every machine: compression is set to one strength and runs on one thread, nothing tells the time, and no
//! encoder computes with more than whole numbers and the four operations of IEEE 754.
//!
//! Formats for displays take the whole [`Tone`], formats of radiance its exposure alone.

mod exr;
mod hdr;
mod jpeg;
mod pfm;
mod png;
mod tiff;
mod webp;

pub(super) use self::exr::PROVENANCE as EXR_PROVENANCE;
pub(super) use self::exr::{attributes as exr_attributes, layout as exr_layout, placed as exr_placed};
pub(super) use self::png::PROVENANCE as PNG_PROVENANCE;
pub use self::png::{write_png, write_texture};

use super::exif;
use super::format::{Encoding, ImageFormat};
use super::metadata::Metadata;
use lancer_core::film::{Image, Tone};
use std::io::{self, Write};

/// Writes an image.
///
/// # Errors
/// The image has no pixel, or more than the format can hold; the metadata are not what they must be; or `out` fails.
pub fn write(
    encoding: impl Into<Encoding>,
    image: &Image,
    tone: Tone,
    metadata: &Metadata,
    out: impl Write,
) -> io::Result<()> {
    let encoding = encoding.into();
    if image.pixels().is_empty() {
        return Err(invalid("an image without pixels"));
    }
    encoding.check_size(image.width(), image.height()).map_err(invalid)?;
    if !metadata.provenance.iter().all(|text| text.bytes().all(|byte| matches!(byte, b' '..=b'~'))) {
        return Err(invalid("what is said of how the picture was made is not one line of ASCII"));
    }
    match encoding.format() {
        ImageFormat::Png => png::write(encoding.bits(), image, tone, metadata, out),
        ImageFormat::Jpeg => jpeg::write(encoding, image, tone, metadata, out),
        ImageFormat::WebP => webp::write(image, tone, metadata, out),
        ImageFormat::Tiff => tiff::write(encoding, image, tone, metadata, out),
        ImageFormat::Hdr => hdr::write(&tone.expose(image), metadata, out),
        ImageFormat::Pfm => pfm::write(&tone.expose(image), out),
        ImageFormat::Exr => exr::write(encoding, &tone.expose(image), metadata, out),
    }
}

fn invalid(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, error)
}

/// An encoder's error, which is most often that of the writer beneath it.
fn to_io_error(error: ::image::ImageError) -> io::Error {
    match error {
        ::image::ImageError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
