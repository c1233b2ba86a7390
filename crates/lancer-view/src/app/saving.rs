//! Pictures and scenes to files, on a thread of their own.

use super::making::Making;
use crate::language::{Language, Phrase};
use lancer_core::camera::Camera;
use lancer_core::film::{Image, Tone};
use lancer_core::scene::Scene;
use lancer_io::LoadOptions;
use lancer_io::image::{Encoding, ImageFormat, Metadata, encode};
use lancer_io::output::write_atomically;
use lancer_io::scene_file;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

const SAVED: Phrase = Phrase::new("Saved", "Enregistré :");
const NOT_SAVED: Phrase = Phrase::new(
    "The scene was saved, but for what a scene file cannot say of these:",
    "La scène a été enregistrée, sauf ce qu’un fichier de scène ne peut dire de :",
);

/// What a thread that saves says at its end.
pub(crate) enum Saved {
    /// A picture was saved.
    Done(String),
    /// The scene that is open was saved into a new file.
    As(String, PathBuf),
    /// The scene that is open was saved into its own file.
    Scene {
        /// What to say.
        message: String,
        /// The camera that the file has now.
        camera: Camera,
        /// The document that the file holds.
        revision: u64,
    },
    /// The scene that is open was saved into its own file, which cannot say all of it.
    Partly(String),
    /// It could not be saved.
    Failed(String),
}

/// Saves things in the background, one thread each.
pub(crate) struct Saver {
    sender: Sender<Saved>,
    receiver: Receiver<Saved>,
    under_way: usize,
}

impl Default for Saver {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, under_way: 0 }
    }
}

impl Saver {
    /// What was saved, or was not, since the last time.
    pub(crate) fn poll(&mut self) -> Vec<Saved> {
        let news = self.receiver.try_iter().collect::<Vec<_>>();
        self.under_way -= news.len();
        news
    }

    /// Whether something is being written.
    pub(crate) fn is_busy(&self) -> bool {
        self.under_way > 0
    }

    /// Starts to save; `wake` is called when it is done.
    pub(crate) fn start(
        &mut self,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce() -> Saved + Send + 'static,
    ) {
        let sender = self.sender.clone();
        self.under_way += 1;
        let spawned = std::thread::Builder::new().name("lancer-save".into()).spawn(move || {
            let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
            let news = result.unwrap_or_else(|_| Saved::Failed("a bug in lancer: saving panicked".into()));
            // Nobody listens any more when the window is closing.
            let _ = sender.send(news);
            wake();
        });
        if let Err(error) = spawned {
            let _ = self.sender.send(Saved::Failed(format!("cannot start a thread: {error}")));
        }
    }
}

/// Writes a picture as its name says: for one whose `making` is known, the bytes that `lancer render` writes.
pub(crate) fn save_picture(
    path: &Path,
    image: &Image,
    tone: Tone,
    making: Option<&Making>,
    language: Language,
) -> Saved {
    let write = || -> Result<(), String> {
        let encoding = Encoding::from(ImageFormat::from_path(path).map_err(|error| error.to_string())?);
        let metadata = making.map_or_else(Metadata::default, |making| making.metadata(encoding));
        write_atomically(path, |out| encode::write(encoding, image, tone, &metadata, out))
            .map_err(|error| error.to_string())
    };
    match write() {
        Ok(()) => Saved::Done(format!("{} {}", language.say(SAVED), path.display())),
        Err(message) => Saved::Failed(message),
    }
}

/// Writes a scene as a file that stands alone.
pub(crate) fn save_scene_as(path: &Path, scene: &Scene, language: Language) -> Saved {
    match scene_file::write_whole(scene, path) {
        Ok(()) => Saved::As(format!("{} {}", language.say(SAVED), path.display()), path.to_owned()),
        Err(error) => Saved::Failed(error.to_string()),
    }
}

/// Writes what changed of a scene into its own file, and keeps all else that is in there.
pub(crate) fn save_into_scene_file(
    path: &Path,
    scene: &Scene,
    revision: u64,
    load: &LoadOptions,
    language: Language,
) -> Saved {
    let write = || -> Result<Vec<String>, String> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let held = lancer_io::load(path, load).map_err(|error| error.to_string())?;
        let changes = scene_file::changes(&held.scene, scene, &held.origins);
        let text = scene_file::patch(path, &text, &changes.overrides).map_err(|error| error.to_string())?;
        write_atomically(path, |out| out.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
        Ok(changes.unsaved.iter().map(ToString::to_string).collect())
    };
    match write() {
        Ok(unsaved) if unsaved.is_empty() => {
            let message = format!("{} {}", language.say(SAVED), path.display());
            Saved::Scene { message, camera: scene.camera, revision }
        }
        Ok(unsaved) => Saved::Partly(format!("{} {}", language.say(NOT_SAVED), unsaved.join(", "))),
        Err(message) => Saved::Failed(message),
    }
}
