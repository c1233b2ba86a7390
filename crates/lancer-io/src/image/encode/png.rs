//! PNG: sRGB codes of 8 or 16 bits, marked as sRGB.

use super::super::metadata::Metadata;
use super::invalid;
use ::png::{BitDepth, ColorType, Compression, Encoder, Filter, PixelDimensions, SrgbRenderingIntent, Unit};
use lancer_core::film::{Image, Tone, ToneCurve};
use lancer_core::scene::ImageTexture;
use std::io::{self, Write};

/// The keyword of the text chunk that says how the picture was made.
pub(in super::super) const PROVENANCE: &str = "Lancer";

/// Writes a PNG: 8-bit RGB, sRGB-encoded and marked as such, clamped to [0, 1].
///
/// # Errors
/// The image has no pixel, or `out` fails.
pub fn write_png(image: &Image, metadata: &Metadata, out: impl Write) -> io::Result<()> {
    write(8, image, Tone::default(), metadata, out)
}

pub(super) fn write(
    bits: u8,
    image: &Image,
    tone: Tone,
    metadata: &Metadata,
    out: impl Write,
) -> io::Result<()> {
    if image.pixels().is_empty() {
        return Err(invalid("an image without pixels"));
    }
    let mut encoder = Encoder::new(out, image.width(), image.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(if bits == 16 { BitDepth::Sixteen } else { BitDepth::Eight });
    // Raw values are not sRGB, though whoever writes them so means them to be shown as if they were.
    if tone.curve != ToneCurve::Raw {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
    encoder.set_compression(Compression::Balanced);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_pixel_dims(metadata.pixels_per_metre().map(|pixels| PixelDimensions {
        xppu: pixels,
        yppu: pixels,
        unit: Unit::Meter,
    }));
    // First, so that the maker is found at the head of the file.
    encoder.add_text_chunk("Software".to_owned(), metadata.software.clone())?;
    if !metadata.title.is_empty() {
        // A scene may be named in any script.
        encoder.add_itxt_chunk("Title".to_owned(), metadata.title.clone())?;
    }
    if let Some(provenance) = &metadata.provenance {
        encoder.add_text_chunk(PROVENANCE.to_owned(), provenance.clone())?;
    }
    let mut writer = encoder.write_header()?;
    if bits == 16 {
        let codes = tone.to_codes16(image);
        let bytes = codes.as_flattened().iter().flat_map(|code| code.to_be_bytes()).collect::<Vec<_>>();
        writer.write_image_data(&bytes)?;
    } else {
        writer.write_image_data(tone.to_codes8(image).as_flattened())?;
    }
    writer.finish()?;
    Ok(())
}

/// Writes a texture as a PNG of its 8-bit sRGB texels, which [`load_texture`](crate::image::load_texture) reads back.
///
/// # Errors
/// `out` fails.
pub fn write_texture(texture: &ImageTexture, out: impl Write) -> io::Result<()> {
    let mut encoder = Encoder::new(out, texture.width(), texture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(texture.texels().as_flattened())?;
    writer.finish()?;
    Ok(())
}
