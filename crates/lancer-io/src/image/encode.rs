//! Rendered images to files: 8-bit sRGB in PNG, linear floats in EXR.
//!
//! In: a linear [`Image`]. Out: bytes, the same for the same image, whatever the machine: compression is set
//! to one strength and runs on one thread, and nothing tells the time.

use ::exr::prelude::{
    Blocks, Compression, Encoding, Image as ExrImage, Layer, LayerAttributes, LineOrder, SpecificChannels,
    Text, Vec2, WritableImage,
};
use lancer_core::film::{Image, to_srgb8};
use lancer_core::scene::ImageTexture;
use std::io::{self, Cursor, Write};
use std::path::Path;

/// The formats that images are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// PNG: 8 bits a channel, sRGB, clamped to [0, 1].
    Png,
    /// OpenEXR: 32-bit floats, linear, unclamped.
    Exr,
}

/// A file's name says no format that is written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("images are written as .png or .exr, not as `{name}`")]
pub struct UnknownImageFormat {
    /// The name.
    pub name: String,
}

impl ImageFormat {
    /// The format that a file's extension asks for, in any case.
    ///
    /// # Errors
    /// [`UnknownImageFormat`], which lists what is written.
    pub fn from_path(path: &Path) -> Result<Self, UnknownImageFormat> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(UnknownImageFormat { name: path.display().to_string() }),
        }
    }
}

/// What a file says about itself beside the pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Metadata {
    /// The program that made it.
    pub software: String,
}

impl Default for Metadata {
    fn default() -> Self {
        Self { software: concat!("Lancer ", env!("CARGO_PKG_VERSION")).to_owned() }
    }
}

/// Writes an image in a format.
///
/// # Errors
/// The image has no pixel, or `out` fails.
pub fn write(format: ImageFormat, image: &Image, metadata: &Metadata, out: impl Write) -> io::Result<()> {
    match format {
        ImageFormat::Png => write_png(image, metadata, out),
        ImageFormat::Exr => write_exr(image, metadata, out),
    }
}

/// Writes a PNG: 8-bit RGB, sRGB-encoded and marked as such, clamped to [0, 1].
///
/// # Errors
/// The image has no pixel, or `out` fails.
pub fn write_png(image: &Image, metadata: &Metadata, out: impl Write) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.add_text_chunk("Software".to_owned(), metadata.software.clone())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(to_srgb8(image).as_flattened())?;
    writer.finish()?;
    Ok(())
}

/// Writes a texture as a PNG of its 8-bit sRGB texels, which [`load_texture`](super::load_texture) reads back.
///
/// # Errors
/// `out` fails.
pub fn write_texture(texture: &ImageTexture, out: impl Write) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, texture.width(), texture.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(texture.texels().as_flattened())?;
    writer.finish()?;
    Ok(())
}

/// Writes an OpenEXR file: R, G and B as linear 32-bit floats, in scan lines compressed by ZIP.
///
/// # Errors
/// The image has no pixel, or `out` fails.
pub fn write_exr(image: &Image, metadata: &Metadata, mut out: impl Write) -> io::Result<()> {
    let size = Vec2(image.width() as usize, image.height() as usize);
    if size.area() == 0 {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "an image without pixels"));
    }
    let pixel = |Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = image.pixel(x as u32, y as u32);
        (r, g, b)
    };
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let attributes = LayerAttributes {
        software_name: Text::new_or_none(&metadata.software),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(size, attributes, encoding, SpecificChannels::rgb(pixel));
    // The format's table of offsets is written last, so it needs a place that can be sought in.
    let mut bytes = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).map_err(to_io_error)?;
    out.write_all(bytes.get_ref())
}

fn to_io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
