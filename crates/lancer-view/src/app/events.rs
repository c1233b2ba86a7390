//! What the worker tells, and what becomes of it.

use super::{App, Selection};
use crate::document::Document;
use crate::language::Phrase;
use crate::navigation::Navigator;
use crate::panels::inspector::InspectorState;
use crate::panels::scene_tree::TreeState;
use crate::worker::{Event, Opened, RenderFault, Rendered};
use eframe::egui::Context;
use lancer_io::Loaded;

const CANCELLED: Phrase = Phrase::new("The render was cancelled.", "Le rendu a été annulé.");
const DONE: Phrase = Phrase::new("Rendered", "Rendu terminé :");

/// Warnings of a file that are shown: with more, they would hide the picture.
const MOST_WARNINGS: usize = 3;

impl App {
    /// Takes all that the worker has told since the last time.
    pub(super) fn take_events(&mut self, ctx: &Context) {
        for event in self.worker.poll() {
            match event {
                Event::Opening { source, stage } => self.opening = Some((source, stage)),
                Event::Opened(opened) => self.opened(ctx, *opened),
                Event::OpenFailed { source, error } => {
                    self.opening = None;
                    self.faults = Some((source, error));
                }
                Event::OpenCancelled { .. } => self.opening = None,
                Event::Frame(frame) => {
                    self.view_fault = None;
                    let tone = self.tone();
                    self.live.show(ctx, *frame, tone);
                }
                Event::ViewFailed { message } => self.view_fault = Some(message),
                Event::RenderStarted(_) => {}
                Event::RenderProgress(id, progress) => self.shelf.progress(ctx, id, progress),
                Event::RenderDone(rendered) => self.rendered(ctx, *rendered),
                Event::RenderFailed { id, error } => {
                    self.shelf.abandon(id);
                    match error {
                        RenderFault::Cancelled => self.messages.info(self.language().say(CANCELLED)),
                        RenderFault::Message(message) => self.messages.error(message),
                    }
                }
            }
        }
    }

    fn opened(&mut self, ctx: &Context, opened: Opened) {
        let Opened { source, loaded, .. } = opened;
        let Loaded { scene, warnings, .. } = loaded;
        self.opening = None;
        self.faults = None;
        for warning in warnings.iter().take(MOST_WARNINGS) {
            self.messages.warning(warning.to_string());
        }
        let is_reload = self.document.as_ref().is_some_and(|document| *document.source() == source);
        if is_reload {
            // The user looks from where they want to, whatever else has changed.
            self.navigator.set_home(scene.camera);
        } else {
            self.navigator = Navigator::new(scene.camera);
            self.tree = TreeState::default();
            self.inspector = InspectorState::default();
            self.shelf.showing = super::shelf::Showing::Live;
        }
        self.selection = Selection::None;
        if let Some(path) = source.path() {
            self.preferences.recent.add(path);
        }
        let document = Document::new(source, scene);
        self.first_revision = document.revision();
        self.document = Some(document);
        self.watch(ctx);
        self.live.forget_request();
        self.set_title(ctx);
    }

    fn rendered(&mut self, ctx: &Context, rendered: Rendered) {
        let seconds = rendered.elapsed.as_secs_f64();
        let (width, height) = (rendered.image.width(), rendered.image.height());
        let done = self.language().say(DONE);
        self.messages.info(format!("{done} {width} × {height}, {seconds:.1} s"));
        self.shelf.finish(ctx, rendered);
    }
}
