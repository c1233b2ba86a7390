//! The command palette: a few letters find a command, a scene or a file.

mod fuzzy;

use super::scenes;
use crate::commands::shortcut_text;
use crate::{Action, Command, CommandContext, Language, Phrase, Source};
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, Align2, Button, Context, Id, Key, Modal, Modifiers, RichText, ScrollArea, TextEdit, Ui, vec2,
};
use std::path::PathBuf;

/// What can be found.
#[derive(Clone, Copy)]
pub struct PaletteView<'a> {
    /// What the state of commands depends on.
    pub commands: &'a CommandContext,
    /// The files opened last, newest first.
    pub recent: &'a [PathBuf],
}

/// The palette, while it is open.
#[derive(Clone, Debug, Default)]
pub struct Palette {
    query: String,
    selected: usize,
}

/// Something that can be found.
#[derive(Clone, Debug, PartialEq)]
enum Entry {
    Command(Command),
    Open(Source),
}

impl Entry {
    fn action(self) -> Action {
        match self {
            Self::Command(command) => Action::Command(command),
            Self::Open(source) => Action::Open(source),
        }
    }

    fn label(&self, context: &CommandContext, language: Language) -> String {
        match self {
            Self::Command(command) => command.label(context, language),
            Self::Open(source) => source.title(),
        }
    }

    /// What stands small at the right: the keys, or what kind of thing it is.
    fn note(&self, language: Language) -> String {
        match self {
            Self::Command(command) => {
                command.shortcuts().first().map_or(String::new(), |keys| shortcut_text(keys, language))
            }
            Self::Open(Source::Builtin(_)) => language.say(Phrase::new("scene", "scène")).to_owned(),
            Self::Open(Source::File(path)) => path.parent().map_or(String::new(), scenes::short_path),
        }
    }

    /// How well a query fits it: its name, less so its name in another language or what it does.
    fn score(&self, query: &str, context: &CommandContext, language: Language) -> Option<i32> {
        const OTHER_LANGUAGE: i32 = 240;
        const DESCRIPTION: i32 = 400;
        let by_name = fuzzy::score(query, &self.label(context, language));
        let elsewhere = match self {
            Self::Command(command) => {
                let names = Language::ALL.iter().map(|language| language.say(command.name()));
                names.filter_map(|name| fuzzy::score(query, name)).max().map(|score| score - OTHER_LANGUAGE)
            }
            Self::Open(_) => None,
        };
        let description = match self {
            Self::Command(command) => command.description(),
            Self::Open(source) => scenes::about(source),
        };
        // Letters scattered over a whole sentence are found for almost any query.
        let by_description = fuzzy::score(query, language.say(description))
            .filter(|&score| score > DESCRIPTION)
            .map(|score| score - DESCRIPTION);
        by_name.max(elsewhere).max(by_description)
    }
}

/// All that fits, the best first; what fits alike as it is listed in menus.
fn find(query: &str, view: &PaletteView, language: Language) -> Vec<Entry> {
    let commands = Command::ALL.iter().copied();
    let commands = commands
        .filter(|command| *command != Command::Palette && command.is_enabled(view.commands))
        .map(Entry::Command);
    let builtin = scenes::builtin_scenes().map(|scene| Entry::Open(Source::Builtin(scene)));
    let recent = view.recent.iter().map(|path| Entry::Open(Source::File(path.clone())));
    let entries = commands.chain(builtin).chain(recent);
    if query.trim().is_empty() {
        return entries.collect();
    }
    let mut found = entries
        .filter_map(|entry| Some((entry.score(query, view.commands, language)?, entry)))
        .collect::<Vec<_>>();
    found.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    found.into_iter().map(|(_, entry)| entry).collect()
}

const WIDTH: f32 = 520.0;
const HEIGHT: f32 = 340.0;

impl Palette {
    /// Draws the palette over everything. Returns whether it stays open.
    #[must_use]
    pub fn show(
        &mut self,
        ctx: &Context,
        view: &PaletteView,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        let id = Id::unique("command palette");
        let area = Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, 64.0));
        let mut chosen = None;
        let modal = Modal::new(id).area(area).show(ctx, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 32.0));
            let moved = self.take_keys(ui);
            self.query_field(ui, language);
            let entries = find(&self.query, view, language);
            self.selected = self.selected.min(entries.len().saturating_sub(1));
            ui.separator();
            chosen = self.list(ui, &entries, moved, view, language);
            if ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter)) {
                chosen = entries.get(self.selected).cloned();
            }
        });
        let is_open = chosen.is_none() && !modal.should_close();
        actions.extend(chosen.map(Entry::action));
        is_open
    }

    /// Moves the selection by the keys, before the text field has them. Returns whether it moved.
    fn take_keys(&mut self, ui: &Ui) -> bool {
        const PAGE: usize = 10;
        let before = self.selected;
        ui.input_mut(|input| {
            let mut count = |key| input.count_and_consume_key(Modifiers::NONE, key);
            let down = count(Key::ArrowDown) + PAGE * count(Key::PageDown);
            let up = count(Key::ArrowUp) + PAGE * count(Key::PageUp);
            self.selected = (self.selected + down).saturating_sub(up);
        });
        self.selected != before
    }

    fn query_field(&mut self, ui: &mut Ui, language: Language) {
        const HINT: Phrase =
            Phrase::new("A command, a scene or a file", "Une commande, une scène ou un fichier");
        let field = TextEdit::singleline(&mut self.query)
            .hint_text(language.say(HINT))
            .desired_width(f32::INFINITY)
            .margin(vec2(8.0, 6.0));
        let field = ui.add(field).accessible_name(language.say(HINT));
        field.request_focus();
        if field.changed() {
            self.selected = 0;
        }
    }

    fn list(
        &self,
        ui: &mut Ui,
        entries: &[Entry],
        moved: bool,
        view: &PaletteView,
        language: Language,
    ) -> Option<Entry> {
        const NONE: Phrase = Phrase::new("Nothing is called that", "Rien ne porte ce nom");
        if entries.is_empty() {
            ui.weak(language.say(NONE));
        }
        let mut chosen = None;
        ScrollArea::vertical()
            .max_height(HEIGHT)
            .min_scrolled_height(HEIGHT)
            .auto_shrink([false, true])
            .show(ui, |ui| {
                for (i, entry) in entries.iter().enumerate() {
                    let label = entry.label(view.commands, language);
                    let is_selected = i == self.selected;
                    let note = RichText::new(entry.note(language));
                    let button = Button::selectable(is_selected, label.as_str())
                        .right_text(if is_selected { note } else { note.weak() })
                        .min_size(vec2(ui.available_width(), 0.0));
                    let row = ui.add(button).accessible_name(label);
                    row.ctx.accesskit_node_builder(row.id, |node| {
                        node.set_role(Role::ListBoxOption);
                        node.set_selected(is_selected);
                    });
                    if is_selected && moved {
                        row.scroll_to_me(Some(Align::Center));
                    }
                    if row.clicked() {
                        chosen = Some(entry.clone());
                    }
                }
            });
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    fn context() -> CommandContext {
        CommandContext { has_document: true, ..CommandContext::default() }
    }

    fn first(query: &str, language: Language) -> Option<Entry> {
        let recent = [PathBuf::from("/models/bunny.ply")];
        find(query, &PaletteView { commands: &context(), recent: &recent }, language).into_iter().next()
    }

    #[test]
    fn commands_scenes_and_files_are_found() {
        for language in Language::ALL {
            assert_eq!(
                first("teapot", language).map(|entry| entry.label(&context(), language)).unwrap(),
                "teapot"
            );
            assert_eq!(first("bunny", language), Some(Entry::Open(Source::File("/models/bunny.ply".into()))));
        }
        assert_eq!(first("save pic", Language::English), Some(Entry::Command(Command::SavePicture)));
        assert_eq!(first("theme sombre", Language::French), Some(Entry::Command(Command::ThemeDark)));
    }

    #[test]
    fn every_enabled_command_is_found_first_by_its_whole_name() {
        for language in Language::ALL {
            for &command in Command::ALL {
                if command.is_enabled(&context()) && command != Command::Palette {
                    let name = command.label(&context(), language);
                    assert_eq!(first(&name, language), Some(Entry::Command(command)), "{name}");
                }
            }
        }
    }

    #[test]
    fn a_name_of_the_other_language_is_found_after_those_of_this_one() {
        assert_eq!(first("quitter", Language::English), Some(Entry::Command(Command::Quit)));
    }

    #[test]
    fn what_cannot_be_done_is_not_offered() {
        assert_ne!(first("undo", Language::English), Some(Entry::Command(Command::Undo)));
    }

    struct State {
        palette: Option<Palette>,
        language: Language,
        actions: Vec<Action>,
    }

    fn window(language: Language) -> Harness<'static, State> {
        let state = State { palette: Some(Palette::default()), language, actions: Vec::new() };
        crate::theme::test_window([900.0, 600.0]).build_ui_state(
            |ui, state: &mut State| {
                let context = context();
                let view = PaletteView { commands: &context, recent: &[] };
                if let Some(palette) = &mut state.palette
                    && !palette.show(ui.ctx(), &view, state.language, &mut state.actions)
                {
                    state.palette = None;
                }
            },
            state,
        )
    }

    fn type_text(window: &mut Harness<State>, text: &str) {
        window.run();
        window.get_by_role(Role::TextInput).type_text(text);
        window.run();
    }

    #[test]
    fn enter_gives_the_first_and_closes() {
        let mut window = window(Language::French);
        type_text(&mut window, "cadrer t");
        window.key_press(Key::Enter);
        window.run();
        assert!(matches!(window.state().actions[..], [Action::Command(Command::FrameAll)]));
        assert!(window.state().palette.is_none());
    }

    #[test]
    fn arrows_choose_another() {
        let mut window = window(Language::English);
        type_text(&mut window, "theme");
        window.key_press(Key::ArrowDown);
        window.run();
        window.key_press(Key::Enter);
        window.run();
        let [Action::Command(command)] = window.state().actions[..] else { panic!() };
        assert_ne!(command, Command::ThemeLight.min(Command::ThemeDark).min(Command::ThemeSystem));
    }

    #[test]
    fn a_click_gives_what_is_clicked() {
        let mut window = window(Language::English);
        type_text(&mut window, "dark");
        window.get_by_label("Dark theme").click();
        window.run();
        assert!(matches!(window.state().actions[..], [Action::Command(Command::ThemeDark)]));
    }

    #[test]
    fn escape_closes_and_gives_nothing() {
        let mut window = window(Language::English);
        window.run();
        window.key_press(Key::Escape);
        window.run();
        assert!(window.state().palette.is_none() && window.state().actions.is_empty());
    }

    #[test]
    fn a_query_that_fits_nothing_says_so_and_enter_does_nothing() {
        let mut window = window(Language::French);
        type_text(&mut window, "xqzw");
        window.get_by_label("Rien ne porte ce nom");
        window.key_press(Key::Enter);
        window.run();
        assert!(window.state().palette.is_some() && window.state().actions.is_empty());
    }
}
