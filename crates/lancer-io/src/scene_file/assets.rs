//! What scene files refer to, as they see it.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::model::ModelOptions;
use lancer_core::scene::{ImageTexture, NodeId, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where the models and images come from that scene files refer to.
///
/// Each file is asked for once in a scene, however often it is referred to.
pub trait Assets {
    /// The file that `reference`, written in the file `from`, names.
    ///
    /// # Errors
    /// A message without a place, as of a path that leads nowhere or where it may not; the place of the reference
    /// is added to it.
    fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String>;

    /// Inserts the model in the file at `path` into `scene`, as one node that is not drawn by itself. `options` are
    /// what the scene file says of how it is to be read.
    ///
    /// The model's own materials are added to the scene and named by the nodes of its subtree. Where the scene
    /// file gives a material, the model is drawn from a copy of that subtree without them.
    ///
    /// # Errors
    /// The model cannot be read; told at the place of the reference, along with each diagnostic's own place.
    fn model(&mut self, scene: &mut Scene, path: &Path, options: &ModelOptions) -> Result<Model, LoadError>;

    /// The image in the file at `path`.
    ///
    /// # Errors
    /// The image cannot be read; told at the place of the reference.
    fn texture(&mut self, path: &Path) -> Result<Arc<ImageTexture>, LoadError>;
}

/// A model that was inserted into a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Model {
    /// All of it.
    pub root: NodeId,
    /// What is odd about its files.
    pub warnings: Vec<Diagnostic>,
}
