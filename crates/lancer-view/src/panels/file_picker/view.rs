//! The dialog, drawn.

use super::super::scenes::short_path;
use super::disk::Fault;
use super::state::{FilePicker, Outcome};
use crate::{Action, Language, Phrase};
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, Button, Context, Id, Key, Layout, Modal, Modifiers, Rect, RichText, ScrollArea, TextEdit, Ui, vec2,
};

const WIDTH: f32 = 680.0;
const LIST_HEIGHT: f32 = 300.0;
const PLACES_WIDTH: f32 = 150.0;

const PATH_HINT: Phrase = Phrase::new("Name or path", "Nom ou chemin");
const UP: Phrase = Phrase::new("Up", "Dossier parent");
const CANCEL: Phrase = Phrase::new("Close", "Fermer");
const REPLACE: Phrase = Phrase::new("Replace it", "Le remplacer");
const KEEP: Phrase = Phrase::new("Keep it", "Le garder");
const ALL_FILES: Phrase = Phrase::new("All files", "Tous les fichiers");
const HIDDEN_FILES: Phrase = Phrase::new("Hidden files", "Fichiers cachés");

impl FilePicker {
    /// Draws the dialog over everything. Returns whether it stays open.
    #[must_use]
    pub fn show(&mut self, ctx: &Context, language: Language, actions: &mut Vec<Action>) -> bool {
        let mut outcome = self.poll();
        let mut is_closed = false;
        let modal = Modal::new(Id::unique("file picker")).show(ctx, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 32.0));
            ui.heading(language.say(self.purpose.title()));
            ui.add_space(4.0);
            let moved = self.take_keys(ui);
            self.directory_line(ui, language);
            let size = vec2(ui.available_width(), LIST_HEIGHT);
            ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Min), |ui| {
                self.places_list(ui, language);
                ui.separator();
                self.entries_list(ui, moved, language);
            });
            ui.separator();
            if self.to_replace.is_some() {
                outcome = self.question(ui, language);
            } else {
                is_closed = self.buttons(ui, language);
            }
        });
        if let Outcome::Picked(path) = outcome {
            actions.push(self.action(path));
            return false;
        }
        if modal.should_close() {
            // Escape answers the question first.
            return self.to_replace.take().is_some();
        }
        !is_closed
    }

    /// Takes the keys that move, before the text field has them. Returns whether the selection moved.
    fn take_keys(&mut self, ui: &Ui) -> bool {
        let (mut by, mut up) = (0_isize, false);
        ui.input_mut(|input| {
            up = input.consume_key(Modifiers::ALT, Key::ArrowUp)
                || self.typed.is_empty() && input.consume_key(Modifiers::NONE, Key::Backspace);
            by += isize::from(input.consume_key(Modifiers::NONE, Key::ArrowDown));
            by -= isize::from(input.consume_key(Modifiers::NONE, Key::ArrowUp));
            by += 10 * isize::from(input.consume_key(Modifiers::NONE, Key::PageDown));
            by -= 10 * isize::from(input.consume_key(Modifiers::NONE, Key::PageUp));
        });
        if up {
            self.up();
        }
        if by != 0 {
            self.move_selection(by);
        }
        by != 0
    }

    fn directory_line(&mut self, ui: &mut Ui, language: Language) {
        ui.horizontal(|ui| {
            let up = ui.add_enabled(self.directory.parent().is_some(), Button::new(language.say(UP)));
            if up.clicked() {
                self.up();
            }
            ui.label(RichText::new(short_path(&self.directory)).monospace());
            if self.is_waiting() {
                ui.spinner();
            }
        });
    }

    fn places_list(&mut self, ui: &mut Ui, language: Language) {
        let mut chosen = None;
        ui.vertical(|ui| {
            ui.set_width(PLACES_WIDTH);
            ScrollArea::vertical().id_salt("places").max_height(LIST_HEIGHT).show(ui, |ui| {
                for place in &self.places {
                    let shown = match place.name {
                        Some(name) => language.say(name).to_owned(),
                        None => place.path.file_name().map_or_else(
                            || place.path.display().to_string(),
                            |name| name.to_string_lossy().into_owned(),
                        ),
                    };
                    let button = Button::selectable(place.path == self.directory, shown).truncate();
                    let button = ui.add(button.min_size(vec2(PLACES_WIDTH, 0.0)));
                    if button.on_hover_text(short_path(&place.path)).clicked() {
                        chosen = Some(place.path.clone());
                    }
                }
            });
        });
        if let Some(path) = chosen {
            self.look_at(path);
        }
    }

    fn entries_list(&mut self, ui: &mut Ui, moved: bool, language: Language) {
        const EMPTY: Phrase = Phrase::new("No such files here", "Aucun fichier de ce type ici");
        const CUT: Phrase =
            Phrase::new("There are more files than are listed", "Il y a plus de fichiers que listés");
        let (mut clicked, mut opened) = (None, false);
        ui.vertical(|ui| {
            let shown = self.shown();
            let row_height = ui.spacing().interact_size.y;
            let area = ScrollArea::vertical()
                .id_salt("entries")
                .max_height(LIST_HEIGHT)
                .min_scrolled_height(LIST_HEIGHT);
            area.auto_shrink(false).show_rows(ui, row_height, shown.len().max(1), |ui, rows| {
                if shown.is_empty() && !self.is_waiting() {
                    ui.weak(language.say(EMPTY));
                }
                if let Some(selected) = self.selected.filter(|_| moved) {
                    // It may be one of the rows that are not drawn.
                    let below =
                        (selected as f32 - rows.start as f32) * (row_height + ui.spacing().item_spacing.y);
                    let corner = ui.max_rect().left_top() + vec2(0.0, below);
                    ui.scroll_to_rect(Rect::from_min_size(corner, vec2(1.0, row_height)), None);
                }
                for (i, entry) in shown.iter().enumerate().skip(rows.start).take(rows.len()) {
                    let is_selected = self.selected == Some(i);
                    let (shown, note) = if entry.is_directory {
                        (RichText::new(format!("{}/", entry.name)).strong(), String::new())
                    } else {
                        (RichText::new(&entry.name), size_text(entry.bytes, language))
                    };
                    let button = Button::selectable(is_selected, shown)
                        .right_text(RichText::new(note).weak())
                        .truncate()
                        .min_size(vec2(ui.available_width(), row_height));
                    let row = ui.add(button).accessible_name(&entry.name);
                    row.ctx.accesskit_node_builder(row.id, |node| {
                        node.set_role(Role::ListBoxOption);
                        node.set_selected(is_selected);
                    });
                    if row.clicked() {
                        clicked = Some(i);
                    }
                    opened |= row.double_clicked();
                }
            });
            if self.is_cut {
                ui.weak(language.say(CUT));
            }
        });
        if let Some(i) = clicked {
            self.select(i);
        }
        if opened {
            self.submit();
        }
    }

    /// The path, what is wrong with it, and the buttons. Returns whether the dialog is closed.
    fn buttons(&mut self, ui: &mut Ui, language: Language) -> bool {
        let field = TextEdit::singleline(&mut self.typed)
            .hint_text(language.say(PATH_HINT))
            .desired_width(f32::INFINITY)
            .margin(vec2(8.0, 6.0));
        let field = ui.add(field).accessible_name(language.say(PATH_HINT));
        if field.changed() {
            self.edited();
        }
        let enter = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        if let Some(fault) = &self.fault {
            ui.colored_label(ui.visuals().error_fg_color, fault_text(fault, language));
        }
        let mut is_closed = false;
        ui.horizontal(|ui| {
            let extensions =
                self.purpose.extensions().iter().map(|name| format!(".{name}")).collect::<Vec<_>>();
            let tip = extensions.join(" ");
            let all = ui.checkbox(&mut self.shows_all, language.say(ALL_FILES)).on_hover_text(tip);
            let hidden = ui.checkbox(&mut self.shows_hidden, language.say(HIDDEN_FILES));
            if all.changed() || hidden.changed() {
                self.selected = None;
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.button(language.say(self.purpose.verb())).clicked() || enter {
                    self.submit();
                }
                is_closed = ui.button(language.say(CANCEL)).clicked();
            });
        });
        is_closed
    }

    /// Whether to replace a file that is there.
    fn question(&mut self, ui: &mut Ui, language: Language) -> Outcome {
        const EXISTS: Phrase = Phrase::new("is there already.", "existe déjà.");
        let name = self.to_replace.as_ref().and_then(|path| path.file_name());
        let name = name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let mut outcome = Outcome::Pending;
        ui.horizontal(|ui| {
            ui.colored_label(ui.visuals().warn_fg_color, format!("{name} {}", language.say(EXISTS)));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.button(language.say(REPLACE)).clicked() {
                    outcome = self.replace();
                }
                let keep = ui.button(language.say(KEEP));
                if ui.memory(|memory| memory.focused().is_none()) {
                    keep.request_focus();
                }
                if keep.clicked() {
                    self.to_replace = None;
                }
            });
        });
        outcome
    }
}

fn fault_text(fault: &Fault, language: Language) -> String {
    let (phrase, detail) = match fault {
        Fault::NoName => {
            return language
                .say(Phrase::new("Choose or type a name.", "Choisissez ou tapez un nom."))
                .to_owned();
        }
        Fault::NoSuchFile(path) => {
            (Phrase::new("There is no file", "Il n’y a pas de fichier"), short_path(path))
        }
        Fault::NoSuchDirectory(path) => {
            (Phrase::new("There is no directory", "Il n’y a pas de dossier"), short_path(path))
        }
        Fault::Denied(path) => (
            Phrase::new("You have no permission to read", "Vous n’avez pas le droit de lire"),
            short_path(path),
        ),
        Fault::OtherKind(purpose) => (
            Phrase::new("The name must end in", "Le nom doit finir par"),
            purpose.extensions().iter().map(|name| format!(".{name}")).collect::<Vec<_>>().join(", "),
        ),
        Fault::Other(path, error) => (
            Phrase::new("This cannot be read:", "Lecture impossible :"),
            format!("{} ({error})", short_path(path)),
        ),
    };
    format!("{} {detail}", language.say(phrase))
}

/// A size to read at a glance.
fn size_text(bytes: u64, language: Language) -> String {
    const BYTE: Phrase = Phrase::new("B", "o");
    let mut units = ["", "k", "M", "G"].into_iter().peekable();
    let mut size = bytes as f64;
    while let Some(unit) = units.next() {
        if size < 1000.0 || units.peek().is_none() {
            let decimals = usize::from(size < 9.95 && !unit.is_empty());
            let number = format!("{size:.decimals$}");
            let number = if language == Language::French { number.replace('.', ",") } else { number };
            return format!("{number} {unit}{}", language.say(BYTE));
        }
        size /= 1000.0;
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::super::{Place, Purpose};
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use std::fs;
    use std::path::Path;
    use std::thread::sleep;
    use std::time::Duration;
    use tempfile::TempDir;

    struct State {
        picker: Option<FilePicker>,
        language: Language,
        actions: Vec<Action>,
    }

    fn directory() -> TempDir {
        let directory = tempfile::tempdir().unwrap();
        for name in ["a.ply", "b.yaml", "shot.png"] {
            fs::write(directory.path().join(name), name).unwrap();
        }
        fs::create_dir(directory.path().join("more")).unwrap();
        directory
    }

    fn window(purpose: Purpose, directory: &Path, name: &str, language: Language) -> Harness<'static, State> {
        let places = vec![Place { name: None, path: directory.join("more") }];
        let picker = FilePicker::new(purpose, directory, name, places, || {});
        let state = State { picker: Some(picker), language, actions: Vec::new() };
        let mut window = crate::theme::test_window([900.0, 640.0]).with_step_dt(1.0 / 60.0).build_ui_state(
            |ui, state: &mut State| {
                if let Some(picker) = &mut state.picker
                    && !picker.show(ui.ctx(), state.language, &mut state.actions)
                {
                    state.picker = None;
                }
            },
            state,
        );
        settle(&mut window);
        window
    }

    /// Draws until the disk has answered and what it said is drawn.
    fn settle(window: &mut Harness<State>) {
        window.run_steps(2);
        while window.state().picker.as_ref().is_some_and(FilePicker::is_waiting) {
            sleep(Duration::from_millis(1));
            window.step();
        }
        window.run();
    }

    #[test]
    fn a_file_that_is_double_clicked_is_opened() {
        let directory = directory();
        let mut window = window(Purpose::Open, directory.path(), "", Language::English);
        for _ in 0..2 {
            window.get_by_label("a.ply").click();
        }
        settle(&mut window);
        let [Action::OpenPath(path)] = &window.state().actions[..] else { panic!() };
        assert_eq!(*path, directory.path().join("a.ply"));
        assert!(window.state().picker.is_none());
    }

    #[test]
    fn a_path_is_typed_and_entered_in_both_languages() {
        let directory = directory();
        for language in Language::ALL {
            let mut window = window(Purpose::SaveScene, directory.path(), "", language);
            window.get_by_label(language.say(PATH_HINT)).type_text("more/new");
            window.run();
            window.key_press(Key::Enter);
            settle(&mut window);
            let [Action::SaveScene(path)] = &window.state().actions[..] else { panic!() };
            assert_eq!(*path, directory.path().join("more/new.yaml"));
        }
    }

    #[test]
    fn arrows_enter_and_backspace_walk_through_directories() {
        let directory = directory();
        let mut window = window(Purpose::Open, directory.path(), "", Language::English);
        let here = |window: &Harness<State>| window.state().picker.as_ref().unwrap().directory().to_owned();
        window.key_press(Key::ArrowDown);
        window.run();
        window.key_press(Key::Enter);
        settle(&mut window);
        assert_eq!(here(&window), directory.path().join("more"));
        window.key_press(Key::Backspace);
        settle(&mut window);
        assert_eq!(here(&window), directory.path());
    }

    #[test]
    fn a_place_is_gone_to() {
        let directory = directory();
        let mut window = window(Purpose::SavePicture, directory.path(), "", Language::English);
        window.get_all_by_label("more").next().unwrap().click();
        settle(&mut window);
        assert_eq!(window.state().picker.as_ref().unwrap().directory(), directory.path().join("more"));
    }

    #[test]
    fn a_file_is_replaced_after_a_question_and_escape_keeps_it() {
        let directory = directory();
        let mut window = window(Purpose::SavePicture, directory.path(), "shot.png", Language::French);
        window.get_by_label("Enregistrer").click();
        settle(&mut window);
        window.key_press(Key::Escape);
        window.run();
        assert!(window.state().actions.is_empty());
        window.get_by_label("Enregistrer").click();
        settle(&mut window);
        window.get_by_label("Le remplacer").click();
        settle(&mut window);
        assert!(
            matches!(&window.state().actions[..], [Action::SavePicture(path)] if path.ends_with("shot.png"))
        );
    }

    #[test]
    fn what_is_wrong_is_said_in_place_and_in_the_language() {
        let directory = directory();
        for (language, expected) in
            [(Language::English, "There is no file"), (Language::French, "Il n’y a pas")]
        {
            let mut window = window(Purpose::Open, directory.path(), "none.ply", language);
            window.get_by_label(language.say(PATH_HINT)).type_text("none.ply");
            window.run();
            window.get_by_label(language.say(Purpose::Open.verb())).click();
            settle(&mut window);
            window.get_by_label_contains(expected);
        }
    }

    #[test]
    fn escape_and_the_button_close_it() {
        let directory = directory();
        for close in [
            |window: &Harness<State>| window.key_press(Key::Escape),
            |window: &Harness<State>| {
                window.get_by_label("Close").click();
            },
        ] {
            let mut window = window(Purpose::Open, directory.path(), "", Language::English);
            close(&window);
            settle(&mut window);
            assert!(window.state().picker.is_none() && window.state().actions.is_empty());
        }
    }

    #[test]
    fn sizes_are_read_at_a_glance() {
        let shown = [0, 999, 1000, 45_600, 12_300_000_000].map(|bytes| size_text(bytes, Language::English));
        assert_eq!(shown, ["0 B", "999 B", "1.0 kB", "46 kB", "12 GB"]);
        assert_eq!(size_text(1500, Language::French), "1,5 ko");
    }
}
