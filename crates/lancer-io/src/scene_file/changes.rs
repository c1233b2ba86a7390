//! What makes one scene into another, in the words of its file.

use super::export::{
    boolean, camera_entries, leaf, list, material_entries, of_camera, of_light, of_steps, of_texture,
    settings_entries, short_rgb, text, vector,
};
use super::origins::Origins;
use super::overrides::Override;
use super::syntax::{Language, Node as Syntax, Scalar, flow, same_tree};
use lancer_core::camera::Camera;
use lancer_core::scene::{Light, Material, Node, NodeId, Scene, Shape, Texture};
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

/// What makes one scene into another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// What a scene file can say, for [`patch`](super::patch) to write into it.
    pub overrides: Vec<Override>,
    /// What it cannot.
    pub unsaved: Vec<Unsaved>,
}

/// A change that cannot be written into the scene's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unsaved {
    /// Of an object, by its name: it belongs to a model or an asset, or what changed is its shape or its children.
    Object(String),
    /// Of a material, by its name: it belongs to a model or an asset, or what changed is its name or its image.
    Material(String),
    /// A camera of that name was removed.
    Camera(String),
    /// Objects or materials were added or removed.
    Structure,
}

impl fmt::Display for Unsaved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = |name: &str| if name.is_empty() { String::new() } else { format!(" `{name}`") };
        match self {
            Self::Object(name) => write!(f, "a change of the object{}", named(name)),
            Self::Material(name) => write!(f, "a change of the material{}", named(name)),
            Self::Camera(name) => write!(f, "the removal of the camera{}", named(name)),
            Self::Structure => f.write_str("objects or materials that were added or removed"),
        }
    }
}

/// What makes `old`, as it was loaded from a file with these origins, into `new`.
///
/// Reading the file with the overrides gives `new`, but for what is unsaved; numbers read back to the last bit.
pub fn changes(old: &Scene, new: &Scene, origins: &Origins) -> Changes {
    let mut differ = Differ { origins, changes: Changes::default() };
    differ.scene(old, new);
    differ.lights(&old.lights, &new.lights);
    differ.cameras(&old.cameras, &new.cameras);
    differ.materials(old.materials(), new.materials());
    differ.nodes(old, new);
    differ.changes
}

struct Differ<'a> {
    origins: &'a Origins,
    changes: Changes,
}

type Path<'a> = &'a [&'a str];

impl Differ<'_> {
    fn set(&mut self, path: Path<'_>, value: &Syntax) {
        let path = path.iter().map(|&key| key.to_owned()).collect();
        self.changes.overrides.push(Override::new(path, flow(value, Language::Yaml)));
    }

    fn unsaved(&mut self, change: Unsaved) {
        if !self.changes.unsaved.contains(&change) {
            self.changes.unsaved.push(change);
        }
    }

    /// Sets those entries that changed; `old` and `new` have the same keys.
    fn entries<'k>(
        &mut self,
        path: Path<'_>,
        old: impl IntoIterator<Item = (&'k str, Rc<Syntax>)>,
        new: impl IntoIterator<Item = (&'k str, Rc<Syntax>)>,
    ) {
        for ((key, old), (_, new)) in old.into_iter().zip(new) {
            if !same_tree(&old, &new) {
                self.set(&[path, &[key]].concat(), &new);
            }
        }
    }

    fn scene(&mut self, old: &Scene, new: &Scene) {
        let top_level = |scene: &Scene| {
            [
                ("name", text(&scene.name)),
                ("ambient", short_rgb(scene.ambient)),
                ("background", short_rgb(scene.background)),
            ]
        };
        self.entries(&[], top_level(old), top_level(new));
        self.camera(&["camera"], &old.camera, &new.camera);
        let (old_ao, old_rest) = settings_entries(&old.settings, old.tone);
        let (new_ao, new_rest) = settings_entries(&new.settings, new.tone);
        self.entries(&["render"], old_rest, new_rest);
        self.entries(&["render", "ao"], old_ao, new_ao);
    }

    fn camera(&mut self, path: Path<'_>, old: &Camera, new: &Camera) {
        self.entries(path, camera_entries(old), camera_entries(new));
    }

    fn cameras(&mut self, old: &[(String, Camera)], new: &[(String, Camera)]) {
        for (name, camera) in new {
            match old.iter().find(|(other, _)| other == name) {
                Some((_, before)) => self.camera(&["cameras", name], before, camera),
                None => self.set(&["cameras", name], &of_camera(camera)),
            }
        }
        for (name, _) in old {
            if !new.iter().any(|(other, _)| other == name) {
                self.unsaved(Unsaved::Camera(name.clone()));
            }
        }
    }

    fn lights(&mut self, old: &[Light], new: &[Light]) {
        if old.len() != new.len() {
            let lights = list(new.iter().map(|light| of_light(light, short_rgb)));
            return self.set(&["lights"], &lights);
        }
        let entries = |light: &Light| {
            [
                ("name", text(&light.name)),
                ("position", vector(light.position)),
                ("intensity", short_rgb(light.intensity)),
            ]
        };
        for (index, (old, new)) in old.iter().zip(new).enumerate() {
            self.entries(&["lights", &index.to_string()], entries(old), entries(new));
        }
    }

    fn materials(&mut self, old: &[Material], new: &[Material]) {
        if old.len() != new.len() {
            self.unsaved(Unsaved::Structure);
        }
        for (index, (old, new)) in old.iter().zip(new).enumerate().filter(|(_, (old, new))| old != new) {
            let Some(path) = self.origins.material_path(index) else {
                self.unsaved(Unsaved::Material(new.name.clone()));
                continue;
            };
            let path = path.iter().map(String::as_str).collect::<Vec<_>>();
            if old.name != new.name || (old.color != new.color && matches!(new.color, Texture::Image { .. }))
            {
                self.unsaved(Unsaved::Material(old.name.clone()));
            }
            if old.color != new.color
                && let Some(color) = of_texture(&new.color, short_rgb)
            {
                self.set(&[&path[..], &["color"]].concat(), &color);
            }
            self.entries(&path, material_entries(old, short_rgb), material_entries(new, short_rgb));
        }
    }

    fn nodes(&mut self, old: &Scene, new: &Scene) {
        if old.nodes().len() != new.nodes().len() || old.roots() != new.roots() {
            self.unsaved(Unsaved::Structure);
        }
        for (index, (before, after)) in old.nodes().iter().zip(new.nodes()).enumerate() {
            if is_same(before, after) {
                continue;
            }
            match self.origins.node_path(index) {
                Some(path) => {
                    self.node(&path.iter().map(String::as_str).collect::<Vec<_>>(), before, after, new);
                }
                None => self.unsaved(Unsaved::Object(after.name.clone())),
            }
        }
    }

    fn node(&mut self, path: Path<'_>, old: &Node, new: &Node, scene: &Scene) {
        let entries = |node: &Node| [("name", text(&node.name)), ("hidden", boolean(node.hidden))];
        self.entries(path, entries(old), entries(new));
        if old.transform != new.transform {
            self.set(&[path, &["transform"]].concat(), &of_steps(new.transform));
        }
        if old.material != new.material {
            match self.material_of(old, new, scene) {
                Some(material) => self.set(&[path, &["material"]].concat(), &material),
                None => self.unsaved(Unsaved::Object(new.name.clone())),
            }
        }
        if old.children != new.children || !is_same_shape(old.shape.as_ref(), new.shape.as_ref()) {
            self.unsaved(Unsaved::Object(new.name.clone()));
        }
    }

    /// The new material of an object as its file would name it, if that means the same.
    fn material_of(&self, old: &Node, new: &Node, scene: &Scene) -> Option<Rc<Syntax>> {
        // A material of the file's takes the place of all those of models below, and without one they are back.
        if old.material.is_some() != new.material.is_some() && !self.holds_all(&new.children, scene) {
            return None;
        }
        match new.material {
            None => Some(leaf(Scalar::Null)),
            Some(id) => self.origins.material_name(id).map(text),
        }
    }

    fn holds_all(&self, nodes: &[NodeId], scene: &Scene) -> bool {
        let mut waiting = nodes.to_vec();
        while let Some(id) = waiting.pop() {
            if !self.origins.holds_node(id) {
                return false;
            }
            waiting.extend(&scene.node(id).children);
        }
        true
    }
}

fn is_same(old: &Node, new: &Node) -> bool {
    let Node { name, transform, material, shape, children, hidden } = old;
    (name, transform, material, children, hidden)
        == (&new.name, &new.transform, &new.material, &new.children, &new.hidden)
        && is_same_shape(shape.as_ref(), new.shape.as_ref())
}

/// Meshes are compared as a whole only where they are not shared.
fn is_same_shape(old: Option<&Shape>, new: Option<&Shape>) -> bool {
    match (old, new) {
        (Some(Shape::Mesh(old)), Some(Shape::Mesh(new))) if Arc::ptr_eq(old, new) => true,
        _ => old == new,
    }
}
