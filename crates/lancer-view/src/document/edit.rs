//! What can be changed in a scene, as values.

use crate::{Language, Phrase};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::Transform;
use lancer_core::scene::{Light, Material, MaterialId, NodeId, Scene, Settings};
use std::mem;

/// A change: what is changed, and the value that it gets.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// What to render.
    Settings(Settings),
    /// How radiance is shown.
    Tone(Tone),
    /// L_a.
    Ambient(Rgb),
    /// The radiance of a ray that meets nothing.
    Background(Rgb),
    /// A material, whole.
    Material(MaterialId, Box<Material>),
    /// All lights: one is added, removed or moved in the list.
    Lights(Vec<Light>),
    /// A light, by its place in the list.
    Light(usize, Light),
    /// From a node's space to its parent's.
    Transform(NodeId, Transform),
    /// Whether a node and all below it are left out.
    Hidden(NodeId, bool),
    /// The material of a node, or none to inherit it.
    NodeMaterial(NodeId, Option<MaterialId>),
    /// What a node is called.
    NodeName(NodeId, String),
    /// The scene's own camera.
    SceneCamera(Camera),
}

/// What an edit changes, to be named in a menu or a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EditKind {
    /// What to render.
    Settings,
    /// How radiance is shown.
    Tone,
    /// L_a.
    Ambient,
    /// The radiance of a ray that meets nothing.
    Background,
    /// A material.
    Material,
    /// The list of lights.
    Lights,
    /// A light.
    Light,
    /// The transform of a node.
    Transform,
    /// Whether a node is hidden.
    Hidden,
    /// Which material a node has.
    NodeMaterial,
    /// What a node is called.
    NodeName,
    /// The scene's own camera.
    SceneCamera,
    /// Everything, back to what was loaded or saved.
    Revert,
}

impl EditKind {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Settings,
        Self::Tone,
        Self::Ambient,
        Self::Background,
        Self::Material,
        Self::Lights,
        Self::Light,
        Self::Transform,
        Self::Hidden,
        Self::NodeMaterial,
        Self::NodeName,
        Self::SceneCamera,
        Self::Revert,
    ];

    /// Its name, to stand after "Undo" or alone.
    pub const fn name(self) -> Phrase {
        match self {
            Self::Settings => Phrase::new("Render Settings", "Réglages du rendu"),
            Self::Tone => Phrase::new("Tone", "Tons"),
            Self::Ambient => Phrase::new("Ambient Light", "Lumière ambiante"),
            Self::Background => Phrase::new("Background", "Arrière-plan"),
            Self::Material => Phrase::new("Material", "Matériau"),
            Self::Lights => Phrase::new("Lights", "Lumières"),
            Self::Light => Phrase::new("Light", "Lumière"),
            Self::Transform => Phrase::new("Transform", "Transformation"),
            Self::Hidden => Phrase::new("Visibility", "Visibilité"),
            Self::NodeMaterial => Phrase::new("Choice of Material", "Choix du matériau"),
            Self::NodeName => Phrase::new("Name", "Nom"),
            Self::SceneCamera => Phrase::new("Camera", "Caméra"),
            Self::Revert => Phrase::new("Revert", "Retour à l’original"),
        }
    }

    /// "Undo Material".
    pub fn undo_text(self, language: Language) -> String {
        format!("{}{}", language.say(Phrase::new("Undo ", "Annuler : ")), language.say(self.name()))
    }

    /// "Redo Material".
    pub fn redo_text(self, language: Language) -> String {
        format!("{}{}", language.say(Phrase::new("Redo ", "Rétablir : ")), language.say(self.name()))
    }
}

impl Edit {
    /// What it changes.
    pub fn kind(&self) -> EditKind {
        match self {
            Self::Settings(_) => EditKind::Settings,
            Self::Tone(_) => EditKind::Tone,
            Self::Ambient(_) => EditKind::Ambient,
            Self::Background(_) => EditKind::Background,
            Self::Material(..) => EditKind::Material,
            Self::Lights(_) => EditKind::Lights,
            Self::Light(..) => EditKind::Light,
            Self::Transform(..) => EditKind::Transform,
            Self::Hidden(..) => EditKind::Hidden,
            Self::NodeMaterial(..) => EditKind::NodeMaterial,
            Self::NodeName(..) => EditKind::NodeName,
            Self::SceneCamera(_) => EditKind::SceneCamera,
        }
    }

    /// Whether both change the same value, so that the later of them alone decides it.
    pub(super) fn has_target_of(&self, other: &Self) -> bool {
        self.kind() == other.kind() && self.index() == other.index()
    }

    /// Which node, material or light it changes.
    fn index(&self) -> Option<usize> {
        match self {
            Self::Material(id, _) => Some(id.index()),
            Self::Light(index, _) => Some(*index),
            Self::Transform(id, _)
            | Self::Hidden(id, _)
            | Self::NodeMaterial(id, _)
            | Self::NodeName(id, _) => Some(id.index()),
            _ => None,
        }
    }

    /// Whether the scene has what it changes, with another value.
    pub(super) fn would_change(&self, scene: &Scene) -> bool {
        let node = |id: &NodeId| scene.nodes().get(id.index());
        match self {
            Self::Settings(value) => scene.settings != *value,
            Self::Tone(value) => scene.tone != *value,
            Self::Ambient(value) => scene.ambient != *value,
            Self::Background(value) => scene.background != *value,
            Self::Material(id, value) => scene.materials().get(id.index()).is_some_and(|old| *old != **value),
            Self::Lights(value) => scene.lights != *value,
            Self::Light(index, value) => scene.lights.get(*index).is_some_and(|old| old != value),
            Self::Transform(id, value) => node(id).is_some_and(|node| node.transform != *value),
            Self::Hidden(id, value) => node(id).is_some_and(|node| node.hidden != *value),
            Self::NodeMaterial(id, value) => node(id).is_some_and(|node| node.material != *value),
            Self::NodeName(id, value) => node(id).is_some_and(|node| node.name != *value),
            Self::SceneCamera(value) => scene.camera != *value,
        }
    }

    /// Exchanges its value with the scene's: the edit is then its own inverse.
    ///
    /// # Panics
    /// Where the scene has not what it changes; see [`Edit::would_change`].
    pub(super) fn swap(&mut self, scene: &mut Scene) {
        match self {
            Self::Settings(value) => mem::swap(value, &mut scene.settings),
            Self::Tone(value) => mem::swap(value, &mut scene.tone),
            Self::Ambient(value) => mem::swap(value, &mut scene.ambient),
            Self::Background(value) => mem::swap(value, &mut scene.background),
            Self::Material(id, value) => mem::swap(&mut **value, &mut scene.materials_mut()[id.index()]),
            Self::Lights(value) => mem::swap(value, &mut scene.lights),
            Self::Light(index, value) => mem::swap(value, &mut scene.lights[*index]),
            Self::Transform(id, value) => mem::swap(value, &mut scene.node_mut(*id).transform),
            Self::Hidden(id, value) => mem::swap(value, &mut scene.node_mut(*id).hidden),
            Self::NodeMaterial(id, value) => mem::swap(value, &mut scene.node_mut(*id).material),
            Self::NodeName(id, value) => mem::swap(value, &mut scene.node_mut(*id).name),
            Self::SceneCamera(value) => mem::swap(value, &mut scene.camera),
        }
    }
}
