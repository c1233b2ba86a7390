//! The panel at right: which scene, seen by which camera, and all that decides what the picture is.
//!
//! In: the document and the way it is rendered. Out: edits of the scene and other wishes, as actions.

mod parameters;
mod picture;
mod scene;
#[cfg(test)]
mod tests;

use super::fields::Rows;
use crate::{Action, Command, CommandContext, Document, Edit, Language, Phrase};
use eframe::egui::{Button, CentralPanel, CollapsingHeader, Frame, Panel, RichText, ScrollArea, Ui, vec2};
use lancer_core::camera::Camera;
use lancer_core::world::CompileOptions;
use picture::LinkedSides;
use std::path::PathBuf;

/// What the panel shows.
#[derive(Clone, Copy)]
pub struct SettingsView<'a> {
    /// The scene that is open.
    pub document: Option<&'a Document>,
    /// The files opened last, newest first.
    pub recent: &'a [PathBuf],
    /// Where the view stands.
    pub camera: &'a Camera,
    /// How hits are found.
    pub options: CompileOptions,
    /// How many threads render; 0 for one a core.
    pub threads: usize,
    /// What the state of commands depends on.
    pub commands: &'a CommandContext,
}

/// The panel's own state.
#[derive(Clone, Debug)]
pub struct SettingsPanel {
    linked: LinkedSides,
    /// N, for when ambient occlusion is turned on again.
    ao_samples: u32,
}

impl Default for SettingsPanel {
    fn default() -> Self {
        Self { linked: LinkedSides::default(), ao_samples: AO_SAMPLES }
    }
}

/// N where ambient occlusion is turned on and the scene has none. With fewer, corners are grainy; with more, the view
/// sharpens late. Untuned.
const AO_SAMPLES: u32 = 64;

impl SettingsPanel {
    /// Draws the panel into all of `ui`.
    pub fn show(&mut self, ui: &mut Ui, view: &SettingsView, language: Language, actions: &mut Vec<Action>) {
        let frame = Frame::NONE.inner_margin(vec2(0.0, 8.0));
        Panel::bottom("render button").frame(frame).resizable(false).show_separator_line(false).show(
            ui,
            |ui| {
                render_button(ui, view.commands, language, actions);
            },
        );
        CentralPanel::no_frame().show(ui, |ui| {
            ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| self.sections(ui, view, language, actions));
        });
    }

    fn sections(&mut self, ui: &mut Ui, view: &SettingsView, language: Language, actions: &mut Vec<Action>) {
        section(ui, language, Phrase::new("Scene", "Scène"), |ui| {
            scene::show(ui, view, language, actions);
        });
        let Some(document) = view.document else { return };
        let (scene, saved) = (document.scene(), document.saved());
        let mut settings = scene.settings;
        let mut tone = scene.tone;
        let (mut ambient, mut background) = (scene.ambient, scene.background);
        let mut options = view.options;
        let mut threads = view.threads;
        section(ui, language, Phrase::new("Picture", "Image"), |ui| {
            let mut rows = Rows { ui, language };
            picture::size(&mut rows, &mut self.linked, &mut settings, &saved.settings);
            picture::film(&mut rows, &mut settings, &saved.settings, &mut tone, saved.tone);
        });
        section(ui, language, Phrase::new("Light", "Lumière"), |ui| {
            let mut rows = Rows { ui, language };
            picture::light(&mut rows, &mut settings, &saved.settings);
            rows.color(&parameters::AMBIENT, &mut ambient, saved.ambient);
            rows.color(&parameters::BACKGROUND, &mut background, saved.background);
        });
        section(ui, language, Phrase::new("Ambient occlusion", "Occultation ambiante"), |ui| {
            let mut rows = Rows { ui, language };
            picture::occlusion(&mut rows, &mut self.ao_samples, &mut settings.ao, saved.settings.ao);
        });
        section(ui, language, Phrase::new("Speed", "Vitesse"), |ui| {
            let mut rows = Rows { ui, language };
            picture::speed(&mut rows, &mut options, &mut threads);
        });
        let edits = [
            (settings != scene.settings).then_some(Edit::Settings(settings)),
            (tone != scene.tone).then_some(Edit::Tone(tone)),
            (ambient != scene.ambient).then_some(Edit::Ambient(ambient)),
            (background != scene.background).then_some(Edit::Background(background)),
        ];
        actions.extend(edits.into_iter().flatten().map(Action::Edit));
        actions.extend((options != view.options).then_some(Action::Options(options)));
        actions.extend((threads != view.threads).then_some(Action::Threads(threads)));
    }
}

fn section(ui: &mut Ui, language: Language, name: Phrase, add: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(language.say(name)).strong())
        .id_salt(language.say(name))
        .default_open(true)
        .show_unindented(ui, add);
    ui.add_space(ui.spacing().item_spacing.y);
}

/// The one large button: it starts a render, and stops the one that runs.
fn render_button(ui: &mut Ui, context: &CommandContext, language: Language, actions: &mut Vec<Action>) {
    let command = if context.is_rendering { Command::Cancel } else { Command::Render };
    let selection = ui.visuals().selection;
    let text = RichText::new(language.say(command.name())).strong().color(selection.stroke.color);
    let size = vec2(ui.available_width(), 1.6 * ui.spacing().interact_size.y);
    let button = Button::new(text).min_size(size).fill(selection.bg_fill);
    let keys = command.shortcuts().iter().map(|keys| crate::commands::shortcut_text(keys, language));
    let tip = format!("{} ({})", language.say(command.description()), keys.collect::<Vec<_>>().join(", "));
    ui.vertical_centered_justified(|ui| {
        if ui.add_enabled(command.is_enabled(context), button).on_hover_text(tip).clicked() {
            actions.push(Action::Command(command));
        }
    });
}
