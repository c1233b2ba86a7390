//! Pictures of things without what is behind them.

use super::Metadata;
use lancer_core::film::{Image, to_srgb8};
use std::io::{self, Write};

/// A picture with a coverage.
#[derive(Clone, Debug, PartialEq)]
pub struct Cutout {
    /// What covers each pixel, times how much of the pixel it covers.
    pub image: Image,
    /// How much of each pixel is covered, in [0, 1]. Shape: `[height * width]`, top row first.
    pub coverage: Vec<f32>,
}

/// Writes a cutout as a PNG: 8-bit sRGB, not multiplied by its 8-bit alpha, as the format has it.
///
/// # Errors
/// The picture has no pixel, or another number of them than the coverage; or `out` fails.
pub fn write_cutout(cutout: &Cutout, metadata: &Metadata, out: impl Write) -> io::Result<()> {
    let Cutout { image, coverage } = cutout;
    if coverage.len() != image.pixels().len() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "a coverage of another size than its picture",
        ));
    }
    let mut whole = Image::black(image.width(), image.height());
    let colors = image.pixels().iter().zip(coverage).map(|(pixel, &covered)| {
        let scale = if covered > 0.0 { 1.0 / covered } else { 0.0 };
        pixel.map(|channel| channel * scale)
    });
    whole.put(0, 0, image.width().max(1), &colors.collect::<Vec<_>>());
    let alpha = coverage.iter().map(|covered| (covered.clamp(0.0, 1.0) * 255.0).round() as u8);
    let codes =
        to_srgb8(&whole).into_iter().zip(alpha).map(|([r, g, b], a)| [r, g, b, a]).collect::<Vec<_>>();

    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.add_text_chunk("Software".to_owned(), metadata.software.clone())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(codes.as_flattened())?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cutout_keeps_its_colors_where_it_is_thin() {
        let mut image = Image::black(3, 1);
        image.put(0, 0, 3, &[[1.0, 0.0, 0.0], [0.25, 0.0, 0.0], [0.0; 3]]);
        let mut bytes = Vec::new();
        let cutout = Cutout { image, coverage: vec![1.0, 0.25, 0.0] };
        write_cutout(&cutout, &Metadata::default(), &mut bytes).unwrap();
        let read = ::image::load_from_memory(&bytes).unwrap().into_rgba8();
        let pixels = read.pixels().map(|pixel| pixel.0).collect::<Vec<_>>();
        assert_eq!(pixels, [[255, 0, 0, 255], [255, 0, 0, 64], [0, 0, 0, 0]]);
    }

    #[test]
    fn a_coverage_of_another_size_is_refused() {
        let cutout = Cutout { image: Image::black(2, 2), coverage: vec![1.0; 3] };
        assert!(write_cutout(&cutout, &Metadata::default(), io::sink()).is_err());
    }
}
