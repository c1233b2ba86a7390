//! Which files a scene may open: those in its own directory and below, unless the user allows more.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::package::Packed;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Turns references written in files into files that may be opened.
#[derive(Clone, Debug)]
pub struct Resolver {
    root: PathBuf,
    allow_outside: bool,
    /// How much a file may ask for.
    pub limits: Limits,
    /// The packed file that is being read.
    packed: Option<Arc<Packed>>,
}

impl Resolver {
    /// A resolver for the file at `path`, which the user named and which may lie anywhere. What it refers to
    /// must lie in its directory or below, symbolic links followed, unless `allow_outside`.
    pub fn for_file(path: &Path, allow_outside: bool, limits: Limits) -> Self {
        Self { root: directory_of(path), allow_outside, limits, packed: None }
    }

    /// The resolver for what is in a packed file.
    pub(crate) fn within(&self, packed: Packed) -> Self {
        Self { packed: Some(Arc::new(packed)), ..self.clone() }
    }

    /// The file that `reference`, written in the file `from`, names: relative to the directory of `from`.
    ///
    /// # Errors
    /// A message without a place: the reference leaves the root, or names no file.
    pub fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String> {
        if reference.trim().is_empty() {
            return Err("the path is empty".into());
        }
        if let Some(resolved) = self.packed.as_ref().and_then(|packed| packed.resolve(from, reference)) {
            return resolved;
        }
        let portable = reference.replace('\\', "/");
        let path = directory_of(from).join(&portable);
        let found =
            path.canonicalize().map_err(|error| format!("cannot open `{reference}`: {}", reason(&error)))?;
        if !self.allow_outside {
            let root = self.root.canonicalize().map_err(|error| reason(&error))?;
            if !found.starts_with(&root) {
                return Err(format!("`{reference}` lies outside of the scene's directory"));
            }
        }
        if !found.is_file() {
            return Err(format!("`{reference}` is not a file"));
        }
        Ok(path)
    }

    /// The bytes of a file, no more than the limit.
    ///
    /// # Errors
    /// It cannot be read, or is too long.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, LoadError> {
        if let Some(read) = self.packed.as_ref().and_then(|packed| packed.read(path, &self.limits)) {
            return read.map_err(|message| LoadError::new(path, message));
        }
        let failed =
            |error: std::io::Error| LoadError::new(path, format!("cannot be read: {}", reason(&error)));
        // Asked before it is opened: to open a pipe would wait for whoever writes to it.
        if !std::fs::metadata(path).map_err(failed)?.is_file() {
            return Err(LoadError::new(path, "is not a file"));
        }
        let file = File::open(path).map_err(failed)?;
        let mut bytes = Vec::new();
        let limit = self.limits.file_bytes;
        file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > limit {
            return Err(Diagnostic::new(path, format!("is longer than {limit} bytes")).into());
        }
        Ok(bytes)
    }
}

/// An operating system's error in its own words, without the number.
pub fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_lowercase()
}

fn directory_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}
