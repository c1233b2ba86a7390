//! What the dialog knows and how it reacts, without a picture of it.

use super::disk::{Entry, Fault, Found, look};
use crate::{Action, Phrase};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::time::Duration;
    use tempfile::TempDir;

    /// A directory with a scene, a model, a picture, another file, a hidden one, and a directory with a scene.
    fn directory() -> TempDir {
        let directory = tempfile::tempdir().unwrap();
        for name in ["b.yaml", "a.PLY", "shot.png", "notes.txt", ".hidden.yaml"] {
            fs::write(directory.path().join(name), name).unwrap();
        }
        fs::create_dir(directory.path().join("more")).unwrap();
        fs::write(directory.path().join("more/c.json"), "{}").unwrap();
        directory
    }

    fn picker(purpose: Purpose, directory: &Path, name: &str) -> FilePicker {
        let mut picker = FilePicker::new(purpose, directory, name, Vec::new(), || {});
        assert_eq!(settle(&mut picker), Outcome::Pending);
        picker
    }

    /// Waits for the disk.
    fn settle(picker: &mut FilePicker) -> Outcome {
        let looking = picker.looking.as_ref().unwrap();
        let answer = looking.recv_timeout(Duration::from_secs(30)).unwrap();
        picker.answered(answer)
    }

    fn submit(picker: &mut FilePicker, typed: &str) -> Outcome {
        typed.clone_into(&mut picker.typed);
        picker.edited();
        picker.submit();
        settle(picker)
    }

    fn names(picker: &FilePicker) -> Vec<&str> {
        picker.shown().iter().map(|entry| entry.name.as_str()).collect()
    }

    #[test]
    fn directories_come_first_and_then_the_files_that_the_purpose_is_about() {
        let directory = directory();
        assert_eq!(names(&picker(Purpose::Open, directory.path(), "")), ["more", "a.PLY", "b.yaml"]);
        assert_eq!(names(&picker(Purpose::SavePicture, directory.path(), "")), ["more", "shot.png"]);
        let mut all = picker(Purpose::Open, directory.path(), "");
        (all.shows_all, all.shows_hidden) = (true, true);
        assert_eq!(names(&all), ["more", ".hidden.yaml", "a.PLY", "b.yaml", "notes.txt", "shot.png"]);
    }

    #[test]
    fn a_name_that_is_typed_opens_that_file() {
        let directory = directory();
        let mut picker = picker(Purpose::Open, directory.path(), "");
        assert_eq!(submit(&mut picker, " b.yaml "), Outcome::Picked(directory.path().join("b.yaml")));
    }

    #[test]
    fn a_path_may_be_absolute_quoted_a_url_or_go_up() {
        let directory = directory();
        let wanted = directory.path().join("more/c.json");
        let absolute = wanted.display().to_string();
        for typed in [
            absolute.clone(),
            format!("'{absolute}'"),
            format!("\"{absolute}\""),
            format!("file://{absolute}"),
            "more/c.json".to_owned(),
            "./more/../more/c.json".to_owned(),
        ] {
            let mut picker = picker(Purpose::Open, directory.path(), "");
            assert_eq!(submit(&mut picker, &typed), Outcome::Picked(wanted.clone()), "{typed}");
        }
    }

    #[test]
    fn a_tilde_is_the_home_directory() {
        let home = directories::UserDirs::new().unwrap().home_dir().to_owned();
        assert_eq!(resolve("~", Path::new("/x")), Some(home.clone()));
        assert_eq!(resolve("~/scene.yaml", Path::new("/x")), Some(home.join("scene.yaml")));
        assert_eq!(resolve("~other", Path::new("/x")), Some("/x/~other".into()));
    }

    #[test]
    fn a_directory_is_gone_into_and_left_again() {
        let directory = directory();
        let mut picker = picker(Purpose::Open, directory.path(), "");
        assert_eq!(submit(&mut picker, "more"), Outcome::Pending);
        assert_eq!((names(&picker), picker.typed.as_str()), (vec!["c.json"], ""));
        picker.up();
        assert_eq!(settle(&mut picker), Outcome::Pending);
        assert_eq!(picker.directory(), directory.path());
    }

    #[test]
    fn the_name_to_save_under_stays_on_the_way_to_another_directory() {
        let directory = directory();
        let mut picker = picker(Purpose::SavePicture, directory.path(), "glass.png");
        picker.move_selection(1);
        picker.submit();
        assert_eq!(settle(&mut picker), Outcome::Pending);
        picker.submit();
        assert_eq!(settle(&mut picker), Outcome::Picked(directory.path().join("more/glass.png")));
    }

    #[test]
    fn arrows_select_and_the_selected_file_is_taken() {
        let directory = directory();
        let mut picker = picker(Purpose::Open, directory.path(), "");
        for expected in [0, 1, 2, 2] {
            picker.move_selection(1);
            assert_eq!(picker.selected, Some(expected));
        }
        assert_eq!(picker.typed, "b.yaml");
        picker.submit();
        assert_eq!(settle(&mut picker), Outcome::Picked(directory.path().join("b.yaml")));
    }

    #[test]
    fn a_missing_extension_is_added_and_another_one_is_refused() {
        let directory = directory();
        let mut picker = picker(Purpose::SavePicture, directory.path(), "");
        assert_eq!(submit(&mut picker, "new"), Outcome::Picked(directory.path().join("new.png")));
        assert_eq!(submit(&mut picker, "new.EXR"), Outcome::Picked(directory.path().join("new.EXR")));
        assert_eq!(submit(&mut picker, "new.jpg"), Outcome::Pending);
        assert_eq!(picker.fault, Some(Fault::OtherKind(Purpose::SavePicture)));
    }

    #[test]
    fn a_file_that_is_there_is_replaced_only_when_that_is_said() {
        let directory = directory();
        let mut picker = picker(Purpose::SavePicture, directory.path(), "");
        assert_eq!(submit(&mut picker, "shot"), Outcome::Pending);
        assert_eq!(picker.to_replace, Some(directory.path().join("shot.png")));
        picker.edited();
        assert_eq!(picker.replace(), Outcome::Pending, "what was typed since is another name");
        submit(&mut picker, "shot.png");
        assert_eq!(picker.replace(), Outcome::Picked(directory.path().join("shot.png")));
    }

    #[test]
    fn a_path_that_leads_nowhere_says_so_and_leaves_the_list() {
        let directory = directory();
        let mut open = picker(Purpose::Open, directory.path(), "");
        submit(&mut open, "none.yaml");
        assert_eq!(open.fault, Some(Fault::NoSuchFile(directory.path().join("none.yaml"))));
        submit(&mut open, "none/b.yaml");
        assert_eq!(open.fault, Some(Fault::NoSuchDirectory(directory.path().join("none"))));
        assert_eq!(names(&open), ["more", "a.PLY", "b.yaml"]);
        let mut save = picker(Purpose::SaveScene, directory.path(), "");
        submit(&mut save, "none/b.yaml");
        assert_eq!(save.fault, Some(Fault::NoSuchDirectory(directory.path().join("none"))));
    }

    #[test]
    fn nothing_typed_and_nothing_selected_says_so() {
        let directory = directory();
        let mut picker = picker(Purpose::Open, directory.path(), "");
        picker.submit();
        assert_eq!(picker.fault, Some(Fault::NoName));
    }

    #[cfg(unix)]
    #[test]
    fn a_directory_that_may_not_be_read_says_so() {
        use std::os::unix::fs::PermissionsExt as _;
        let directory = directory();
        let locked = directory.path().join("more");
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o000)).unwrap();
        // The superuser may read everything.
        if fs::read_dir(&locked).is_err() {
            let mut picker = picker(Purpose::Open, directory.path(), "");
            submit(&mut picker, "more");
            assert_eq!(picker.fault, Some(Fault::Denied(locked.clone())));
        }
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[test]
    fn usual_places_are_absolute_and_each_is_there_once() {
        let recent = ["/a/b.ply", "/a/c.ply", "/d/e.yaml", "f.yaml"].map(PathBuf::from);
        let places = Place::usual(Some(Path::new("/d/e.yaml")), &recent);
        let count = |path: &str| places.iter().filter(|place| place.path == Path::new(path)).count();
        assert_eq!((count("/a"), count("/d"), count("")), (1, 1, 0));
    }

    #[test]
    fn whoever_waits_is_woken() {
        let (sender, receiver) = channel();
        let directory = directory();
        let _picker = FilePicker::new(Purpose::Open, directory.path(), "", Vec::new(), move || {
            let _ = sender.send(());
        });
        assert_eq!(receiver.recv_timeout(Duration::from_secs(30)), Ok(()));
    }
}
