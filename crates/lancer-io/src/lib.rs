//! Bytes to scenes, and images to bytes.
//!
//! It knows neither traversal nor threads.

pub mod diagnostics;
pub mod limits;
pub mod resolver;
pub mod scene_file;

use diagnostics::Diagnostic;
use lancer_core::scene::Scene;

/// A scene that could be read, and what its author should know about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What is odd about the files, but does not keep the scene from being drawn.
    pub warnings: Vec<Diagnostic>,
}
