//! Scenes to files that stand alone.
//!
//! In: any scene, be it built in, read from a model or edited. Out: a scene file, and beside it a folder with its
//! meshes and images, which read back as a scene that gives the same picture, byte for byte. `tree` says the scene
//! as a syntax tree, `parts` names the files of what a text cannot hold. The text is read back before anything is
//! written.

mod parts;
mod tree;

use super::syntax::{Language, block, flow};
use super::{Assets, Model, read};
use crate::diagnostics::LoadError;
use crate::limits::Limits;
use crate::model::ModelOptions;
use crate::output::{WriteError, write_atomically};
use lancer_core::scene::{ImageTexture, Node, Scene};
use parts::{Part, Parts};
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes a scene as a file that needs nothing but the folder beside it, `<stem>-files`, where the meshes are as PLY
/// and the images as PNG.
///
/// What is written reads back as the same picture, byte for byte; nodes that draw nothing, names of materials that
/// are not unique, and the like may differ. Files in the folder are named by what is in them, so that those that a
/// former version of the scene file uses stay as they are; the scene file itself is written last, whole or not at
/// all.
///
/// # Errors
/// The scene is not one that can be read, as one that draws nothing or has a transform that flattens an object; or the
/// directory does not exist, or a file cannot be written. The scene file is then as it was.
pub fn write_whole(scene: &Scene, path: &Path) -> Result<(), WriteError> {
    let failed = |source| WriteError { path: path.to_owned(), source };
    let folder = folder_beside(path).ok_or_else(|| failed(invalid("the path names no file")))?;
    let parts = Parts::of(scene, &folder).map_err(failed)?;
    let tree = tree::of_scene(scene, &parts);
    let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let text = if is_json { flow(&tree, Language::Json) + "\n" } else { block(&tree) };
    check(path, &text, &parts).map_err(|error| failed(invalid(&error.to_string())))?;

    let directory = path.with_file_name(&folder);
    if !parts.is_empty() {
        make_directory(&directory).map_err(|source| WriteError { path: directory.clone(), source })?;
    }
    for part in parts.iter() {
        part.write(&directory)?;
    }
    write_atomically(path, |out| out.write_all(text.as_bytes()))
}

fn folder_beside(path: &Path) -> Option<String> {
    Some(format!("{}-files", path.file_stem()?.to_string_lossy()))
}

/// Makes a directory in one that is there, unless it is there already.
fn make_directory(path: &Path) -> io::Result<()> {
    match fs::create_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => Ok(()),
        other => other,
    }
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// Reads the text as it will be read, with the parts from memory.
fn check(path: &Path, text: &str, parts: &Parts) -> Result<(), LoadError> {
    let by_reference = parts.iter().map(|part| (part.reference(), part)).collect();
    read(path, text.as_bytes(), &[], &mut InMemory { by_reference }, &Limits::default()).map(|_| ())
}

/// Parts that are not written yet.
struct InMemory<'a> {
    by_reference: HashMap<&'a str, &'a Part>,
}

impl InMemory<'_> {
    fn part(&self, path: &Path) -> Result<&Part, LoadError> {
        let found = path.to_str().and_then(|reference| self.by_reference.get(reference));
        found.copied().ok_or_else(|| LoadError::new(path, "is no part of the scene"))
    }
}

impl Assets for InMemory<'_> {
    fn resolve(&self, _: &Path, reference: &str) -> Result<PathBuf, String> {
        Ok(reference.into())
    }

    fn model(&mut self, scene: &mut Scene, path: &Path, _: &ModelOptions) -> Result<Model, LoadError> {
        let Part::Mesh { mesh, .. } = self.part(path)? else {
            return Err(LoadError::new(path, "is no mesh"));
        };
        let root = scene.insert(Node::mesh("", Arc::clone(mesh)));
        Ok(Model { root, warnings: Vec::new() })
    }

    fn texture(&mut self, path: &Path) -> Result<Arc<ImageTexture>, LoadError> {
        match self.part(path)? {
            Part::Image { image, .. } => Ok(Arc::clone(image)),
            Part::Mesh { .. } => Err(LoadError::new(path, "is no image")),
        }
    }
}
