//! Layers beside a picture: one OpenEXR file with all of them, or one file each.
//!
//! In: a picture and its [`Layer`]s. Out: bytes, the same for the same layers. The picture is in the channels `R`,
//! `G` and `B`, which every reader shows; a layer is in channels that begin with its name and a dot, all in one
//! part. Floats keep their 32 bits, so that sums stay exact; ids and counts are unsigned integers.
//!
//! Source of the names: OpenEXR's "Technical introduction", on channel names and layers; `P`, `N`, `Ng` and `uv` are
//! those that renderers and compositors agree on.

use super::encode::{exr_attributes, exr_layout, exr_placed};
use super::read::exr_check_sizes;
use super::{Encoding, Metadata};
use ::exr::prelude::{
    AnyChannel, AnyChannels, FlatSamples, Layer as ExrLayer, ReadChannels, ReadLayers, Text, Vec2,
    WritableImage,
};
use lancer_core::film::Image;
use lancer_core::render::passes::{Layer, Pass, Samples};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Cursor, Write};

/// Writes a picture and its layers as one OpenEXR file. `lights` are the names of the lights, by
/// [`light_names`](lancer_core::render::passes::light_names). Of `encoding` only the compression counts.
///
/// # Errors
/// The picture has no pixel, or a layer not as many; or `out` fails.
pub fn write_layers(
    image: &Image,
    layers: &[Layer],
    lights: &[String],
    encoding: Encoding,
    metadata: &Metadata,
    out: impl Write,
) -> io::Result<()> {
    let mut channels = channels_of("", &Samples::Color(image.pixels().to_vec()));
    for Layer { pass, samples } in layers {
        channels.extend(channels_of(&prefix(*pass, lights), samples));
    }
    write_channels(image, channels, encoding, metadata, out)
}

/// Writes one layer of a picture as an OpenEXR file of its own, in channels without its name.
///
/// # Errors
/// As [`write_layers`].
pub fn write_layer(
    image: &Image,
    layer: &Layer,
    encoding: Encoding,
    metadata: &Metadata,
    out: impl Write,
) -> io::Result<()> {
    write_channels(image, channels_of("", &layer.samples), encoding, metadata, out)
}

/// The channels of a pass in the file that has all of them, in the order of their places.
pub fn channel_names(pass: Pass, lights: &[String]) -> Vec<String> {
    let prefix = prefix(pass, lights);
    names(&Samples::empty(pass)).iter().map(|name| joined(&prefix, name)).collect()
}

/// The channels in which two OpenEXR files differ, by name; those that only one of them has, too.
///
/// # Errors
/// One of them is no such file, or of more than `most_pixels`.
pub fn differing_channels(a: &[u8], b: &[u8], most_pixels: u64) -> Result<Vec<String>, String> {
    let (a, b) = (read_channels(a, most_pixels)?, read_channels(b, most_pixels)?);
    let names = a.keys().chain(b.keys()).collect::<BTreeSet<_>>();
    Ok(names.into_iter().filter(|&name| a.get(name) != b.get(name)).cloned().collect())
}

/// The channels of a file's first layer, as bits, by name.
fn read_channels(bytes: &[u8], most_pixels: u64) -> Result<BTreeMap<String, Vec<u32>>, String> {
    exr_check_sizes(bytes, most_pixels)?;
    let layer = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| format!("is a broken OpenEXR: {error}"))?
        .layer_data;
    let bits = |samples: &FlatSamples| match samples {
        FlatSamples::F16(values) => values.iter().map(|value| u32::from(value.to_bits())).collect(),
        FlatSamples::F32(values) => values.iter().map(|value| value.to_bits()).collect(),
        FlatSamples::U32(values) => values.clone(),
    };
    let channels = layer.channel_data.list.iter();
    Ok(channels.map(|channel| (channel.name.to_string(), bits(&channel.sample_data))).collect())
}

/// What stands before the dot in the names of a pass's channels; nothing for those of the picture itself.
fn prefix(pass: Pass, lights: &[String]) -> String {
    match pass {
        // The one depth that every reader knows has no layer's name.
        Pass::Depth => String::new(),
        Pass::Position => "P".into(),
        Pass::Normal => "N".into(),
        Pass::GeometricNormal => "Ng".into(),
        pass => pass.name(lights),
    }
}

fn joined(prefix: &str, name: &str) -> String {
    if prefix.is_empty() { name.to_owned() } else { format!("{prefix}.{name}") }
}

/// What stands after the dot.
fn names(samples: &Samples) -> &'static [&'static str] {
    match samples {
        Samples::Color(_) => &["R", "G", "B"],
        Samples::Vector(_) => &["X", "Y", "Z"],
        Samples::Coordinates(_) => &["U", "V"],
        Samples::Length(_) => &["Z"],
        Samples::Factor(_) => &["Y"],
        Samples::Id(_) => &["X"],
        Samples::Counts(_) => &["rays", "nodes", "triangles"],
    }
}

fn channels_of(prefix: &str, samples: &Samples) -> Vec<AnyChannel<FlatSamples>> {
    let planes = match samples {
        Samples::Color(values) | Samples::Vector(values) => planes(values, FlatSamples::F32),
        Samples::Coordinates(values) => planes(values, FlatSamples::F32),
        Samples::Length(values) | Samples::Factor(values) => vec![FlatSamples::F32(values.clone())],
        Samples::Id(values) => vec![FlatSamples::U32(values.clone())],
        Samples::Counts(values) => planes(values, FlatSamples::U32),
    };
    let named = names(samples).iter().zip(planes);
    // Ids and lengths are no brightness, which readers may store or show by its logarithm.
    let is_light = matches!(samples, Samples::Color(_));
    named
        .map(|(name, plane)| AnyChannel {
            quantize_linearly: !is_light,
            ..AnyChannel::new(Text::new_or_panic(joined(prefix, name)), plane)
        })
        .collect()
}

/// One plane for each component.
fn planes<T: Copy, const N: usize>(
    values: &[[T; N]],
    samples: impl Fn(Vec<T>) -> FlatSamples,
) -> Vec<FlatSamples> {
    (0..N).map(|place| samples(values.iter().map(|value| value[place]).collect())).collect()
}

fn write_channels(
    image: &Image,
    channels: Vec<AnyChannel<FlatSamples>>,
    encoding: Encoding,
    metadata: &Metadata,
    mut out: impl Write,
) -> io::Result<()> {
    let size = Vec2(image.width() as usize, image.height() as usize);
    if size.area() == 0 || channels.iter().any(|channel| channel.sample_data.len() != size.area()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a layer of another size than the picture"));
    }
    let layer = ExrLayer::new(
        size,
        exr_attributes(metadata),
        exr_layout(encoding.compression()),
        AnyChannels::sort(channels.into()),
    );
    // The format's table of offsets is written last, so it needs a place that can be sought in.
    let mut bytes = Cursor::new(Vec::new());
    exr_placed(layer, metadata).write().non_parallel().to_buffered(&mut bytes).map_err(to_io_error)?;
    out.write_all(bytes.get_ref())
}

fn to_io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
