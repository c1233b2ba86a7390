//! The menus at the top, drawn from the table of commands.

use super::scenes;
use crate::commands::{Item, Kind, MENUS, shortcut_text};
use crate::{Action, Command, CommandContext, Language, Phrase, Source};
use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{
    Atom, Button, Key, MenuBar as Bar, Modifiers, Response, Shape, Stroke, Ui, lerp, pos2, vec2,
};
use std::path::PathBuf;

/// What the menus show.
#[derive(Clone, Copy)]
pub struct MenuBarView<'a> {
    /// What the state of commands depends on.
    pub commands: &'a CommandContext,
    /// The scene that is open.
    pub source: Option<&'a Source>,
    /// The files opened last, newest first.
    pub recent: &'a [PathBuf],
}

/// The key that goes to the menus, as in other programs.
pub(super) const MENU_KEY: Key = Key::F10;

/// Room before a name for its mark.
const MARK_WIDTH: f32 = 14.0;

/// Least width of a menu: names and shortcuts do not touch.
const MENU_WIDTH: f32 = 230.0;

/// Draws the menus in a row.
pub fn show(ui: &mut Ui, view: &MenuBarView, language: Language, actions: &mut Vec<Action>) {
    let go_to_menus = ui.input_mut(|input| input.consume_key(Modifiers::NONE, MENU_KEY));
    Bar::new().ui(ui, |ui| {
        for (i, (menu, items)) in MENUS.into_iter().enumerate() {
            let button = ui.menu_button(language.say(menu.name()), |ui| {
                show_items(ui, items, view, language, actions);
            });
            if i == 0 && go_to_menus {
                button.response.request_focus();
            }
        }
    });
}

fn show_items(
    ui: &mut Ui,
    items: &[Item],
    view: &MenuBarView,
    language: Language,
    actions: &mut Vec<Action>,
) {
    ui.set_min_width(MENU_WIDTH);
    for item in items {
        match item {
            Item::Command(command) => show_command(ui, *command, view.commands, language, actions),
            Item::Separator => {
                ui.separator();
            }
            Item::Submenu(name, items) => {
                submenu(ui, *name, language, |ui| show_items(ui, items, view, language, actions));
            }
            Item::BuiltinScenes => submenu(ui, scenes::BUILTIN, language, |ui| {
                for scene in scenes::builtin_scenes() {
                    let tip = language.say(scenes::summary(scene));
                    show_source(ui, Source::Builtin(scene), tip, view, actions);
                }
            }),
            Item::RecentFiles => submenu(ui, scenes::RECENT, language, |ui| {
                const NONE: Phrase = Phrase::new("None yet", "Aucun pour l’instant");
                if view.recent.is_empty() {
                    ui.weak(language.say(NONE));
                }
                for path in view.recent {
                    let tip = scenes::short_path(path);
                    show_source(ui, Source::File(path.clone()), &tip, view, actions);
                }
            }),
        }
    }
}

fn submenu(ui: &mut Ui, name: Phrase, language: Language, add: impl FnOnce(&mut Ui)) {
    let name = language.say(name);
    let button = ui.menu_button((mark(false), name), add);
    button.response.accessible_name(name);
}

fn show_source(ui: &mut Ui, source: Source, tip: &str, view: &MenuBarView, actions: &mut Vec<Action>) {
    let is_current = view.source == Some(&source);
    let title = source.title();
    let entry = entry(ui, &title, Some(is_current), "", true);
    if name_entry(entry, &title, Kind::Choice, is_current).on_hover_text(tip).clicked() {
        actions.push(Action::Open(source));
    }
}

fn show_command(
    ui: &mut Ui,
    command: Command,
    context: &CommandContext,
    language: Language,
    actions: &mut Vec<Action>,
) {
    let name = command.label(context, language);
    let keys = command.shortcuts().first().map_or(String::new(), |keys| shortcut_text(keys, language));
    let checked = command.is_checked(context);
    let entry = entry(ui, &name, checked, &keys, command.is_enabled(context));
    let entry = name_entry(entry, &name, command.kind(), checked.unwrap_or(false));
    let description = language.say(command.description());
    if entry.on_hover_text(description).on_disabled_hover_text(description).clicked() {
        actions.push(Action::Command(command));
    }
}

/// A line of a menu: its mark, its name, its keys.
fn entry(ui: &mut Ui, name: &str, checked: Option<bool>, keys: &str, enabled: bool) -> Response {
    let button = Button::new((mark(checked == Some(true)), name)).shortcut_text(keys);
    ui.add_enabled(enabled, button)
}

/// A tick, or as much room. It is drawn: the fonts have none.
fn mark(checked: bool) -> Atom<'static> {
    Atom::paint(vec2(MARK_WIDTH, MARK_WIDTH), move |ui, args| {
        let at = |x, y| pos2(lerp(args.rect.x_range(), x), lerp(args.rect.y_range(), y));
        if checked {
            let stroke = Stroke::new(1.5, args.fallback_text_color);
            ui.painter().add(Shape::line(vec![at(0.1, 0.5), at(0.35, 0.75), at(0.8, 0.2)], stroke));
        }
    })
}

/// Tells who cannot see it what the line is.
fn name_entry(entry: Response, name: &str, kind: Kind, checked: bool) -> Response {
    let entry = entry.accessible_name(name);
    entry.ctx.accesskit_node_builder(entry.id, |node| {
        node.set_role(match kind {
            Kind::Act => Role::MenuItem,
            Kind::Toggle => Role::MenuItemCheckBox,
            Kind::Choice => Role::MenuItemRadio,
        });
        if kind != Kind::Act {
            node.set_toggled(Toggled::from(checked));
        }
    });
    entry
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};
    use lancer_gallery::find;

    struct State {
        language: Language,
        context: CommandContext,
        recent: Vec<PathBuf>,
        actions: Vec<Action>,
    }

    fn window(language: Language) -> Harness<'static, State> {
        let context =
            CommandContext { has_document: true, checked: vec![Command::Grid], ..CommandContext::default() };
        let recent = vec![PathBuf::from("/models/bunny.ply")];
        let state = State { language, context, recent, actions: Vec::new() };
        crate::theme::test_window([900.0, 900.0]).build_ui_state(
            |ui, state: &mut State| {
                let source = find("glass").map(Source::Builtin);
                let view =
                    MenuBarView { commands: &state.context, source: source.as_ref(), recent: &state.recent };
                show(ui, &view, state.language, &mut state.actions);
            },
            state,
        )
    }

    fn is_entry(role: Role) -> bool {
        matches!(role, Role::MenuItem | Role::MenuItemCheckBox | Role::MenuItemRadio)
    }

    fn follow(window: &mut Harness<State>, path: &[&str]) {
        for name in path {
            window.get_by_label(name).click();
            window.run();
        }
    }

    #[test]
    fn every_command_is_found_by_its_name_in_its_menu_in_both_languages() {
        for language in Language::ALL {
            for (menu, items) in MENUS {
                let mut window = window(language);
                follow(&mut window, &[language.say(menu.name())]);
                for item in items {
                    match item {
                        Item::Command(command) => {
                            let name = command.label(&window.state().context, language);
                            window.get_by(|node| {
                                node.label().as_deref() == Some(&name) && is_entry(node.role())
                            });
                        }
                        Item::Submenu(name, _) => {
                            window.get_by_label(language.say(*name));
                        }
                        _ => {}
                    }
                }
            }
        }
    }

    #[test]
    fn a_click_says_the_command() {
        let mut window = window(Language::French);
        follow(&mut window, &["Fichier", "Ouvrir…"]);
        assert!(matches!(window.state().actions[..], [Action::Command(Command::Open)]));
    }

    #[test]
    fn commands_of_a_menu_in_a_menu_are_reached() {
        let mut window = window(Language::English);
        follow(&mut window, &["View", "Overlays", "Axes"]);
        assert!(matches!(window.state().actions[..], [Action::Command(Command::Axes)]));
    }

    #[test]
    fn scenes_and_recent_files_are_opened() {
        let mut window = window(Language::English);
        follow(&mut window, &["File", "Built-in scenes", "teapot"]);
        follow(&mut window, &["File", "Recent files", "bunny.ply"]);
        let [Action::Open(Source::Builtin(scene)), Action::Open(Source::File(path))] =
            &window.state().actions[..]
        else {
            panic!("{:?}", window.state().actions)
        };
        assert_eq!((scene.name(), path.to_str()), ("teapot", Some("/models/bunny.ply")));
    }

    #[test]
    fn what_makes_no_sense_now_cannot_be_clicked() {
        let mut window = window(Language::English);
        follow(&mut window, &["Edit"]);
        assert!(window.get_by_label("Undo").accesskit_node().is_disabled());
        follow(&mut window, &["Undo"]);
        assert!(window.state().actions.is_empty());
    }

    #[test]
    fn a_toggle_tells_whether_it_is_on() {
        let mut window = window(Language::English);
        follow(&mut window, &["View", "Overlays"]);
        let toggled = |name| window.get_by_label(name).accesskit_node().toggled();
        assert_eq!(toggled("Grid"), Some(Toggled::True));
        assert_eq!(toggled("Axes"), Some(Toggled::False));
    }

    #[test]
    fn the_menus_are_reached_and_used_by_keys_alone() {
        let mut window = window(Language::English);
        for key in [MENU_KEY, Key::Enter, Key::ArrowDown, Key::Enter] {
            window.key_press(key);
            window.run();
        }
        assert!(matches!(window.state().actions[..], [Action::Command(Command::Open)]));
    }
}
