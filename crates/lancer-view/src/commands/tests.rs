//! The table as a whole, and keys on their way to commands.

use super::*;
use crate::{EditKind, Language};
use eframe::egui::{Context, Event, Key, Modifiers, RawInput, Ui};
use std::collections::{BTreeMap, BTreeSet};

/// A state in which every command makes sense.
fn everything() -> CommandContext {
    CommandContext {
        has_document: true,
        has_file: true,
        undo: Some(EditKind::Material),
        redo: Some(EditKind::Settings),
        is_changed: true,
        has_selection: true,
        can_hide: true,
        has_hidden: true,
        is_working: true,
        is_rendering: true,
        renders: 2,
        shows_render: true,
        checked: Vec::new(),
    }
}

#[test]
fn no_two_commands_share_a_shortcut() {
    let mut taken = BTreeMap::new();
    for &command in Command::ALL {
        for shortcut in command.shortcuts() {
            let text = shortcut_text(shortcut, Language::English);
            let other = taken.insert(text.clone(), command);
            assert_eq!(other, None, "{text} is of {command:?} too");
        }
    }
}

#[test]
fn every_command_has_a_name_and_a_description_of_its_own_in_each_language() {
    for language in Language::ALL {
        let names = Command::ALL.iter().map(|command| language.say(command.name()));
        let descriptions = Command::ALL.iter().map(|command| language.say(command.description()));
        for texts in [names.collect::<Vec<_>>(), descriptions.collect()] {
            assert!(texts.iter().all(|text| !text.is_empty() && !text.ends_with('.')));
            assert_eq!(texts.iter().collect::<BTreeSet<_>>().len(), texts.len(), "{language:?}: {texts:?}");
        }
    }
}

#[test]
fn names_differ_between_the_languages_but_for_words_that_are_the_same() {
    let same = |phrase| Language::English.say(phrase) == Language::French.say(phrase);
    let names = Command::ALL.iter().copied().filter(|command| same(command.name())).collect::<Vec<_>>();
    assert_eq!(names, [Command::Axes, Command::LanguageEnglish, Command::LanguageFrench]);
    assert!(!Command::ALL.iter().any(|command| same(command.description())));
}

#[test]
fn every_command_stands_once_in_the_menus_and_in_the_menu_that_it_names() {
    fn collect(items: &[Item], menu: Menu, found: &mut Vec<(Command, Menu)>) {
        for item in items {
            match item {
                Item::Command(command) => found.push((*command, menu)),
                Item::Submenu(_, items) => collect(items, menu, found),
                Item::Separator | Item::BuiltinScenes | Item::RecentFiles => {}
            }
        }
    }
    let mut found = Vec::new();
    for (menu, items) in MENUS {
        collect(items, menu, &mut found);
    }
    found.sort_unstable_by_key(|(command, _)| *command);
    let expected = Command::ALL.iter().map(|&command| (command, command.menu())).collect::<Vec<_>>();
    assert_eq!(found, expected);
}

#[test]
fn without_a_scene_only_what_needs_none_is_enabled() {
    let nothing = CommandContext::default();
    let enabled = |command: Command| command.is_enabled(&nothing);
    assert!([Command::Open, Command::Quit, Command::Palette, Command::ThemeDark].into_iter().all(enabled));
    assert!(![Command::Undo, Command::Render, Command::Cancel, Command::SaveScene].into_iter().any(enabled));
    assert!(Command::ALL.iter().all(|command| command.is_enabled(&everything())));
}

#[test]
fn a_toggle_is_checked_where_the_context_says_so_and_an_act_never() {
    let context = CommandContext { checked: vec![Command::Grid], ..everything() };
    assert_eq!(Command::Grid.is_checked(&context), Some(true));
    assert_eq!(Command::Axes.is_checked(&context), Some(false));
    assert_eq!(Command::Open.is_checked(&context), None);
}

fn key(key: Key, modifiers: Modifiers) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

/// Draws once. A frame may take several passes; the keys are gone after the first.
fn frame(ctx: &Context, events: Vec<Event>, draw: impl FnMut(&mut Ui)) {
    let mut output = ctx.run_ui(RawInput { events, ..RawInput::default() }, draw);
    output.textures_delta.clear();
}

/// What a key gives in a window that shows nothing else.
fn commands_of(event: Event, context: &CommandContext) -> Vec<Command> {
    let ctx = Context::default();
    let mut commands = Vec::new();
    frame(&ctx, vec![event], |ui| commands.extend(pressed(ui.ctx(), context)));
    commands
}

const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..CTRL };

#[test]
fn each_shortcut_gives_its_command_and_no_other() {
    for &command in Command::ALL {
        for shortcut in command.shortcuts() {
            let ctrl = shortcut.modifiers.command;
            let modifiers = Modifiers { ctrl, ..shortcut.modifiers };
            let event = match (modifiers, shortcut.logical_key) {
                (CTRL, Key::C) => Event::Copy,
                (modifiers, logical_key) => key(logical_key, modifiers),
            };
            assert_eq!(commands_of(event, &everything()), [command], "{shortcut:?}");
        }
    }
}

#[test]
fn shift_tells_shortcuts_apart() {
    assert_eq!(commands_of(key(Key::Z, CTRL), &everything()), [Command::Undo]);
    assert_eq!(commands_of(key(Key::Z, CTRL_SHIFT), &everything()), [Command::Redo]);
}

#[test]
fn a_sign_that_takes_shift_on_some_keyboard_is_the_same_sign() {
    assert_eq!(commands_of(key(Key::Questionmark, Modifiers::SHIFT), &everything()), [Command::Shortcuts]);
    assert_eq!(commands_of(key(Key::Plus, CTRL_SHIFT), &everything()), [Command::LargerInterface]);
}

#[test]
fn the_digits_of_a_french_keyboard_work_with_and_without_shift() {
    let azerty = |key, modifiers| Event::Key {
        key,
        physical_key: Some(Key::Num3),
        pressed: true,
        repeat: false,
        modifiers,
    };
    assert_eq!(commands_of(azerty(Key::Quote, Modifiers::NONE), &everything()), [Command::Right]);
    assert_eq!(commands_of(azerty(Key::Num3, Modifiers::SHIFT), &everything()), [Command::Right]);
    assert_eq!(commands_of(azerty(Key::Quote, CTRL), &everything()), [Command::Left]);
}

#[test]
fn a_disabled_command_leaves_its_key_alone() {
    assert_eq!(commands_of(key(Key::Z, CTRL), &CommandContext::default()), []);
}

#[test]
fn a_text_field_keeps_what_writes_or_edits_and_leaves_the_rest() {
    let in_text = |event: Event| {
        let ctx = Context::default();
        let mut commands = Vec::new();
        let mut text = String::new();
        for events in [vec![], vec![], vec![event]] {
            frame(&ctx, events, |ui| {
                commands.extend(pressed(ui.ctx(), &everything()));
                ui.text_edit_singleline(&mut text).request_focus();
            });
        }
        commands
    };
    for event in [key(Key::F, Modifiers::NONE), key(Key::F, Modifiers::SHIFT), key(Key::Z, CTRL), Event::Copy]
    {
        assert_eq!(in_text(event.clone()), [], "{event:?}");
    }
    assert_eq!(in_text(key(Key::O, CTRL)), [Command::Open]);
    assert_eq!(in_text(key(Key::F12, Modifiers::NONE)), [Command::Render]);
}

#[test]
fn shortcuts_are_written_as_on_the_keys_of_each_language() {
    let redo = &Command::Redo.shortcuts()[0];
    assert_eq!(shortcut_text(redo, Language::English), "Ctrl+Shift+Z");
    assert_eq!(shortcut_text(redo, Language::French), "Ctrl+Maj+Z");
    assert_eq!(shortcut_text(&Command::Cancel.shortcuts()[0], Language::French), "Échap");
}

#[test]
fn undo_says_what_it_would_undo() {
    assert_eq!(Command::Undo.label(&everything(), Language::English), "Undo Material");
    let nothing = CommandContext::default();
    assert_eq!(Command::Undo.label(&nothing, Language::French), "Annuler la modification");
}
