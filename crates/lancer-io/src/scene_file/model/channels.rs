//! One number a channel: coefficients, intensities and colours.

use super::number::{NotNegative, Number, Range};
use crate::scene_file::deserialize::{Forms, OneOf, deserialize_by_forms};
use lancer_core::Rgb;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected};
use std::borrow::Cow;
use std::marker::PhantomData;

/// One number for all channels, or one for each.
pub(crate) struct Channels<R> {
    rgb: Rgb,
    range: PhantomData<R>,
}

impl<R: Range> Channels<R> {
    /// The value that an author left out.
    pub(crate) fn default_of(rgb: Rgb) -> Self {
        Self { rgb, range: PhantomData }
    }

    pub(crate) fn get(&self) -> Rgb {
        self.rgb
    }
}

impl<R: Range> Forms for Channels<R> {
    const FORMS: &'static str = "a number or a list of three";

    fn from_number<E: Error>(number: f64) -> Result<Self, E> {
        Number::<R>::checked(number).map(|number| Self::default_of(Rgb::grey(number.get())))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let channels = <[Number<R>; 3]>::deserialize(SeqAccessDeserializer::new(list))?;
        Ok(Self::default_of(channels.map(|channel| channel.get()).into()))
    }
}

impl<'de, R: Range> Deserialize<'de> for Channels<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        OneOf::deserialize(deserializer)
    }
}

impl<R: Range> JsonSchema for Channels<R> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Channels".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [R::schema(), { "type": "array", "items": R::schema(), "minItems": 3, "maxItems": 3 }]
        })
    }
}

/// A colour: linear numbers, or sRGB in the notation of the web. Default black.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Color(pub(crate) Rgb);

impl Forms for Color {
    const FORMS: &'static str = r##"a number, a list of three, or text such as "#87ceeb", in quotes"##;

    fn from_number<E: Error>(number: f64) -> Result<Self, E> {
        Channels::<NotNegative>::from_number(number).map(|channels| Self(channels.get()))
    }

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        rgb_from_hex(text)
            .map(Self)
            .ok_or_else(|| E::invalid_value(Unexpected::Str(text), &r##"like "#87ceeb" or "#fff""##))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        Channels::<NotNegative>::from_list(list).map(|channels| Self(channels.get()))
    }
}

fn rgb_from_hex(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#')?;
    if !digits.chars().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    match digits.len() {
        6 => Some(Rgb::from_srgb_hex(number)),
        // Each digit stands for itself twice.
        3 => Some(Rgb::from_srgb_hex(((number & 0xf00) << 8 | (number & 0xf0) << 4 | number & 0xf) * 0x11)),
        _ => None,
    }
}

deserialize_by_forms!(Color);

impl JsonSchema for Color {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A colour: one linear number for grey, three for red, green and blue, or \"#rrggbb\" in sRGB.",
            "anyOf": [
                Channels::<NotNegative>::json_schema(generator),
                { "type": "string", "pattern": "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$" }
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colors_are_srgb() {
        assert_eq!(rgb_from_hex("#87ceeb"), Some(Rgb::from_srgb_hex(0x87ceeb)));
        assert_eq!(rgb_from_hex("#8cE"), Some(Rgb::from_srgb_hex(0x88ccee)));
        for wrong in ["", "#", "87ceeb", "#87ce", "#87ceebff", "#+7ceeb", "#ggg", "red"] {
            assert_eq!(rgb_from_hex(wrong), None, "{wrong}");
        }
    }
}
