//! The tree of the scene: nodes, lights, materials and cameras, to select, hide and find.
//!
//! In: the document and what is selected. Out: what the user wants, as actions. Only the rows in sight are drawn, so
//! that a frame costs the same for ten nodes and for a hundred thousand.

mod rows;
#[cfg(test)]
mod tests;

use crate::{Action, Document, Edit, Language, Phrase, Selection};
use eframe::egui::epaint::QuadraticBezierShape;
use eframe::egui::text::{LayoutJob, TextFormat, TextWrapping};
use eframe::egui::{
    Align, Color32, Context, EventFilter, FontId, Id, Key as Button, Modifiers, Painter, Pos2, Rect,
    Response, Role, ScrollArea, Sense, Shape, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, pos2, vec2,
};
use lancer_core::scene::{NodeId, Scene};
use rows::{Item, Key, Row, Section};
use std::collections::HashSet;

/// What is unfolded, and where the keyboard is. A new one for a new scene; kept where a scene is loaded again.
#[derive(Clone, Debug)]
pub struct TreeState {
    unfolded: HashSet<Key>,
    rows: Vec<Row>,
    /// The revision that the rows are of; none where they are to be listed anew.
    listed: Option<u64>,
    /// The row that the keys act on.
    cursor: Option<Key>,
    selection: Selection,
    /// Whether to scroll to the cursor.
    follow: bool,
    /// The part of the list that was in sight, in points from its top.
    in_sight: (f32, f32),
}

impl Default for TreeState {
    fn default() -> Self {
        let unfolded = [Section::Objects, Section::Lights, Section::Materials].map(Section::key);
        Self {
            unfolded: unfolded.into(),
            rows: Vec::new(),
            listed: None,
            cursor: None,
            selection: Selection::None,
            follow: false,
            in_sight: (0.0, 0.0),
        }
    }
}

/// Draws the tree into all of `ui`.
pub fn show(
    ui: &mut Ui,
    document: &Document,
    selection: Selection,
    state: &mut TreeState,
    language: Language,
    actions: &mut Vec<Action>,
) {
    let scene = document.scene();
    if selection != state.selection {
        state.reveal(scene, selection);
    }
    if state.listed != Some(document.revision()) {
        state.list(document);
    }
    let base = ui.scope_id().with("scene tree");
    if state.cursor.is_some_and(|cursor| ui.memory(|memory| memory.has_focus(row_id(base, cursor)))) {
        state.press_keys(ui, base, document, actions);
    }

    let height = ui.spacing().interact_size.y;
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut area = ScrollArea::vertical().id_salt("scene tree").auto_shrink(false);
    if std::mem::take(&mut state.follow)
        && let Some(offset) = state.offset_to_cursor(height)
    {
        area = area.vertical_scroll_offset(offset);
    }
    let count = state.rows.len();
    let output = area.show_rows(ui, height, count, |ui, range| {
        let mut drawn = Drawn { scene, selection, language, base, asked: None, focused: None };
        // Without a cursor the first row in sight is where the keyboard comes in.
        let entrance = state.cursor_index().filter(|index| range.contains(index)).unwrap_or(range.start);
        for index in range {
            drawn.row(ui, state.rows[index], index == entrance, actions);
        }
        (drawn.asked, drawn.focused)
    });
    state.in_sight = (output.state.clamped_offset().y, output.inner_rect.height());
    let (asked, focused) = output.inner;
    state.cursor = focused.or(state.cursor);
    match asked {
        Some(Asked::Go(key)) => state.go(ui.ctx(), base, key, actions),
        Some(Asked::Fold(key)) => state.fold(key),
        None => {}
    }
}

/// What something is called that can be selected: by its author, or else after what it is.
pub(super) fn name_of(item: Selection, scene: &Scene, language: Language) -> String {
    let item = match item {
        Selection::None => return scene.name.clone(),
        Selection::Node(id) => Item::Node(id),
        Selection::Light(index) => Item::Light(index),
        Selection::Material(id) => Item::Material(id),
    };
    item.name(scene, language).into_owned()
}

/// What a row asks of the state.
#[derive(Clone, Copy)]
enum Asked {
    /// Put the cursor there, and select it.
    Go(Key),
    /// Fold or unfold it.
    Fold(Key),
}

fn row_id(base: Id, key: Key) -> Id {
    base.with(key)
}

impl TreeState {
    fn list(&mut self, document: &Document) {
        self.rows = rows::list(document.scene(), &self.unfolded);
        self.listed = Some(document.revision());
    }

    fn cursor_index(&self) -> Option<usize> {
        let cursor = self.cursor?;
        self.rows.iter().position(|row| row.key == cursor)
    }

    /// Unfolds what lies above a selection that was made elsewhere, as by a click on the picture.
    fn reveal(&mut self, scene: &Scene, selection: Selection) {
        self.selection = selection;
        let way = rows::way_to(scene, selection);
        if let [above @ .., last] = &way[..] {
            self.unfolded.extend(above);
            self.cursor = Some(*last);
            self.follow = true;
            self.listed = None;
        }
    }

    fn fold(&mut self, key: Key) {
        if !self.unfolded.remove(&key) {
            self.unfolded.insert(key);
        }
        self.listed = None;
    }

    /// Puts the cursor, and with it the keyboard's focus, on a row, and selects it.
    fn go(&mut self, ctx: &Context, base: Id, key: Key, actions: &mut Vec<Action>) {
        self.cursor = Some(key);
        self.follow = true;
        ctx.memory_mut(|memory| memory.request_focus(row_id(base, key)));
        let row = self.cursor_index().map(|index| self.rows[index]);
        if let Some(selection) = row.and_then(|row| row.item.selection())
            && selection != self.selection
        {
            // Made here, so that it is not looked for elsewhere in the tree.
            self.selection = selection;
            actions.push(Action::Select(selection));
        }
    }

    fn press_keys(&mut self, ui: &Ui, base: Id, document: &Document, actions: &mut Vec<Action>) {
        let Some(index) = self.cursor_index() else { return };
        let row = self.rows[index];
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let last = self.rows.len() - 1;
        let mut to = None;
        if pressed(Button::ArrowDown) {
            to = Some((index + 1).min(last));
        } else if pressed(Button::ArrowUp) {
            to = Some(index.saturating_sub(1));
        } else if pressed(Button::Home) {
            to = Some(0);
        } else if pressed(Button::End) {
            to = Some(last);
        } else if pressed(Button::ArrowRight) {
            match row.unfolded {
                Some(false) => self.fold(row.key),
                Some(true) => to = Some((index + 1).min(last)),
                None => {}
            }
        } else if pressed(Button::ArrowLeft) {
            match row.unfolded {
                Some(true) => self.fold(row.key),
                _ => to = self.rows[..index].iter().rposition(|above| above.depth < row.depth),
            }
        } else if pressed(Button::Enter) {
            activate(row, document.scene(), actions);
            if let Item::Section(_) = row.item {
                self.fold(row.key);
            }
        } else if pressed(Button::H)
            && let Item::Node(id) = row.item
        {
            toggle_hidden(document.scene(), id, actions);
        }
        if let Some(to) = to {
            self.go(ui.ctx(), base, self.rows[to].key, actions);
        }
        if self.listed.is_none() {
            self.list(document);
        }
    }

    /// How far to scroll so that the cursor is in sight; none if it is.
    fn offset_to_cursor(&self, height: f32) -> Option<f32> {
        let top = self.cursor_index()? as f32 * height;
        let (offset, shown) = self.in_sight;
        if top < offset {
            Some(top)
        } else if top + height > offset + shown {
            Some((top + height - shown).max(0.0))
        } else {
            None
        }
    }
}

/// What a double click or the return key does.
fn activate(row: Row, scene: &Scene, actions: &mut Vec<Action>) {
    match row.item {
        Item::Node(_) | Item::Light(_) => actions.extend(row.item.selection().map(Action::Frame)),
        Item::Camera(index) => use_camera(scene, index, actions),
        Item::Section(_) | Item::Material(_) | Item::More(_) => {}
    }
}

fn use_camera(scene: &Scene, index: Option<usize>, actions: &mut Vec<Action>) {
    let name = index.and_then(|index| scene.cameras.get(index)).map(|(name, _)| name.clone());
    actions.push(Action::UseCamera(name));
}

fn toggle_hidden(scene: &Scene, id: NodeId, actions: &mut Vec<Action>) {
    actions.push(Action::Edit(Edit::Hidden(id, !scene.node(id).hidden)));
    actions.push(Action::EndGesture);
}

/// Points that a row stands further to the right than the one it lies below.
const INDENT: f32 = 14.0;

/// The deepest row that is indented; beyond, names would leave the panel.
const DEEPEST_INDENT: u32 = 16;

/// Room for the sign that folds, and for the eye.
const SIGN_WIDTH: f32 = 18.0;

/// What rows are drawn from, and what they ask.
struct Drawn<'a> {
    scene: &'a Scene,
    selection: Selection,
    language: Language,
    base: Id,
    asked: Option<Asked>,
    /// The row that the keyboard has come to, as by the tabulator.
    focused: Option<Key>,
}

impl Drawn<'_> {
    fn row(&mut self, ui: &mut Ui, row: Row, takes_focus: bool, actions: &mut Vec<Action>) {
        let size = vec2(ui.available_width(), ui.spacing().interact_size.y);
        let (_, rect) = ui.allocate_space(size);
        let id = row_id(self.base, row.key);
        // The tabulator stops once, at the cursor; from there on the arrows go.
        let sense = if takes_focus { Sense::click() } else { Sense::CLICK };
        let response = ui.interact(rect, id, sense);
        if response.has_focus() {
            self.focused = Some(row.key);
        }
        let name = row.item.name(self.scene, self.language);
        let is_selected = row.item.selection() == Some(self.selection);
        self.describe(ui, &response, row, &name, is_selected);
        paint_ground(ui, &response, is_selected);

        let indent = INDENT * row.depth.min(DEEPEST_INDENT) as f32;
        let sign =
            Rect::from_min_size(pos2(rect.left() + indent, rect.top()), vec2(SIGN_WIDTH, rect.height()));
        let eye = Rect::from_min_max(pos2(rect.right() - SIGN_WIDTH, rect.top()), rect.max);
        self.paint_text(ui, row, &name, rect.with_min_x(sign.right()).with_max_x(eye.left()), is_selected);
        if let Some(unfolded) = row.unfolded {
            self.fold_sign(ui, row.key, sign, unfolded, &name);
        }
        if let Item::Node(node) = row.item {
            self.eye(ui, node, id, eye, &name, actions);
        }
        self.react(&response, row, actions);
    }

    fn react(&mut self, response: &Response, row: Row, actions: &mut Vec<Action>) {
        if response.double_clicked() {
            activate(row, self.scene, actions);
        } else if response.clicked() {
            match row.item {
                Item::Section(_) => self.asked = Some(Asked::Fold(row.key)),
                Item::Camera(index) => {
                    use_camera(self.scene, index, actions);
                    self.asked = Some(Asked::Go(row.key));
                }
                _ => self.asked = Some(Asked::Go(row.key)),
            }
        }
        if let Item::Node(node) = row.item {
            response.context_menu(|ui| {
                let frame = Phrase::new("Frame", "Cadrer");
                if ui.button(self.language.say(frame)).clicked() {
                    actions.push(Action::Frame(Selection::Node(node)));
                }
                let hide = match self.scene.node(node).hidden {
                    true => Phrase::new("Show", "Afficher"),
                    false => Phrase::new("Hide", "Masquer"),
                };
                if ui.button(self.language.say(hide)).clicked() {
                    toggle_hidden(self.scene, node, actions);
                }
            });
        }
    }

    /// Says to screen readers what the row is.
    fn describe(&self, ui: &Ui, response: &Response, row: Row, name: &str, is_selected: bool) {
        response.widget_info(|| WidgetInfo::labeled(Role::TreeItem, ui.is_enabled(), name));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_level(row.depth as usize + 1);
            node.set_selected(is_selected);
            if let Some(unfolded) = row.unfolded {
                node.set_expanded(unfolded);
            }
        });
        // The arrows go through the rows, not to the next widget.
        let arrows =
            EventFilter { tab: false, horizontal_arrows: true, vertical_arrows: true, escape: false };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    }

    fn paint_text(&self, ui: &Ui, row: Row, name: &str, rect: Rect, is_selected: bool) {
        let visuals = ui.visuals();
        let (weak, mut strong) = (visuals.weak_text_color(), visuals.text_color());
        let mut aside = String::new();
        match row.item {
            Item::Node(id) => {
                let node = self.scene.node(id);
                if node.hidden {
                    strong = weak;
                }
                if !node.name.is_empty() {
                    aside = self.language.say(rows::kind_of(node)).to_lowercase();
                }
            }
            Item::Section(section) => {
                strong = visuals.strong_text_color();
                aside = self.count(section).to_string();
            }
            Item::More(_) => strong = weak,
            Item::Light(_) | Item::Material(_) | Item::Camera(_) => {}
        }
        if is_selected {
            strong = visuals.selection.stroke.color;
        }
        let font = TextStyle::Body.resolve(ui.style());
        let mut job =
            LayoutJob { wrap: TextWrapping::truncate_at_width(rect.width()), ..LayoutJob::default() };
        job.append(name, 0.0, TextFormat::simple(font.clone(), strong));
        if !aside.is_empty() {
            let small = FontId::new(font.size * 0.85, font.family);
            let color = if is_selected { strong } else { weak };
            let aside_format = TextFormat { valign: Align::Center, ..TextFormat::simple(small, color) };
            job.append(&aside, 6.0, aside_format);
        }
        let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
        let top = rect.center().y - 0.5 * galley.size().y;
        ui.painter().galley(pos2(rect.left(), top), galley, strong);
    }

    fn count(&self, section: Section) -> usize {
        match section {
            Section::Objects => self.scene.nodes().len(),
            Section::Lights => self.scene.lights.len(),
            Section::Materials => self.scene.materials().len(),
            Section::Cameras => self.scene.cameras.len() + 1,
        }
    }

    /// A triangle that points to the name, or down to what is unfolded.
    fn fold_sign(&mut self, ui: &Ui, key: Key, rect: Rect, unfolded: bool, name: &str) {
        let response = ui.interact(rect, row_id(self.base, key).with("fold"), Sense::CLICK);
        let verb = if unfolded { Phrase::new("Fold", "Replier") } else { Phrase::new("Unfold", "Déplier") };
        let text = format!("{} {name}", self.language.say(verb));
        response.widget_info(|| WidgetInfo::labeled(Role::DisclosureTriangle, ui.is_enabled(), &text));
        let (c, r) = (rect.center(), 4.0);
        let corners = match unfolded {
            true => [vec2(-r, -0.6 * r), vec2(r, -0.6 * r), vec2(0.0, 0.9 * r)],
            false => [vec2(-0.6 * r, -r), vec2(0.9 * r, 0.0), vec2(-0.6 * r, r)],
        };
        let color = ui.style().interact(&response).fg_stroke.color;
        let corners = corners.map(|corner| c + corner).to_vec();
        ui.painter().add(Shape::convex_polygon(corners, color, Stroke::NONE));
        if response.clicked() {
            self.asked = Some(Asked::Fold(key));
        }
    }

    /// Whether a node is drawn, to be clicked.
    fn eye(&self, ui: &Ui, node: NodeId, row: Id, rect: Rect, name: &str, actions: &mut Vec<Action>) {
        let is_visible = !self.scene.node(node).hidden;
        let response = ui.interact(rect, row.with("eye"), Sense::CLICK);
        let text = format!("{} {name}", self.language.say(Phrase::new("Visible:", "Visible :")));
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), is_visible, &text));
        let hovered = response.hovered();
        let color = if hovered { ui.visuals().strong_text_color() } else { ui.visuals().weak_text_color() };
        paint_eye(ui.painter(), rect.center(), is_visible, color);
        if response.clicked() {
            toggle_hidden(self.scene, node, actions);
        }
        let hint = match is_visible {
            true => Phrase::new("Hide, with all below (H)", "Masquer, avec tout ce qui est dessous (H)"),
            false => Phrase::new("Show (H)", "Afficher (H)"),
        };
        response.on_hover_text(self.language.say(hint));
    }
}

/// Two lids and a pupil; shut by a stroke. The font has no eye.
fn paint_eye(painter: &Painter, center: Pos2, is_open: bool, color: Color32) {
    let stroke = Stroke::new(1.2, color);
    let [left, right] = [-6.0, 6.0].map(|x| center + vec2(x, 0.0));
    for height in [-7.0, 7.0] {
        let lid = [left, center + vec2(0.0, height), right];
        painter.add(QuadraticBezierShape::from_points_stroke(lid, false, Color32::TRANSPARENT, stroke));
    }
    painter.circle_filled(center, 1.8, color);
    if !is_open {
        painter.line_segment([center + vec2(-5.0, 4.5), center + vec2(5.0, -4.5)], stroke);
    }
}

fn paint_ground(ui: &Ui, response: &Response, is_selected: bool) {
    let visuals = ui.visuals();
    let radius = visuals.widgets.inactive.corner_radius;
    if is_selected {
        ui.painter().rect_filled(response.rect, radius, visuals.selection.bg_fill);
    } else if response.hovered() {
        ui.painter().rect_filled(response.rect, radius, visuals.widgets.hovered.weak_bg_fill);
    }
    if response.has_focus() {
        let stroke = visuals.selection.stroke;
        ui.painter().rect_stroke(response.rect, radius, stroke, StrokeKind::Inside);
    }
}
