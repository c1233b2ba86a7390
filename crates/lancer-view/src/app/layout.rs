//! Where the panels are.

use super::shelf::Showing;
use super::{Action, App, Selection};
use crate::commands::{Command, CommandContext};
use crate::document::Document;
use crate::language::Language;
use crate::navigation::Scheme;
use crate::panels::menu_bar::MenuBarView;
use crate::panels::palette::PaletteView;
use crate::panels::settings::SettingsView;
use crate::panels::{about, inspector, menu_bar, messages, scene_tree, shortcuts};
use crate::preferences::Theme;
use crate::worker::Channel;
use eframe::egui::{self, CentralPanel, Frame, Panel, RichText, Ui};
use lancer_core::geometry::DVec2;

impl App {
    /// Draws everything.
    pub(super) fn lay_out(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let language = self.language();
        let context = self.command_context();
        Panel::top("menus").show(ui, |ui| self.menus(ui, &context, actions));
        if self.preferences.panels.status {
            Panel::bottom("status").exact_size(26.0).show(ui, |ui| self.status_bar(ui, actions));
        }
        let has_renders = !self.shelf.kept.is_empty() || self.shelf.running.is_some();
        if self.preferences.panels.renders && has_renders {
            Panel::bottom("renders").exact_size(78.0).show(ui, |ui| self.strip(ui, actions));
        }
        if self.preferences.panels.tree {
            Panel::left("scene").default_size(310.0).size_range(220.0..=460.0).show(ui, |ui| {
                self.scene_panel(ui, actions);
            });
        }
        if self.preferences.panels.parameters {
            Panel::right("settings").default_size(310.0).size_range(290.0..=460.0).show(ui, |ui| {
                self.settings_panel(ui, &context, actions);
            });
        }
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            self.fault_banner(ui, actions);
            if self.preferences.panels.hints && self.shelf.showing == Showing::Live {
                Panel::bottom("hint").frame(Frame::side_top_panel(ui.style())).show(ui, |ui| {
                    let hint = self.preferences.scheme.hint();
                    ui.add(egui::Label::new(RichText::new(language.say(hint)).small().weak()).truncate());
                });
            }
            let pixels = ui.available_size_before_wrap() * ui.ctx().pixels_per_point();
            self.screen_size = DVec2::new(f64::from(pixels.x), f64::from(pixels.y));
            self.view_rect = ui.available_rect_before_wrap();
            self.viewport(ui, actions);
        });
        self.dialogs(ui, &context, actions);
    }

    fn menus(&self, ui: &mut Ui, commands: &CommandContext, actions: &mut Vec<Action>) {
        let source = self.document.as_ref().map(Document::source);
        let view = MenuBarView { commands, source, recent: self.preferences.recent.paths() };
        menu_bar::show(ui, &view, self.language(), actions);
    }

    /// What is wrong with a file, above the last good picture.
    fn fault_banner(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let language = self.language();
        self.faults.take_if(|(source, error)| {
            messages::show_faults(ui, source, &error.diagnostics, language, actions)
        });
    }

    fn scene_panel(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let language = self.language();
        // Neither a short tree nor a narrow inspector makes the panel smaller.
        ui.set_min_width(ui.available_width());
        let Some(document) = &self.document else { return };
        let selection = self.selection;
        Panel::bottom("inspector").resizable(true).default_size(330.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                inspector::show(ui, document, selection, &mut self.inspector, language, actions);
            });
        });
        CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            scene_tree::show(ui, document, selection, &mut self.tree, language, actions);
        });
    }

    fn settings_panel(&mut self, ui: &mut Ui, context: &CommandContext, actions: &mut Vec<Action>) {
        let camera = self.navigator.camera();
        let view = SettingsView {
            document: self.document.as_ref(),
            recent: self.preferences.recent.paths(),
            camera: &camera,
            options: self.options,
            threads: self.preferences.threads,
            commands: context,
        };
        let language = self.preferences.spoken_language();
        self.settings.show(ui, &view, language, actions);
    }

    /// What lies over the panels.
    fn dialogs(&mut self, ui: &mut Ui, context: &CommandContext, actions: &mut Vec<Action>) {
        let language = self.language();
        let ctx = ui.ctx().clone();
        let recent = self.preferences.recent.paths();
        let view = PaletteView { commands: context, recent };
        self.palette.take_if(|palette| !palette.show(&ctx, &view, language, actions));
        if let Some(picker) = self.picker.take_if(|picker| !picker.show(&ctx, language, actions)) {
            self.directory = Some(picker.directory().to_owned());
        }
        if self.shortcuts_shown {
            self.shortcuts_shown = shortcuts::show(&ctx, self.preferences.scheme, language);
        }
        if self.about_shown {
            self.about_shown = about::show(&ctx, language);
        }
        self.ask(&ctx);
        self.messages.show(&ctx, self.view_rect, language);
    }

    /// What the commands' state depends on.
    pub(super) fn command_context(&self) -> CommandContext {
        let document = self.document.as_ref();
        let scene = document.map(Document::scene);
        let node = match self.selection {
            Selection::Node(node) => scene.map(|scene| scene.node(node)),
            _ => None,
        };
        CommandContext {
            has_document: document.is_some(),
            has_file: document.is_some_and(|document| document.source().path().is_some()),
            undo: document.and_then(Document::undo_name),
            redo: document.and_then(Document::redo_name),
            is_changed: document.is_some_and(Document::is_changed),
            has_selection: self.selection != Selection::None,
            can_hide: node.is_some_and(|node| !node.hidden),
            has_hidden: scene.is_some_and(|scene| scene.nodes().iter().any(|node| node.hidden)),
            is_rendering: self.shelf.running.is_some(),
            is_working: self.opening.is_some() || self.shelf.running.is_some(),
            renders: self.shelf.kept.len(),
            shows_render: self.shelf.showing != Showing::Live,
            checked: self.checked(),
        }
    }

    /// The toggles that are on, and the choices that are made.
    fn checked(&self) -> Vec<Command> {
        let overlays = &self.preferences.overlay;
        let panels = &self.preferences.panels;
        let toggles = [
            (overlays.grid, Command::Grid),
            (overlays.axes, Command::Axes),
            (overlays.lights, Command::Lights),
            (overlays.bounds, Command::Bounds),
            (overlays.interest, Command::Interest),
            (overlays.tree_level.is_some(), Command::Tree),
            (panels.tree, Command::ScenePanel),
            (panels.parameters, Command::SettingsPanel),
            (panels.renders, Command::RendersPanel),
            (panels.hints, Command::MouseHints),
            (matches!(self.shelf.showing, Showing::Compare(..)), Command::Compare),
        ];
        let channel = match self.live.channel {
            Channel::Picture => Command::ShowPicture,
            Channel::Depth => Command::ShowDepth,
            Channel::Normals => Command::ShowNormals,
            Channel::Objects => Command::ShowObjects,
            Channel::Occlusion => Command::ShowOcclusion,
        };
        let scheme = match self.preferences.scheme {
            Scheme::Assignment => Command::MouseAssignment,
            Scheme::Orbit => Command::MouseOrbit,
            Scheme::Trackpad => Command::MouseTrackpad,
        };
        let theme = match self.preferences.theme {
            Theme::System => Command::ThemeSystem,
            Theme::Light => Command::ThemeLight,
            Theme::Dark => Command::ThemeDark,
        };
        let language = match self.preferences.language {
            None => Command::LanguageSystem,
            Some(Language::English) => Command::LanguageEnglish,
            Some(Language::French) => Command::LanguageFrench,
        };
        let on = toggles.into_iter().filter_map(|(on, command)| on.then_some(command));
        on.chain([channel, scheme, theme, language]).collect()
    }
}
