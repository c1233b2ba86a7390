//! What the dialog knows and how it reacts, without a picture of it.

use super::disk::{Entry, Fault, Found, look};
use crate::{Action, Phrase};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

#[cfg(test)]
mod tests;

/// What a file is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To show the scene in it.
    Open,
    /// To write a picture.
    SavePicture,
    /// To write a scene.
    SaveScene,
}

/// A directory that is one click away.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// What it is called; none shows the end of the path.
    pub name: Option<Phrase>,
    /// Where it is.
    pub path: PathBuf,
}

impl Place {
    /// The home and working directories, that of the open scene, and those of the files opened last, each once.
    pub fn usual(open: Option<&Path>, recent: &[PathBuf]) -> Vec<Self> {
        const HOME: Phrase = Phrase::new("Home", "Dossier personnel");
        const CURRENT: Phrase = Phrase::new("Current directory", "Dossier courant");
        const OPEN: Phrase = Phrase::new("Open scene", "Scène ouverte");
        let home = directories::UserDirs::new().map(|dirs| dirs.home_dir().to_owned());
        let directory_of = |path: &Path| path.parent().map(Path::to_owned);
        let named = [
            (Some(HOME), home),
            (Some(CURRENT), std::env::current_dir().ok()),
            (Some(OPEN), open.and_then(directory_of)),
        ];
        let recent = recent.iter().map(|path| (None, directory_of(path)));
        let mut places = Vec::<Self>::new();
        for (name, path) in named.into_iter().chain(recent) {
            let path =
                path.filter(|path| path.is_absolute() && !places.iter().any(|place| place.path == *path));
            places.extend(path.map(|path| Self { name, path }));
        }
        places
    }
}

/// How the dialog stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// A file is still to be chosen.
    Pending,
    /// This file.
    Picked(PathBuf),
}

/// The dialog, while it is open.
pub struct FilePicker {
    pub(super) purpose: Purpose,
    pub(super) places: Vec<Place>,
    /// The directory whose entries are shown.
    pub(super) directory: PathBuf,
    /// A name in that directory, or a path, as typed.
    pub(super) typed: String,
    pub(super) selected: Option<usize>,
    pub(super) shows_all: bool,
    pub(super) shows_hidden: bool,
    pub(super) fault: Option<Fault>,
    /// A file that is there already, until it is said whether to replace it.
    pub(super) to_replace: Option<PathBuf>,
    pub(super) is_cut: bool,
    entries: Vec<Entry>,
    looking: Option<Receiver<Result<Found, Fault>>>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl FilePicker {
    /// The dialog at a directory, with a proposed name. `wake` is called when the disk has answered.
    pub fn new(
        purpose: Purpose,
        directory: &Path,
        name: impl Into<String>,
        places: Vec<Place>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let mut picker = Self {
            purpose,
            places,
            directory: directory.to_owned(),
            typed: name.into(),
            selected: None,
            shows_all: false,
            shows_hidden: false,
            fault: None,
            to_replace: None,
            is_cut: false,
            entries: Vec::new(),
            looking: None,
            wake: Arc::new(wake),
        };
        picker.look_at(directory.to_owned());
        picker
    }

    /// The directory that is shown, to start from the next time.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// What is to be done with the chosen file.
    pub(super) fn action(&self, path: PathBuf) -> Action {
        match self.purpose {
            Purpose::Open => Action::OpenPath(path),
            Purpose::SavePicture => Action::SavePicture(path),
            Purpose::SaveScene => Action::SaveScene(path),
        }
    }

    /// The entries that are shown: no hidden ones, and no files of other kinds, unless they are asked for.
    pub(super) fn shown(&self) -> Vec<&Entry> {
        let extensions = self.purpose.extensions();
        let fits = |entry: &Entry| {
            let extension =
                entry.path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
            entry.is_directory || extension.is_some_and(|found| extensions.contains(&found.as_str()))
        };
        self.entries
            .iter()
            .filter(|entry| self.shows_hidden || !entry.name.starts_with('.'))
            .filter(|entry| self.shows_all || fits(entry))
            .collect()
    }

    /// Whether the disk has yet to answer.
    pub(super) fn is_waiting(&self) -> bool {
        self.looking.is_some()
    }

    /// Takes the disk's answer, if there is one.
    pub(super) fn poll(&mut self) -> Outcome {
        let answer = self.looking.as_ref().and_then(|looking| looking.try_recv().ok());
        match answer {
            Some(answer) => self.answered(answer),
            None => Outcome::Pending,
        }
    }

    fn answered(&mut self, answer: Result<Found, Fault>) -> Outcome {
        self.looking = None;
        match answer {
            Ok(Found::Directory { path, entries, is_cut }) => {
                // What was typed led here; a proposed name stays.
                if self.purpose == Purpose::Open
                    || resolve(&self.typed, &self.directory) == Some(path.clone())
                {
                    self.typed.clear();
                }
                (self.directory, self.entries, self.is_cut) = (path, entries, is_cut);
                self.selected = None;
            }
            Ok(Found::File(path)) if self.purpose == Purpose::Open => return Outcome::Picked(path),
            Ok(Found::File(path)) => self.to_replace = Some(path),
            Ok(Found::Nothing(path)) if self.purpose == Purpose::Open => {
                self.fault = Some(Fault::NoSuchFile(path));
            }
            Ok(Found::Nothing(path)) => return Outcome::Picked(path),
            Err(fault) => self.fault = Some(fault),
        }
        Outcome::Pending
    }

    /// Goes to a directory, or ends with a file. The latest wins.
    pub(super) fn look_at(&mut self, path: PathBuf) {
        (self.fault, self.to_replace) = (None, None);
        let (sender, receiver) = channel();
        let (purpose, wake) = (self.purpose, Arc::clone(&self.wake));
        let spawned = thread::Builder::new().name("file dialog".into()).spawn({
            let path = path.clone();
            move || {
                // Whoever asked may have gone on to another path.
                let _ = sender.send(look(&path, purpose));
                wake();
            }
        });
        match spawned {
            Ok(_) => self.looking = Some(receiver),
            Err(error) => self.fault = Some(Fault::Other(path, error.to_string())),
        }
    }

    /// Goes to the directory above.
    pub(super) fn up(&mut self) {
        if let Some(parent) = self.directory.parent().map(Path::to_owned) {
            self.look_at(parent);
        }
    }

    /// Takes what is selected or typed.
    pub(super) fn submit(&mut self) {
        let selected = self.selected.and_then(|i| self.shown().get(i).map(|entry| entry.path.clone()));
        match selected.or_else(|| resolve(&self.typed, &self.directory)) {
            Some(path) => self.look_at(path),
            None => self.fault = Some(Fault::NoName),
        }
    }

    /// What is typed has changed: it counts, and not what was selected before.
    pub(super) fn edited(&mut self) {
        (self.selected, self.fault, self.to_replace) = (None, None, None);
    }

    /// Selects an entry; a file's name is typed with it, so that it can be changed.
    pub(super) fn select(&mut self, index: usize) {
        let Some((name, is_directory)) =
            self.shown().get(index).map(|entry| (entry.name.clone(), entry.is_directory))
        else {
            return;
        };
        (self.fault, self.to_replace) = (None, None);
        self.selected = Some(index);
        if !is_directory {
            self.typed = name;
        }
    }

    /// Selects the entry so many further down, or up where it is negative.
    pub(super) fn move_selection(&mut self, by: isize) {
        let last = self.shown().len().saturating_sub(1);
        let next = match self.selected {
            Some(selected) => selected.saturating_add_signed(by).min(last),
            None if by > 0 => 0,
            None => last,
        };
        self.select(next);
    }

    /// Says yes to replacing the file that is there.
    pub(super) fn replace(&mut self) -> Outcome {
        self.to_replace.take().map_or(Outcome::Pending, Outcome::Picked)
    }
}

/// The path that is meant by what was typed or pasted: absolute, from `~`, or from the directory that is shown. None
/// for nothing.
pub(super) fn resolve(typed: &str, directory: &Path) -> Option<PathBuf> {
    let typed = typed.trim();
    let typed = typed.strip_prefix("file://").unwrap_or(typed);
    // As a path that is copied from a shell or a file manager may come.
    let typed = ['"', '\'']
        .iter()
        .find_map(|quote| typed.strip_prefix(*quote)?.strip_suffix(*quote))
        .unwrap_or(typed);
    if typed.is_empty() {
        return None;
    }
    let home = || directories::UserDirs::new().map(|dirs| dirs.home_dir().to_owned());
    let path = match typed.strip_prefix('~') {
        Some("") => home()?,
        Some(rest) if rest.starts_with(std::path::is_separator) => {
            home()?.join(rest.trim_start_matches(std::path::is_separator))
        }
        _ => directory.join(typed),
    };
    Some(without_dots(&path))
}

/// The path without `.` and `..`: those are for the one who types, not for titles and lists.
fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            component => plain.push(component),
        }
    }
    plain
}
