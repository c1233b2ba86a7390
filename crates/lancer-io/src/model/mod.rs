//! Model files to meshes and materials.
//!
//! In: a path and the resolver that says what may be opened. Out: a [`Model`]: validated meshes, one for each
//! material, and what the user should know about the file. A further format is a module here, a variant of
//! [`ModelFormat`] and a line in [`load`].

mod mtl;
mod normals;
mod obj;
mod options;
mod ply;
mod polygons;
mod report;
mod text;
mod triangulate;

pub use options::{Crease, ModelOptions};
pub use ply::write_ply;

use crate::diagnostics::{Diagnostic, LoadError};
use crate::resolver::Resolver;
use lancer_core::geometry::{Bounds, DVec3, Transform};
use lancer_core::mesh::Mesh;
use lancer_core::scene::{Material, Node, Scene};
use std::path::Path;
use std::sync::Arc;

/// The formats of model files that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFormat {
    /// Wavefront OBJ, with its materials in MTL files.
    Obj,
    /// The Stanford polygon file format, in text or binary.
    Ply,
}

impl ModelFormat {
    /// Every format.
    pub const ALL: [Self; 2] = [Self::Obj, Self::Ply];

    /// The extension of the format's files, in lower case.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
        }
    }

    /// The format of the file at `path` by its extension, in any case; `None` where no such format is read.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }
}

/// The triangles of one file that share a material.
#[derive(Clone, Debug)]
pub struct ModelPart {
    /// The material's name, or else the first object's or the file's.
    pub name: String,
    /// The triangles, relative to the model's origin.
    pub mesh: Arc<Mesh>,
    /// Its place in [`Model::materials`]; `None` where the file names no material that was found.
    pub material: Option<usize>,
}

/// What a model file holds.
#[derive(Clone, Debug)]
pub struct Model {
    /// The file's name without its extension.
    pub name: String,
    /// The meshes; never empty.
    pub parts: Vec<ModelPart>,
    /// The materials that parts use.
    pub materials: Vec<Material>,
    /// Where the meshes' own origin lies in the file's coordinates.
    ///
    /// Meshes are of single precision, so a model far from the origin (as those of maps are) is stored around
    /// a point near its middle. All parts share it, so that edges that they share stay closed.
    pub origin: DVec3,
    /// What the user should know.
    pub warnings: Vec<Diagnostic>,
}

impl Model {
    /// The number of triangles in all parts.
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.triangle_count()).sum()
    }

    /// The box around the model, in the file's coordinates.
    pub fn bounds(&self) -> Bounds {
        let boxes = self.parts.iter().map(|part| part.mesh.bounds());
        let around = boxes.fold(Bounds::EMPTY, Bounds::union);
        Bounds::new(around.min + self.origin, around.max + self.origin)
    }

    /// Puts the model's materials and parts into a scene.
    ///
    /// Returns the group of the parts, in the file's coordinates, for the caller to add to the scene or to
    /// insert below a node. Parts without a material inherit it from there.
    pub fn insert_into(self, scene: &mut Scene) -> Node {
        let materials =
            self.materials.into_iter().map(|material| scene.add_material(material)).collect::<Vec<_>>();
        let parts = self.parts.into_iter().map(|part| {
            let node = Node::mesh(part.name, part.mesh);
            scene.insert(match part.material {
                Some(material) => node.with_material(materials[material]),
                None => node,
            })
        });
        Node::group(self.name, parts).with_transform(Transform::translate(self.origin))
    }
}

/// Reads a model file of any format in [`ModelFormat`], chosen by its extension.
///
/// What the file refers to and cannot be had (a material, a texture) is a warning.
///
/// # Errors
/// The format is unknown, the file cannot be read or is at fault, or it holds nothing to draw.
pub fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    match ModelFormat::of_path(path) {
        Some(ModelFormat::Obj) => obj::load(path, resolver, options),
        Some(ModelFormat::Ply) => ply::load(path, resolver, options),
        None => {
            let formats = ModelFormat::ALL.map(|format| format!(".{}", format.extension())).join(", ");
            let message = "is not a model of a format that is read";
            Err(Diagnostic::new(path, message).with_hint(format!("models are read from {formats}")).into())
        }
    }
}

/// The name of a model: that of its file.
fn name_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
