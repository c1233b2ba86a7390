//! JPEG: sRGB codes of 8 bits, baseline, with colour at full resolution (4:4:4).
//!
//! The encoder's cosine transform is one of whole numbers, so that its bytes do not depend on the processor.

use super::{Encoding, Metadata, exif, invalid, to_io_error};
use ::image::codecs::jpeg::{JpegEncoder, PixelDensity};
use ::image::{ExtendedColorType, ImageEncoder};
use lancer_core::film::{Image, Tone};
use std::io::{self, Write};

/// The most bytes of metadata: a segment's length, and that of the head of an Exif segment, fit in 16 bits.
const MOST_METADATA: usize = 65_535 - 2 - 6;

pub(super) fn write(
    encoding: Encoding,
    image: &Image,
    tone: Tone,
    metadata: &Metadata,
    mut out: impl Write,
) -> io::Result<()> {
    let described = exif::write(metadata);
    if described.len() > MOST_METADATA {
        return Err(invalid("the settings are longer than the metadata of a JPEG can hold"));
    }
    let mut bytes = Vec::new();
    let quality = encoding.quality().unwrap_or(Encoding::USUAL_QUALITY);
    let mut encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
    if let Some(dpi) = metadata.dpi {
        encoder.set_pixel_density(PixelDensity::dpi(dpi));
    }
    encoder.set_exif_metadata(described).map_err(io::Error::other)?;
    let codes = tone.to_codes8(image);
    encoder
        .write_image(codes.as_flattened(), image.width(), image.height(), ExtendedColorType::Rgb8)
        .map_err(to_io_error)?;
    out.write_all(&bytes)
}
