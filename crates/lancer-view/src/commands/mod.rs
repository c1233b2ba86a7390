//! Every command of the window, once: what it is called, what it does, its keys, its menu and when it can be had.
//!
//! Menus, shortcuts, the command palette and the list of shortcuts are all drawn from [the table](table), so that
//! none of them can say another thing than the others. What a command does is the application's affair. Of egui,
//! this room knows the keys.

mod keys;
mod menus;
mod table;
#[cfg(test)]
mod tests;

pub use keys::{key_name, pressed, shortcut_text};
pub use menus::{Item, MENUS, MenuLayout};
pub use table::Command;

use crate::{EditKind, Language, Phrase};
use eframe::egui::KeyboardShortcut;

/// A menu of the window, and with it the group in which a command is listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Menu {
    /// Scenes and pictures as files.
    File,
    /// Changes of the scene.
    Edit,
    /// Where from, and as what, the scene is seen.
    View,
    /// Pictures of the chosen size.
    Render,
    /// How all of this is used.
    Help,
}

impl Menu {
    /// All of them, from left to right.
    pub const ALL: [Self; 5] = [Self::File, Self::Edit, Self::View, Self::Render, Self::Help];

    /// What it is called.
    pub const fn name(self) -> Phrase {
        match self {
            Self::File => Phrase::new("File", "Fichier"),
            Self::Edit => Phrase::new("Edit", "Édition"),
            Self::View => Phrase::new("View", "Affichage"),
            Self::Render => Phrase::new("Render", "Rendu"),
            Self::Help => Phrase::new("Help", "Aide"),
        }
    }
}

/// How a command behaves in a menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It does something.
    Act,
    /// It is on or off.
    Toggle,
    /// It is one of several, of which one is chosen.
    Choice,
}

/// What must be there for a command to make sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Needs {
    Nothing,
    Document,
    File,
    Undo,
    Redo,
    Changes,
    Selection,
    Hideable,
    Hidden,
    Work,
    Render,
    Renders,
    SeveralRenders,
}

/// What the commands' state depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CommandContext {
    /// A scene is open.
    pub has_document: bool,
    /// The scene came from a file.
    pub has_file: bool,
    /// The step that would be undone.
    pub undo: Option<EditKind>,
    /// The step that would be done again.
    pub redo: Option<EditKind>,
    /// The scene differs from what was loaded or saved.
    pub is_changed: bool,
    /// Something is selected.
    pub has_selection: bool,
    /// What is selected is a node, and is not hidden.
    pub can_hide: bool,
    /// A node is hidden.
    pub has_hidden: bool,
    /// A picture is being rendered, or a scene opened.
    pub is_working: bool,
    /// A picture is being rendered.
    pub is_rendering: bool,
    /// Renders that are kept.
    pub renders: usize,
    /// A render is shown in place of the view.
    pub shows_render: bool,
    /// The toggles that are on, and the choices that are made.
    pub checked: Vec<Command>,
}

impl CommandContext {
    fn meets(&self, needs: Needs) -> bool {
        match needs {
            Needs::Nothing => true,
            Needs::Document => self.has_document,
            Needs::File => self.has_file,
            Needs::Undo => self.undo.is_some(),
            Needs::Redo => self.redo.is_some(),
            Needs::Changes => self.is_changed,
            Needs::Selection => self.has_selection,
            Needs::Hideable => self.can_hide,
            Needs::Hidden => self.has_hidden,
            Needs::Work => self.is_working,
            Needs::Render => self.shows_render,
            Needs::Renders => self.renders > 0,
            Needs::SeveralRenders => self.renders > 1,
        }
    }
}

/// A row of the table.
struct Entry {
    menu: Menu,
    kind: Kind,
    needs: Needs,
    shortcuts: &'static [KeyboardShortcut],
    name: Phrase,
    description: Phrase,
}

impl Command {
    /// What it is called, in a menu or on a button.
    pub const fn name(self) -> Phrase {
        self.entry().name
    }

    /// What it is called now: "Undo" says what.
    pub fn label(self, context: &CommandContext, language: Language) -> String {
        match self {
            Self::Undo => context.undo.map(|kind| kind.undo_text(language)),
            Self::Redo => context.redo.map(|kind| kind.redo_text(language)),
            _ => None,
        }
        .unwrap_or_else(|| language.say(self.name()).to_owned())
    }

    /// What it does, in a line without a full stop.
    pub const fn description(self) -> Phrase {
        self.entry().description
    }

    /// The keys that give it; the first is shown in menus.
    pub const fn shortcuts(self) -> &'static [KeyboardShortcut] {
        self.entry().shortcuts
    }

    /// The menu that it is in.
    pub const fn menu(self) -> Menu {
        self.entry().menu
    }

    /// How it behaves in that menu.
    pub const fn kind(self) -> Kind {
        self.entry().kind
    }

    /// Whether it makes sense now.
    pub fn is_enabled(self, context: &CommandContext) -> bool {
        context.meets(self.entry().needs)
    }

    /// Whether it is on or chosen now; none for what is neither.
    pub fn is_checked(self, context: &CommandContext) -> Option<bool> {
        (self.kind() != Kind::Act).then(|| context.checked.contains(&self))
    }
}
