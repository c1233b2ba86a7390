//! OpenEXR: R, G and B as linear floats of 32 or 16 bits, in scan lines.

use super::super::format::Compression;
use super::super::metadata::Window;
use super::{Encoding, Metadata};
use ::exr::error::Error;
use ::exr::prelude::{
    AttributeValue, Blocks, Compression as ExrCompression, Encoding as ExrEncoding, Image as ExrImage,
    ImageAttributes, IntegerBounds, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2,
    WritableImage, f16,
};
use lancer_core::film::Image;
use std::io::{self, Cursor, Write};

/// The attribute that says how the picture was made.
pub(in super::super) const PROVENANCE: &str = "lancer";

pub(super) fn write(
    encoding: Encoding,
    image: &Image,
    metadata: &Metadata,
    mut out: impl Write,
) -> io::Result<()> {
    let size = Vec2(image.width() as usize, image.height() as usize);
    let pixel = |Vec2(x, y): Vec2<usize>| image.pixel(x as u32, y as u32);
    // The format's table of offsets is written last, so it needs a place that can be sought in.
    let mut bytes = Cursor::new(Vec::new());
    let (attributes, layout) = (attributes(metadata), layout(encoding.compression()));
    let written = if encoding.bits() == 16 {
        let channels = SpecificChannels::rgb(|at| <(f16, f16, f16)>::from(pixel(at).map(half)));
        let image = placed(Layer::new(size, attributes, layout, channels), metadata);
        image.write().non_parallel().to_buffered(&mut bytes)
    } else {
        let channels = SpecificChannels::rgb(|at| <(f32, f32, f32)>::from(pixel(at)));
        let image = placed(Layer::new(size, attributes, layout, channels), metadata);
        image.write().non_parallel().to_buffered(&mut bytes)
    };
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(bytes.get_ref())
}

/// The nearest half; beyond the largest one, that: infinite pixels spoil whatever filters them.
fn half(value: f32) -> f16 {
    f16::from_f32(value.clamp(-f16::MAX.to_f32(), f16::MAX.to_f32()))
}

/// The metadata as attributes of a layer.
pub(in super::super) fn attributes(metadata: &Metadata) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        software_name: Text::new_or_none(&metadata.software),
        comments: Some(metadata.title.as_str()).filter(|title| !title.is_empty()).and_then(Text::new_or_none),
        horizontal_density: metadata.dpi.map(f32::from),
        layer_position: metadata.window.map_or(Vec2(0, 0), |window| Vec2(window.x as i32, window.y as i32)),
        ..LayerAttributes::default()
    };
    // One at most: more would be written in an order that differs from run to run.
    let provenance = metadata.provenance.as_deref().and_then(Text::new_or_none);
    attributes
        .other
        .extend(provenance.map(|provenance| (Text::from(PROVENANCE), AttributeValue::Text(provenance))));
    attributes
}

/// A layer as a file. The data window is the layer's; the display window is that of the picture of which it is a part.
pub(in super::super) fn placed<C>(layer: Layer<C>, metadata: &Metadata) -> ExrImage<Layer<C>> {
    let whole = match metadata.window {
        Some(Window { width, height, .. }) => {
            IntegerBounds::from_dimensions((width as usize, height as usize))
        }
        None => IntegerBounds::new(layer.attributes.layer_position, layer.size),
    };
    ExrImage { attributes: ImageAttributes::new(whole), layer_data: layer }
}

/// How pixels are packed.
pub(in super::super) fn layout(compression: Option<Compression>) -> ExrEncoding {
    ExrEncoding {
        compression: match compression {
            Some(Compression::Piz) => ExrCompression::PIZ,
            Some(Compression::None) => ExrCompression::Uncompressed,
            _ => ExrCompression::ZIP16,
        },
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    }
}
