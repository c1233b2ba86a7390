//! Objects: nodes of the tree, the shapes they draw and the materials they name.

use super::material::MaterialFile;
use super::number::{CreaseAngle, Number};
use super::transform::Step;
use crate::scene_file::deserialize::{Forms, Spanned, deserialize_by_forms};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, IntoDeserializer};
use std::borrow::Cow;

/// An object: at least one of `shape`, `use` and `children`.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "Object", extend("anyOf" = [
    { "required": ["shape"] }, { "required": ["use"] }, { "required": ["children"] }
]))]
pub(crate) struct NodeFile {
    /// What you call the object.
    pub(crate) name: String,
    /// What is drawn here.
    pub(crate) shape: Option<ShapeFile>,
    /// The name of the asset that is drawn here.
    #[serde(rename = "use")]
    pub(crate) asset: Option<Spanned<String>>,
    /// What is drawn below, in this object's space.
    pub(crate) children: Option<Vec<Spanned<NodeFile>>>,
    /// The steps from this object's space to its parent's, applied in the order written.
    pub(crate) transform: Option<Spanned<Vec<Spanned<Step>>>>,
    /// The material of this object and of all below it that name none; without one, the parent's.
    pub(crate) material: Option<Spanned<MaterialReference>>,
    /// Whether neither this object nor anything below it is drawn; default false.
    pub(crate) hidden: bool,
}

impl NodeFile {
    /// What to call it in a message.
    pub(crate) fn title(&self) -> String {
        if self.name.is_empty() { "this object".into() } else { format!("`{}`", self.name) }
    }
}

/// A material by its name, or written in place.
pub(crate) enum MaterialReference {
    Name(String),
    InPlace(Box<MaterialFile>),
}

impl Forms for MaterialReference {
    const FORMS: &'static str = "text that names a material, or a material";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Ok(Self::Name(text.into()))
    }

    fn from_mapping<'de, D: Deserializer<'de>>(mapping: D) -> Result<Self, D::Error> {
        MaterialFile::deserialize(mapping).map(|material| Self::InPlace(Box::new(material)))
    }
}

/// A shape by its name, or with what it needs to know.
pub(crate) enum ShapeFile {
    Simple(SimpleShape),
    Detailed(DetailedShape),
}

/// A shape that needs no more than its name. The sphere has the radius 1, the cube and the cylinder reach from -1
/// to 1, and the plane lies at y = 0.
#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum SimpleShape {
    Sphere,
    Cube,
    Cylinder,
    Plane,
}

/// A shape with what it needs to know.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum DetailedShape {
    /// A model of a file.
    Mesh(Spanned<MeshReference>),
    /// x^2 + z^2 = 1 for -1 <= y <= 1.
    Cylinder(Cylinder),
}

/// A model by its path, or with how it is to be read.
pub(crate) enum MeshReference {
    Path(String),
    Detailed(MeshFile),
}

/// A model with how it is to be read.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Mesh")]
pub(crate) struct MeshFile {
    /// The path of the model.
    pub(crate) file: Spanned<String>,
    /// Faces without normals are smooth across edges of up to this angle in degrees; 0 is for facets.
    #[serde(default)]
    pub(crate) crease: Option<Number<CreaseAngle>>,
}

impl Forms for MeshReference {
    const FORMS: &'static str = "text that names a model's file, or {file: PATH, crease: DEGREES}";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Ok(Self::Path(text.into()))
    }

    fn from_mapping<'de, D: Deserializer<'de>>(mapping: D) -> Result<Self, D::Error> {
        MeshFile::deserialize(mapping).map(Self::Detailed)
    }
}

/// A cylinder's own choices.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Cylinder {
    /// Whether two discs close it; default true.
    pub(crate) capped: bool,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { capped: true }
    }
}

impl Forms for ShapeFile {
    const FORMS: &'static str = "sphere, cube, cylinder, plane, {mesh: PATH} or {cylinder: {capped: false}}";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        SimpleShape::deserialize(text.into_deserializer()).map(Self::Simple)
    }

    fn from_mapping<'de, D: Deserializer<'de>>(mapping: D) -> Result<Self, D::Error> {
        DetailedShape::deserialize(mapping).map(Self::Detailed)
    }
}

deserialize_by_forms!(MaterialReference, ShapeFile, MeshReference);

impl JsonSchema for MaterialReference {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "MaterialReference".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<MaterialFile>()] })
    }
}

impl JsonSchema for MeshReference {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "MeshReference".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<MeshFile>()] })
    }
}

impl JsonSchema for ShapeFile {
    fn schema_name() -> Cow<'static, str> {
        "Shape".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "What is drawn: a shape by its name, or with what it needs to know.",
            "anyOf": [generator.subschema_for::<SimpleShape>(), generator.subschema_for::<DetailedShape>()]
        })
    }
}
