//! A stand for the file system, and what every test here does.

use lancer_core::geometry::{DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{ImageTexture, Material, Node, NodeId, Scene};
use lancer_io::Loaded;
use lancer_io::diagnostics::{Diagnostic, LoadError};
use lancer_io::limits::Limits;
use lancer_io::model::ModelOptions;
use lancer_io::scene_file::{Assets, Model, Override, read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Has `bunny.obj`, a group of one mesh with its own material; `broken.obj`, which is none; and `wood.png`.
#[derive(Default)]
pub(crate) struct Shelf {
    pub(crate) models_read: usize,
    pub(crate) textures_read: usize,
}

impl Assets for Shelf {
    fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String> {
        assert_eq!(from, Path::new("dir/scene.yaml"));
        match reference {
            "bunny.obj" | "./bunny.obj" => Ok("shelf/bunny.obj".into()),
            "broken.obj" | "wood.png" => Ok(Path::new("shelf").join(reference)),
            _ => Err(format!("cannot open `{reference}`: no such file or directory")),
        }
    }

    fn model(&mut self, scene: &mut Scene, path: &Path, _: &ModelOptions) -> Result<Model, LoadError> {
        self.models_read += 1;
        if path.ends_with("broken.obj") {
            return Err(Diagnostic::new(path, "a face has 2 corners").at(7, 3).into());
        }
        let fur = scene.add_material(Material::named("fur"));
        let mesh = scene.insert(Node::mesh("body", triangle()).with_material(fur));
        let root = scene.insert(Node::group("bunny", [mesh]));
        Ok(Model { root, warnings: vec![Diagnostic::new(path, "the bunny has no normals")] })
    }

    fn texture(&mut self, _: &Path) -> Result<Arc<ImageTexture>, LoadError> {
        self.textures_read += 1;
        Ok(wood())
    }
}

pub(crate) fn triangle() -> Mesh {
    Mesh::new(MeshData {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        indices: vec![[0, 1, 2]],
        ..MeshData::default()
    })
    .unwrap()
}

pub(crate) fn wood() -> Arc<ImageTexture> {
    Arc::new(ImageTexture::new(1, 1, vec![[120, 80, 40]]).unwrap())
}

pub(crate) fn load_bytes(bytes: &[u8], edits: &[&str]) -> Result<Loaded, LoadError> {
    load_with(bytes, edits, &mut Shelf::default())
}

pub(crate) fn load_with(bytes: &[u8], edits: &[&str], shelf: &mut Shelf) -> Result<Loaded, LoadError> {
    let edits = edits.iter().map(|edit| edit.parse().unwrap()).collect::<Vec<Override>>();
    read(Path::new("dir/scene.yaml"), bytes, &edits, shelf, &Limits::default())
}

/// The scene of a file without faults.
pub(crate) fn scene(text: &str) -> Scene {
    load_bytes(text.as_bytes(), &[]).unwrap_or_else(|error| panic!("{error}")).scene
}

/// The errors of a file, each as `line:column: message`, after checking that each shows its line.
pub(crate) fn errors(text: &str) -> Vec<String> {
    errors_of_bytes(text.as_bytes())
}

pub(crate) fn errors_of_bytes(bytes: &[u8]) -> Vec<String> {
    let error = load_bytes(bytes, &[]).expect_err("the file is at fault");
    assert!(!error.diagnostics.is_empty());
    error
        .diagnostics
        .iter()
        .map(|diagnostic| {
            assert_eq!(diagnostic.file, Path::new("dir/scene.yaml"));
            let at = diagnostic.location.unwrap_or_else(|| panic!("`{diagnostic}` has no place"));
            format!("{}:{}: {}", at.line, at.column, diagnostic.message)
        })
        .collect()
}

/// The one error of a file: its place and message, and its hint.
pub(crate) fn the_error(text: &str) -> (String, Option<String>) {
    let error = load_bytes(text.as_bytes(), &[]).expect_err("the file is at fault");
    let message = errors(text);
    assert_eq!(message.len(), 1, "{message:#?}");
    (message[0].clone(), error.diagnostics[0].hint.clone())
}

pub(crate) fn warnings(text: &str) -> Vec<String> {
    load_bytes(text.as_bytes(), &[]).unwrap().warnings.into_iter().map(|warning| warning.message).collect()
}

/// The shapes of a scene with their names, global transforms and materials, in drawing order.
pub(crate) fn drawn(scene: &Scene) -> Vec<(String, Transform, Option<String>)> {
    fn walk(
        scene: &Scene,
        id: NodeId,
        outer: Transform,
        material: Option<&str>,
        found: &mut Vec<(String, Transform, Option<String>)>,
    ) {
        let node = scene.node(id);
        let transform = node.transform.then(outer);
        let material = node.material.map(|id| scene.material(id).name.as_str()).or(material);
        if node.shape.is_some() {
            found.push((node.name.clone(), transform, material.map(str::to_owned)));
        }
        for &child in &node.children {
            walk(scene, child, transform, material, found);
        }
    }
    let mut found = Vec::new();
    for &root in scene.roots() {
        walk(scene, root, Transform::IDENTITY, None, &mut found);
    }
    found
}

pub(crate) fn vector(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}
