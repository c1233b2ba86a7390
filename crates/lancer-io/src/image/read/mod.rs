//! Pictures from files, to be compared and verified.
//!
//! In: bytes of any format that [`encode`](super::encode) writes, or a BMP. Out: a [`Picture`], which has the values
//! of the file as they are in there. Pixels are counted from the header, before any is decoded.

mod exr;
mod pfm;

pub(super) use self::exr::check_sizes as exr_check_sizes;

use super::decode::{decoder_limits, message_of};
use super::{HDR_PROVENANCE, encode, exif, guard};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::resolver::Resolver;
use ::image::codecs::jpeg::JpegDecoder;
use ::image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};
use lancer_core::color::linear_to_srgb;
use lancer_core::film::Image;
use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;

/// The formats that are read, as users know them.
const FORMATS: &str = "PNG, JPEG, WebP, TIFF, Radiance HDR, PFM, OpenEXR, BMP";

/// A picture as a file has it. Alpha is dropped, and grey is red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The values of the file: radiance, or codes for a display from 0 to 1.
    pub values: Image,
    /// Whether the values are radiance: linear and unbounded.
    pub is_linear: bool,
    /// The code of 1; none where values are no codes.
    pub codes: Option<u16>,
}

impl Picture {
    /// The values as a display is sent them: sRGB from 0 to 1.
    pub fn to_display(&self) -> Cow<'_, Image> {
        let unit = |value: f32| f64::from(value.clamp(0.0, 1.0).max(0.0));
        match self.is_linear {
            true => {
                let shown = self.values.map(|pixel| pixel.map(|value| linear_to_srgb(unit(value)) as f32));
                Cow::Owned(shown)
            }
            false => Cow::Borrowed(&self.values),
        }
    }
}

/// Reads the picture of a file.
///
/// # Errors
/// The file cannot be read; see also [`decode_picture`].
pub fn read_picture(path: &Path, limits: Limits) -> Result<Picture, LoadError> {
    let bytes = Resolver::for_file(path, true, limits).read(path)?;
    decode_picture(path, &bytes, limits.texture_pixels)
}

/// Reads the picture in some bytes; `path` is what messages call them.
///
/// # Errors
/// They are of another format, are broken, or hold more than `most_pixels`.
pub fn decode_picture(path: &Path, bytes: &[u8], most_pixels: u64) -> Result<Picture, LoadError> {
    let broken = |message: String| LoadError::new(path, message);
    guard::decoded(|| decode(path, bytes, most_pixels)).map_err(broken)?
}

fn decode(path: &Path, bytes: &[u8], most_pixels: u64) -> Result<Picture, LoadError> {
    if bytes.starts_with(b"PF") || bytes.starts_with(b"Pf") {
        return pfm::read(bytes, most_pixels).map_err(|message| LoadError::new(path, message));
    }
    if is_exr(bytes) {
        return exr::read(bytes, most_pixels).map_err(|message| LoadError::new(path, message));
    }
    match ::image::guess_format(bytes) {
        Ok(
            format @ (ImageFormat::Png
            | ImageFormat::Jpeg
            | ImageFormat::WebP
            | ImageFormat::Tiff
            | ImageFormat::Hdr
            | ImageFormat::Bmp),
        ) => read(format, bytes, most_pixels).map_err(|message| LoadError::new(path, message)),
        _ => Err(Diagnostic::new(path, "is not an image of a format that is read")
            .with_hint(format!("pictures are read from {FORMATS}"))
            .into()),
    }
}

/// What is said of a header that asks for too much.
fn check_size(width: u64, height: u64, most_pixels: u64) -> Result<(), String> {
    match width.checked_mul(height) {
        Some(pixels) if pixels <= most_pixels => Ok(()),
        _ => Err(format!("{width} x {height} pixels are more than {most_pixels}, the most of a picture")),
    }
}

fn read(format: ImageFormat, bytes: &[u8], most_pixels: u64) -> Result<Picture, String> {
    let broken = |error: ImageError| message_of(&error);
    if format == ImageFormat::Hdr && !hdr_header(bytes).windows(2).any(|pair| pair == b"\n\n") {
        return Err(format!("is a broken image: its header does not end within {MOST_HEADER} bytes"));
    }
    if format == ImageFormat::Tiff {
        guard::check_tiff(bytes)?;
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(decoder_limits(format, bytes, most_pixels));
    let decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    check_size(u64::from(width), u64::from(height), most_pixels)?;
    Ok(values_of(DynamicImage::from_decoder(decoder).map_err(broken)?))
}

/// What a file says of how its picture was made: the text of a [`Provenance`](crate::provenance::Provenance). `None`
/// where it says nothing, or is no picture. No pixel is decoded.
pub fn provenance_of(bytes: &[u8]) -> Option<String> {
    guard::decoded(|| provenance_in(bytes)).ok()?
}

fn provenance_in(bytes: &[u8]) -> Option<String> {
    if is_exr(bytes) {
        return exr::provenance_of(bytes);
    }
    match ::image::guess_format(bytes).ok()? {
        ImageFormat::Png => of_png(bytes),
        ImageFormat::Jpeg => of_exif(&JpegDecoder::new(Cursor::new(bytes)).ok()?.exif_metadata().ok()??),
        ImageFormat::WebP => of_webp(bytes),
        // Exif has the form of a TIFF.
        ImageFormat::Tiff => of_exif(bytes),
        ImageFormat::Hdr => of_hdr(bytes),
        _ => None,
    }
}

fn is_exr(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
}

fn of_exif(exif: &[u8]) -> Option<String> {
    exif::read_text(exif, exif::IMAGE_DESCRIPTION)
}

fn of_webp(bytes: &[u8]) -> Option<String> {
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(bytes)).ok()?;
    // It believes a chunk's own word for its length, of up to 4 GB.
    decoder.set_memory_limit(bytes.len());
    of_exif(&decoder.exif_metadata().ok()??)
}

fn values_of(decoded: DynamicImage) -> Picture {
    let (width, height) = (decoded.width(), decoded.height());
    let of = |pixels: Vec<[f32; 3]>, codes: Option<u16>| {
        let mut values = Image::black(width, height);
        if !pixels.is_empty() {
            values.put(0, 0, width, &pixels);
        }
        Picture { values, is_linear: codes.is_none(), codes }
    };
    match decoded {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            of(decoded.into_rgb32f().pixels().map(|pixel| pixel.0).collect(), None)
        }
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let code = |code: u16| f32::from(code) / 65535.0;
            of(decoded.into_rgb16().pixels().map(|pixel| pixel.0.map(code)).collect(), Some(u16::MAX))
        }
        _ => {
            let code = |code: u8| f32::from(code) / 255.0;
            of(decoded.into_rgb8().pixels().map(|pixel| pixel.0.map(code)).collect(), Some(255))
        }
    }
}

/// The text chunk before the pixels of a PNG. Compressed ones are not looked into.
fn of_png(bytes: &[u8]) -> Option<String> {
    let reader = ::png::Decoder::new_with_limits(Cursor::new(bytes), ::png::Limits { bytes: MOST_TEXT });
    let reader = reader.read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    let found = texts.iter().find(|chunk| chunk.keyword == encode::PNG_PROVENANCE)?;
    Some(found.text.clone())
}

/// The most bytes of text that are looked through for what a picture says of itself.
const MOST_TEXT: usize = 16 << 20;

/// The longest header of a Radiance HDR: its decoder keeps every line.
const MOST_HEADER: usize = 1 << 20;

/// As much of a Radiance HDR as can be its header.
fn hdr_header(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.len().min(MOST_HEADER)]
}

/// The line of the header of a Radiance HDR.
fn of_hdr(bytes: &[u8]) -> Option<String> {
    let lines = hdr_header(bytes).split(|&byte| byte == b'\n').take_while(|line| !line.is_empty());
    let mut found = lines.filter_map(|line| line.strip_prefix(HDR_PROVENANCE.as_bytes())?.strip_prefix(b"="));
    String::from_utf8(found.next()?.to_vec()).ok()
}
