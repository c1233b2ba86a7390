//! A point light: where it is, and L_i.

use super::controls::{LARGE, Split, speed_of};
use super::{Parameter, Rows, View, Wish};
use crate::{Action, Edit, Phrase, Selection};
use eframe::egui::Ui;
use lancer_core::Rgb;
use lancer_core::scene::{Light, Scene};
use std::f64::consts::PI;

/// Draws the light, and says what is changed about it.
pub(super) fn show(view: &mut View, ui: &mut Ui, index: usize, split: &mut Split) {
    let lights = &view.document.scene().lights;
    let Some(light) = lights.get(index) else { return };
    let saved = view.saved_light(index).unwrap_or(light).clone();
    let mut edited = light.clone();
    let rows = &mut Rows { ui, language: view.language };
    rows.text(&NAME, &mut edited.name, saved.name);
    let speed = speed_of(edited.position.abs().max_element());
    rows.vector(&POSITION, &mut edited.position, saved.position, -LARGE..=LARGE, speed);
    let speed = speed_of(edited.intensity.max_channel());
    rows.coefficient(&INTENSITY, &mut edited.intensity, saved.intensity, speed, split);
    let remove = view.language.say(Phrase::new("Remove this light", "Supprimer cette lumière"));
    if ui.button(remove).clicked() {
        let mut left = lights.clone();
        left.remove(index);
        view.once(Edit::Lights(left));
        view.wishes.push(Wish::Once(Action::Select(Selection::None)));
    } else if edited != *light {
        view.edit(Edit::Light(index, edited));
    }
}

/// A light at the scene's eye, which sees all that is lit, and as bright as what it looks at asks for.
pub(super) fn new_for(scene: &Scene) -> Light {
    let distance = (scene.camera.eye - scene.camera.target).length();
    // Gives 1 at the distance of what is looked at.
    Light { name: String::new(), position: scene.camera.eye, intensity: Rgb::grey(PI * distance * distance) }
}

const NAME: Parameter = Parameter {
    name: Phrase::new("Name", "Nom"),
    meaning: Phrase::new("What the light is called", "Comment s’appelle la lumière"),
};

const POSITION: Parameter = Parameter {
    name: Phrase::same("Position"),
    meaning: Phrase::new(
        "Where the light is, in the world; r is the distance from there to the surface.",
        "Où se trouve la lumière, dans le monde ; r est la distance de là à la surface.",
    ),
};

const INTENSITY: Parameter = Parameter {
    name: Phrase::new("L_i intensity", "L_i intensité"),
    meaning: Phrase::new(
        "L_i: at the distance r a surface gets L_i / (pi r²) of it.",
        "L_i : à la distance r, une surface en reçoit L_i / (pi r²).",
    ),
};
