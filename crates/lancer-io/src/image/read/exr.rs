//! OpenEXR files: the first layer that has R, G and B.

use super::{Picture, check_size, encode};
use ::exr::error::Error;
use ::exr::meta::MetaData;
use ::exr::prelude::{AttributeValue, ReadChannels, ReadLayers, Text};
use lancer_core::film::Image;
use std::io::Cursor;

pub(super) fn read(bytes: &[u8], most_pixels: u64) -> Result<Picture, String> {
    check_sizes(bytes, most_pixels)?;
    let read = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Image::black(size.x() as u32, size.y() as u32),
            |image: &mut Image, at, (r, g, b): (f32, f32, f32)| {
                image.put(at.x() as u32, at.y() as u32, 1, &[[r, g, b]]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| message_of(&error))?;
    let values = read.layer_data.channel_data.pixels;
    Ok(Picture { values, is_linear: true, codes: None })
}

/// Refuses a file with a layer of more pixels, by its headers.
pub(in super::super) fn check_sizes(bytes: &[u8], most_pixels: u64) -> Result<(), String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| message_of(&error))?;
    let mut sizes = meta.headers.iter().map(|header| header.layer_size);
    sizes.try_for_each(|size| check_size(size.x() as u64, size.y() as u64, most_pixels))
}

/// What the attributes of a layer say.
pub(super) fn provenance_of(bytes: &[u8]) -> Option<String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).ok()?;
    let name = Text::from(encode::EXR_PROVENANCE);
    meta.headers.iter().find_map(|header| match header.own_attributes.other.get(&name)? {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    })
}

fn message_of(error: &Error) -> String {
    match error {
        Error::NotSupported(what) => format!("is an OpenEXR that is not supported: {what}"),
        other => format!("is a broken OpenEXR: {other}"),
    }
}
