//! TIFF: sRGB codes of 8 or 16 bits, or linear 32-bit floats, in strips.

use super::super::format::Compression;
use super::{Encoding, Metadata};
use ::tiff::encoder::colortype::{ColorType, RGB8, RGB16, RGB32Float};
use ::tiff::encoder::{
    Compression as TiffCompression, DeflateLevel, ImageEncoder, Predictor, Rational, TiffEncoder, TiffKind,
};
use ::tiff::tags::{ResolutionUnit, Tag};
use ::tiff::{TiffError, TiffResult};
use lancer_core::film::{Image, Tone};
use std::io::{self, Cursor, Seek, Write};

pub(super) fn write(
    encoding: Encoding,
    image: &Image,
    tone: Tone,
    metadata: &Metadata,
    mut out: impl Write,
) -> io::Result<()> {
    // The format's directory says where the strips are, so it needs a place that can be sought in.
    let mut bytes = Cursor::new(Vec::new());
    write_to(&mut bytes, encoding, image, tone, metadata).map_err(|error| match error {
        TiffError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(bytes.get_ref())
}

fn write_to(
    out: &mut (impl Write + Seek),
    encoding: Encoding,
    image: &Image,
    tone: Tone,
    metadata: &Metadata,
) -> TiffResult<()> {
    let is_packed = encoding.compression() == Some(Compression::Zip);
    let compression = match is_packed {
        true => TiffCompression::Deflate(DeflateLevel::Balanced),
        false => TiffCompression::Uncompressed,
    };
    // Differences of floats would lose their last bits.
    let predictor = match is_packed && encoding.bits() != 32 {
        true => Predictor::Horizontal,
        false => Predictor::None,
    };
    let mut encoder = TiffEncoder::new(out)?.with_compression(compression).with_predictor(predictor);
    let (width, height) = (image.width(), image.height());
    match encoding.bits() {
        8 => {
            let mut page = encoder.new_image::<RGB8>(width, height)?;
            describe(&mut page, metadata)?;
            page.write_data(tone.to_codes8(image).as_flattened())
        }
        16 => {
            let mut page = encoder.new_image::<RGB16>(width, height)?;
            describe(&mut page, metadata)?;
            page.write_data(tone.to_codes16(image).as_flattened())
        }
        _ => {
            let mut page = encoder.new_image::<RGB32Float>(width, height)?;
            describe(&mut page, metadata)?;
            page.write_data(tone.expose(image).pixels().as_flattened())
        }
    }
}

/// The tag of the title, which the encoder does not name.
const DOCUMENT_NAME: u16 = 0x010d;

fn describe<W: Write + Seek, C: ColorType, K: TiffKind>(
    page: &mut ImageEncoder<'_, W, C, K>,
    metadata: &Metadata,
) -> TiffResult<()> {
    if let Some(dpi) = metadata.dpi {
        page.resolution(ResolutionUnit::Inch, Rational { n: u32::from(dpi), d: 1 });
    }
    let directory = page.encoder();
    directory.write_tag(Tag::Software, metadata.software.as_str())?;
    // The format knows no other letters. A title in others still stands in the provenance.
    if !metadata.title.is_empty() && metadata.title.bytes().all(|byte| matches!(byte, 1..=127)) {
        directory.write_tag(Tag::Unknown(DOCUMENT_NAME), metadata.title.as_str())?;
    }
    if let Some(provenance) = &metadata.provenance {
        directory.write_tag(Tag::ImageDescription, provenance.as_str())?;
    }
    Ok(())
}
