//! Rows of parameters: a name that explains itself, a control to type into or drag, and a way back.

use crate::{Language, Phrase};
use eframe::egui::{
    Align, Button, ComboBox, DragValue, Id, Label, Layout, Response, RichText, Ui, UiBuilder, Vec2,
    emath::Numeric, vec2,
};
use lancer_core::Rgb;
use lancer_core::geometry::portable;
use std::ops::RangeInclusive;

/// What a parameter is called, and what it means for the picture.
pub(super) struct Parameter {
    pub(super) name: Phrase,
    pub(super) meaning: Phrase,
}

/// Draws rows under one another, in one language.
pub(super) struct Rows<'a> {
    pub(super) ui: &'a mut Ui,
    pub(super) language: Language,
}

/// What is left of a row for its control once the name has its part. With less, "Reflections" is cut; with more,
/// three numbers of a colour are.
const CONTROL_SHARE: f32 = 0.6;

/// Room for the button that goes back.
const RESET_WIDTH: f32 = 20.0;

/// Units that a number changes by for one point of dragging.
pub(super) type Speed = f64;

impl Rows<'_> {
    /// A number.
    pub(super) fn number<N: Numeric>(
        &mut self,
        parameter: &Parameter,
        value: &mut N,
        own: N,
        range: RangeInclusive<N>,
        speed: Speed,
    ) {
        let language = self.language;
        self.row(parameter, value, own, |ui, label, value| {
            let width = ui.available_width();
            number(ui, language, value, range, speed, width).labelled_by(label)
        });
    }

    /// Something that is on or off.
    pub(super) fn switch(&mut self, parameter: &Parameter, value: &mut bool, own: bool) {
        self.row(parameter, value, own, |ui, label, value| ui.checkbox(value, "").labelled_by(label));
    }

    /// A colour, as three numbers that may be above 1 and a button that shows it.
    pub(super) fn color(&mut self, parameter: &Parameter, value: &mut Rgb, own: Rgb) {
        const CHANNELS: [Phrase; 3] =
            [Phrase::new("red", "rouge"), Phrase::new("green", "vert"), Phrase::new("blue", "bleu")];
        let language = self.language;
        let name = language.say(parameter.name);
        self.row(parameter, value, own, |ui, _, value| {
            tighten(ui);
            let mut shown = value.to_array().map(|channel| channel as f32);
            let button = ui.color_edit_button_rgb(&mut shown).accessible_name(name);
            if button.changed() {
                // To the sixth decimal: what a picker can tell apart, without the tail of the narrower float.
                *value = shown.map(|channel| (f64::from(channel) * 1e6).round() / 1e6).into();
            }
            let spacing = ui.spacing().item_spacing.x;
            let width = (ui.available_width() - 2.0 * spacing) / 3.0;
            for (channel, of) in [&mut value.r, &mut value.g, &mut value.b].into_iter().zip(CHANNELS) {
                let of = format!("{name}, {}", language.say(of));
                number(ui, language, channel, 0.0..=MAX_RADIANCE, 0.005, width)
                    .accessible_name(&of)
                    .on_hover_text(of);
            }
            button
        });
    }

    /// A number that the renderer chooses where it is none.
    pub(super) fn automatic(
        &mut self,
        parameter: &Parameter,
        value: &mut Option<u32>,
        usual: u32,
        range: RangeInclusive<u32>,
    ) {
        const AUTOMATIC: Phrase = Phrase::new("automatic", "automatique");
        let language = self.language;
        let name = language.say(parameter.name);
        self.row(parameter, value, None, |ui, label, value| {
            let mut is_automatic = value.is_none();
            let automatic = language.say(AUTOMATIC);
            let switch = ui
                .checkbox(&mut is_automatic, value.map_or(automatic, |_| ""))
                .accessible_name(format!("{name}, {automatic}"));
            *value = if is_automatic { None } else { Some(value.unwrap_or(usual)) };
            match value {
                Some(value) => {
                    let width = ui.available_width();
                    number(ui, language, value, range, 0.1, width).labelled_by(label)
                }
                None => switch,
            }
        });
    }

    /// One of a few.
    pub(super) fn choice<T: Copy + PartialEq>(
        &mut self,
        parameter: &Parameter,
        value: &mut T,
        own: T,
        choices: &[(T, Phrase)],
    ) {
        let language = self.language;
        let name_of = |value: T| {
            choices.iter().find(|(choice, _)| *choice == value).map_or("", |(_, name)| language.say(*name))
        };
        self.row(parameter, value, own, |ui, label, value| {
            ComboBox::from_id_salt(language.say(parameter.name))
                .selected_text(name_of(*value))
                .width(ui.available_width())
                .truncate()
                .show_ui(ui, |ui| {
                    for &(choice, name) in choices {
                        ui.selectable_value(value, choice, language.say(name));
                    }
                })
                .response
                .labelled_by(label)
        });
    }

    /// The name, what `add` draws to change the value, and a button that goes back to the scene's own.
    pub(super) fn row<V: PartialEq>(
        &mut self,
        parameter: &Parameter,
        value: &mut V,
        own: V,
        add: impl FnOnce(&mut Ui, Id, &mut V) -> Response,
    ) {
        const RESET: Phrase = Phrase::new("Reset", "Rétablir :");
        const TO_WHAT: Phrase =
            Phrase::new("Back to the scene’s own value", "Revenir à la valeur de la scène");
        let (name, meaning) = (self.language.say(parameter.name), self.language.say(parameter.meaning));
        let height = self.ui.spacing().interact_size.y;
        self.ui.horizontal(|ui| {
            let spacing = ui.spacing().item_spacing.x;
            let width = ui.available_width() - RESET_WIDTH - 2.0 * spacing;
            let label = cell(ui, vec2(width * (1.0 - CONTROL_SHARE), height), |ui| {
                ui.add(Label::new(name).truncate()).on_hover_text(meaning)
            });
            cell(ui, vec2(width * CONTROL_SHARE, height), |ui| {
                add(ui, label.id, value).on_hover_text(meaning);
            });
            cell(ui, vec2(RESET_WIDTH, height), |ui| {
                if *value != own
                    && ui
                        .add(Button::new(RichText::new("↺").size(16.0)).frame(false))
                        .accessible_name(format!("{} {name}", self.language.say(RESET)))
                        .on_hover_text(self.language.say(TO_WHAT))
                        .clicked()
                {
                    *value = own;
                }
            });
        });
    }
}

/// The brightest light that can be set: beyond, squares and sums come near to what a float can hold.
const MAX_RADIANCE: f64 = 1e9;

/// Makes room for several numbers in a row.
pub(super) fn tighten(ui: &mut Ui) {
    let spacing = ui.spacing_mut();
    spacing.item_spacing.x = 4.0;
    spacing.button_padding.x = 2.0;
    spacing.interact_size.x = 24.0;
}

fn cell<R>(ui: &mut Ui, size: Vec2, add: impl FnOnce(&mut Ui) -> R) -> R {
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        add(ui)
    })
    .inner
}

/// A number to type or to drag. What is typed counts once it is finished, so that 1920 is not rendered at 1, 19 and
/// 192 first.
pub(super) fn number<N: Numeric>(
    ui: &mut Ui,
    language: Language,
    value: &mut N,
    range: RangeInclusive<N>,
    speed: Speed,
    width: f32,
) -> Response {
    let height = ui.spacing().interact_size.y;
    // A field that is left as it was writes what it shows; the decimals that it does not show must not be lost by it.
    let digits = if width < ROOM_FOR_FIVE_DIGITS { 4 } else { 5 };
    let shown = parse_number(&number_text(value.to_f64(), digits, language));
    let drag = DragValue::from_get_set(move |new| {
        if let Some(new) = new.filter(|new| Some(*new) != shown) {
            *value = N::from_f64(new);
        }
        value.to_f64()
    });
    let drag = if N::INTEGRAL { drag.max_decimals(0) } else { drag };
    // A long number is cut, and does not widen the panel.
    let (_, rect) = ui.allocate_space(vec2(width, height));
    let mut field =
        ui.new_child(UiBuilder::new().max_rect(rect).layout(Layout::left_to_right(Align::Center)));
    field.shrink_clip_rect(rect);
    field.add(
        drag.range(range)
            .clamp_existing_to_range(false)
            .speed(speed)
            .update_while_editing(false)
            .custom_formatter(move |value, _| number_text(value, digits, language))
            .custom_parser(parse_number)
            .min_size(vec2(width, height))
            .clip_text(true),
    )
}

/// The width in points in which "0.8714" is not cut.
const ROOM_FOR_FIVE_DIGITS: f32 = 52.0;

/// A number with at most so many digits, or all of those before the decimal mark, which is that of the language.
fn number_text(value: f64, digits: i32, language: Language) -> String {
    // A zero before the mark counts as a digit.
    let power = |exponent: i32| portable::pow(10.0, exponent.into());
    let decimals = (1..digits).rev().find(|&decimals| value.abs() < power(digits - decimals)).unwrap_or(0);
    let text = if value != 0.0 && value.abs() < 1e-3 {
        format!("{:e}", format!("{value:.2e}").parse().unwrap_or(value))
    } else {
        ((value * power(decimals)).round() / power(decimals)).to_string()
    };
    match language {
        Language::English => text,
        Language::French => text.replace('.', ","),
    }
}

/// A finite number with a point or a comma; none for what is no such thing.
pub(super) fn parse_number(text: &str) -> Option<f64> {
    let text = text
        .chars()
        .filter(|c| !c.is_whitespace())
        .map(|c| match c {
            ',' => '.',
            '\u{2212}' => '-',
            c => c,
        })
        .collect::<String>();
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_have_the_decimal_mark_of_the_language() {
        assert_eq!(number_text(0.1 + 0.2, 5, Language::English), "0.3");
        assert_eq!(number_text(2.5, 5, Language::French), "2,5");
        assert_eq!(number_text(1920.0, 5, Language::French), "1920");
        assert_eq!(number_text(2e-5, 5, Language::English), "2e-5");
        assert_eq!(number_text(-1.0 / 3e4, 5, Language::English), "-3.33e-5");
        assert_eq!(number_text(0.8714, 4, Language::English), "0.871");
        assert_eq!(number_text(-672.1234, 5, Language::English), "-672.12");
        assert_eq!(number_text(1_234_567.8, 5, Language::English), "1234568");
    }

    #[test]
    fn what_is_shown_can_be_typed_again() {
        for language in Language::ALL {
            for value in [0.0, -1.5, 1e-6, 0.25, 65_535.0] {
                assert_eq!(parse_number(&number_text(value, 5, language)), Some(value));
            }
        }
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        for text in ["", "-", "a", "1.2.3", "NaN", "inf", "1e999"] {
            assert_eq!(parse_number(text), None, "{text:?}");
        }
    }
}
