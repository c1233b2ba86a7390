//! Materials and the colours of surfaces.

use super::channels::{Channels, Color};
use super::number::{Fraction, NotNegative, Number, Positive};
use crate::scene_file::deserialize::{Forms, Spanned, deserialize_by_forms};
use lancer_core::Rgb;
use lancer_core::scene::{Material, Wrap};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Unexpected};
use std::borrow::Cow;

/// How a surface reflects and refracts light. Coefficients are one number, or one for each of red, green and
/// blue.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "Material")]
pub(crate) struct MaterialFile {
    /// S: the colour of the surface; default white.
    pub(crate) color: SurfaceColor,
    /// k_a: how much of the ambient light is reflected; default 1.
    pub(crate) ambient: Channels<NotNegative>,
    /// k_d: how much of a light is reflected in all directions; default 1.
    pub(crate) diffuse: Channels<NotNegative>,
    /// k_s: how much of a light is reflected as a highlight; default 0.
    pub(crate) specular: Channels<NotNegative>,
    /// m: how far highlights take the surface's colour, from 0 for plastic to 1 for metal; default 0.
    pub(crate) metallic: Channels<Fraction>,
    /// n: the exponent of highlights; the larger, the smaller they are; default 32.
    pub(crate) shininess: Number<NotNegative>,
    /// k_r: how much of the mirror image is seen; default 0.
    pub(crate) reflect: Channels<NotNegative>,
    /// k_t: how much of what lies behind is seen, refracted; default 0.
    pub(crate) transmit: Channels<NotNegative>,
    /// The index of refraction; default 1.5.
    pub(crate) ior: Number<Positive>,
    /// Whether `reflect` and `transmit` are weighted by the Fresnel reflectance; default false.
    pub(crate) fresnel: bool,
}

impl Default for MaterialFile {
    fn default() -> Self {
        let material = Material::default();
        Self {
            color: SurfaceColor::Solid(Color(Rgb::WHITE)),
            ambient: Channels::default_of(material.ambient),
            diffuse: Channels::default_of(material.diffuse),
            specular: Channels::default_of(material.specular),
            metallic: Channels::default_of(material.metallic),
            shininess: Number::default_of(material.shininess),
            reflect: Channels::default_of(material.reflect),
            transmit: Channels::default_of(material.transmit),
            ior: Number::default_of(material.ior),
            fresnel: material.fresnel,
        }
    }
}

/// A colour that may vary over the surface.
pub(crate) enum SurfaceColor {
    Solid(Color),
    Pattern(Pattern),
}

/// A colour by texture coordinates.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Pattern {
    /// An image.
    Image(Spanned<ImageReference>),
    /// Squares of two colours.
    Checker(Checker),
}

/// An image by its path, which is repeated, or with what lies beyond it.
pub(crate) enum ImageReference {
    Path(String),
    Detailed(ImageFile),
}

/// An image with what lies beyond it.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Image")]
pub(crate) struct ImageFile {
    /// The path of the image.
    pub(crate) file: Spanned<String>,
    /// What lies beyond the image, or a list of what lies beyond it along u and along v; default repeat.
    #[serde(default)]
    pub(crate) wrap: WrapFile,
}

/// What lies beyond an image, along u and along v.
#[derive(Clone, Copy, Default)]
pub(crate) struct WrapFile(pub(crate) [Wrap; 2]);

/// What lies beyond an image along one axis.
struct AxisWrap(Wrap);

impl Forms for ImageReference {
    const FORMS: &'static str = "text that names an image's file, or {file: PATH, wrap: clamp}";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Ok(Self::Path(text.into()))
    }

    fn from_mapping<'de, D: Deserializer<'de>>(mapping: D) -> Result<Self, D::Error> {
        ImageFile::deserialize(mapping).map(Self::Detailed)
    }
}

impl Forms for WrapFile {
    const FORMS: &'static str = "repeat, clamp, mirror or a list of two of them";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        AxisWrap::from_text(text).map(|AxisWrap(wrap)| Self([wrap; 2]))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let axes = <[AxisWrap; 2]>::deserialize(SeqAccessDeserializer::new(list))?;
        Ok(Self(axes.map(|AxisWrap(wrap)| wrap)))
    }
}

impl Forms for AxisWrap {
    const FORMS: &'static str = "repeat, clamp or mirror";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Wrap::from_name(text).map(Self).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &Self::FORMS))
    }
}

deserialize_by_forms!(ImageReference, WrapFile, AxisWrap);

impl JsonSchema for ImageReference {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ImageReference".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<ImageFile>()] })
    }
}

impl JsonSchema for WrapFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Wrap".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let name = json_schema!({ "enum": Wrap::ALL.map(Wrap::name) });
        json_schema!({ "anyOf": [name, { "type": "array", "items": name, "minItems": 2, "maxItems": 2 }] })
    }
}

/// Squares of two colours.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Checker {
    /// The colour of the square at the origin of the texture coordinates.
    pub(crate) even: Color,
    /// The colour of its neighbours.
    pub(crate) odd: Color,
    /// The length of a square's edge in texture coordinates; default 1.
    #[serde(default = "unit")]
    pub(crate) size: Number<Positive>,
}

fn unit() -> Number<Positive> {
    Number::default_of(1.0)
}

impl Forms for SurfaceColor {
    const FORMS: &'static str =
        r##"a number, a list of three, text such as "#87ceeb" in quotes, {image: ...} or {checker: ...}"##;

    fn from_number<E: Error>(number: f64) -> Result<Self, E> {
        Color::from_number(number).map(Self::Solid)
    }

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Color::from_text(text).map(Self::Solid)
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        Color::from_list(list).map(Self::Solid)
    }

    fn from_mapping<'de, D: Deserializer<'de>>(mapping: D) -> Result<Self, D::Error> {
        Pattern::deserialize(mapping).map(Self::Pattern)
    }
}

deserialize_by_forms!(SurfaceColor);

impl JsonSchema for SurfaceColor {
    fn schema_name() -> Cow<'static, str> {
        "SurfaceColor".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A colour, or a pattern of colours over the surface.",
            "anyOf": [generator.subschema_for::<Color>(), generator.subschema_for::<Pattern>()]
        })
    }
}
