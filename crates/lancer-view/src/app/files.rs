//! Files that come and go: dropped on the window, changed on disk, asked for, written; and what is remembered.

use super::saving::Saved;
use super::{App, Asking};
use crate::Source;
use crate::document::{Document, Edit};
use crate::language::Phrase;
use crate::panels::file_picker::{FilePicker, Place, Purpose};
use crate::preferences::WindowPlace;
use crate::watch::Watch;
use eframe::egui::{Context, ViewportCommand};
use lancer_core::scene::Scene;
use std::path::Path;

const CHANGED_ON_DISK: Phrase = Phrase::new(
    "The file has changed on disk. Reload it to see, and lose what you have changed here.",
    "Le fichier a changé sur le disque. Rechargez-le pour le voir, en perdant vos modifications.",
);
const NOT_REMEMBERED: Phrase =
    Phrase::new("The settings cannot be remembered:", "Les réglages ne peuvent être mémorisés :");

impl App {
    /// Opens the first of the files that were dropped.
    pub(super) fn take_dropped(&mut self, ctx: &Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
        if let Some(path) = dropped {
            self.open(Source::File(path));
        }
    }

    /// Reads the open file again when another program wrote it.
    pub(super) fn take_changes_on_disk(&mut self) {
        let has_changed = self.watch.as_ref().is_some_and(|watch| !watch.take_changes().is_empty());
        let Some(document) = self.document.as_ref().filter(|_| has_changed) else { return };
        if document.is_changed() {
            self.messages.warning(self.language().say(CHANGED_ON_DISK));
        } else {
            let source = document.source().clone();
            self.open_now(source);
        }
    }

    /// Watches the open file from now on.
    pub(super) fn watch(&mut self, ctx: &Context) {
        self.watch = None;
        let Some(path) = self.document.as_ref().and_then(|document| document.source().path()) else { return };
        let waker = ctx.clone();
        match Watch::start(path, move || waker.request_repaint()) {
            Ok(watch) => self.watch = Some(watch),
            Err(error) => self.messages.warning(error.to_string()),
        }
    }

    /// Takes note of what was written.
    pub(super) fn take_saved(&mut self, ctx: &Context) {
        for saved in self.saver.poll() {
            match saved {
                Saved::Done(message) => self.messages.info(message),
                Saved::Failed(message) => self.messages.error(message),
                Saved::As(message, path) => {
                    self.messages.info(message);
                    // From now on it is that file that is edited, saved and watched.
                    self.open_now(Source::File(path));
                }
                Saved::Partly(message) => {
                    self.messages.warning(message);
                    self.watch(ctx);
                }
                Saved::Scene { message, camera, revision } => {
                    self.messages.info(message);
                    let Some(document) = &mut self.document else { continue };
                    // What was changed while the file was written is not in it.
                    if document.revision() == revision {
                        if document.scene().camera != camera {
                            document.apply(Edit::SceneCamera(camera));
                            document.end_gesture();
                        }
                        self.navigator.set_home(camera);
                        document.mark_saved();
                    }
                    // What we wrote ourselves is no news.
                    self.watch(ctx);
                }
            }
        }
    }

    /// Asks for a file.
    pub(super) fn ask_for_file(&mut self, ctx: &Context, purpose: Purpose) {
        let source = self.document.as_ref().map(Document::source);
        let stem = source.map_or_else(|| "picture".to_owned(), Source::stem);
        let open = source.and_then(Source::path);
        // A bare name has an empty parent, which means here.
        let beside = open.and_then(Path::parent).filter(|parent| !parent.as_os_str().is_empty());
        let here = || std::env::current_dir().unwrap_or_default();
        let directory = self.directory.clone().or(beside.map(Path::to_owned)).unwrap_or_else(here);
        let name = match purpose {
            Purpose::Open => String::new(),
            Purpose::SavePicture => format!("{stem}.png"),
            Purpose::SaveScene => format!("{stem}.yaml"),
        };
        let places = Place::usual(open, self.preferences.recent.paths());
        let waker = ctx.clone();
        self.picker =
            Some(FilePicker::new(purpose, &directory, name, places, move || waker.request_repaint()));
    }

    /// Keeps the window open while there is something to ask first.
    pub(super) fn hold_window(&mut self, ctx: &Context) {
        let wants_to_close = ctx.input(|input| input.viewport().close_requested());
        if wants_to_close && !self.may_close && self.has_unsaved_work() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.asking = Some(Asking::Quit);
        }
    }

    /// Whether the scene has changes that would be lost; the numbers of a render are none.
    pub(super) fn has_unsaved_work(&self) -> bool {
        self.document.as_ref().is_some_and(|document| {
            // The whole scene is copied and compared only where something was edited at all.
            document.is_changed() && {
                let saved = document.saved();
                let mut scene = Scene::clone(document.scene());
                (scene.settings, scene.tone) = (saved.settings, saved.tone);
                scene != **saved
            }
        })
    }

    /// Notes where the window is, and how large its texts are.
    pub(super) fn remember(&mut self, ctx: &Context) {
        self.preferences.zoom = Some(ctx.zoom_factor()).filter(|zoom| *zoom != 1.0);
        ctx.input(|input| {
            let viewport = input.viewport();
            let maximized = viewport.maximized.unwrap_or(false);
            let Some(inner) = viewport.inner_rect else { return };
            let position = viewport.outer_rect.map(|outer| outer.min.into());
            let before = self.preferences.window;
            let size = match before {
                Some(before) if maximized => before.size,
                _ => inner.size().into(),
            };
            self.preferences.window = Some(WindowPlace { position, size, maximized });
        });
    }

    /// Writes what is to be remembered.
    pub(super) fn save_preferences(&mut self) {
        if let Err(error) = self.preferences_file.save(&self.preferences) {
            self.messages
                .warning(format!("{} {error}", self.preferences.spoken_language().say(NOT_REMEMBERED)));
        }
    }
}
