//! Which scene, and which of its cameras.

use super::super::fields::Rows;
use super::super::scenes;
use super::{SettingsView, parameters as p};
use crate::{Action, Command, Language, Phrase, Source};
use eframe::egui::{ComboBox, RichText, Ui};
use lancer_core::scene::Scene;

pub(super) fn show(ui: &mut Ui, view: &SettingsView, language: Language, actions: &mut Vec<Action>) {
    let source = view.document.map(|document| document.source());
    Rows { ui: &mut *ui, language }.row(&p::SCENE, &mut (), (), |ui, label, ()| {
        const NONE: Phrase = Phrase::new("None", "Aucune");
        let title = source.map_or_else(|| language.say(NONE).to_owned(), Source::title);
        ComboBox::from_id_salt("scene")
            .selected_text(title)
            .width(ui.available_width())
            .height(SCENE_LIST_HEIGHT)
            .truncate()
            .show_ui(ui, |ui| actions.extend(list(ui, source, view, language)))
            .response
            .labelled_by(label)
    });
    if let Some(Source::Builtin(scene)) = source {
        ui.label(RichText::new(language.say(scenes::summary(*scene))).weak().small());
    }
    if let Some(document) = view.document {
        cameras(ui, document.scene(), view, language, actions);
    }
}

/// Room for all built-in scenes and some files, in points.
const SCENE_LIST_HEIGHT: f32 = 600.0;

/// All that can be opened; what is chosen.
fn list(ui: &mut Ui, current: Option<&Source>, view: &SettingsView, language: Language) -> Option<Action> {
    let mut chosen = None;
    let mut entry = |ui: &mut Ui, source: Source, tip: String| {
        let is_current = current == Some(&source);
        if ui.selectable_label(is_current, source.title()).on_hover_text(tip).clicked() && !is_current {
            chosen = Some(Action::Open(source));
        }
    };
    ui.weak(language.say(scenes::BUILTIN));
    for scene in scenes::builtin_scenes() {
        entry(ui, Source::Builtin(scene), language.say(scenes::summary(scene)).to_owned());
    }
    if !view.recent.is_empty() {
        ui.separator();
        ui.weak(language.say(scenes::RECENT));
        for path in view.recent {
            entry(ui, Source::File(path.clone()), path.display().to_string());
        }
    }
    ui.separator();
    let open = ui.button(language.say(Command::Open.name()));
    if open.on_hover_text(language.say(Command::Open.description())).clicked() {
        chosen = Some(Action::Command(Command::Open));
    }
    chosen
}

fn cameras(ui: &mut Ui, scene: &Scene, view: &SettingsView, language: Language, actions: &mut Vec<Action>) {
    const MAIN: Phrase = Phrase::new("Main camera", "Caméra principale");
    const FREE: Phrase = Phrase::new("Free view", "Vue libre");
    let main = [(None, &scene.camera)];
    let named = scene.cameras.iter().map(|(name, camera)| (Some(name), camera));
    let cameras = || main.into_iter().chain(named.clone());
    let title = |name: Option<&String>| name.cloned().unwrap_or_else(|| language.say(MAIN).to_owned());
    let current = cameras().find(|(_, camera)| *camera == view.camera).map(|(name, _)| name);
    Rows { ui, language }.row(&p::CAMERA, &mut (), (), |ui, label, ()| {
        ComboBox::from_id_salt("camera")
            .selected_text(current.map_or_else(|| language.say(FREE).to_owned(), title))
            .width(ui.available_width())
            .truncate()
            .show_ui(ui, |ui| {
                for (name, _) in cameras() {
                    if ui.selectable_label(current == Some(name), title(name)).clicked() {
                        actions.push(Action::UseCamera(name.cloned()));
                    }
                }
            })
            .response
            .labelled_by(label)
    });
}
