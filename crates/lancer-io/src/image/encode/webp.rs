//! WebP: sRGB codes of 8 bits, without losses.

use super::{Metadata, exif, to_io_error};
use ::image::codecs::webp::WebPEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use lancer_core::film::{Image, Tone};
use std::io::{self, Write};

pub(super) fn write(image: &Image, tone: Tone, metadata: &Metadata, mut out: impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    let mut encoder = WebPEncoder::new_lossless(&mut bytes);
    encoder.set_exif_metadata(exif::write(metadata)).map_err(io::Error::other)?;
    let codes = tone.to_codes8(image);
    encoder
        .write_image(codes.as_flattened(), image.width(), image.height(), ExtendedColorType::Rgb8)
        .map_err(to_io_error)?;
    out.write_all(&bytes)
}
