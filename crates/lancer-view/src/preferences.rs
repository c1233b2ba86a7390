//! What is remembered from one run to the next.
//!
//! In and out: a JSON file in the platform's directory for settings. A value that is missing, as one that a newer
//! version has added, has its default; a file that makes no sense is kept beside and started anew, with a warning.
//! It knows neither windows nor scenes.

use crate::navigation::Scheme;
use crate::overlay::OverlayOptions;
use crate::{Language, Phrase};
use lancer_core::accel::Accelerator;
use lancer_io::output::{WriteError, write_atomically};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Light or dark.
    pub theme: Theme,
    /// The window's language; none follows the system.
    pub language: Option<Language>,
    /// What the mouse does.
    pub scheme: Scheme,
    /// The files that were opened last.
    pub recent: RecentFiles,
    /// Where the window was; none before the first run.
    pub window: Option<WindowPlace>,
    /// How much larger texts and controls are than usual; none for not at all.
    pub zoom: Option<f32>,
    /// Which panels are shown.
    pub panels: Panels,
    /// What is drawn over the picture.
    pub overlay: OverlayOptions,
    /// How many threads render; 0 is one a core.
    pub threads: usize,
    /// What finds hits.
    #[serde(with = "accelerator_by_name")]
    pub accelerator: Accelerator,
}

impl Preferences {
    /// The language to speak: the chosen one, or the system's.
    pub fn spoken_language(&self) -> Language {
        self.language.unwrap_or_else(Language::of_system)
    }
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// As the system has it.
    #[default]
    System,
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

impl Theme {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::System, Self::Light, Self::Dark];

    /// Its name in a menu.
    pub const fn name(self) -> Phrase {
        match self {
            Self::System => Phrase::new("As the system", "Comme le système"),
            Self::Light => Phrase::new("Light", "Clair"),
            Self::Dark => Phrase::new("Dark", "Sombre"),
        }
    }
}

/// Where the window was, in logical points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowPlace {
    /// Its outer top left corner; none where the system does not tell.
    pub position: Option<[f32; 2]>,
    /// Its inner width and height, before it was maximised.
    pub size: [f32; 2],
    /// Whether it filled the screen.
    pub maximized: bool,
}

/// Which panels are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Panels {
    /// The tree of the scene.
    pub tree: bool,
    /// The parameters.
    pub parameters: bool,
    /// The pictures that were rendered.
    pub renders: bool,
    /// The line at the bottom.
    pub status: bool,
    /// The line that says what the mouse does.
    pub hints: bool,
}

impl Default for Panels {
    fn default() -> Self {
        Self { tree: true, parameters: true, renders: true, status: true, hints: true }
    }
}

/// The files that were opened last, newest first, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<PathBuf>", into = "Vec<PathBuf>")]
pub struct RecentFiles(Vec<PathBuf>);

impl RecentFiles {
    /// How many are kept: what fits in a menu.
    pub const MOST: usize = 12;

    /// Puts a file first. Relative paths are made absolute by the working directory.
    pub fn add(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.remove(&path);
        self.0.insert(0, path);
        self.0.truncate(Self::MOST);
    }

    /// Forgets a file, as one that is gone.
    pub fn remove(&mut self, path: &Path) {
        self.0.retain(|other| other != path);
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The files, newest first.
    pub fn paths(&self) -> &[PathBuf] {
        &self.0
    }
}

impl From<Vec<PathBuf>> for RecentFiles {
    fn from(paths: Vec<PathBuf>) -> Self {
        let mut recent = Self::default();
        for path in paths.iter().rev().filter(|path| path.is_absolute()) {
            recent.add(path);
        }
        recent
    }
}

impl From<RecentFiles> for Vec<PathBuf> {
    fn from(recent: RecentFiles) -> Self {
        recent.0
    }
}

/// An accelerator as the command line names it.
mod accelerator_by_name {
    use super::{Accelerator, Deserialize};
    use serde::de::Error;
    use serde::{Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &Accelerator, out: S) -> Result<S::Ok, S::Error> {
        out.serialize_str(value.name())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Accelerator, D::Error> {
        let name = String::deserialize(from)?;
        let found = Accelerator::ALL.into_iter().find(|accelerator| accelerator.name() == name);
        found.ok_or_else(|| D::Error::custom(format!("`{name}` is no accelerator")))
    }
}

/// The file that the preferences are kept in.
#[derive(Debug)]
pub struct PreferencesFile {
    /// None where the system names no directory for settings: then nothing is remembered.
    path: Option<PathBuf>,
    /// What the file holds; none before there is one.
    held: Option<Preferences>,
}

/// The preferences could not be read. Defaults stand in for them.
#[derive(Debug)]
pub struct PreferencesWarning {
    /// The file.
    pub path: PathBuf,
    /// Where what it held is kept; none where it could not be moved.
    pub kept: Option<PathBuf>,
    /// Why.
    pub reason: String,
}

impl PreferencesWarning {
    /// What to tell the user.
    pub fn text(&self, language: Language) -> String {
        let what = language.say(Phrase::new(
            "Your preferences could not be read, so the defaults are used.",
            "Vos préférences n’ont pas pu être lues ; les valeurs par défaut les remplacent.",
        ));
        let kept = language.say(Phrase::new("The old file is kept as", "L’ancien fichier est gardé sous"));
        let reason = format!("{what} {}: {}.", self.path.display(), self.reason);
        match &self.kept {
            Some(path) => format!("{reason} {kept} {}.", path.display()),
            None => reason,
        }
    }
}

impl fmt::Display for PreferencesWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(Language::English))
    }
}

impl PreferencesFile {
    /// The variable of the environment that names another directory.
    pub const VARIABLE: &str = "LANCER_CONFIG_DIR";

    /// The user's own: in the directory that [`PreferencesFile::VARIABLE`] names, or else in the platform's.
    pub fn of_user() -> Self {
        let named = std::env::var_os(Self::VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from);
        let platform = || Some(directories::ProjectDirs::from("", "", "lancer")?.config_dir().to_owned());
        Self { path: named.or_else(platform).map(|directory| directory.join(NAME)), held: None }
    }

    /// The one in a directory, which need not exist.
    pub fn in_directory(directory: &Path) -> Self {
        Self { path: Some(directory.join(NAME)), held: None }
    }

    /// Where it is, if anything is remembered at all.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Reads it. Without a file there are the defaults; with one that cannot be read too, and a warning.
    pub fn load(&mut self) -> (Preferences, Option<PreferencesWarning>) {
        let Some(path) = self.path.as_deref() else { return Default::default() };
        match read(path) {
            Ok(preferences) => {
                self.held.clone_from(&preferences);
                (preferences.unwrap_or_default(), None)
            }
            Err(reason) => {
                let kept = path.with_extension("json.bad");
                let kept = std::fs::rename(path, &kept).is_ok().then_some(kept);
                (Preferences::default(), Some(PreferencesWarning { path: path.to_owned(), kept, reason }))
            }
        }
    }

    /// Writes it, whole or not at all, if it does not hold the same already.
    ///
    /// # Errors
    /// The directory cannot be made, or the file not be written.
    pub fn save(&mut self, preferences: &Preferences) -> Result<(), WriteError> {
        let Some(path) = self.path.as_deref().filter(|_| self.held.as_ref() != Some(preferences)) else {
            return Ok(());
        };
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)
                .map_err(|source| WriteError { path: directory.to_owned(), source })?;
        }
        write_atomically(path, |out| {
            serde_json::to_writer_pretty(&mut *out, preferences)?;
            out.write_all(b"\n")
        })?;
        self.held = Some(preferences.clone());
        Ok(())
    }
}

const NAME: &str = "preferences.json";

/// What a file holds, if there is one, or why it cannot be read.
fn read(path: &Path) -> Result<Option<Preferences>, String> {
    match std::fs::read(path) {
        Ok(bytes) => serde_json::from_slice(&bytes).map(Some).map_err(|error| error.to_string()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use tempfile::TempDir;

    fn unusual() -> Preferences {
        let mut recent = RecentFiles::default();
        recent.add(Path::new("/models/dragon.ply"));
        Preferences {
            theme: Theme::Dark,
            language: Some(Language::French),
            zoom: Some(1.25),
            scheme: Scheme::Trackpad,
            recent,
            window: Some(WindowPlace { position: Some([3.0, -4.5]), size: [1280.0, 800.0], maximized: true }),
            panels: Panels { tree: false, ..Panels::default() },
            overlay: OverlayOptions { grid: true, tree_level: Some(4), ..OverlayOptions::default() },
            threads: 3,
            accelerator: Accelerator::KdTree,
        }
    }

    fn in_temporary() -> (TempDir, PreferencesFile) {
        let directory = TempDir::new().unwrap();
        let file = PreferencesFile::in_directory(&directory.path().join("made when needed"));
        (directory, file)
    }

    fn put(file: &PreferencesFile, text: &str) {
        fs::create_dir_all(file.path().unwrap().parent().unwrap()).unwrap();
        fs::write(file.path().unwrap(), text).unwrap();
    }

    #[test]
    fn what_is_saved_is_loaded() {
        let (_directory, mut file) = in_temporary();
        file.save(&unusual()).unwrap();
        let (loaded, warning) = PreferencesFile { held: None, ..file }.load();
        assert_eq!(loaded, unusual());
        assert!(warning.is_none());
    }

    #[test]
    fn without_a_file_there_are_the_defaults_and_no_warning() {
        let (_directory, mut file) = in_temporary();
        let (loaded, warning) = file.load();
        assert_eq!(loaded, Preferences::default());
        assert!(warning.is_none());
    }

    #[test]
    fn missing_values_have_their_defaults_and_unknown_ones_do_no_harm() {
        let (_directory, mut file) = in_temporary();
        put(&file, r#"{"theme": "light", "panels": {"tree": false}, "from a newer version": [1, 2]}"#);
        let (loaded, warning) = file.load();
        let panels = Panels { tree: false, ..Panels::default() };
        assert_eq!(loaded, Preferences { theme: Theme::Light, panels, ..Preferences::default() });
        assert!(warning.is_none());
    }

    #[test]
    fn a_damaged_file_is_kept_aside_with_a_warning_that_says_where() {
        let damaged =
            ["", "{", "null", r#"{"theme": "sepia"}"#, r#"{"accelerator": "octree"}"#, r#"{"threads": -1}"#];
        for text in damaged {
            let (_directory, mut file) = in_temporary();
            put(&file, text);
            let (loaded, warning) = file.load();
            assert_eq!(loaded, Preferences::default(), "{text}");
            let warning = warning.expect(text);
            let kept = warning.kept.as_deref().unwrap();
            assert_eq!(fs::read_to_string(kept).unwrap(), text);
            for language in Language::ALL {
                assert!(warning.text(language).contains("preferences.json.bad"));
            }
            file.save(&unusual()).unwrap();
            assert_eq!(file.load().0, unusual());
        }
    }

    #[test]
    fn a_file_is_written_only_when_something_changed() {
        let (_directory, mut file) = in_temporary();
        file.save(&unusual()).unwrap();
        let path = file.path().unwrap().to_owned();
        fs::remove_file(&path).unwrap();
        file.save(&unusual()).unwrap();
        assert!(!path.exists(), "nothing had changed");
        file.save(&Preferences::default()).unwrap();
        assert!(path.exists());
    }

    #[test]
    fn what_was_loaded_is_not_written_back() {
        let (_directory, mut file) = in_temporary();
        put(&file, r#"{ "theme":"dark" }"#);
        let (loaded, _) = file.load();
        file.save(&loaded).unwrap();
        assert_eq!(fs::read_to_string(file.path().unwrap()).unwrap(), r#"{ "theme":"dark" }"#);
    }

    #[test]
    fn a_directory_that_cannot_be_made_is_an_error_that_names_it() {
        let directory = TempDir::new().unwrap();
        let in_the_way = directory.path().join("a file");
        fs::write(&in_the_way, "").unwrap();
        let error = PreferencesFile::in_directory(&in_the_way).save(&unusual()).unwrap_err();
        assert!(error.to_string().contains("a file"), "{error}");
    }

    #[test]
    fn recent_files_are_absolute_newest_first_each_once_and_at_most_twelve() {
        let mut recent = RecentFiles::default();
        for i in 0..20 {
            recent.add(Path::new(&format!("scene{i}.yaml")));
        }
        recent.add(Path::new("scene15.yaml"));
        let names = recent.paths().iter().map(|path| path.file_name().unwrap().to_str().unwrap());
        assert_eq!(
            names.take(4).collect::<Vec<_>>(),
            ["scene15.yaml", "scene19.yaml", "scene18.yaml", "scene17.yaml"]
        );
        assert_eq!(recent.paths().len(), RecentFiles::MOST);
        assert!(recent.paths().iter().all(|path| path.is_absolute()));
    }

    #[test]
    fn a_list_of_recent_files_is_put_in_order_as_it_is_read() {
        let text = r#"["/b.yaml", "/a.yaml", "/b.yaml", "relative.yaml"]"#;
        let recent: RecentFiles = serde_json::from_str(text).unwrap();
        assert_eq!(recent.paths(), [Path::new("/b.yaml"), Path::new("/a.yaml")]);
    }
}
