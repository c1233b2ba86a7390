//! The list of keys and of what the mouse does.

use super::menu_bar::MENU_KEY;
use crate::commands::{Menu, key_name, shortcut_text};
use crate::navigation::{Button as MouseButton, Gesture, Modifiers, Scheme};
use crate::{Command, Language, Phrase};
use eframe::egui::{Align, Context, Grid, Id, Key, Layout, Modal, RichText, ScrollArea, Ui};

const TITLE: Phrase = Phrase::new("Keyboard and mouse", "Clavier et souris");
const CLOSE: Phrase = Phrase::new("Close", "Fermer");
const WIDTH: f32 = 820.0;
const HEIGHT: f32 = 640.0;

/// Draws the list over everything. Returns whether it stays open.
#[must_use]
pub fn show(ctx: &Context, scheme: Scheme, language: Language) -> bool {
    let mut is_closed = false;
    let modal = Modal::new(Id::unique("shortcuts")).show(ctx, |ui| {
        ui.set_width(WIDTH.min(ctx.content_rect().width() - 32.0));
        ui.horizontal(|ui| {
            ui.heading(language.say(TITLE));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                is_closed = ui.button(language.say(CLOSE)).clicked();
            });
        });
        ui.separator();
        let height = HEIGHT.min(ctx.content_rect().height() - 120.0);
        ScrollArea::vertical().max_height(height).auto_shrink(false).show(ui, |ui| {
            ui.columns_const(|[left, right]| {
                mouse(left, scheme, language);
                group(left, language.say(Menu::View.name()), &keys_of(Menu::View, language));
                for menu in [Menu::File, Menu::Edit, Menu::Render, Menu::Help] {
                    group(right, language.say(menu.name()), &keys_of(menu, language));
                }
                group(right, language.say(Phrase::new("Everywhere", "Partout")), &everywhere(language));
            });
        });
    });
    // The keys that opened it close it as well.
    let again = ctx.input(|input| input.key_pressed(Key::Questionmark) || input.key_pressed(Key::F1));
    !(is_closed || again || modal.should_close())
}

/// Keys, and what they do.
type Row = (String, String);

fn group(ui: &mut Ui, name: &str, rows: &[Row]) {
    ui.label(RichText::new(name).strong());
    Grid::new(name).num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
        for (keys, does) in rows {
            ui.label(RichText::new(keys).monospace());
            ui.label(does);
            ui.end_row();
        }
    });
    ui.add_space(10.0);
}

fn keys_of(menu: Menu, language: Language) -> Vec<Row> {
    let with_keys =
        Command::ALL.iter().filter(|command| command.menu() == menu && !command.shortcuts().is_empty());
    with_keys
        .map(|command| {
            let keys = command.shortcuts().iter().map(|keys| shortcut_text(keys, language));
            (keys.collect::<Vec<_>>().join(", "), language.say(command.name()).to_owned())
        })
        .collect()
}

fn everywhere(language: Language) -> Vec<Row> {
    let row = |keys: String, does| (keys, language.say(does).to_owned());
    vec![
        row("Tab".into(), Phrase::new("Go to the next control", "Aller au contrôle suivant")),
        row(
            key_name(Key::Space, language).into(),
            Phrase::new("Press the control that has the keyboard", "Actionner le contrôle qui a le clavier"),
        ),
        row(key_name(MENU_KEY, language).into(), Phrase::new("Go to the menus", "Aller aux menus")),
        row(
            key_name(Key::Escape, language).into(),
            Phrase::new("Close a dialog or a menu", "Fermer un dialogue ou un menu"),
        ),
    ]
}

fn mouse(ui: &mut Ui, scheme: Scheme, language: Language) {
    let title = language.say(Phrase::new("Mouse", "Souris"));
    group(ui, &format!("{title} ({})", language.say(scheme.name())), &mouse_rows(scheme, language));
}

/// Every movement of the mouse that does something else than the same without a key held.
fn mouse_rows(scheme: Scheme, language: Language) -> Vec<Row> {
    const NONE: Modifiers = Modifiers { shift: false, ctrl: false, alt: false };
    const HELD: [(Modifiers, Phrase); 3] = [
        (NONE, Phrase::same("")),
        (Modifiers { shift: true, ..NONE }, Phrase::new("Shift+", "Maj+")),
        (Modifiers { ctrl: true, ..NONE }, Phrase::same("Ctrl+")),
    ];
    const DRAGS: [(MouseButton, Phrase); 3] = [
        (MouseButton::Left, Phrase::new("left drag", "glisser à gauche")),
        (MouseButton::Middle, Phrase::new("middle drag", "glisser au milieu")),
        (MouseButton::Right, Phrase::new("right drag", "glisser à droite")),
    ];
    const WHEEL: Phrase = Phrase::new("wheel", "molette");
    let mut rows = Vec::new();
    let mut add = |of: &dyn Fn(Modifiers) -> Option<Gesture>, name| {
        for (held, prefix) in HELD {
            let gesture = of(held).filter(|gesture| held == NONE || of(NONE) != Some(*gesture));
            let keys = || format!("{}{}", language.say(prefix), language.say(name));
            rows.extend(gesture.map(|gesture| (keys(), language.say(gesture_name(gesture)).to_owned())));
        }
    };
    for (button, name) in DRAGS {
        add(&|held| scheme.gesture(button, held), name);
    }
    add(&|held| Some(scheme.wheel(held)), WHEEL);
    let others = [
        (
            Phrase::new("click", "cliquer"),
            Phrase::new("Select what is there", "Sélectionner ce qui s’y trouve"),
        ),
        (
            Phrase::new("double click", "double-cliquer"),
            Phrase::new("Make it the point of interest", "En faire le point d’intérêt"),
        ),
    ];
    rows.extend(others.map(|(keys, does)| (language.say(keys).to_owned(), language.say(does).to_owned())));
    rows
}

const fn gesture_name(gesture: Gesture) -> Phrase {
    match gesture {
        Gesture::Pan => Phrase::new("Move in the plane of the picture", "Déplacer dans le plan de l’image"),
        Gesture::Dolly => Phrase::new("Go nearer or farther", "Approcher ou éloigner"),
        Gesture::Rotate => {
            Phrase::new("Turn about the point of interest", "Tourner autour du point d’intérêt")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn the_assignments_mouse_is_listed_a_button_a_movement() {
        let rows = mouse_rows(Scheme::Assignment, Language::English);
        let does = |keys: &str| rows.iter().find(|row| row.0 == keys).map(|row| row.1.as_str());
        assert_eq!(does("left drag"), Some("Move in the plane of the picture"));
        assert_eq!(does("middle drag"), Some("Go nearer or farther"));
        assert_eq!(does("right drag"), Some("Turn about the point of interest"));
        assert_eq!(does("wheel"), Some("Go nearer or farther"));
        assert_eq!(does("Shift+left drag"), None);
    }

    #[test]
    fn every_gesture_of_every_scheme_is_listed() {
        for scheme in Scheme::ALL {
            let rows = mouse_rows(scheme, Language::French);
            for gesture in [Gesture::Pan, Gesture::Dolly, Gesture::Rotate] {
                let name = Language::French.say(gesture_name(gesture));
                assert!(rows.iter().any(|(_, does)| does == name), "{scheme:?}: {name}");
            }
        }
    }

    #[test]
    fn every_command_with_a_key_is_listed_in_both_languages() {
        for language in Language::ALL {
            let mut window = crate::theme::test_window([1000.0, 2000.0])
                .build_ui(move |ui| assert!(show(ui.ctx(), Scheme::Orbit, language)));
            window.run();
            for command in Command::ALL.iter().filter(|command| !command.shortcuts().is_empty()) {
                assert!(
                    window.query_all_by_label(language.say(command.name())).next().is_some(),
                    "{command:?}"
                );
            }
        }
    }

    #[test]
    fn the_button_escape_and_its_own_key_close_it() {
        let closes: [fn(&Harness<bool>); 3] = [
            |window| window.get_by_label("Close").click(),
            |window| window.key_press(Key::Escape),
            |window| window.key_press(Key::Questionmark),
        ];
        for close in closes {
            let mut window = crate::theme::test_window([900.0, 600.0]).build_ui_state(
                |ui, is_open: &mut bool| {
                    *is_open = *is_open && show(ui.ctx(), Scheme::Assignment, Language::English);
                },
                true,
            );
            window.run();
            close(&window);
            window.run();
            assert!(!window.state());
        }
    }
}
