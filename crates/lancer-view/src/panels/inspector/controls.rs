//! Rows that only the inspector has.

use super::super::fields::{Parameter, Rows, Speed, number, tighten};
use crate::Phrase;
use eframe::egui::{Button, TextEdit, TextStyle, TextWrapMode, Ui, WidgetText};
use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use std::collections::HashSet;
use std::ops::RangeInclusive;

/// The parameters that are shown by channel though all channels are the same, by their English names.
pub(super) type Split = HashSet<&'static str>;

/// The largest coordinate and light that can be set: beyond, squares and their sums come near to where a float no
/// longer tells neighbours apart.
pub(super) const LARGE: f64 = 1e9;

const CHANNELS: [Phrase; 3] =
    [Phrase::new("red", "rouge"), Phrase::new("green", "vert"), Phrase::new("blue", "bleu")];

impl Rows<'_> {
    /// One number for all channels, or with the button pressed one for each.
    pub(super) fn coefficient(
        &mut self,
        parameter: &Parameter,
        value: &mut Rgb,
        own: Rgb,
        speed: Speed,
        split: &mut Split,
    ) {
        const RGB: &str = "RGB";
        const SPLIT: Phrase = Phrase::new("by channel", "par canal");
        const MEANING: Phrase = Phrase::new(
            "One number each for red, green and blue",
            "Un nombre pour le rouge, le vert et le bleu",
        );
        let language = self.language;
        let (key, name) = (crate::Language::English.say(parameter.name), language.say(parameter.name));
        self.row(parameter, value, own, |ui, label, value| {
            tighten(ui);
            let is_grey = value.r == value.g && value.g == value.b;
            let is_split = !is_grey || split.contains(key);
            let spacing = ui.spacing().item_spacing.x;
            let room = ui.available_width() - button_width(ui, RGB) - spacing;
            let response = if is_split {
                let width = (room - 2.0 * spacing) / 3.0;
                let [red, green, blue] = [&mut value.r, &mut value.g, &mut value.b]
                    .map(|channel| number(ui, language, channel, 0.0..=LARGE, speed, width));
                let responses = [red, green, blue];
                for (response, channel) in responses.iter().zip(CHANNELS) {
                    let text = format!("{name}, {}", language.say(channel));
                    response.clone().accessible_name(&text).on_hover_text(text);
                }
                let [red, green, blue] = responses;
                red | green | blue
            } else {
                let mut grey = value.r;
                let response = number(ui, language, &mut grey, 0.0..=LARGE, speed, room).labelled_by(label);
                if grey != value.r {
                    *value = Rgb::grey(grey);
                }
                response
            };
            let button = ui
                .add(Button::selectable(is_split, RGB))
                .accessible_name(format!("{name}, {}", language.say(SPLIT)))
                .on_hover_text(language.say(MEANING));
            if button.clicked() {
                if is_split {
                    split.remove(key);
                    if !is_grey {
                        *value = Rgb::grey((value.r + value.g + value.b) / 3.0);
                    }
                } else {
                    split.insert(key);
                }
            }
            response
        });
    }

    /// Three numbers along the axes.
    pub(super) fn vector(
        &mut self,
        parameter: &Parameter,
        value: &mut DVec3,
        own: DVec3,
        range: RangeInclusive<f64>,
        speed: Speed,
    ) {
        let language = self.language;
        let name = language.say(parameter.name);
        self.row(parameter, value, own, |ui, _, value| {
            tighten(ui);
            let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
            let [x, y, z] = [&mut value.x, &mut value.y, &mut value.z]
                .map(|coordinate| number(ui, language, coordinate, range.clone(), speed, width));
            for (response, axis) in [&x, &y, &z].into_iter().zip(["x", "y", "z"]) {
                let text = format!("{name}, {axis}");
                response.clone().accessible_name(&text).on_hover_text(text);
            }
            x | y | z
        });
    }

    /// A line of text.
    pub(super) fn text(&mut self, parameter: &Parameter, value: &mut String, own: String) {
        self.row(parameter, value, own, |ui, label, value| {
            let width = ui.available_width();
            ui.add(TextEdit::singleline(value).desired_width(width)).labelled_by(label)
        });
    }
}

/// How wide a button is with this text.
fn button_width(ui: &Ui, text: &str) -> f32 {
    let text =
        WidgetText::from(text).into_galley(ui, Some(TextWrapMode::Extend), f32::INFINITY, TextStyle::Button);
    text.size().x + 2.0 * ui.spacing().button_padding.x
}

/// How fast a length changes by dragging: the large ones faster.
pub(super) fn speed_of(length: f64) -> Speed {
    if length.is_finite() { (length.abs() * 0.005).clamp(0.005, 1e6) } else { 1.0 }
}

/// A row over the whole width, for a matrix.
pub(super) fn numbers<const N: usize>(
    ui: &mut Ui,
    language: crate::Language,
    values: [(&mut f64, String); N],
) {
    ui.horizontal(|ui| {
        tighten(ui);
        let spacing = ui.spacing().item_spacing.x;
        let width = (ui.available_width() - (N as f32 - 1.0) * spacing) / N as f32;
        for (value, name) in values {
            let speed = speed_of(*value);
            number(ui, language, value, -LARGE..=LARGE, speed, width)
                .accessible_name(&name)
                .on_hover_text(name);
        }
    });
}
