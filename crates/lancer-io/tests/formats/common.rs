//! Files in a directory of their own, and what is asked of the models in them.

use lancer_io::diagnostics::LoadError;
use lancer_io::limits::Limits;
use lancer_io::model::{self, Crease, Model, ModelOptions};
use lancer_io::resolver::Resolver;
use proptest::prelude::*;
use std::fmt::Display;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A directory with files, that of the model being `models/<name>`.
pub(crate) struct Files(TempDir);

impl Files {
    pub(crate) fn new() -> Self {
        let files = Self(TempDir::new().unwrap());
        fs::create_dir(files.0.path().join("models")).unwrap();
        files
    }

    pub(crate) fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
        self
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join("models").join(name)
    }

    /// A path beside the model's directory.
    pub(crate) fn outside(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn load(&self, name: &str) -> Result<Model, LoadError> {
        self.load_within(name, Limits::default())
    }

    pub(crate) fn load_smoothed(&self, name: &str, degrees: f64) -> Result<Model, LoadError> {
        let path = self.path(name);
        let options = ModelOptions { crease: Crease::from_degrees(degrees) };
        model::load(&path, &Resolver::for_file(&path, false, Limits::default()), &options)
    }

    pub(crate) fn load_within(&self, name: &str, limits: Limits) -> Result<Model, LoadError> {
        let path = self.path(name);
        model::load(&path, &Resolver::for_file(&path, false, limits), &ModelOptions::default())
    }
}

/// The model in a file of its own.
pub(crate) fn load(name: &str, bytes: impl AsRef<[u8]>) -> Result<Model, LoadError> {
    Files::new().with(name, bytes).load(name)
}

/// An error or a warning without the directory and the lines that follow.
pub(crate) fn first_line(diagnostic: impl Display + Copy) -> String {
    let text = diagnostic.to_string();
    let line = text.lines().next().unwrap();
    line.rsplit_once("/models/").map_or(line, |(_, rest)| rest).to_owned()
}

pub(crate) fn error_of(result: Result<Model, LoadError>) -> String {
    first_line(&result.unwrap_err())
}

pub(crate) fn warnings_of(model: &Model) -> Vec<String> {
    model.warnings.iter().map(first_line).collect()
}

/// The area of all parts, each counted once.
pub(crate) fn area(model: &Model) -> f64 {
    let double = |mesh: &lancer_core::mesh::Mesh, triangle| {
        let [a, b, c] = mesh.corners(triangle);
        (b - a).cross(c - a).length()
    };
    let of_part = |part: &model::ModelPart| {
        (0..part.mesh.triangle_count() as u32).map(|triangle| double(&part.mesh, triangle)).sum::<f64>() * 0.5
    };
    model.parts.iter().map(of_part).sum()
}

/// Bytes to be changed: where, and what to.
pub(crate) fn mutations() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)
}

/// The bytes with some changed, and perhaps cut off.
pub(crate) fn mutated(bytes: &[u8], mutations: &[(prop::sample::Index, u8)], cut: bool) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for (place, byte) in mutations {
        let place = place.index(bytes.len());
        bytes[place] = *byte;
    }
    if cut {
        bytes.truncate(mutations[0].0.index(bytes.len()));
    }
    bytes
}
