//! Texture files to 8-bit sRGB images.
//!
//! In: a path that the resolver allowed. Out: an [`ImageTexture`]. Images of 16 bits are rounded to 8, grey
//! and palettes become RGB, and alpha is dropped: a texture is a colour. Pixels are counted from the header,
//! before any is decoded.

use super::guard;
use crate::diagnostics::{Diagnostic, LoadError};
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

/// Reads a texture: PNG, JPEG, WebP, TIFF, BMP or TGA, told apart by content and, for TGA, by extension. A file is read
/// once for a resolver and its copies, whatever names it has.
///
/// # Errors
/// The file cannot be read, is of another format, is broken, or has more pixels than
/// [`Limits::texture_pixels`](crate::limits::Limits::texture_pixels) allows, alone or with the textures before it.
pub fn load_texture(path: &Path, resolver: &Resolver) -> Result<Arc<ImageTexture>, LoadError> {
    let file = resolver.identity(path);
    if let Some(known) = resolver.account().texture(&file) {
        return Ok(known);
    }
    let texture = texture_of_bytes(path, &resolver.read(path)?, resolver)?;
    resolver.account().keep(file, &texture);
    Ok(texture)
}

/// As [`load_texture`], from bytes that are part of another file; `path` is what messages call them.
pub(crate) fn texture_of_bytes(
    path: &Path,
    bytes: &[u8],
    resolver: &Resolver,
) -> Result<Arc<ImageTexture>, LoadError> {
    let format = format_of(path, bytes)?;
    let broken = |message: String| LoadError::new(path, message);
    let decoded = guard::decoded(|| decode(path, format, bytes, resolver));
    let Decoded { width, height, texels } = decoded.map_err(broken)??;
    resolver.account().hold(size_of_val(&texels[..]) as u64);
    let texture =
        ImageTexture::new(width, height, texels).map_err(|error| LoadError::new(path, error.to_string()))?;
    Ok(Arc::new(texture))
}

/// An image as textures hold it.
struct Decoded {
    width: u32,
    height: u32,
    texels: Vec<[u8; 3]>,
}

fn decode(path: &Path, format: ImageFormat, bytes: &[u8], resolver: &Resolver) -> Result<Decoded, LoadError> {
    /// What the user can do about a texture that is too large.
    const HINT: &str = "--limit texture-pixels=N allows more";
    let most_pixels = resolver.limits.texture_pixels;
    let broken = |error: ImageError| LoadError::new(path, message_of(&error));
    if format == ImageFormat::Tiff {
        guard::check_tiff(bytes).map_err(|message| LoadError::new(path, message))?;
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(decoder_limits(format, bytes, most_pixels));

    let decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > most_pixels {
        let message = format!("{width} x {height} pixels are more than {most_pixels}, the most of a texture");
        return Err(Diagnostic::new(path, message).with_hint(HINT).into());
    }
    if matches!(decoder.color_type(), ColorType::Rgb32F | ColorType::Rgba32F) {
        return Err(Diagnostic::new(path, "holds floats, which are no colours of a surface")
            .with_hint("save it with 8 or 16 bits a channel")
            .into());
    }
    let needed = decoder.total_bytes().saturating_mul(guard::times_held(format, bytes));
    if let Some(excess) = resolver.account().excess(needed, most_pixels) {
        let message = format!("{width} x {height} pixels: {excess}");
        return Err(Diagnostic::new(path, message).with_hint(HINT).into());
    }
    let texels = texels_of(decoder).map_err(broken)?;
    Ok(Decoded { width, height, texels })
}

/// The pixels, of which large images should not be there twice.
fn texels_of(decoder: impl ImageDecoder) -> Result<Vec<[u8; 3]>, ImageError> {
    if decoder.color_type() == ColorType::Rgb8 {
        let (width, height) = decoder.dimensions();
        let mut texels = vec![[0; 3]; width as usize * height as usize];
        decoder.read_image(texels.as_flattened_mut())?;
        return Ok(texels);
    }
    Ok(match DynamicImage::from_decoder(decoder)? {
        DynamicImage::ImageRgba8(image) => {
            image.pixels().map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
        }
        DynamicImage::ImageLuma8(image) => image.pixels().map(|pixel| [pixel[0]; 3]).collect(),
        other => other.into_rgb8().pixels().map(|pixel| pixel.0).collect(),
    })
}

/// What a decoder may hold for an image.
///
/// That of a PNG unpacks the colour profile before it tells how large the image is, so its limit goes by the header:
/// a small image has no right to a profile of hundreds of megabytes.
pub(super) fn decoder_limits(format: ImageFormat, bytes: &[u8], most_pixels: u64) -> DecoderLimits {
    let own = pixels_of_png(bytes).filter(|_| format == ImageFormat::Png);
    let pixels = own.map_or(most_pixels, |own| own.min(most_pixels));
    let mut limits = DecoderLimits::default();
    limits.max_alloc = Some(pixels.saturating_mul(BYTES_PER_PIXEL).saturating_add(DECODER_OVERHEAD));
    limits
}

/// The pixels that the header of a PNG tells of.
fn pixels_of_png(bytes: &[u8]) -> Option<u64> {
    let side = |at: usize| Some(u64::from(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?)));
    // Behind the signature, and the length and name of the first chunk.
    Some(side(16)? * side(20)?)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_decoder_of_a_small_png_may_hold_little() {
        let header = |side: u32| [&[0; 16][..], &side.to_be_bytes(), &side.to_be_bytes()].concat();
        let limit = |format, bytes: &[u8]| decoder_limits(format, bytes, 1 << 26).max_alloc.unwrap();
        assert_eq!(limit(ImageFormat::Png, &header(10)), 800 + DECODER_OVERHEAD);
        let most = (8 << 26) + DECODER_OVERHEAD;
        assert_eq!(limit(ImageFormat::Png, &header(u32::MAX)), most);
        assert_eq!(limit(ImageFormat::Png, &header(10)[..20]), most);
        assert_eq!(limit(ImageFormat::Jpeg, &header(10)), most);
    }
}
