//! What a scene file may say: the one description that reading and the JSON Schema are made from.
//!
//! In: nothing but serde. Out: values within their ranges, whose names and references are not looked up yet. The
//! comments on public-facing fields are the descriptions in the schema, so they speak to authors of files.

mod channels;
mod material;
mod named;
mod node;
mod number;
mod settings;
mod transform;

pub(crate) use channels::Color;
pub(crate) use material::{ImageFile, ImageReference, MaterialFile, Pattern, SurfaceColor};
pub(crate) use named::Named;
pub(crate) use node::{
    DetailedShape, MaterialReference, MeshFile, MeshReference, NodeFile, ShapeFile, SimpleShape,
};
pub(crate) use settings::{CameraFile, LightFile, RenderFile};
pub(crate) use transform::{Step, transform_of};

use super::deserialize::Spanned;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;

/// A scene for Lancer. Lengths are in scene units, angles in degrees; +Y is up. Relative paths are relative to
/// this file.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(title = "Lancer scene", rename = "Scene", extend("required" = ["format"]))]
pub(crate) struct SceneFile {
    /// The version of this format.
    #[schemars(with = "Format")]
    pub(crate) format: Option<Format>,
    /// What you call the scene.
    pub(crate) name: String,
    /// The camera that is used where none is named.
    pub(crate) camera: CameraFile,
    /// Further cameras, by name.
    pub(crate) cameras: Named<CameraFile>,
    /// L_a: the ambient light of the whole scene; default black.
    pub(crate) ambient: Color,
    /// What a ray sees that meets nothing; default black.
    pub(crate) background: Color,
    /// The point lights.
    pub(crate) lights: Vec<LightFile>,
    /// Materials, by name.
    pub(crate) materials: Named<MaterialFile>,
    /// Objects that are not drawn by themselves, to be `use`d many times, by name.
    pub(crate) assets: Named<Spanned<NodeFile>>,
    /// The objects that are drawn.
    pub(crate) objects: Vec<Spanned<NodeFile>>,
    /// What to render, unless the command line says otherwise.
    pub(crate) render: RenderFile,
}

/// The version of the format that this program reads.
pub(crate) const FORMAT: u64 = 1;

/// The one legal version.
#[derive(Debug)]
pub(crate) struct Format;

impl<'de> Deserialize<'de> for Format {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number::Whole::<FORMAT, FORMAT>::deserialize(deserializer).map(|_| Self)
    }
}

impl JsonSchema for Format {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Format".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "const": FORMAT })
    }
}
