//! Where in its file each part of a scene stands.

use super::model::{MaterialReference, NodeFile, SceneFile};
use crate::scene_file::deserialize::Spanned;
use lancer_core::scene::{MaterialId, NodeId, Scene};
use std::collections::HashMap;

/// Which objects and materials of a scene its file holds, and by what paths an
/// [`Override`](super::Override) reaches them.
///
/// Not in the file are the parts of models, and not told are those of assets, which an object that has `use`
/// shares with others. A scene that comes from no scene file has none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origins {
    /// By the node's index.
    objects: HashMap<usize, Position>,
    /// By index; those beyond its end have none.
    materials: Vec<Option<MaterialOrigin>>,
}

/// The place of an object among `objects`, or among the `children` of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Position {
    /// By its index.
    parent: Option<usize>,
    index: u32,
}

/// Where a material stands.
#[derive(Clone, Debug, PartialEq, Eq)]
enum MaterialOrigin {
    /// Under `materials`, by this name.
    Named(String),
    /// In the object of the node of that index.
    InPlace(usize),
}

impl Origins {
    /// The origins of what `scene`, built from `file` without a fault, holds.
    pub(super) fn of(file: &SceneFile, scene: &Scene) -> Self {
        let named = file.materials.0.iter().map(|(name, _)| Some(MaterialOrigin::Named(name.value.clone())));
        let mut origins = Self { objects: HashMap::new(), materials: named.collect() };
        origins.materials.resize(scene.materials().len(), None);
        origins.add_objects(None, &file.objects, scene.roots(), scene);
        origins
    }

    /// Recurses as deep as objects are nested in the file.
    fn add_objects(
        &mut self,
        parent: Option<usize>,
        objects: &[Spanned<NodeFile>],
        nodes: &[NodeId],
        scene: &Scene,
    ) {
        for (index, (object, &id)) in (0..).zip(objects.iter().zip(nodes)) {
            self.objects.insert(id.index(), Position { parent, index });
            let node = scene.node(id);
            let is_in_place = |material: &Spanned<_>| matches!(material.value, MaterialReference::InPlace(_));
            if let Some(material) = node.material
                && object.value.material.as_ref().is_some_and(is_in_place)
            {
                self.materials[material.index()] = Some(MaterialOrigin::InPlace(id.index()));
            }
            // The node of a model or an asset comes first.
            if let Some(children) = &object.value.children
                && let Some(first) = node.children.len().checked_sub(children.len())
            {
                self.add_objects(Some(id.index()), children, &node.children[first..], scene);
            }
        }
    }

    /// Whether the file holds the object of this node.
    pub fn holds_node(&self, id: NodeId) -> bool {
        self.objects.contains_key(&id.index())
    }

    /// Whether the file holds this material.
    pub fn holds_material(&self, id: MaterialId) -> bool {
        self.material(id.index()).is_some()
    }

    /// The path of the object of the node of this index.
    pub(super) fn node_path(&self, node: usize) -> Option<Vec<String>> {
        let mut path = Vec::new();
        let mut next = Some(node);
        while let Some(node) = next {
            let Position { parent, index } = *self.objects.get(&node)?;
            path.push(index.to_string());
            path.push(if parent.is_some() { "children" } else { "objects" }.to_owned());
            next = parent;
        }
        path.reverse();
        Some(path)
    }

    /// The path of the material of this index.
    pub(super) fn material_path(&self, index: usize) -> Option<Vec<String>> {
        match self.material(index)? {
            MaterialOrigin::Named(name) => Some(vec!["materials".to_owned(), name.clone()]),
            MaterialOrigin::InPlace(object) => {
                let mut path = self.node_path(*object)?;
                path.push("material".to_owned());
                Some(path)
            }
        }
    }

    /// The name by which objects of the file may refer to a material.
    pub(super) fn material_name(&self, id: MaterialId) -> Option<&str> {
        match self.material(id.index())? {
            MaterialOrigin::Named(name) => Some(name),
            MaterialOrigin::InPlace(_) => None,
        }
    }

    fn material(&self, index: usize) -> Option<&MaterialOrigin> {
        self.materials.get(index)?.as_ref()
    }
}
