//! From keys to commands, and how keys are called.

use super::{Command, CommandContext};
use crate::{Language, Phrase};
use eframe::egui::{Context, Event, Key, KeyboardShortcut, Modifiers, Popup};

/// Takes the keys that give a command out of this frame's input; to be called before anything is drawn.
///
/// A dialog keeps all keys for itself, an open menu the plain ones, and a text field those that write or edit. A
/// field that is left by a command takes what was typed first: carry the commands out after the panels' actions.
pub fn pressed(ctx: &Context, context: &CommandContext) -> Vec<Command> {
    if ctx.memory(|memory| memory.top_modal_layer().is_some()) {
        return Vec::new();
    }
    let in_text = ctx.text_edit_focused();
    let in_menu = Popup::is_any_open(ctx);
    let mut commands = Vec::new();
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let command = command_of(event, context, |shortcut| {
                !(in_text && edits_text(shortcut) || in_menu && is_plain(shortcut))
            });
            commands.extend(command);
            command.is_none()
        });
    });
    if in_text && !commands.is_empty() {
        ctx.memory_mut(|memory| memory.stop_text_input());
    }
    commands
}

/// The command that a key gives, if it makes sense and its shortcut is `free`.
fn command_of(
    event: &Event,
    context: &CommandContext,
    free: impl Fn(&KeyboardShortcut) -> bool,
) -> Option<Command> {
    Command::ALL.iter().copied().find(|command| {
        command.is_enabled(context)
            && command.shortcuts().iter().any(|shortcut| free(shortcut) && is_pressed(event, shortcut))
    })
}

fn is_pressed(event: &Event, shortcut: &KeyboardShortcut) -> bool {
    match event {
        // What the platform makes of Ctrl+C.
        Event::Copy => *shortcut == COPY,
        Event::Key { key, physical_key, pressed: true, repeat: false, modifiers } => {
            let wanted = shortcut.logical_key;
            // The digits of some keyboards (AZERTY among them) are written with Shift.
            if is_digit(wanted) && (*physical_key == Some(wanted) || *key == wanted) {
                return modifiers.alt == shortcut.modifiers.alt
                    && modifiers.cmd_ctrl_matches(shortcut.modifiers);
            }
            *key == wanted
                && if is_sign(wanted) {
                    // Whether a sign takes Shift is the keyboard's affair.
                    modifiers.matches_logically(shortcut.modifiers) && modifiers.alt == shortcut.modifiers.alt
                } else {
                    modifiers.matches_exact(shortcut.modifiers)
                }
        }
        _ => false,
    }
}

const COPY: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::C);

fn is_digit(key: Key) -> bool {
    (Key::Num0..=Key::Num9).contains(&key)
}

fn is_sign(key: Key) -> bool {
    (Key::Colon..=Key::Quote).contains(&key)
}

/// Whether neither Ctrl nor Alt is in it.
fn is_plain(shortcut: &KeyboardShortcut) -> bool {
    !(shortcut.modifiers.command || shortcut.modifiers.ctrl || shortcut.modifiers.alt)
}

/// Whether a text field makes something of it.
fn edits_text(shortcut: &KeyboardShortcut) -> bool {
    let is_function = (Key::F1..=Key::F35).contains(&shortcut.logical_key);
    let edits = matches!(shortcut.logical_key, Key::C | Key::Y | Key::Z) && shortcut.modifiers.command;
    edits || is_plain(shortcut) && !is_function
}

/// How a shortcut is written: `Ctrl+Shift+S`, `Ctrl+Maj+S`.
pub fn shortcut_text(shortcut: &KeyboardShortcut, language: Language) -> String {
    let Modifiers { alt, shift, command, ctrl, .. } = shortcut.modifiers;
    let modifiers = [
        (command || ctrl, if cfg!(target_os = "macos") { Phrase::same("Cmd") } else { Phrase::same("Ctrl") }),
        (alt, if cfg!(target_os = "macos") { Phrase::same("Option") } else { Phrase::same("Alt") }),
        (shift, Phrase::new("Shift", "Maj")),
    ];
    modifiers
        .iter()
        .filter(|(held, _)| *held)
        .map(|&(_, name)| language.say(name))
        .chain([key_name(shortcut.logical_key, language)])
        .collect::<Vec<_>>()
        .join("+")
}

/// What is written on a key.
pub fn key_name(key: Key, language: Language) -> &'static str {
    let name = match key {
        Key::Escape => Phrase::new("Esc", "Échap"),
        Key::Enter => Phrase::new("Enter", "Entrée"),
        Key::Delete => Phrase::new("Delete", "Suppr"),
        Key::Home => Phrase::new("Home", "Début"),
        Key::PageUp => Phrase::new("Page Up", "Page préc."),
        Key::PageDown => Phrase::new("Page Down", "Page suiv."),
        Key::Minus => Phrase::same("-"),
        Key::Plus => Phrase::same("+"),
        Key::Equals => Phrase::same("="),
        Key::Period => Phrase::same("."),
        Key::Comma => Phrase::same(","),
        Key::Space => Phrase::new("Space", "Espace"),
        Key::Questionmark => Phrase::same("?"),
        _ => Phrase::same(key.name()),
    };
    language.say(name)
}
