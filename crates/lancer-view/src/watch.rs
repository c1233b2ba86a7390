//! Tells when the open file, or a file that it refers to, changes on disk.
//!
//! In: the open file. Out: the files that changed, once their writer has come to rest, and a call that wakes whoever
//! asks for them. The system reports changes of directories; nothing is polled, and nothing runs between changes.
//!
//! A file is taken to be referred to where its name stands in the text of the open file, or in a text that the open
//! file refers to, and it lies in the same directory or below. So a texture that is missing today is noticed when
//! it comes, and a picture that is saved beside the scene is not taken for a part of it.

use lancer_io::SCENE_EXTENSIONS;
use notify::{RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Read;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How long all must be quiet before a change is told: editors write a file in several steps, most of them within
/// a few milliseconds. Shorter, and half a file is loaded; longer, and the window seems slow.
const QUIET: Duration = Duration::from_millis(200);

/// The most directories that are watched; a scene refers to a few. Untuned.
const MOST_DIRECTORIES: usize = 64;

/// How much of a text is searched for names, in bytes: large models name their materials at the top.
const MOST_TEXT: u64 = 1 << 20;

/// The file could not be watched: it will not be loaded again by itself.
#[derive(Debug, thiserror::Error)]
#[error("{}: changes on disk will not be noticed: {source}", path.display())]
pub struct WatchError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub source: notify::Error,
}

/// Watches the open file until it is dropped.
#[derive(Debug)]
pub struct Watch {
    path: PathBuf,
    changes: Arc<Mutex<BTreeSet<PathBuf>>>,
    signals: Sender<Signal>,
    thread: Option<JoinHandle<()>>,
}

enum Signal {
    Event(notify::Result<notify::Event>),
    Stop,
}

impl Watch {
    /// Watches a file and what it refers to. `wake` is called, on another thread, when there are new changes.
    ///
    /// What was written before this call is not told. So a program that has written the file itself starts anew.
    ///
    /// # Errors
    /// The directory of the file cannot be watched.
    pub fn start(path: &Path, wake: impl Fn() + Send + 'static) -> Result<Self, WatchError> {
        let failed = |source| WatchError { path: path.to_owned(), source };
        let (signals, received) = channel();
        let events = signals.clone();
        let watcher = notify::recommended_watcher(move |event| {
            // Without a receiver nobody wants to know.
            let _ = events.send(Signal::Event(event));
        });
        let mut watched = Watched {
            watcher: watcher.map_err(failed)?,
            open: names_of(path),
            directories: BTreeSet::new(),
            texts: Vec::new(),
        };
        watched.look_again().map_err(failed)?;

        let changes = Arc::default();
        let shared = Arc::clone(&changes);
        let thread = thread::Builder::new()
            .name("watch".into())
            .spawn(move || watched.run(&received, &shared, wake))
            .map_err(|error| failed(notify::Error::io(error)))?;
        Ok(Self { path: path.to_owned(), changes, signals, thread: Some(thread) })
    }

    /// The open file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The files that changed since the last call; empty if there are none.
    pub fn take_changes(&self) -> Vec<PathBuf> {
        let mut changes = self.changes.lock().unwrap_or_else(PoisonError::into_inner);
        mem::take(&mut *changes).into_iter().collect()
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.signals.send(Signal::Stop);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The open file by its absolute path, and by the one without symbolic links.
fn names_of(path: &Path) -> Vec<PathBuf> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let real = absolute.canonicalize().ok().filter(|real| *real != absolute);
    [Some(absolute), real].into_iter().flatten().collect()
}

/// What is watched, and why.
struct Watched {
    watcher: RecommendedWatcher,
    open: Vec<PathBuf>,
    directories: BTreeSet<PathBuf>,
    /// The starts of the texts in which the names of further files stand.
    texts: Vec<Vec<u8>>,
}

impl Watched {
    fn run(mut self, received: &Receiver<Signal>, changes: &Mutex<BTreeSet<PathBuf>>, wake: impl Fn()) {
        let mut pending = BTreeSet::new();
        loop {
            let signal = match pending.is_empty() {
                true => received.recv().map_err(|_| RecvTimeoutError::Disconnected),
                false => received.recv_timeout(QUIET),
            };
            match signal {
                Ok(Signal::Event(Ok(event))) => pending.extend(self.concerned(event)),
                Ok(Signal::Event(Err(_))) => {}
                Err(RecvTimeoutError::Timeout) => {
                    // References may have changed, and directories come. One that cannot be watched is no reason
                    // to forget the others.
                    let _ = self.look_again();
                    let told = mem::take(&mut pending).into_iter().filter(|path: &PathBuf| path.is_file());
                    let told = told.collect::<BTreeSet<_>>();
                    if !told.is_empty() {
                        changes.lock().unwrap_or_else(PoisonError::into_inner).extend(told);
                        wake();
                    }
                }
                Ok(Signal::Stop) | Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// The paths of an event that matter.
    fn concerned(&mut self, event: notify::Event) -> Vec<PathBuf> {
        if event.need_rescan() {
            // Events were lost, perhaps ours.
            return self.open.clone();
        }
        if event.kind.is_access() {
            return Vec::new();
        }
        // A directory that goes takes its watch with it; if it comes back, it is watched anew.
        for path in &event.paths {
            if self.directories.remove(path) {
                let _ = self.watcher.unwatch(path);
            }
        }
        event.paths.into_iter().filter(|path| self.matters(path)).collect()
    }

    fn matters(&self, path: &Path) -> bool {
        self.open.iter().any(|open| open == path) || (!is_temporary(path) && self.is_named(path))
    }

    /// Whether the name of a file or directory stands in one of the texts.
    fn is_named(&self, path: &Path) -> bool {
        let name = path.file_name().map(std::ffi::OsStr::as_encoded_bytes).unwrap_or_default();
        let stands_in = |text: &Vec<u8>| text.windows(name.len()).any(|window| window == name);
        !name.is_empty() && self.texts.iter().any(stands_in)
    }

    /// Reads the references anew and watches the directories of those that are new.
    ///
    /// # Errors
    /// The directory of the open file cannot be watched.
    fn look_again(&mut self) -> notify::Result<()> {
        self.texts = self.open.first().and_then(|path| start_of_text(path)).into_iter().collect();
        let mut waiting =
            self.open.iter().filter_map(|path| path.parent()).map(Path::to_owned).collect::<Vec<_>>();
        for directory in &waiting {
            Self::watch(&mut self.watcher, &mut self.directories, directory)?;
        }
        let mut seen = self.open.iter().cloned().collect::<BTreeSet<_>>();
        // A text may name files in directories that were looked through before it was found.
        let mut looked_through = Vec::new();
        while let Some(directory) = waiting.pop() {
            let texts = self.texts.len();
            for path in entries(&directory) {
                if is_temporary(&path) || seen.contains(&path) || !self.is_named(&path) {
                    continue;
                }
                seen.insert(path.clone());
                if path.is_dir() {
                    if self.directories.len() < MOST_DIRECTORIES {
                        let _ = Self::watch(&mut self.watcher, &mut self.directories, &path);
                        waiting.push(path);
                    }
                } else if may_refer_to_others(&path) {
                    self.texts.extend(start_of_text(&path));
                }
            }
            looked_through.push(directory);
            if self.texts.len() > texts {
                waiting.append(&mut looked_through);
            }
        }
        Ok(())
    }

    fn watch(
        watcher: &mut RecommendedWatcher,
        directories: &mut BTreeSet<PathBuf>,
        directory: &Path,
    ) -> notify::Result<()> {
        if !directories.contains(directory) {
            watcher.watch(directory, RecursiveMode::NonRecursive)?;
            directories.insert(directory.to_owned());
        }
        Ok(())
    }
}

fn entries(directory: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.path())
}

/// Whether a name is one that editors and downloads give to what is not yet, or no longer, the file.
fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default();
    name.starts_with(['.', '#'])
        || name.ends_with('~')
        || ["tmp", "temp", "swp", "bak", "part"].iter().any(|known| ending.eq_ignore_ascii_case(known))
}

fn may_refer_to_others(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    SCENE_EXTENSIONS.iter().chain(&["obj", "mtl", "gltf"]).any(|known| ending.eq_ignore_ascii_case(known))
}

fn start_of_text(path: &Path) -> Option<Vec<u8>> {
    // Asked before it is opened: to open a pipe would wait for whoever writes to it.
    if !path.is_file() {
        return None;
    }
    let mut text = Vec::new();
    File::open(path).ok()?.take(MOST_TEXT).read_to_end(&mut text).ok()?;
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    /// Long enough for a slow machine; a test that succeeds does not wait for it.
    const PATIENCE: Duration = Duration::from_secs(20);
    /// Long enough that what is not told within it is taken never to be told.
    const SILENCE: Duration = Duration::from_millis(900);

    struct Scene {
        directory: TempDir,
        watch: Watch,
        woken: Receiver<()>,
    }

    impl Scene {
        /// `scene.yaml` names a model, which names its materials, which name a texture.
        fn new() -> Self {
            let directory = TempDir::new().unwrap();
            let at = |name: &str| directory.path().join(name);
            fs::create_dir_all(at("models/textures")).unwrap();
            fs::write(at("scene.yaml"), "objects: [{ model: models/chair.obj }]").unwrap();
            fs::write(at("models/chair.obj"), "mtllib chair.mtl\n").unwrap();
            fs::write(at("models/chair.mtl"), "map_Kd textures/wood.png\n").unwrap();
            fs::write(at("models/textures/wood.png"), "").unwrap();
            let (wake, woken) = channel();
            let watch = Watch::start(&at("scene.yaml"), move || wake.send(()).unwrap()).unwrap();
            Self { directory, watch, woken }
        }

        fn at(&self, name: &str) -> PathBuf {
            self.directory.path().join(name)
        }

        #[track_caller]
        fn expect_change_of(&self, name: &str) {
            self.woken.recv_timeout(PATIENCE).expect("the change is told");
            assert_eq!(self.watch.take_changes(), [self.at(name)]);
            assert!(self.watch.take_changes().is_empty());
        }

        #[track_caller]
        fn expect_silence(&self) {
            assert_eq!(self.woken.recv_timeout(SILENCE), Err(RecvTimeoutError::Timeout));
            assert!(self.watch.take_changes().is_empty());
        }
    }

    #[test]
    fn a_written_file_is_told_once() {
        let scene = Scene::new();
        for line in ["a", "b", "c"] {
            fs::write(scene.at("scene.yaml"), line).unwrap();
        }
        scene.expect_change_of("scene.yaml");
        scene.expect_silence();
    }

    #[test]
    fn editors_that_replace_the_file_are_followed_again_and_again() {
        let scene = Scene::new();
        for version in ["first", "second"] {
            fs::write(scene.at("scene.yaml.tmp"), version).unwrap();
            fs::rename(scene.at("scene.yaml.tmp"), scene.at("scene.yaml")).unwrap();
            scene.expect_change_of("scene.yaml");
        }
        fs::rename(scene.at("scene.yaml"), scene.at("scene.yaml~")).unwrap();
        fs::write(scene.at("scene.yaml"), "third").unwrap();
        scene.expect_change_of("scene.yaml");
    }

    #[test]
    fn what_the_file_refers_to_is_watched_through_models_and_materials() {
        let scene = Scene::new();
        for name in ["models/chair.obj", "models/chair.mtl", "models/textures/wood.png"] {
            fs::write(scene.at(name), fs::read(scene.at(name)).unwrap()).unwrap();
            scene.expect_change_of(name);
        }
    }

    #[test]
    fn temporary_files_pictures_and_reading_are_not_told() {
        let scene = Scene::new();
        for name in
            [".scene.yaml.swp", "scene.yaml~", "#scene.yaml#", "4913", "picture.png", "models/other.obj"]
        {
            fs::write(scene.at(name), "x").unwrap();
        }
        fs::read(scene.at("scene.yaml")).unwrap();
        scene.expect_silence();
    }

    #[test]
    fn a_file_that_is_gone_is_told_when_it_is_back() {
        let scene = Scene::new();
        let text = fs::read(scene.at("scene.yaml")).unwrap();
        fs::remove_file(scene.at("scene.yaml")).unwrap();
        scene.expect_silence();
        fs::write(scene.at("scene.yaml"), text).unwrap();
        scene.expect_change_of("scene.yaml");
    }

    #[test]
    fn references_that_come_later_are_watched_too() {
        let scene = Scene::new();
        fs::write(scene.at("scene.yaml"), "objects: [{ model: later/table.ply }]").unwrap();
        scene.expect_change_of("scene.yaml");
        fs::create_dir(scene.at("later")).unwrap();
        // A directory is no change of the scene, but it is watched once it has been quiet.
        scene.expect_silence();
        fs::write(scene.at("later/table.ply"), "ply").unwrap();
        scene.expect_change_of("later/table.ply");
    }

    #[test]
    #[cfg(unix)]
    fn a_change_behind_a_symbolic_link_is_told() {
        let scene = Scene::new();
        let elsewhere = TempDir::new().unwrap();
        let link = elsewhere.path().join("link.yaml");
        std::os::unix::fs::symlink(scene.at("scene.yaml"), &link).unwrap();
        let (wake, woken) = channel();
        let watch = Watch::start(&link, move || wake.send(()).unwrap()).unwrap();
        fs::write(scene.at("scene.yaml"), "new").unwrap();
        woken.recv_timeout(PATIENCE).unwrap();
        assert_eq!(watch.take_changes(), [scene.at("scene.yaml").canonicalize().unwrap()]);
    }

    #[test]
    fn a_directory_that_is_not_there_is_an_error_that_names_the_file() {
        let error = Watch::start(Path::new("/nowhere/at all/scene.yaml"), || {}).unwrap_err();
        assert!(error.to_string().starts_with("/nowhere/at all/scene.yaml: "), "{error}");
    }
}
