//! The strip of renders below the picture: the live one, the one being made, and those that are kept.

use super::shelf::{Kept, Running, Showing};
use super::{Action, App};
use crate::language::Phrase;
use eframe::egui::{
    self, Align2, Button, Color32, FontId, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
    pos2, vec2,
};

const LIVE: Phrase = Phrase::new("Live", "En direct");
const LIVE_TIP: Phrase =
    Phrase::new("Back to the live picture, where the mouse moves the camera", "Revenir à l’image en direct");
const RENDERING: Phrase = Phrase::new("Rendering", "Rendu en cours");
const REMOVE: Phrase = Phrase::new("Forget this render", "Oublier ce rendu");
const USE_VIEW: Phrase = Phrase::new("Look from here again", "Reprendre ce point de vue");
const SAVE: Phrase = Phrase::new("Save picture…", "Enregistrer l’image…");
const COMPARE: Phrase = Phrase::new("Compare with the one before", "Comparer au précédent");
const COMPARE_WITH: Phrase = Phrase::new("Compare with the one shown", "Comparer à celui affiché");

/// The height of a picture in the strip, in points.
const HEIGHT: f32 = 58.0;

impl App {
    /// Shows the strip; nothing while there is no render.
    pub(super) fn strip(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        ScrollArea::horizontal().show(ui, |ui| {
            ui.horizontal(|ui| {
                self.live_entry(ui);
                for index in 0..self.shelf.kept.len() {
                    self.kept_entry(ui, index, actions);
                }
                self.running_entry(ui);
            });
        });
    }

    fn live_entry(&mut self, ui: &mut Ui) {
        let is_shown = self.shelf.showing == Showing::Live;
        let button = Button::new(self.language().say(LIVE)).selected(is_shown).min_size(vec2(64.0, HEIGHT));
        if ui.add(button).on_hover_text(self.language().say(LIVE_TIP)).clicked() {
            self.shelf.showing = Showing::Live;
        }
    }

    fn kept_entry(&mut self, ui: &mut Ui, index: usize, actions: &mut Vec<Action>) {
        let language = self.language();
        let Some(kept) = self.shelf.kept.get(index) else { return };
        let is_shown = match self.shelf.showing {
            Showing::Kept(shown) => shown == index,
            Showing::Compare(a, b) => a == index || b == index,
            Showing::Live | Showing::Running => false,
        };
        let response =
            entry(ui, &kept.title, size_of(kept), is_shown, |ui, rect| kept.texture().paint(ui, rect));
        let response = response.on_hover_text(kept.summary());
        if response.clicked() {
            self.shelf.showing = if ui.input(|input| input.modifiers.shift) {
                self.compare_with(index)
            } else {
                Showing::Kept(index)
            };
        }
        response.context_menu(|ui| {
            if ui.button(language.say(SAVE)).clicked() {
                self.shelf.showing = Showing::Kept(index);
                actions.push(Action::Command(crate::commands::Command::SavePicture));
            }
            if ui.button(language.say(USE_VIEW)).clicked() {
                let camera = self.shelf.kept[index].rendered.request.camera;
                self.navigator.set_camera(camera);
                self.shelf.showing = Showing::Live;
            }
            let can_compare = self.shelf.kept.len() > 1;
            let compare = if is_shown { COMPARE } else { COMPARE_WITH };
            if ui.add_enabled(can_compare, Button::new(language.say(compare))).clicked() {
                self.shelf.showing = self.compare_with(index);
            }
            if ui.button(language.say(REMOVE)).clicked() {
                self.shelf.remove(index);
            }
        });
    }

    /// The comparison of a render with the one shown, older to the left; with the one before where it is shown.
    fn compare_with(&self, index: usize) -> Showing {
        let other = match self.shelf.showing {
            Showing::Kept(shown) | Showing::Compare(shown, _) if shown != index => shown,
            _ if index > 0 => index - 1,
            _ if self.shelf.kept.len() > 1 => 1,
            _ => return Showing::Kept(index),
        };
        Showing::Compare(index.min(other), index.max(other))
    }

    fn running_entry(&mut self, ui: &mut Ui) {
        let Some(running) = &self.shelf.running else { return };
        let is_shown = self.shelf.showing == Showing::Running;
        let label = self.language().say(RENDERING);
        let response = entry(ui, label, running.size, is_shown, |ui, rect| paint_running(ui, rect, running));
        if response.clicked() {
            self.shelf.showing = Showing::Running;
        }
    }
}

/// A small picture with a name, to click.
fn entry(
    ui: &mut Ui,
    title: &str,
    (width, height): (u32, u32),
    is_shown: bool,
    paint: impl FnOnce(&Ui, Rect),
) -> egui::Response {
    let aspect = (width as f32 / height as f32).clamp(0.3, 4.0);
    let (rect, response) = ui.allocate_exact_size(vec2(HEIGHT * aspect, HEIGHT), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, title));
    paint(ui, rect);
    let bar = Rect::from_min_max(pos2(rect.min.x, rect.max.y - 15.0), rect.max);
    ui.painter().rect_filled(bar, 0.0, Color32::from_black_alpha(150));
    let text = ui.painter().with_clip_rect(rect);
    text.text(
        bar.left_center() + vec2(4.0, 0.0),
        Align2::LEFT_CENTER,
        title,
        FontId::proportional(10.5),
        Color32::WHITE,
    );
    let stroke = if is_shown {
        Stroke::new(2.0, ui.visuals().selection.stroke.color)
    } else if response.hovered() || response.has_focus() {
        Stroke::new(1.5, ui.visuals().widgets.hovered.fg_stroke.color)
    } else {
        Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color)
    };
    ui.painter().rect_stroke(rect, 3.0, stroke, StrokeKind::Inside);
    response
}

fn paint_running(ui: &Ui, rect: Rect, running: &Running) {
    ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    if let Some(texture) = &running.texture {
        texture.paint(ui, rect);
    }
    let bar = Rect::from_min_size(rect.min, vec2(rect.width() * running.done, 3.0));
    ui.painter().rect_filled(bar, 0.0, ui.visuals().selection.bg_fill);
}

fn size_of(kept: &Kept) -> (u32, u32) {
    (kept.rendered.image.width(), kept.rendered.image.height())
}
