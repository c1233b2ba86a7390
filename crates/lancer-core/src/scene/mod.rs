//! What an author says: a tree of named nodes, materials, lights and cameras.
//!
//! In: a scene file, a model or a program. Out: a [`Scene`], to be compiled into a
//! [`World`](crate::world::World). It knows neither accelerators nor file syntax, and is checked only when it
//! is compiled, so that an editor may hold an unfinished one.

mod material;
mod node;
mod settings;
mod texture;

pub use material::{Material, MaterialId};
pub use node::{Node, NodeId, Shape};
pub use settings::{AmbientOcclusion, Settings, SettingsError};
pub use texture::{ImageError, ImageTexture, Texture, Wrap};

use crate::camera::Camera;
use crate::color::Rgb;
use crate::film::Tone;
use crate::geometry::DVec3;

/// A point light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What the author calls it; may be empty.
    pub name: String,
    /// Where it is, in the world.
    pub position: DVec3,
    /// L_i of the illumination model; the light at distance r is L_i / (pi r^2).
    pub intensity: Rgb,
}

/// A scene: nodes in one arena, some of which are drawn.
///
/// A node may be the child of several others: that is how a subtree is used many times. Materials are
/// inherited from the nearest ancestor that names one.
///
/// ```
/// use lancer_core::Rgb;
/// use lancer_core::geometry::{DVec3, Transform};
/// use lancer_core::scene::{Material, Node, Scene, Shape};
///
/// let mut scene = Scene::new("two balls");
/// let red = scene.add_material(Material { color: Rgb::new(0.8, 0.1, 0.1).into(), ..Material::named("red") });
/// scene.add(Node::shape("left", Shape::Sphere).with_material(red));
/// scene.add(
///     Node::shape("right", Shape::Sphere)
///         .with_material(red)
///         .with_transform(Transform::translate(DVec3::X * 3.0)),
/// );
/// scene.add_light(DVec3::new(4.0, 6.0, 4.0), Rgb::grey(300.0));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// What the author calls it.
    pub name: String,
    /// The camera that is used where none is named.
    pub camera: Camera,
    /// Further cameras, by name, in the author's order.
    pub cameras: Vec<(String, Camera)>,
    /// L_a: the ambient light of the whole scene.
    pub ambient: Rgb,
    /// The radiance of a ray that meets nothing.
    pub background: Rgb,
    /// The lights, in the order in which they are summed.
    pub lights: Vec<Light>,
    /// What to render, unless told otherwise.
    pub settings: Settings,
    /// How radiance is shown, unless told otherwise.
    pub tone: Tone,
    materials: Vec<Material>,
    nodes: Vec<Node>,
    roots: Vec<NodeId>,
}

impl Scene {
    /// A scene with nothing in it: no object, no light, black all around, and the default camera and settings.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds a material, for nodes to name. Its name may be that of another: ids tell them apart.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(index_of_last(self.materials.len()))
    }

    /// Adds a nameless point light, at a position in the world. At a distance r, an intensity of pi r^2 makes a
    /// white surface that faces it just white.
    pub fn add_light(&mut self, position: DVec3, intensity: Rgb) {
        self.lights.push(Light { name: String::new(), position, intensity });
    }

    /// Adds a node that is not drawn by itself, to be the child of others.
    pub fn insert(&mut self, node: Node) -> NodeId {
        self.nodes.push(node);
        NodeId(index_of_last(self.nodes.len()))
    }

    /// Adds a node at the top of the tree, where it is drawn, in the space of the world.
    pub fn add(&mut self, node: Node) -> NodeId {
        let id = self.insert(node);
        self.roots.push(id);
        id
    }

    /// Adds a node as the last child of `parent`: it is drawn wherever `parent` is, in its space.
    ///
    /// # Panics
    /// Where `parent` is of another scene and out of range here.
    pub fn add_child(&mut self, parent: NodeId, node: Node) -> NodeId {
        let id = self.insert(node);
        self.node_mut(parent).children.push(id);
        id
    }

    /// The materials, in the order of their ids.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The ids of the materials, in their order.
    pub fn material_ids(&self) -> impl ExactSizeIterator<Item = MaterialId> + use<> {
        (0..self.materials.len()).map(MaterialId::from_index)
    }

    /// The materials, to edit in place.
    pub fn materials_mut(&mut self) -> &mut [Material] {
        &mut self.materials
    }

    /// A material.
    ///
    /// # Panics
    /// Where `id` is of another scene and out of range here.
    pub fn material(&self, id: MaterialId) -> &Material {
        &self.materials[id.index()]
    }

    /// The nodes, in the order of their ids.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The ids of all nodes, in their order.
    pub fn node_ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// The nodes at the top of the tree, in drawing order.
    pub fn roots(&self) -> &[NodeId] {
        &self.roots
    }

    /// A node.
    ///
    /// # Panics
    /// Where `id` is of another scene and out of range here.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// A node, to edit.
    ///
    /// # Panics
    /// Where `id` is of another scene and out of range here.
    pub fn node_mut(&mut self, id: NodeId) -> &mut Node {
        &mut self.nodes[id.index()]
    }

    /// The camera of that name, or without a name the main one; none where there is no such camera.
    pub fn camera_named(&self, name: Option<&str>) -> Option<&Camera> {
        match name {
            None => Some(&self.camera),
            Some(name) => self.cameras.iter().find(|(other, _)| other == name).map(|(_, camera)| camera),
        }
    }
}

fn index_of_last(len: usize) -> u32 {
    u32::try_from(len - 1).expect("fewer than 2^32 entries fit in memory")
}
