//! What is asked of the worker.

use super::alike::traces_alike;
use lancer_core::camera::Camera;
use lancer_core::scene::{Scene, Settings};
use lancer_core::world::CompileOptions;
use std::sync::Arc;

/// What is shown of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Channel {
    /// The ray-traced picture itself.
    #[default]
    Picture,
    /// How far the first surface is: near is bright, far is dark, nothing is black.
    Depth,
    /// The world normal of the first surface, turned to the eye, as a colour.
    Normals,
    /// A colour for each object.
    Objects,
    /// Ambient occlusion alone, as grey.
    Occlusion,
}

impl Channel {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 5] = [Self::Picture, Self::Depth, Self::Normals, Self::Objects, Self::Occlusion];
}

/// What the viewport is to show.
#[derive(Clone, Debug)]
pub struct ViewRequest {
    /// The scene. One that traces as the one before it is not compiled again.
    pub scene: Arc<Scene>,
    /// The scene's revision, told again with each [`Frame`](super::Frame).
    pub revision: u64,
    /// How the scene is compiled.
    pub options: CompileOptions,
    /// Threads that trace; 0 for one a core.
    pub threads: usize,
    /// From where.
    pub camera: Camera,
    /// The full settings; `width` and `height` are the viewport in physical pixels.
    pub settings: Settings,
    /// What of the scene.
    pub channel: Channel,
    /// Whether the next request is about to come: then there is one coarse image that keeps up, and no more.
    pub moving: bool,
}

impl ViewRequest {
    /// Whether the same world is traced for both.
    pub(super) fn same_world(&self, other: &Self) -> bool {
        self.options == other.options && traces_alike(&self.scene, &other.scene)
    }

    /// Whether both come to the same picture in the end. The number of threads changes no pixel, and neither do
    /// names nor tone in a scene.
    pub(super) fn same_picture(&self, other: &Self) -> bool {
        self.camera == other.camera
            && self.settings == other.settings
            && self.channel == other.channel
            && self.same_world(other)
    }
}

/// A picture to be made at a size of its own.
#[derive(Clone, Debug)]
pub struct RenderRequest {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The scene's revision, for whoever asked.
    pub revision: u64,
    /// How the scene is compiled.
    pub options: CompileOptions,
    /// Threads that trace; 0 for one a core.
    pub threads: usize,
    /// From where.
    pub camera: Camera,
    /// The size and all that decides the pixels.
    pub settings: Settings,
    /// What of the scene.
    pub channel: Channel,
}

/// Which render. Later ones compare as greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RenderId(pub(super) u64);
