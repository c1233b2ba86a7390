//! Texture files to 8-bit sRGB images.
//!
//! In: a path that the resolver allowed. Out: an [`ImageTexture`]. Images of 16 bits are rounded to 8, grey
//! and palettes become RGB, and alpha is dropped: a texture is a colour. Pixels are counted from the header,
//! before any is decoded.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::resolver::Resolver;
use ::image::{
    ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits as DecoderLimits,
};
use lancer_core::scene::ImageTexture;
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// The formats that are read, as users know them.
const FORMATS: &str = "PNG, JPEG, WebP, TIFF, BMP, TGA";

/// Bytes that a decoder may hold for each pixel of the largest texture: four channels of 16 bits.
const BYTES_PER_PIXEL: u64 = 8;

/// What a decoder may hold beyond the pixels: tables, text chunks and colour profiles.
const DECODER_OVERHEAD: u64 = 16 << 20;

/// Reads a texture: PNG, JPEG, WebP, TIFF, BMP or TGA, told apart by content and, for TGA, by extension.
///
/// # Errors
/// The file cannot be read, is of another format, is broken, or has more pixels than
/// [`Limits::texture_pixels`](crate::limits::Limits::texture_pixels).
pub fn load_texture(path: &Path, resolver: &Resolver) -> Result<Arc<ImageTexture>, LoadError> {
    texture_of_bytes(path, &resolver.read(path)?, &resolver.limits)
}

/// As [`load_texture`], from bytes that are part of another file; `path` is what messages call them.
pub(crate) fn texture_of_bytes(
    path: &Path,
    bytes: &[u8],
    limits: &Limits,
) -> Result<Arc<ImageTexture>, LoadError> {
    let image = decode(path, bytes, limits.texture_pixels)?;
    let rgb = image.into_rgb8();
    let (width, height) = rgb.dimensions();
    let texels = rgb.pixels().map(|pixel| pixel.0).collect();
    let texture =
        ImageTexture::new(width, height, texels).map_err(|error| LoadError::new(path, error.to_string()))?;
    Ok(Arc::new(texture))
}

fn decode(path: &Path, bytes: &[u8], most_pixels: u64) -> Result<DynamicImage, LoadError> {
    let format = format_of(path, bytes)?;
    let broken = |error: ImageError| LoadError::new(path, message_of(&error));
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(decoder_limits(most_pixels));

    let decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > most_pixels {
        let message = format!("{width} x {height} pixels are more than {most_pixels}, the most of a texture");
        return Err(LoadError::new(path, message));
    }
    if matches!(decoder.color_type(), ColorType::Rgb32F | ColorType::Rgba32F) {
        return Err(Diagnostic::new(path, "holds floats, which are no colours of a surface")
            .with_hint("save it with 8 or 16 bits a channel")
            .into());
    }
    DynamicImage::from_decoder(decoder).map_err(broken)
}

/// What a decoder may hold for an image of so many pixels.
pub(super) fn decoder_limits(most_pixels: u64) -> DecoderLimits {
    let mut limits = DecoderLimits::default();
    limits.max_alloc = Some(most_pixels.saturating_mul(BYTES_PER_PIXEL).saturating_add(DECODER_OVERHEAD));
    limits
}

fn format_of(path: &Path, bytes: &[u8]) -> Result<ImageFormat, LoadError> {
    let is_read = |format: &ImageFormat| {
        matches!(
            format,
            ImageFormat::Png
                | ImageFormat::Jpeg
                | ImageFormat::WebP
                | ImageFormat::Tiff
                | ImageFormat::Bmp
                | ImageFormat::Tga
        )
    };
    let format = ::image::guess_format(bytes).ok().or_else(|| {
        // TGA has no signature.
        let extension = path.extension()?.to_str()?;
        extension.eq_ignore_ascii_case("tga").then_some(ImageFormat::Tga)
    });
    format.filter(is_read).ok_or_else(|| {
        Diagnostic::new(path, "is not an image of a format that is read")
            .with_hint(format!("textures are read from {FORMATS}"))
            .into()
    })
}

/// A decoder's error on one line, without the names of its types.
pub(super) fn message_of(error: &ImageError) -> String {
    let words = error.to_string();
    format!("is a broken image: {}", words.split_whitespace().collect::<Vec<_>>().join(" "))
}
