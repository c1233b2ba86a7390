//! A scene as the syntax tree of a file.

use super::super::export::{
    boolean, integer, list, mapping, material_entries, of_camera, of_light, of_settings, of_steps,
    of_texture, short_rgb, text,
};
use super::parts::Parts;
use crate::scene_file::model::FORMAT;
use crate::scene_file::syntax::Node as Syntax;
use lancer_core::geometry::Transform;
use lancer_core::scene::{ImageTexture, Material, Node, NodeId, Scene, Shape, Texture, Wrap};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

/// The tree of a scene, whose meshes and images are `parts`.
pub(super) fn of_scene(scene: &Scene, parts: &Parts) -> Rc<Syntax> {
    let mut taken = HashSet::new();
    let materials = scene.materials().iter().map(|material| unique(&material.name, "material", &mut taken));
    let writer = Writer { scene, parts, materials: materials.collect(), assets: assets(scene) };
    let materials = writer.materials.iter().zip(scene.materials());
    let materials = materials.map(|(name, material)| (name.as_str(), writer.material(material)));
    let cameras = scene.cameras.iter().map(|(name, camera)| (name.as_str(), of_camera(camera)));
    let assets =
        writer.assets.in_order.iter().map(|&id| (writer.assets.names[&id].as_str(), writer.node(id)));
    let objects = scene.roots().iter().map(|&root| writer.reference_or_node(root));
    let sections = [
        ("cameras", mapping(cameras)),
        ("ambient", short_rgb(scene.ambient)),
        ("background", short_rgb(scene.background)),
        ("lights", list(scene.lights.iter().map(|light| of_light(light, short_rgb)))),
        ("render", of_settings(&scene.settings, scene.tone)),
        ("materials", mapping(materials)),
        ("assets", mapping(assets)),
        ("objects", list(objects)),
    ];
    let head = [
        ("format", integer(FORMAT as u32)),
        ("name", text(&scene.name)),
        ("camera", of_camera(&scene.camera)),
    ];
    mapping(head.into_iter().chain(sections.into_iter().filter(|(_, section)| !section.is_empty())))
}

struct Writer<'a> {
    scene: &'a Scene,
    parts: &'a Parts,
    /// The names of the materials, by index, each once.
    materials: Vec<String>,
    assets: Assets,
}

impl Writer<'_> {
    fn material(&self, material: &Material) -> Rc<Syntax> {
        let color = match &material.color {
            Texture::Image { image, wrap } => Some(mapping([("image", self.image(image, *wrap))])),
            other => of_texture(other, short_rgb),
        };
        let entries = material_entries(material, short_rgb);
        mapping(color.map(|color| ("color", color)).into_iter().chain(entries))
    }

    /// An image by its reference, and how it is wrapped, unless it is repeated.
    fn image(&self, image: &Arc<ImageTexture>, wrap: [Wrap; 2]) -> Rc<Syntax> {
        let file = text(self.parts.image(image));
        let name = |wrap: Wrap| text(wrap.name());
        match wrap {
            [Wrap::Repeat, Wrap::Repeat] => file,
            [u, v] if u == v => mapping([("file", file), ("wrap", name(u))]),
            axes => mapping([("file", file), ("wrap", list(axes.map(name)))]),
        }
    }

    fn reference_or_node(&self, id: NodeId) -> Rc<Syntax> {
        match self.assets.names.get(&id) {
            Some(name) => mapping([("use", text(name))]),
            None => self.node(id),
        }
    }

    /// Recurses no deeper than [`DEEPEST`].
    fn node(&self, id: NodeId) -> Rc<Syntax> {
        let Node { name, transform, material, shape, children, hidden } = self.scene.node(id);
        let mut entries = Vec::new();
        if !name.is_empty() {
            entries.push(("name", text(name)));
        }
        if let Some(shape) = shape {
            entries.push(("shape", self.shape(shape)));
        }
        if let Some(material) = material {
            entries.push(("material", text(&self.materials[material.index()])));
        }
        if *transform != Transform::IDENTITY {
            entries.push(("transform", of_steps(*transform)));
        }
        if *hidden {
            entries.push(("hidden", boolean(true)));
        }
        if !children.is_empty() || shape.is_none() {
            entries.push(("children", list(children.iter().map(|&child| self.reference_or_node(child)))));
        }
        mapping(entries)
    }

    fn shape(&self, shape: &Shape) -> Rc<Syntax> {
        match shape {
            Shape::Sphere => text("sphere"),
            Shape::Cube => text("cube"),
            Shape::Plane => text("plane"),
            Shape::Cylinder { capped: true } => text("cylinder"),
            Shape::Cylinder { capped: false } => {
                mapping([("cylinder", mapping([("capped", boolean(false))]))])
            }
            Shape::Mesh(mesh) => mapping([("mesh", text(self.parts.mesh(mesh)))]),
        }
    }
}

/// How many objects are nested in one another before the next becomes an asset: a file may be nested
/// [200 deep](crate::limits::Limits::nesting), and an object takes two levels.
const DEEPEST: usize = 50;

/// The nodes that are written once, to be used by name.
struct Assets {
    names: HashMap<NodeId, String>,
    in_order: Vec<NodeId>,
}

/// Those nodes that have several parents, and those that lie deep.
fn assets(scene: &Scene) -> Assets {
    let mut uses = vec![0_usize; scene.nodes().len()];
    for id in scene.roots().iter().chain(scene.nodes().iter().flat_map(|node| &node.children)) {
        uses[id.index()] += 1;
    }
    let mut assets = Assets { names: HashMap::new(), in_order: Vec::new() };
    let mut taken = HashSet::new();
    let mut seen = vec![false; scene.nodes().len()];
    let mut waiting = scene.roots().iter().rev().map(|&root| (root, 0)).collect::<Vec<_>>();
    while let Some((id, depth)) = waiting.pop() {
        if std::mem::replace(&mut seen[id.index()], true) {
            continue;
        }
        let is_asset = uses[id.index()] > 1 || depth >= DEEPEST;
        if is_asset {
            assets.names.insert(id, unique(&scene.node(id).name, "part", &mut taken));
            assets.in_order.push(id);
        }
        let below = if is_asset { 1 } else { depth + 1 };
        waiting.extend(scene.node(id).children.iter().rev().map(|&child| (child, below)));
    }
    assets
}

/// A name that is not taken yet, and then is: the one that is wanted where it can be.
fn unique(wanted: &str, nameless: &str, taken: &mut HashSet<String>) -> String {
    let base = if wanted.is_empty() { nameless } else { wanted };
    let numbered = (2_u64..).map(|number| format!("{base} {number}"));
    let free = std::iter::once(base.to_owned()).chain(numbered).find(|name| !taken.contains(name));
    let name = free.expect("there are more numbers than names");
    taken.insert(name.clone());
    name
}
