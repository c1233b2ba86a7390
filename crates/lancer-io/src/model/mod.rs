//! Model files to meshes and materials.
//!
//! In: a path and the resolver that says what may be opened. Out: a [`Model`]: validated meshes, one for each
//! material, how they are arranged, and what the user should know about the file. A further format is a module
//! here, a variant of [`ModelFormat`] and a line in `read`.

mod archive;
mod gltf;
mod mtl;
mod normals;
mod obj;
mod off;
mod options;
mod ply;
mod polygons;
mod report;
mod stl;
mod text;
mod three_mf;
mod tree;
mod triangulate;

pub use options::{Crease, ModelOptions};
pub use ply::write_ply;
pub use tree::{ModelNode, ModelTree};

use crate::diagnostics::{Diagnostic, LoadError};
use crate::resolver::Resolver;
use lancer_core::camera::Camera;
use lancer_core::geometry::{Bounds, DVec3, Transform};
use lancer_core::mesh::Mesh;
use lancer_core::scene::{Light, Material, Node, Scene};
use std::path::Path;
use std::sync::Arc;

/// The formats of model files that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFormat {
    /// Wavefront OBJ, with its materials in MTL files.
    Obj,
    /// The Stanford polygon file format, in text or binary.
    Ply,
    /// Stereolithography, in text or binary.
    Stl,
    /// Geomview's object file format, in text.
    Off,
    /// glTF 2.0, with its buffers and images in files of their own or within, and its binary form GLB.
    Gltf,
    /// The 3D Manufacturing Format of printers.
    ThreeMf,
}

impl ModelFormat {
    /// Every format.
    pub const ALL: [Self; 6] = [Self::Obj, Self::Ply, Self::Stl, Self::Off, Self::Gltf, Self::ThreeMf];

    /// The extensions of the format's files, in lower case.
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Obj => &["obj"],
            Self::Ply => &["ply"],
            Self::Stl => &["stl"],
            Self::Off => &["off"],
            Self::Gltf => &["gltf", "glb"],
            Self::ThreeMf => &["3mf"],
        }
    }

    /// The format of the file at `path` by its extension, in any case; `None` where no such format is read.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        let is_of =
            |format: &Self| format.extensions().iter().any(|known| extension.eq_ignore_ascii_case(known));
        Self::ALL.into_iter().find(is_of)
    }
}

/// The extensions of all files that are read as models, packed ones among them.
pub fn model_extensions() -> impl Iterator<Item = &'static str> {
    let formats = ModelFormat::ALL.into_iter().flat_map(|format| format.extensions().iter().copied());
    formats.chain(archive::EXTENSIONS)
}

/// Whether a file is read as a model, by its name.
pub fn is_model_file(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|found| model_extensions().any(|known| found.eq_ignore_ascii_case(known)))
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

/// Which axis of a model file points up, by the custom of its format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// As in scenes.
    #[default]
    Y,
    /// As on the bed of a printer.
    Z,
}

/// A camera of a model file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelCamera {
    /// What the file calls it, or a number.
    pub name: String,
    /// Where it stands, in the file's coordinates.
    pub camera: Camera,
    /// The width of its picture over the height; `None` where the file leaves it open.
    pub aspect: Option<f64>,
}

/// What a model file holds.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The file's name without its extension.
    pub name: String,
    /// The meshes; never empty in a model that was loaded.
    pub parts: Vec<ModelPart>,
    /// The materials that parts use.
    pub materials: Vec<Material>,
    /// Where the meshes' own origin lies in the file's coordinates.
    ///
    /// Meshes are of single precision, so a model far from the origin (as those of maps are) is stored around
    /// a point near its middle. All parts share it, so that edges that they share stay closed.
    pub origin: DVec3,
    /// How the parts are arranged; `None` where each is drawn once, as it is.
    pub tree: Option<ModelTree>,
    /// The file's cameras, of which no two have one name.
    pub cameras: Vec<ModelCamera>,
    /// The file's lights, in the file's coordinates.
    pub lights: Vec<Light>,
    /// Which axis of the file's coordinates points up. Only the [showcase](crate::showcase) turns a model by it.
    pub up: UpAxis,
    /// What the user should know.
    pub warnings: Vec<Diagnostic>,
}

impl Model {
    /// The number of triangles that are drawn; those of a part count as often as it is placed.
    pub fn triangle_count(&self) -> u64 {
        let of_part = |part: &ModelPart| part.mesh.triangle_count() as u64;
        match &self.tree {
            None => self.parts.iter().map(of_part).sum(),
            Some(tree) => tree.count(|part| of_part(&self.parts[part])),
        }
    }

    /// The box around the model, in the file's coordinates.
    pub fn bounds(&self) -> Bounds {
        self.bounds_under(Transform::IDENTITY)
    }

    /// The box around the image of the model.
    pub fn bounds_under(&self, transform: Transform) -> Bounds {
        let place = Transform::translate(self.origin).then(transform);
        match &self.tree {
            Some(tree) => tree.bounds(&self.parts, place),
            None => tree::bounds_of_parts(self.parts.iter().map(|part| (&*part.mesh, place))),
        }
    }

    /// Puts the model's materials and parts into a scene; its cameras and lights are left to the caller.
    ///
    /// Returns the group of the parts, in the file's coordinates, for the caller to add to the scene or to
    /// insert below a node. Parts without a material inherit it from there.
    pub fn insert_into(self, scene: &mut Scene) -> Node {
        let materials =
            self.materials.into_iter().map(|material| scene.add_material(material)).collect::<Vec<_>>();
        let node_of_part = |part: ModelPart| {
            let node = Node::mesh(part.name, part.mesh);
            match part.material {
                Some(material) => node.with_material(materials[material]),
                None => node,
            }
        };
        let parts = self.parts.into_iter().map(node_of_part).collect::<Vec<_>>();
        let children = match self.tree {
            Some(tree) => tree.insert_into(scene, &parts),
            None => parts.into_iter().map(|part| scene.insert(part)).collect(),
        };
        Node::group(self.name, children).with_transform(Transform::translate(self.origin))
    }
}

/// Reads a model file of any format in [`ModelFormat`], chosen by its extension, or the model in a `.gz` or `.zip` file.
///
/// What the file refers to and cannot be had (a material, a texture) is a warning.
///
/// # Errors
/// The format is unknown, the file cannot be read or is at fault, or it holds nothing to draw.
pub fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    match ModelFormat::of_path(path) {
        Some(format) => read(format, path, resolver, options),
        None if archive::is_packed(path) => archive::load(path, resolver, options),
        None => {
            let formats = model_extensions().map(|extension| format!(".{extension}")).collect::<Vec<_>>();
            let message = "is not a model of a format that is read";
            let hint = format!("models are read from {}", formats.join(", "));
            Err(Diagnostic::new(path, message).with_hint(hint).into())
        }
    }
}

fn read(
    format: ModelFormat,
    path: &Path,
    resolver: &Resolver,
    options: &ModelOptions,
) -> Result<Model, LoadError> {
    match format {
        ModelFormat::Obj => obj::load(path, resolver, options),
        ModelFormat::Ply => ply::load(path, resolver, options),
        ModelFormat::Stl => stl::load(path, resolver, options),
        ModelFormat::Off => off::load(path, resolver, options),
        ModelFormat::Gltf => gltf::load(path, resolver, options),
        ModelFormat::ThreeMf => three_mf::load(path, resolver, options),
    }
}

/// The name of a model: that of its file.
fn name_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
