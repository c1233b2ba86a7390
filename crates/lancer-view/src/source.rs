//! Where a scene comes from.

use lancer_gallery::BuiltinScene;
use lancer_io::diagnostics::LoadError;
use lancer_io::provenance::SceneSource;
use lancer_io::{LoadOptions, Loaded};
use std::fmt;
use std::path::{Path, PathBuf};

/// A built-in scene, or a file.
#[derive(Clone)]
pub enum Source {
    /// The gallery.
    Builtin(&'static dyn BuiltinScene),
    /// A scene file or a model.
    File(PathBuf),
}

impl Source {
    /// Makes or reads the scene.
    ///
    /// # Errors
    /// All that is wrong with the files, or with the overrides.
    pub fn load(&self, options: &LoadOptions) -> Result<Loaded, LoadError> {
        match self {
            Self::File(path) => lancer_io::load(path, options),
            Self::Builtin(builtin) => {
                let mut scene = builtin.build();
                lancer_io::scene_file::apply_overrides(&mut scene, &options.overrides)?;
                Ok(scene.into())
            }
        }
    }

    /// The name without directory, for a list or a title.
    pub fn title(&self) -> String {
        match self {
            Self::Builtin(builtin) => builtin.name().to_owned(),
            Self::File(path) => {
                path.file_name().map_or_else(|| self.to_string(), |name| name.to_string_lossy().into_owned())
            }
        }
    }

    /// The name without directory and extension, after which pictures are named.
    pub fn stem(&self) -> String {
        match self {
            Self::Builtin(builtin) => builtin.name().to_owned(),
            Self::File(path) => path
                .file_stem()
                .map_or_else(|| "picture".to_owned(), |stem| stem.to_string_lossy().into_owned()),
        }
    }

    /// What a picture says of where its scene comes from: of a file, the name alone.
    pub fn record(&self) -> SceneSource {
        match self {
            Self::Builtin(_) => SceneSource::Builtin(self.title()),
            Self::File(_) => SceneSource::File(self.title()),
        }
    }

    /// The file, if it is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Builtin(_) => None,
            Self::File(path) => Some(path),
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Builtin(builtin) => f.write_str(builtin.name()),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Builtin(builtin) => f.debug_tuple("Builtin").field(&builtin.name()).finish(),
            Self::File(path) => f.debug_tuple("File").field(path).finish(),
        }
    }
}

impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Builtin(a), Self::Builtin(b)) => a.name() == b.name(),
            (Self::File(a), Self::File(b)) => a == b,
            _ => false,
        }
    }
}

impl Eq for Source {}
