//! Which files a scene may open: those in its own directory and below, unless the user allows more; or those that a
//! program holds in memory.

use crate::account::Account;
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::package::Packed;
use crate::progress::ReadProgress;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Turns references written in files into files that may be opened.
///
/// One is made for a scene or a model and all that it refers to: what is read through a resolver and its copies is
/// bounded together.
#[derive(Clone, Debug)]
pub struct Resolver {
    store: Store,
    /// How much a file may ask for.
    pub limits: Limits,
    /// The packed file that is being read.
    packed: Option<Arc<Packed>>,
    /// Hears how far the reading of a model is.
    pub progress: ReadProgress,
    account: Arc<Account>,
}

/// Where files are.
#[derive(Clone, Debug)]
enum Store {
    /// On disk; those outside of `root` may be opened only if `allow_outside`.
    Disk { root: PathBuf, allow_outside: bool },
    /// Here and nowhere else.
    Memory(Arc<BTreeMap<PathBuf, Vec<u8>>>),
}

impl Resolver {
    /// A resolver for the file at `path`, which the user named and which may lie anywhere. What it refers to
    /// must lie in its directory or below, symbolic links followed, unless `allow_outside`.
    pub fn for_file(path: &Path, allow_outside: bool, limits: Limits) -> Self {
        Self::over(Store::Disk { root: directory_of(path), allow_outside }, limits)
    }

    /// A resolver for files that a program holds in memory; nothing on disk is opened.
    ///
    /// Paths are relative, of names alone (`chairs/stool.obj`); none leads out of the directory that they begin in.
    ///
    /// ```
    /// use lancer_io::limits::Limits;
    /// use lancer_io::model::{ModelOptions, load};
    /// use lancer_io::resolver::Resolver;
    ///
    /// let stool = b"mtllib wood.mtl\nusemtl oak\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
    /// let wood = b"newmtl oak\nKd 0.5 0.3 0.1\n".to_vec();
    /// let files = [("stool.obj".into(), stool), ("wood.mtl".into(), wood)];
    /// let resolver = Resolver::in_memory(files, Limits::default());
    /// let model = load("stool.obj".as_ref(), &resolver, &ModelOptions::default())?;
    /// assert_eq!(model.materials.len(), 1);
    /// # Ok::<(), lancer_io::diagnostics::LoadError>(())
    /// ```
    pub fn in_memory(files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>, limits: Limits) -> Self {
        Self::over(Store::Memory(Arc::new(files.into_iter().collect())), limits)
    }

    fn over(store: Store, limits: Limits) -> Self {
        Self { store, limits, packed: None, progress: ReadProgress::default(), account: Arc::default() }
    }

    /// The resolver for what is in a packed file.
    pub(crate) fn within(&self, packed: Packed) -> Self {
        // Only the model is granted less: files beside a packed one are not packed.
        let limits = Limits { memory: self.limits.of_packed(packed.length()).memory, ..self.limits };
        Self { packed: Some(Arc::new(packed)), limits, ..self.clone() }
    }

    /// What has been read so far.
    pub(crate) fn account(&self) -> &Account {
        &self.account
    }

    /// A path that is the same for all names of a file that [`resolve`](Self::resolve) found.
    pub(crate) fn identity(&self, path: &Path) -> PathBuf {
        match self.store {
            Store::Disk { .. } => path.canonicalize().unwrap_or_else(|_| path.to_owned()),
            // Names in memory and in archives are made plain when they are resolved.
            Store::Memory(_) => path.to_owned(),
        }
    }

    /// The file that `reference`, written in the file `from`, names: relative to the directory of `from`.
    ///
    /// # Errors
    /// A message without a place: the reference leaves the root, or names no file.
    pub fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String> {
        if reference.trim().is_empty() {
            return Err("the path is empty".into());
        }
        if reference.len() > LONGEST_REFERENCE {
            return Err(format!("the path is longer than {LONGEST_REFERENCE} bytes"));
        }
        if let Some(resolved) = self.packed.as_ref().and_then(|packed| packed.resolve(from, reference)) {
            return resolved;
        }
        let (root, allow_outside) = match &self.store {
            Store::Disk { root, allow_outside } => (root, *allow_outside),
            Store::Memory(files) => {
                let path = path_below(directory_of(from).as_path(), reference)
                    .ok_or_else(|| format!("`{reference}` lies outside of the scene's directory"))?;
                return match files.contains_key(&path) {
                    true => Ok(path),
                    false => Err(format!("cannot open `{reference}`: no such file")),
                };
            }
        };
        let portable = reference.replace('\\', "/");
        let path = directory_of(from).join(&portable);
        let found =
            path.canonicalize().map_err(|error| format!("cannot open `{reference}`: {}", reason(&error)))?;
        if !allow_outside {
            let root = root.canonicalize().map_err(|error| reason(&error))?;
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
        let bytes = self.read_unpacked(path)?;
        self.account.read(self.identity(path), bytes.len() as u64);
        Ok(bytes)
    }

    fn read_unpacked(&self, path: &Path) -> Result<Vec<u8>, LoadError> {
        let limit = self.limits.file_bytes;
        let too_long = || -> LoadError {
            let error = Diagnostic::new(path, format!("is longer than {limit} bytes"));
            error.with_hint("--limit file-bytes=N allows longer ones").into()
        };
        if let Store::Memory(files) = &self.store {
            let bytes =
                files.get(path).ok_or_else(|| LoadError::new(path, "cannot be read: no such file"))?;
            return if bytes.len() as u64 > limit { Err(too_long()) } else { Ok(bytes.clone()) };
        }
        let failed =
            |error: std::io::Error| LoadError::new(path, format!("cannot be read: {}", reason(&error)));
        // Asked before it is opened: to open a pipe would wait for whoever writes to it.
        let metadata = std::fs::metadata(path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(LoadError::new(path, "is not a file"));
        }
        let file = File::open(path).map_err(failed)?;
        // One more than there should be, so that the end is seen without growing.
        let mut bytes = Vec::with_capacity(metadata.len().min(limit) as usize + 1);
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > limit {
            return Err(too_long());
        }
        Ok(bytes)
    }
}

/// As long as the longest path that systems take.
const LONGEST_REFERENCE: usize = 4096;

/// An operating system's error in its own words, without the number.
pub fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_lowercase()
}

/// The path of `reference`, as written in a file of `folder`, without `.` and `..`; `None` where it is absolute or leads
/// out of the directory that `folder` is relative to.
pub(crate) fn path_below(folder: &Path, reference: &str) -> Option<PathBuf> {
    let portable = reference.replace('\\', "/");
    let mut found = PathBuf::new();
    for component in folder.join(&portable).components() {
        match component {
            Component::Normal(name) => found.push(name),
            Component::CurDir => {}
            Component::ParentDir if found.pop() => {}
            _ => return None,
        }
    }
    Some(found)
}

fn directory_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_memory(names: &[&str], limits: Limits) -> Resolver {
        Resolver::in_memory(names.iter().map(|name| (PathBuf::from(name), name.as_bytes().to_vec())), limits)
    }

    #[test]
    fn files_in_memory_are_found_from_the_file_that_names_them() {
        let resolver = in_memory(&["a/model.obj", "a/m.mtl", "t.png"], Limits::default());
        let resolve = |reference| resolver.resolve(Path::new("a/model.obj"), reference);
        assert_eq!(resolve("m.mtl"), Ok("a/m.mtl".into()));
        assert_eq!(resolve("./b/..\\../t.png"), Ok("t.png".into()));
        assert_eq!(resolver.read(Path::new("a/m.mtl")).unwrap(), b"a/m.mtl");
    }

    #[test]
    fn nothing_but_the_files_in_memory_is_opened() {
        let resolver = in_memory(&["model.obj"], Limits::default());
        let resolve = |reference| resolver.resolve(Path::new("model.obj"), reference).unwrap_err();
        assert_eq!(resolve("../model.obj"), "`../model.obj` lies outside of the scene's directory");
        assert_eq!(resolve("/dev/null"), "`/dev/null` lies outside of the scene's directory");
        assert_eq!(resolve("m.mtl"), "cannot open `m.mtl`: no such file");
        // A file of the directory that the test runs in.
        assert_eq!(resolve("Cargo.toml"), "cannot open `Cargo.toml`: no such file");
        let error = resolver.read(Path::new("Cargo.toml")).unwrap_err();
        assert_eq!(error.to_string(), "Cargo.toml: cannot be read: no such file");
    }

    #[test]
    fn limits_hold_for_files_in_memory() {
        let resolver = in_memory(&["model.obj"], Limits { file_bytes: 8, ..Limits::default() });
        let error = resolver.read(Path::new("model.obj")).unwrap_err();
        let message = "model.obj: is longer than 8 bytes\nhint: --limit file-bytes=N allows longer ones";
        assert_eq!(error.to_string(), message);
    }
}
