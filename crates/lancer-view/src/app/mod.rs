//! The state of the window, and how it reacts.
//!
//! Panels read the state and say what the user wants as [`Action`]s; the application carries them out. So every
//! way to do a thing (menu, shortcut, palette, button) ends in the same place.

mod action;
mod asking;
mod events;
mod files;
mod layout;
mod live;
mod making;
mod perform;
mod saving;
mod shelf;
mod status_bar;
mod strip;
#[cfg(test)]
mod tests;
mod viewport;

pub use action::{Action, Selection};

use crate::Source;
use crate::document::Document;
use crate::language::Language;
use crate::navigation::Navigator;
use crate::panels::file_picker::FilePicker;
use crate::panels::inspector::InspectorState;
use crate::panels::messages::Messages;
use crate::panels::palette::Palette;
use crate::panels::scene_tree::TreeState;
use crate::panels::settings::SettingsPanel;
use crate::picture::Readout;
use crate::preferences::{Preferences, PreferencesFile, PreferencesWarning, WindowPlace};
use crate::theme;
use crate::watch::Watch;
use crate::worker::{Frame, OpenStage, Worker};
use asking::Asking;
use eframe::egui::{Context, Rect, Ui, ViewportCommand};
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::DVec2;
use lancer_core::world::CompileOptions;
use lancer_io::LoadOptions;
use lancer_io::diagnostics::LoadError;
use live::Live;
use saving::Saver;
use shelf::{Shelf, Showing};
use std::path::PathBuf;

/// How the window begins.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scene that is shown first.
    pub source: Source,
    /// How files are read.
    pub load: LoadOptions,
}

/// What the last run left to this one.
#[derive(Debug)]
pub struct Remembered {
    file: PreferencesFile,
    preferences: Preferences,
    warning: Option<PreferencesWarning>,
}

impl Remembered {
    /// Reads what was remembered.
    pub fn load(mut file: PreferencesFile) -> Self {
        let (preferences, warning) = file.load();
        Self { file, preferences, warning }
    }

    /// Where the window was.
    pub(crate) fn window(&self) -> Option<WindowPlace> {
        self.preferences.window
    }
}

/// The window's application.
pub struct App {
    load: LoadOptions,
    options: CompileOptions,
    preferences: Preferences,
    preferences_file: PreferencesFile,
    worker: Worker,
    watch: Option<Watch>,
    saver: Saver,
    document: Option<Document>,
    navigator: Navigator,
    live: Live,
    shelf: Shelf,
    selection: Selection,
    readout: Option<Readout>,
    opening: Option<(Source, OpenStage)>,
    /// Why there is no picture of the scene as it is now.
    view_fault: Option<String>,
    /// What is to be done with the live picture when it is refined.
    save_when_final: Option<PathBuf>,
    copy_when_final: bool,
    /// The middle of the window, in physical pixels.
    screen_size: DVec2,
    /// The same, in points of the window.
    view_rect: Rect,
    tree: TreeState,
    inspector: InspectorState,
    settings: SettingsPanel,
    messages: Messages,
    /// The document's revision when it was opened. Frames of less are of the document before.
    first_revision: u64,
    /// What is wrong with the file that was to be shown.
    faults: Option<(Source, LoadError)>,
    palette: Option<Palette>,
    picker: Option<FilePicker>,
    /// Where the last file was chosen.
    directory: Option<PathBuf>,
    asking: Option<Asking>,
    may_close: bool,
    shortcuts_shown: bool,
    about_shown: bool,
    title: String,
}

impl App {
    /// The application, in a window or a test.
    pub fn new(ctx: &Context, options: Options, remembered: Remembered) -> Self {
        let Remembered { file: preferences_file, preferences, warning } = remembered;
        let mut messages = Messages::default();
        if let Some(warning) = warning {
            messages.warning(warning.text(preferences.spoken_language()));
        }
        theme::install(ctx);
        theme::choose(ctx, preferences.theme);
        if let Some(zoom) = preferences.zoom {
            ctx.set_zoom_factor(zoom);
        }
        let waker = ctx.clone();
        let worker = Worker::start(move || waker.request_repaint());
        let compile = CompileOptions { accelerator: preferences.accelerator, ..CompileOptions::default() };
        worker.open(options.source, options.load.clone());
        Self {
            load: options.load,
            options: compile,
            preferences,
            preferences_file,
            worker,
            watch: None,
            saver: Saver::default(),
            document: None,
            navigator: Navigator::new(Camera::default()),
            live: Live::default(),
            shelf: Shelf::default(),
            selection: Selection::None,
            readout: None,
            opening: None,
            view_fault: None,
            save_when_final: None,
            copy_when_final: false,
            screen_size: DVec2::ONE,
            view_rect: Rect::NOTHING,
            tree: TreeState::default(),
            inspector: InspectorState::default(),
            settings: SettingsPanel::default(),
            messages,
            first_revision: 0,
            faults: None,
            palette: None,
            picker: None,
            directory: None,
            asking: None,
            may_close: false,
            shortcuts_shown: false,
            about_shown: false,
            title: String::new(),
        }
    }

    /// The language that is spoken.
    fn language(&self) -> Language {
        self.preferences.spoken_language()
    }

    /// How the scene is shown.
    fn tone(&self) -> Tone {
        self.document.as_ref().map_or_else(Tone::default, |document| document.scene().tone)
    }

    /// Columns over rows of the picture.
    fn aspect(&self) -> f64 {
        self.document.as_ref().map_or(1.0, |document| {
            let settings = document.scene().settings;
            f64::from(settings.width) / f64::from(settings.height)
        })
    }

    /// The newest frame, if it shows the scene that is open and not the one before.
    fn frame_of_document(&self) -> Option<&Frame> {
        self.live.frame().filter(|frame| frame.revision >= self.first_revision)
    }

    /// Names the window after the scene.
    fn set_title(&mut self, ctx: &Context) {
        let title = match &self.document {
            Some(document) => {
                let mark = if document.is_changed() { "*" } else { "" };
                format!("{}{mark} - Lancer", document.source().title())
            }
            None => "Lancer".to_owned(),
        };
        if title != self.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Everything that a frame of the window does, but for drawing it.
    fn react(&mut self, ctx: &Context) {
        self.take_events(ctx);
        self.take_saved(ctx);
        self.take_dropped(ctx);
        self.take_changes_on_disk();
        self.hold_window(ctx);
    }

    /// One frame: news, input, panels, what the user wants of them, and what the worker is to do.
    pub fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.react(&ctx);
        let mut actions = Vec::new();
        let pressed = crate::commands::pressed(&ctx, &self.command_context());
        self.lay_out(ui, &mut actions);
        actions.extend(pressed.into_iter().map(Action::Command));
        for action in actions {
            self.perform(&ctx, action);
        }
        let tone = self.tone();
        self.live.expose(&ctx, tone);
        if let (Some(document), Showing::Live) = (&self.document, self.shelf.showing) {
            let threads = self.preferences.threads;
            self.live.ask(&ctx, &self.worker, document, &self.navigator, self.options, threads);
        }
        self.finish_pending(&ctx);
        self.set_title(&ctx);
        self.remember(&ctx);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.frame(ui);
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.save_preferences();
    }
}
