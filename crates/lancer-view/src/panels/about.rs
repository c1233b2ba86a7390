//! What this program is.

use crate::{Language, Phrase};
use eframe::egui::{Context, Id, Key, Modal};

const WHAT: Phrase = Phrase::new(
    "A recursive (Whitted) ray tracer for the CPU: exact, repeatable pictures of scenes and meshes.",
    "Un lanceur de rayons récursif (Whitted) sur processeur : des images exactes et reproductibles de scènes et de maillages.",
);
const LICENCE: Phrase =
    Phrase::new("Free software, under MIT or Apache-2.0.", "Logiciel libre, sous MIT ou Apache-2.0.");
const CLOSE: Phrase = Phrase::new("Close", "Fermer");

/// Draws it over everything. Returns whether it stays open.
#[must_use]
pub fn show(ctx: &Context, language: Language) -> bool {
    let mut is_closed = false;
    let modal = Modal::new(Id::unique("about")).show(ctx, |ui| {
        ui.set_max_width(380.0);
        ui.heading(concat!("Lancer ", env!("CARGO_PKG_VERSION")));
        ui.label(language.say(WHAT));
        ui.label(language.say(LICENCE));
        ui.add_space(8.0);
        is_closed = ui.button(language.say(CLOSE)).clicked();
    });
    !(is_closed || modal.should_close() || ctx.input(|input| input.key_pressed(Key::Escape)))
}
