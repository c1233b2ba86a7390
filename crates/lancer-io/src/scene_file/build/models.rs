//! Models of other files, each read once.

use super::{Builder, Warning, problems_of_reference};
use crate::model::ModelOptions;
use crate::scene_file::deserialize::Spanned;
use lancer_core::scene::{Node, NodeId, Scene};
use std::collections::HashMap;
use std::path::PathBuf;

/// The models that were asked for, by file; `None` for those that cannot be read.
pub(super) type Models = HashMap<PathBuf, Option<Placed>>;

/// A model in the scene.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    /// With its own materials.
    own: NodeId,
    /// Without any, made when first asked for.
    bare: Option<NodeId>,
}

impl Builder<'_> {
    /// The node of a model, with its own materials or without any. `None` where it cannot be read, which is told.
    pub(super) fn model(&mut self, reference: &Spanned<String>, bare: bool) -> Option<NodeId> {
        let path = self.source.resolve(reference).map_err(|problem| self.problems.push(problem)).ok()?;
        if !self.models.contains_key(&path) {
            let model = self.read_model(reference, &path);
            self.models.insert(path.clone(), model.map(|own| Placed { own, bare: None }));
        }
        let model = self.models.get_mut(&path)?.as_mut()?;
        if !bare {
            return Some(model.own);
        }
        let scene = &mut self.scene;
        Some(*model.bare.get_or_insert_with(|| copy_without_materials(scene, model.own)))
    }

    fn read_model(&mut self, reference: &Spanned<String>, path: &std::path::Path) -> Option<NodeId> {
        match self.source.assets.model(&mut self.scene, path, &ModelOptions::default()) {
            Ok(model) => {
                self.warnings.extend(model.warnings.into_iter().map(Warning::Elsewhere));
                Some(model.root)
            }
            Err(error) => {
                self.problems.extend(problems_of_reference(reference, &error));
                None
            }
        }
    }
}

/// A copy of a subtree that shares its meshes, but names no materials.
fn copy_without_materials(scene: &mut Scene, root: NodeId) -> NodeId {
    let mut copies = HashMap::new();
    let mut waiting = vec![root];
    while let Some(id) = waiting.pop() {
        if copies.contains_key(&id) {
            continue;
        }
        let node = scene.node(id).clone();
        waiting.extend(&node.children);
        copies.insert(id, scene.insert(Node { material: None, ..node }));
    }
    for &copy in copies.values() {
        for child in &mut scene.node_mut(copy).children {
            *child = copies[child];
        }
    }
    copies[&root]
}
