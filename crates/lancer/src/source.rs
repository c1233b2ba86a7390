//! Which scene is meant, and how it is read.

use crate::error::Error;
use lancer_gallery::BuiltinScene;
use lancer_io::diagnostics::{Diagnostic, LoadError};
use lancer_io::provenance::SceneSource;
use lancer_io::{LoadOptions, Loaded};
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

/// Where a scene comes from.
#[derive(Clone)]
pub(crate) enum Source {
    /// The gallery.
    Builtin(&'static dyn BuiltinScene),
    /// A scene file or a model.
    File(PathBuf),
}

impl Source {
    /// What the user means by SCENE; without it, the default scene.
    ///
    /// A built-in scene goes before a file of the same name, so that scripts mean the same in every directory;
    /// `./NAME` is the file.
    ///
    /// # Errors
    /// There is neither such a scene nor such a file.
    pub(crate) fn find(scene: Option<&OsStr>) -> Result<Self, Error> {
        let typed = scene.unwrap_or(OsStr::new(lancer_gallery::DEFAULT));
        let builtin = typed.to_str().and_then(lancer_gallery::find);
        match builtin {
            Some(builtin) => Ok(Self::Builtin(builtin)),
            None if Path::new(typed).exists() => Ok(Self::File(typed.into())),
            None => Err(not_found(typed)),
        }
    }

    /// Makes or reads the scene.
    ///
    /// # Errors
    /// All that is wrong with the files, or with the overrides.
    pub(crate) fn load(&self, options: &LoadOptions) -> Result<Loaded, LoadError> {
        match self {
            Self::File(path) => lancer_io::load(path, options),
            Self::Builtin(builtin) => {
                let mut scene = builtin.build();
                lancer_io::scene_file::apply_overrides(&mut scene, &options.overrides)?;
                Ok(scene.into())
            }
        }
    }

    /// The name without directory and extension, after which pictures are named.
    pub(crate) fn stem(&self) -> &OsStr {
        match self {
            Self::Builtin(builtin) => OsStr::new(builtin.name()),
            Self::File(path) => path.file_stem().unwrap_or(OsStr::new("picture")),
        }
    }

    /// What a picture says of where its scene comes from: of a file, the name alone.
    pub(crate) fn record(&self) -> SceneSource {
        match self {
            Self::Builtin(builtin) => SceneSource::Builtin(builtin.name().to_owned()),
            Self::File(path) => {
                let name = path.file_name().unwrap_or_default();
                SceneSource::File(name.to_string_lossy().into_owned())
            }
        }
    }

    /// Something wrong, or not quite right, with the scene as a whole.
    pub(crate) fn diagnostic(&self, message: impl fmt::Display) -> Diagnostic {
        Diagnostic::new(self.to_string(), message.to_string())
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

fn not_found(typed: &OsStr) -> Error {
    let path = Path::new(typed);
    let fault = Diagnostic::new(path, "there is no such file, and no such built-in scene");
    let hint = match nearest(path) {
        Some(meant) => format!("did you mean `{meant}`?"),
        None => "`lancer scenes` lists the built-in scenes".into(),
    };
    LoadError::from(fault.with_hint(hint)).into()
}

/// The built-in scene, or the file in the same directory, whose name is nearest to what was typed.
fn nearest(typed: &Path) -> Option<String> {
    let builtins = lancer_gallery::SCENES.iter().map(|scene| PathBuf::from(scene.name()));
    builtins
        .chain(siblings(typed))
        .filter_map(|candidate| Some((likeness(typed, &candidate)?, candidate)))
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, candidate)| candidate.display().to_string())
}

/// The files beside one that does not exist, named as it was: with its directory, or without.
fn siblings(typed: &Path) -> Vec<PathBuf> {
    let directory = typed.parent().unwrap_or(Path::new(""));
    let to_list = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    let entries = std::fs::read_dir(to_list).into_iter().flatten().flatten();
    entries.filter(|entry| entry.path().is_file()).map(|entry| directory.join(entry.file_name())).collect()
}

/// How alike two paths are; none where they are not enough to be taken for one another.
fn likeness(typed: &Path, candidate: &Path) -> Option<f64> {
    let lower = |path: &Path| path.to_string_lossy().to_lowercase();
    let likeness = strsim::jaro_winkler(&lower(typed), &lower(candidate));
    (likeness > LIKE_ENOUGH).then_some(likeness)
}

/// Whether one word may have been typed for the other.
pub(crate) fn are_alike(typed: &str, meant: &str) -> bool {
    likeness(Path::new(typed), Path::new(meant)).is_some()
}

/// Lets about one wrong letter in five through; untuned.
const LIKE_ENOUGH: f64 = 0.8;
