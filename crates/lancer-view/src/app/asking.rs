//! A question before changes are lost.

use super::App;
use crate::Source;
use crate::language::Phrase;
use eframe::egui::{Context, Id, Key, Modal, ViewportCommand};

/// What would lose the changes of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Asking {
    /// Another scene is to be opened.
    Open(Source),
    /// The window is to be closed.
    Quit,
}

const TITLE: Phrase = Phrase::new("Keep your changes?", "Garder vos modifications ?");
const TEXT: Phrase = Phrase::new(
    "The scene has changes that are in no file yet.",
    "La scène a des modifications qui ne sont encore dans aucun fichier.",
);
const SAVE: Phrase = Phrase::new("Save…", "Enregistrer…");
const DISCARD: Phrase = Phrase::new("Discard", "Ne pas garder");
const BACK: Phrase = Phrase::new("Go back", "Revenir");

impl App {
    /// Shows the question, if there is one.
    pub(super) fn ask(&mut self, ctx: &Context) {
        let Some(asking) = self.asking.clone() else { return };
        let language = self.language();
        let (mut save, mut discard, mut back) = (false, false, false);
        let modal = Modal::new(Id::unique("asking")).show(ctx, |ui| {
            ui.set_max_width(360.0);
            ui.heading(language.say(TITLE));
            ui.label(language.say(TEXT));
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                save = ui.button(language.say(SAVE)).clicked();
                discard = ui.button(language.say(DISCARD)).clicked();
                back = ui.button(language.say(BACK)).clicked();
            });
        });
        back |= modal.should_close() || ctx.input(|input| input.key_pressed(Key::Escape));
        if save || discard || back {
            self.asking = None;
        }
        if save {
            self.save_scene(ctx);
        } else if discard {
            match asking {
                Asking::Open(source) => self.open_now(source),
                Asking::Quit => {
                    self.may_close = true;
                    ctx.send_viewport_cmd(ViewportCommand::Close);
                }
            }
        }
    }
}
