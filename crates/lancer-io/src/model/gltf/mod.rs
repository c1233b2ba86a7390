//! glTF 2.0 and GLB.
//!
//! In: the bytes of a file and the buffers and images that it names. Out: a [`Model`] with the whole tree of nodes
//! of the default scene: a mesh that many nodes use is one, its primitives are parts, and cameras and lights come
//! along. [`materials`] says how materials are understood, [`view`] how lights are. Skins, morph targets and
//! animations are told and not applied; what a file requires and this reader lacks is refused by name.
//!
//! The reader is our own: the `gltf` crate panics on some invalid files, follows cycles of nodes and any path, and has
//! had no release since 2024. Faults are told by the place in the document, as a JSON pointer.
//!
//! Source: Khronos Group, "glTF 2.0 specification", and its registry of extensions.

mod accessors;
mod buffers;
mod container;
mod document;
mod fault;
mod materials;
mod nodes;
mod primitives;
mod textures;
mod view;
mod words;

use self::buffers::Buffers;
use self::container::Container;
use self::document::Document;
use self::fault::{Fault, Result, Warnings, entry};
use self::materials::Converted;
use self::nodes::Graph;
use self::primitives::MeshMaker;
use self::textures::Textures;
use super::polygons::Excess;
use super::text::{kept_name, quoted};
use super::tree::{Grown, ModelNode, ModelTree, TreeError};
use super::{Model, ModelOptions, ModelPart, name_of, normals};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::resolver::Resolver;
use lancer_core::geometry::Transform;
use lancer_core::mesh::Mesh;
use lancer_core::scene::Material;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Extensions that are understood, if only to be told of.
const UNDERSTOOD: [&str; 9] = [
    "KHR_lights_punctual",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    // Its factor scales what is told of anyway.
    "KHR_materials_emissive_strength",
];

/// Reads the glTF or GLB file at `path`.
pub(super) fn load(
    path: &Path,
    resolver: &Resolver,
    options: &ModelOptions,
) -> std::result::Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    let container = Container::parse(&bytes).map_err(|message| LoadError::new(path, message))?;
    let document = parse(path, container.json, &resolver.limits)?;
    let buffers = Buffers::new(path, resolver, &document, container.binary);
    let mut warnings = Warnings::default();
    let assembled = assemble(path, resolver, options, &document, &buffers, &mut warnings);
    let model = assembled.map_err(|fault| fault.into_error(path))?;
    let warnings = warnings.into_diagnostics(path);
    if model.parts.is_empty() {
        let hint = warnings.first().map(|warning| warning.message.clone());
        let error = Diagnostic::new(path, "holds no node with a mesh to draw");
        return Err(match hint {
            Some(hint) => error.with_hint(hint),
            None => error,
        }
        .into());
    }
    Ok(Model { warnings, ..model })
}

/// The document, if it is of a version that is read.
fn parse(path: &Path, json: &[u8], limits: &Limits) -> std::result::Result<Document, LoadError> {
    // Older documents differ in more than this member, so it is looked at first.
    #[derive(Default, serde::Deserialize)]
    #[serde(default)]
    struct Versioned {
        asset: document::Asset,
    }
    if memory_of(json) > limits.memory {
        let excess = Excess::Memory(limits.memory);
        return Err(Diagnostic::new(path, excess.to_string()).with_hint(excess.hint()).into());
    }
    let broken = |error: serde_json::Error| -> LoadError {
        let diagnostic = Diagnostic::new(path, words::of_error(&error));
        let place = diagnostic.at(error.line().max(1), error.column().max(1));
        place.showing(&String::from_utf8_lossy(json)).into()
    };
    let Versioned { asset } = serde_json::from_slice(json).map_err(broken)?;
    let needed = asset.min_version.as_deref().unwrap_or(&asset.version);
    if !needed.starts_with("2.") {
        let message = match needed {
            "" => "/asset/version: is missing, so this is no glTF file".to_owned(),
            other => format!("/asset/version: is `{}`; 2.0 is read", quoted(other.as_bytes())),
        };
        return Err(LoadError::new(path, message));
    }
    serde_json::from_slice(json).map_err(broken)
}

/// About the most bytes that a document and what is made of it take, by the marks between its values: an empty node is
/// three bytes long.
fn memory_of(json: &[u8]) -> u64 {
    const FOR_AN_OBJECT: u64 = 400;
    const FOR_A_VALUE: u64 = 16;
    let bytes = |&mark: &u8| match mark {
        b'{' => FOR_AN_OBJECT,
        b',' | b'[' => FOR_A_VALUE,
        _ => 0,
    };
    json.iter().map(bytes).sum()
}

/// The model that a document describes, without its warnings.
fn assemble(
    path: &Path,
    resolver: &Resolver,
    options: &ModelOptions,
    document: &Document,
    buffers: &Buffers,
    warnings: &mut Warnings,
) -> Result<Model> {
    check_extensions(document, warnings)?;
    if document.scenes.len() > 1 {
        let drawn = document.scene.unwrap_or(0);
        warnings.add("/scenes", format!("of {} scenes only {drawn} is drawn", document.scenes.len()));
    }
    if !document.animations.is_empty() {
        warnings.add("/animations", "animations are not applied");
    }
    let graph = Graph::new(document)?;
    let mut parts = Parts {
        document,
        textures: Textures::new(path, document, buffers, resolver),
        meshes: MeshMaker::new(document, buffers, &resolver.limits),
        options,
        smoothed: HashMap::new(),
        materials: Vec::new(),
        material_of: HashMap::new(),
        parts: Vec::new(),
        places_of_mesh: HashMap::new(),
    };
    let nodes = model_nodes(document, &graph, &mut parts, warnings)?;
    let grown = ModelTree::grow(nodes, graph.roots.clone(), resolver.limits.objects);
    let too_many = |error: TreeError| Fault::new("/nodes", error.to_string()).with_hint(error.hint());
    let Grown { tree, singular } = grown.map_err(too_many)?;
    for index in singular {
        warnings.add(format!("/nodes/{index}"), "is not drawn: its transform flattens it");
    }
    let mut model = Model {
        name: name_of(path),
        // Without a tree nothing is drawn.
        parts: if tree.is_some() { parts.parts } else { Vec::new() },
        materials: parts.materials,
        tree,
        ..Model::default()
    };
    let bounds = model.bounds();
    model.cameras = view::cameras(document, &graph, bounds, warnings)?;
    model.lights = view::lights(document, &graph, bounds, warnings)?;
    Ok(model)
}

fn check_extensions(document: &Document, warnings: &mut Warnings) -> Result<()> {
    let understood = |name: &&String| UNDERSTOOD.contains(&name.as_str());
    for (index, name) in document.extensions_required.iter().enumerate() {
        if !understood(&name) {
            let message = format!("the file requires `{name}`, which is not read");
            return Err(Fault::new(format!("/extensionsRequired/{index}"), message));
        }
    }
    for (index, name) in document.extensions_used.iter().enumerate().filter(|(_, name)| !understood(name)) {
        warnings.add(format!("/extensionsUsed/{index}"), format!("`{name}` is passed over"));
    }
    Ok(())
}

/// The nodes of the document, and after them one for each mesh of several parts, which all who use it share.
fn model_nodes(
    document: &Document,
    graph: &Graph,
    parts: &mut Parts,
    warnings: &mut Warnings,
) -> Result<Vec<ModelNode>> {
    let mut nodes = vec![ModelNode::default(); document.nodes.len()];
    let mut node_of_mesh = HashMap::new();
    for (index, _) in graph.placed(&document.nodes) {
        let written = &document.nodes[index];
        if written.skin.is_some() {
            warnings.add(
                format!("/nodes/{index}/skin"),
                "skins are not applied: the mesh is drawn as it is stored",
            );
        }
        let mut node = ModelNode {
            name: kept_name(written.name.as_deref().unwrap_or_default()),
            transform: graph.transforms[index],
            parts: Vec::new(),
            children: written.children.to_vec(),
        };
        if let Some(mesh) = written.mesh {
            if node.name.is_empty() {
                node.name = parts.mesh_name(mesh);
            }
            match parts.of_mesh(mesh, &format!("/nodes/{index}/mesh"), warnings)? {
                few @ ([] | [_]) => node.parts = few.to_vec(),
                several => {
                    let shared = *node_of_mesh.entry(mesh).or_insert_with(|| {
                        let (name, parts) = (String::new(), several.to_vec());
                        nodes.push(ModelNode {
                            name,
                            parts,
                            transform: Transform::IDENTITY,
                            children: Vec::new(),
                        });
                        nodes.len() - 1
                    });
                    node.children.push(shared);
                }
            }
        }
        nodes[index] = node;
    }
    Ok(nodes)
}

/// The parts of a model as they are made.
struct Parts<'a> {
    document: &'a Document,
    textures: Textures<'a>,
    meshes: MeshMaker<'a>,
    options: &'a ModelOptions,
    /// Meshes that got normals, by the address of what they were.
    smoothed: HashMap<usize, (Arc<Mesh>, Arc<Mesh>)>,
    materials: Vec<Material>,
    /// By the document's material: its place in `materials`, and where its texture takes its coordinates from.
    material_of: HashMap<usize, (usize, Option<materials::UvMapping>)>,
    parts: Vec<ModelPart>,
    /// By the document's mesh: the places of its parts.
    places_of_mesh: HashMap<usize, Vec<usize>>,
}

impl Parts<'_> {
    fn mesh_name(&self, index: usize) -> String {
        let name = self.document.meshes.get(index).and_then(|mesh| mesh.name.as_deref()).map(kept_name);
        name.filter(|name| !name.is_empty()).unwrap_or_else(|| format!("mesh {index}"))
    }

    /// The places of a mesh's parts, which are made when first asked for.
    fn of_mesh(&mut self, index: usize, at: &str, warnings: &mut Warnings) -> Result<&[usize]> {
        let written = entry(&self.document.meshes, "meshes", index, at)?;
        if !self.places_of_mesh.contains_key(&index) {
            let mut places = Vec::new();
            for (number, primitive) in written.primitives.iter().enumerate() {
                let at = format!("/meshes/{index}/primitives/{number}");
                places.extend(self.part(index, primitive, &at, warnings)?);
            }
            self.places_of_mesh.insert(index, places);
        }
        Ok(&self.places_of_mesh[&index])
    }

    fn part(
        &mut self,
        mesh: usize,
        primitive: &document::Primitive,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<usize>> {
        if primitive.extensions.draco.is_some() {
            // A file that does not require it holds the data uncompressed as well, if it keeps to its word.
            let position =
                primitive.attributes.get("POSITION").and_then(|&index| self.document.accessors.get(index));
            if position.is_none_or(|accessor| accessor.buffer_view.is_none()) {
                let message = "is compressed with KHR_draco_mesh_compression, which is not read";
                return Err(Fault::new(at, message));
            }
            warnings.add(at, "KHR_draco_mesh_compression is not read; the uncompressed data are");
        }
        let material = primitive.material.map(|index| self.material(index, at, warnings)).transpose()?;
        let mapping = material.as_ref().and_then(|(_, mapping)| mapping.as_ref());
        let Some(made) = self.meshes.mesh(primitive, mapping, at, warnings)? else { return Ok(None) };
        let mesh_made = self.smooth(made, at)?;
        let material = material.map(|(place, _)| place);
        let name = match material {
            Some(place) => self.materials[place].name.clone(),
            None => self.mesh_name(mesh),
        };
        self.parts.push(ModelPart { name, mesh: mesh_made, material });
        Ok(Some(self.parts.len() - 1))
    }

    /// The mesh with normals up to the crease angle that the user asks for, if it has none.
    fn smooth(&mut self, mesh: Arc<Mesh>, at: &str) -> Result<Arc<Mesh>> {
        let Some(crease) = self.options.crease.filter(|_| mesh.data().normals.is_empty()) else {
            return Ok(mesh);
        };
        let address = Arc::as_ptr(&mesh).addr();
        if let Some((_, smoothed)) = self.smoothed.get(&address) {
            return Ok(Arc::clone(smoothed));
        }
        let mut data = mesh.data().clone();
        normals::smooth(&mut data, crease);
        let smoothed = Mesh::new(data).map_err(|error| Fault::new(at, error.to_string()))?;
        let smoothed = Arc::new(smoothed);
        self.smoothed.insert(address, (mesh, Arc::clone(&smoothed)));
        Ok(smoothed)
    }

    /// The place of a material, and where its texture takes its coordinates from.
    fn material(
        &mut self,
        index: usize,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<(usize, Option<materials::UvMapping>)> {
        if let Some(known) = self.material_of.get(&index) {
            return Ok(known.clone());
        }
        entry(&self.document.materials, "materials", index, format!("{at}/material"))?;
        let Converted { material, mapping } =
            materials::convert(self.document, &mut self.textures, index, warnings)?;
        self.materials.push(material);
        let made = (self.materials.len() - 1, mapping);
        self.material_of.insert(index, made.clone());
        Ok(made)
    }
}
