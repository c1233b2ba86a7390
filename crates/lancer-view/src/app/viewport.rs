//! The middle of the window: the live picture with the mouse in it, or the renders.

use super::live::OverlayKey;
use super::shelf::Showing;
use super::{Action, App, Selection};
use crate::commands::Command;
use crate::language::Phrase;
use crate::navigation::{Button, Gesture, Modifiers};
use crate::picture::{Readout, Taken};
use eframe::egui::{
    self, Align2, Color32, CursorIcon, FontId, Key, PointerButton, Pos2, Rect, Response, RichText, Role,
    Sense, Stroke, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};
use lancer_core::geometry::DVec2;
use lancer_core::render::{Feature, feature_at};

const LIVE: Phrase = Phrase::new("Live picture", "Image en direct");
const RENDERED: Phrase = Phrase::new("Rendered picture", "Image rendue");
const SPLIT: Phrase = Phrase::new("Split between the two pictures", "Limite entre les deux images");
const INVITATION: Phrase = Phrase::new("Drop a scene or a model here", "Déposez ici une scène ou un modèle");
const OR_OPEN: Phrase = Phrase::new("or open a file…", "ou ouvrez un fichier…");
const DROP: Phrase = Phrase::new("Drop to open", "Déposer pour ouvrir");

/// What is around a picture, without a hue of its own: beside white, a picture would look dark.
const LIGHT_SURROUND: Color32 = Color32::from_gray(206);

/// The same in a dark window.
const DARK_SURROUND: Color32 = Color32::from_gray(20);

/// Turns of a wheel that a pinch to twice the size counts as.
const STEPS_PER_PINCH: f32 = 8.0;

/// How far an arrow key drags, in heights of the viewport.
const KEY_STEP: f64 = 0.03;

/// How near to a light's symbol a click selects it, in points.
const LIGHT_REACH: f64 = 10.0;

impl App {
    /// Shows the middle of the window.
    pub(super) fn viewport(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let rect = ui.available_rect_before_wrap();
        ui.allocate_rect(rect, Sense::hover());
        ui.set_clip_rect(rect);
        let surround = if ui.visuals().dark_mode { DARK_SURROUND } else { LIGHT_SURROUND };
        ui.painter().rect_filled(rect, 0.0, surround);
        self.readout = None;
        match self.shelf.showing {
            Showing::Live => self.live_viewport(ui, rect, actions),
            Showing::Running | Showing::Kept(_) | Showing::Compare(..) => self.render_viewport(ui, rect),
        }
        if ui.ctx().input(|input| !input.raw.hovered_files.is_empty()) {
            announce_drop(ui, rect, self.language().say(DROP));
        }
    }

    /// What can be done where there is nothing to show: after the reading of the first file failed or was cancelled.
    fn invitation(&self, ui: &mut Ui, rect: Rect, actions: &mut Vec<Action>) {
        if self.opening.is_some() {
            return;
        }
        let language = self.language();
        let middle = Rect::from_center_size(rect.center(), vec2(rect.width(), 64.0));
        ui.scope_builder(UiBuilder::new().max_rect(middle), |ui| {
            ui.vertical_centered(|ui| {
                ui.label(RichText::new(language.say(INVITATION)).size(18.0));
                if ui.button(language.say(OR_OPEN)).clicked() {
                    actions.push(Action::Command(Command::Open));
                }
            });
        });
    }

    fn live_viewport(&mut self, ui: &mut Ui, rect: Rect, actions: &mut Vec<Action>) {
        let Some(document) = &self.document else {
            self.invitation(ui, rect, actions);
            return;
        };
        let settings = document.scene().settings;
        let aspect = f64::from(settings.width) / f64::from(settings.height);
        let (picture, size) = fit(rect, aspect, ui.ctx().pixels_per_point());
        self.live.size = size;
        if let Some(texture) = self.live.texture() {
            texture.paint(ui, picture);
        }
        self.paint_overlay(ui, picture);

        let id = ui.scope_id().with("live");
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let label = self.language().say(LIVE);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }
        if response.has_focus() {
            // The arrows move the camera instead of the focus.
            let arrows =
                egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        }
        let to_pixels = ToPixels { origin: picture.min, scale: ui.ctx().pixels_per_point() };
        self.drag(ui, &response, to_pixels);
        self.scroll(ui, &response, to_pixels);
        self.keys(ui, &response);
        self.click(&response, to_pixels, actions);
        if let Some(at) = response.hover_pos() {
            self.read_live(to_pixels.of(at));
        }
    }

    fn paint_overlay(&mut self, ui: &Ui, picture: Rect) {
        let Some(document) = &self.document else { return };
        let key = OverlayKey {
            options: self.preferences.overlay,
            selection: self.selection,
            interest: self.navigator.point_of_interest(),
            dark: self.live.is_dark(),
            pixels_per_point: ui.ctx().pixels_per_point(),
            frame: 0,
        };
        if let Some(texture) = self.live.overlay(ui.ctx(), document.scene(), key) {
            let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            ui.painter().image(texture.id(), picture, uv, Color32::WHITE);
        }
    }

    /// Drags move the camera.
    fn drag(&mut self, ui: &Ui, response: &Response, to_pixels: ToPixels) {
        let viewport = self.viewport_size();
        let buttons = [
            (Button::Left, PointerButton::Primary),
            (Button::Middle, PointerButton::Middle),
            (Button::Right, PointerButton::Secondary),
        ];
        for (button, pointer_button) in buttons {
            if !response.drag_started_by(pointer_button) {
                continue;
            }
            let modifiers = modifiers(ui);
            // Where the button went down, not where the drag was noticed: what was grabbed stays in the hand.
            let origin = ui.input(|input| input.pointer.press_origin());
            let (Some(gesture), Some(origin)) = (self.preferences.scheme.gesture(button, modifiers), origin)
            else {
                continue;
            };
            let at = to_pixels.of(origin);
            let grabbed = self.pick(at).map(|feature| feature.point);
            self.navigator.begin(gesture, at, viewport, grabbed);
        }
        if !self.navigator.is_active() {
            return;
        }
        if let Some(at) = ui.input(|input| input.pointer.interact_pos()) {
            self.navigator.drag_to(to_pixels.of(at));
        }
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        if response.drag_stopped() || !ui.input(|input| input.pointer.any_down()) {
            self.navigator.end();
        }
    }

    /// Wheels, two fingers and pinches move the camera.
    fn scroll(&mut self, ui: &Ui, response: &Response, to_pixels: ToPixels) {
        let Some(at) = response.hover_pos().filter(|_| response.contains_pointer()) else { return };
        let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
        if scroll == Vec2::ZERO && zoom == 1.0 {
            return;
        }
        let at = to_pixels.of(at);
        let under = self.pick(at).map(|feature| feature.point);
        let viewport = self.viewport_size();
        if zoom != 1.0 {
            self.navigator.wheel(f64::from((zoom - 1.0) * STEPS_PER_PINCH), at, viewport, under);
        } else {
            let gesture = self.preferences.scheme.wheel(modifiers(ui));
            // Shift turns the wheel of a mouse sideways.
            let across = if gesture == Gesture::Dolly { 0.0 } else { scroll.x };
            let along = if gesture == Gesture::Dolly { scroll.x + scroll.y } else { scroll.y };
            let by = DVec2::new(f64::from(across), f64::from(along)) * f64::from(to_pixels.scale);
            self.navigator.scroll(gesture, by, at, viewport, under);
        }
        self.live.nudged(ui.ctx());
    }

    /// Arrow keys turn the camera, with Shift move it; plus and minus go nearer and away.
    fn keys(&mut self, ui: &Ui, response: &Response) {
        if !response.has_focus() {
            return;
        }
        let plain = ui.input(|input| !input.modifiers.command && !input.modifiers.alt);
        let pressed = |key| f64::from(u8::from(plain && ui.input(|input| input.key_pressed(key))));
        let across = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
        let down = pressed(Key::ArrowDown) - pressed(Key::ArrowUp);
        let nearer = pressed(Key::Plus) + pressed(Key::Equals) - pressed(Key::Minus);
        let viewport = self.viewport_size();
        if across != 0.0 || down != 0.0 {
            let gesture =
                if ui.input(|input| input.modifiers.shift) { Gesture::Pan } else { Gesture::Rotate };
            self.navigator.nudge(gesture, across * KEY_STEP, down * KEY_STEP);
            self.live.nudged(ui.ctx());
        }
        if nearer != 0.0 {
            self.navigator.wheel(nearer, 0.5 * viewport, viewport, None);
            self.live.nudged(ui.ctx());
        }
    }

    /// A click selects; a double click sets the point of interest.
    fn click(&mut self, response: &Response, to_pixels: ToPixels, actions: &mut Vec<Action>) {
        let Some(at) = response.interact_pointer_pos().map(|at| to_pixels.of(at)) else { return };
        if response.double_clicked() {
            if let Some(feature) = self.pick(at) {
                self.navigator.set_point_of_interest(feature.point);
            }
        } else if response.clicked() {
            let light = self.light_at(at, LIGHT_REACH * f64::from(to_pixels.scale));
            let selection = match (light, self.pick(at)) {
                (Some(light), _) => Selection::Light(light),
                (None, Some(feature)) => Selection::Node(feature.node),
                (None, None) => Selection::None,
            };
            actions.push(Action::Select(selection));
        }
    }

    /// The surface that the live picture shows at a pixel.
    fn pick(&self, at: DVec2) -> Option<Feature> {
        let world = &self.frame_of_document()?.world;
        let (width, height) = self.live.size;
        feature_at(world, &self.navigator.camera(), width, height, at.x, at.y).ok()?
    }

    /// The light whose symbol is near to a pixel, if symbols are shown.
    fn light_at(&self, at: DVec2, reach: f64) -> Option<usize> {
        let document = self.document.as_ref().filter(|_| self.preferences.overlay.lights)?;
        let (width, height) = self.live.size;
        let projection = self.navigator.camera().project(width, height).ok()?;
        let distance = |position| {
            let (x, y, _) = projection.pixel_of(position)?;
            Some((DVec2::new(x, y) - at).length())
        };
        let lights = document.scene().lights.iter().enumerate();
        lights
            .filter_map(|(index, light)| Some((index, distance(light.position)?)))
            .filter(|&(_, distance)| distance <= reach)
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }

    fn read_live(&mut self, at: DVec2) {
        let (Some(frame), Some(document)) = (self.frame_of_document(), &self.document) else { return };
        let size = (frame.width, frame.height);
        let whole = (frame.image.width(), frame.image.height()) == size;
        self.readout = Readout::at(
            at,
            &Taken {
                scene: document.scene(),
                world: &frame.world,
                camera: &frame.camera,
                size,
                image: whole.then_some(&frame.image),
            },
        );
    }

    fn viewport_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.live.size.0), f64::from(self.live.size.1))
    }

    /// Shows a render, to zoom and pan in.
    fn render_viewport(&mut self, ui: &mut Ui, rect: Rect) {
        let Some((width, height)) = self.shelf.shown_size() else { return };
        let scale = ui.ctx().pixels_per_point();
        let to_pixels = ToPixels { origin: rect.min, scale };
        let image = DVec2::new(f64::from(width), f64::from(height));
        let screen = to_pixels.of(rect.max);

        let response = ui.interact(rect, ui.scope_id().with("render"), Sense::click_and_drag());
        let label = self.language().say(RENDERED);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }
        if response.dragged() {
            let by = response.drag_delta() * scale;
            self.shelf.view.pan(DVec2::new(f64::from(by.x), f64::from(by.y)), image, screen);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if let Some(at) = response.hover_pos().filter(|_| response.contains_pointer()) {
            let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
            let factor = f64::from(zoom) * lancer_core::geometry::portable::exp2(f64::from(scroll.y) / 150.0);
            if factor != 1.0 {
                self.shelf.view.zoom_about(factor, to_pixels.of(at), image, screen);
            }
        }
        let corner = self.shelf.view.top_left(image, screen);
        let size = image * self.shelf.view.scale(image, screen);
        let points = |v: DVec2| vec2(v.x as f32, v.y as f32) / scale;
        let picture = Rect::from_min_size(rect.min + points(corner), points(size));
        self.paint_renders(ui, picture);
        if let Showing::Compare(..) = self.shelf.showing {
            self.split_slider(ui, rect, picture);
        }
        if let Some(at) = response.hover_pos() {
            let position = self.shelf.view.image_at(to_pixels.of(at), image, screen);
            self.read_render(position);
        }
    }

    fn paint_renders(&self, ui: &mut Ui, picture: Rect) {
        match self.shelf.showing {
            Showing::Live => {}
            Showing::Running => {
                if let Some(texture) =
                    self.shelf.running.as_ref().and_then(|running| running.texture.as_ref())
                {
                    texture.paint(ui, picture);
                }
            }
            Showing::Kept(index) => {
                if let Some(kept) = self.shelf.kept.get(index) {
                    kept.texture().paint(ui, picture);
                }
            }
            Showing::Compare(left, right) => {
                let border = self.border(picture);
                for (index, part) in [
                    (left, picture.with_max_x(border.min(picture.max.x))),
                    (right, picture.with_min_x(border.max(picture.min.x))),
                ] {
                    if let Some(kept) = self.shelf.kept.get(index) {
                        kept.texture().paint(&clipped(ui, part), picture);
                    }
                }
            }
        }
    }

    /// Where the border of a comparison is on the screen.
    fn border(&self, picture: Rect) -> f32 {
        picture.min.x + self.shelf.split * picture.width()
    }

    /// The border of a comparison, to drag, or to move by the arrow keys.
    fn split_slider(&mut self, ui: &Ui, rect: Rect, picture: Rect) {
        let x = self.border(picture).clamp(rect.min.x, rect.max.x);
        let handle = Rect::from_center_size(pos2(x, rect.center().y), vec2(12.0, rect.height()));
        let id = ui.scope_id().with("split");
        let response = ui.interact(handle, id, Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
        let label = self.language().say(SPLIT);
        let split = f64::from(self.shelf.split);
        response.widget_info(|| WidgetInfo::slider(true, split, label));
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            self.shelf.split = ((at.x - picture.min.x) / picture.width()).clamp(0.0, 1.0);
        }
        if response.has_focus() {
            let arrows = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
            let by = ui.input(|input| {
                f32::from(u8::from(input.key_pressed(Key::ArrowRight)))
                    - f32::from(u8::from(input.key_pressed(Key::ArrowLeft)))
            });
            self.shelf.split = (self.shelf.split + 0.02 * by).clamp(0.0, 1.0);
        }
        let visuals = ui.style().interact(&response);
        ui.painter().vline(x, rect.y_range(), Stroke::new(1.0, Color32::from_gray(230)));
        ui.painter().circle(
            pos2(x, rect.center().y),
            9.0,
            visuals.bg_fill,
            Stroke::new(1.5, Color32::from_gray(230)),
        );
        let arrows = [(-1.0, Align2::RIGHT_CENTER, "<"), (1.0, Align2::LEFT_CENTER, ">")];
        for (side, align, text) in arrows {
            let at = pos2(x + side, rect.center().y);
            ui.painter().text(at, align, text, FontId::proportional(11.0), visuals.text_color());
        }
    }

    fn read_render(&mut self, position: DVec2) {
        let kept = match self.shelf.showing {
            Showing::Kept(index) => self.shelf.kept.get(index),
            Showing::Compare(left, right) => {
                let is_left = self
                    .shelf
                    .shown_size()
                    .is_some_and(|(width, _)| position.x < f64::from(self.shelf.split) * f64::from(width));
                self.shelf.kept.get(if is_left { left } else { right })
            }
            Showing::Live | Showing::Running => None,
        };
        let Some(kept) = kept else { return };
        let (request, image) = (&kept.rendered.request, &kept.rendered.image);
        self.readout = Readout::at(
            position,
            &Taken {
                scene: &request.scene,
                world: &kept.rendered.world,
                camera: &request.camera,
                size: (image.width(), image.height()),
                image: Some(image),
            },
        );
    }
}

/// From the window's points to the pixels of a picture.
#[derive(Clone, Copy)]
struct ToPixels {
    origin: Pos2,
    scale: f32,
}

impl ToPixels {
    fn of(self, at: Pos2) -> DVec2 {
        let pixels = (at - self.origin) * self.scale;
        DVec2::new(f64::from(pixels.x), f64::from(pixels.y))
    }
}

/// The largest picture of an aspect in a rectangle, on whole physical pixels, and its columns and rows.
fn fit(rect: Rect, aspect: f64, pixels_per_point: f32) -> (Rect, (u32, u32)) {
    let available = rect.size() * pixels_per_point;
    let (across, down) = (f64::from(available.x).floor().max(1.0), f64::from(available.y).floor().max(1.0));
    let width = across.min((down * aspect).round().max(1.0));
    let height = down.min((width / aspect).round().max(1.0));
    let size = vec2(width as f32, height as f32);
    let corner = rect.min.to_vec2() * pixels_per_point + (available - size) * 0.5;
    let min = corner.round() / pixels_per_point;
    (Rect::from_min_size(min.to_pos2(), size / pixels_per_point), (width as u32, height as u32))
}

fn modifiers(ui: &Ui) -> Modifiers {
    ui.input(|input| Modifiers {
        shift: input.modifiers.shift,
        ctrl: input.modifiers.command,
        alt: input.modifiers.alt,
    })
}

fn clipped(ui: &mut Ui, part: Rect) -> Ui {
    let mut inner = ui.new_child(UiBuilder::new().max_rect(part));
    inner.set_clip_rect(part.intersect(ui.clip_rect()));
    inner
}

fn announce_drop(ui: &Ui, rect: Rect, text: &str) {
    ui.painter().rect_filled(rect, 0.0, ui.visuals().window_fill.gamma_multiply(0.85));
    let color = ui.visuals().strong_text_color();
    ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(24.0), color);
}
