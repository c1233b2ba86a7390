//! What is selected, with all that can be changed about it.
//!
//! In: the document and what is selected. Out: edits as actions, and where one use of one control ends. Each value
//! can be typed or dragged, says which term of the formula it is, and can be set back to what was loaded.

mod controls;
mod light;
mod material;
mod node;
mod pose;
#[cfg(test)]
mod tests;

use super::fields::{Parameter, Rows};
use super::scene_tree;
use crate::{Action, Document, Edit, Language, Phrase, Selection};
use controls::Split;
use eframe::egui::{Id, Label, RichText, ScrollArea, Ui};
use lancer_core::scene::{Light, NodeId, Scene};
use node::LastPose;

/// The inspector's own state.
#[derive(Clone, Debug, Default)]
pub struct InspectorState {
    /// What was shown last.
    selection: Selection,
    /// Which coefficients are shown by channel though they are grey.
    split: Split,
    /// The pose that was set last: some of its angles cannot be told from the transform.
    pose: Option<LastPose>,
    /// Why the last edit was not made.
    refused: Option<Phrase>,
    gesture: Gesture,
}

/// Draws the inspector into all of `ui`.
pub fn show(
    ui: &mut Ui,
    document: &Document,
    selection: Selection,
    state: &mut InspectorState,
    language: Language,
    actions: &mut Vec<Action>,
) {
    if selection != state.selection {
        *state = InspectorState { selection, gesture: state.gesture, ..InspectorState::default() };
    }
    let mut wishes = Vec::new();
    ScrollArea::vertical().id_salt(("inspector", place_of(selection))).auto_shrink([false, true]).show(
        ui,
        |ui| {
            let scene = document.scene();
            heading(ui, &title(selection, scene, language));
            ui.push_id(place_of(selection), |ui| {
                let mut view = View { document, language, wishes: &mut wishes };
                match selection {
                    Selection::None => view.scene(ui),
                    Selection::Node(id) => node::show(&mut view, ui, id, state),
                    Selection::Light(index) => light::show(&mut view, ui, index, &mut state.split),
                    Selection::Material(id) => material::show(&mut view, ui, id, &mut state.split, true),
                }
            });
            if let Some(reason) = state.refused {
                ui.colored_label(ui.visuals().warn_fg_color, language.say(reason));
            }
        },
    );
    state.gesture.pass_on(ui, wishes, actions);
}

/// A number for what is selected, so that a control of one thing is not taken for that of another.
fn place_of(selection: Selection) -> (u8, usize) {
    match selection {
        Selection::None => (0, 0),
        Selection::Node(id) => (1, id.index()),
        Selection::Light(index) => (2, index),
        Selection::Material(id) => (3, id.index()),
    }
}

fn title(selection: Selection, scene: &Scene, language: Language) -> String {
    let kind = match selection {
        Selection::None => Phrase::new("Scene", "Scène"),
        Selection::Node(_) => Phrase::new("Object", "Objet"),
        Selection::Light(_) => Phrase::new("Light", "Lumière"),
        Selection::Material(_) => Phrase::new("Material", "Matériau"),
    };
    let (kind, name) = (language.say(kind), scene_tree::name_of(selection, scene, language));
    if name.is_empty() {
        return kind.to_owned();
    }
    format!("{kind}{}{name}", language.say(Phrase::new(": ", " : ")))
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(ui.spacing().item_spacing.y);
    ui.add(Label::new(RichText::new(text).strong()).truncate());
}

/// What the parts of the inspector draw from, and where they say what is wanted.
struct View<'a> {
    document: &'a Document,
    language: Language,
    wishes: &'a mut Vec<Wish>,
}

/// What a part wants.
enum Wish {
    /// An edit by a control that is used for a while: dragged or typed into.
    Edit(Edit),
    /// What is done at once: a switch, a choice, a button.
    Once(Action),
}

impl View<'_> {
    fn scene(&mut self, ui: &mut Ui) {
        let add = Phrase::new("Add a light", "Ajouter une lumière");
        if ui.button(self.language.say(add)).clicked() {
            let scene = self.document.scene();
            let mut lights = scene.lights.clone();
            lights.push(light::new_for(scene));
            let index = lights.len() - 1;
            self.once(Edit::Lights(lights));
            self.wishes.push(Wish::Once(Action::Select(Selection::Light(index))));
        }
    }

    fn edit(&mut self, edit: Edit) {
        self.wishes.push(Wish::Edit(edit));
    }

    fn once(&mut self, edit: Edit) {
        self.wishes.push(Wish::Once(Action::Edit(edit)));
        self.wishes.push(Wish::Once(Action::EndGesture));
    }

    /// A light as it was loaded, if it was.
    fn saved_light(&self, index: usize) -> Option<&Light> {
        self.document.saved().lights.get(index)
    }

    /// Whether a node is in the scene: a selection may be older than the scene.
    fn has_node(&self, id: NodeId) -> bool {
        id.index() < self.document.scene().nodes().len()
    }
}

/// Tells where the use of one control ends, so that it is one step of the history.
#[derive(Clone, Copy, Debug, Default)]
struct Gesture {
    /// The control that the last edits came from; none where that use has ended.
    control: Option<Id>,
}

impl Gesture {
    fn pass_on(&mut self, ui: &Ui, wishes: Vec<Wish>, actions: &mut Vec<Action>) {
        // What is dragged, or else typed into.
        let in_use = ui.ctx().dragged_id().or_else(|| ui.memory(eframe::egui::Memory::focused));
        if self.control.is_some() && self.control != in_use {
            self.control = None;
            actions.push(Action::EndGesture);
        }
        for wish in wishes {
            match wish {
                Wish::Edit(edit) => {
                    actions.push(Action::Edit(edit));
                    self.control = in_use;
                    if in_use.is_none() {
                        actions.push(Action::EndGesture);
                    }
                }
                Wish::Once(action) => actions.push(action),
            }
        }
    }
}
