//! How the commands lie in the menus.

use super::{Command, Menu};
use crate::Phrase;

/// A line of a menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// A command.
    Command(Command),
    /// A line between groups.
    Separator,
    /// A menu in the menu.
    Submenu(Phrase, &'static [Item]),
    /// The built-in scenes, as a menu in the menu.
    BuiltinScenes,
    /// The files opened last, as a menu in the menu.
    RecentFiles,
}

/// A menu and its lines.
pub type MenuLayout = (Menu, &'static [Item]);

/// The menus, from left to right.
pub const MENUS: [MenuLayout; 5] =
    [(Menu::File, FILE), (Menu::Edit, EDIT), (Menu::View, VIEW), (Menu::Render, RENDER), (Menu::Help, HELP)];

const FILE: &[Item] = &[
    Item::Command(Command::Open),
    Item::BuiltinScenes,
    Item::RecentFiles,
    Item::Command(Command::Reload),
    Item::Separator,
    Item::Command(Command::SaveScene),
    Item::Command(Command::SaveSceneAs),
    Item::Separator,
    Item::Command(Command::SavePicture),
    Item::Command(Command::CopyPicture),
    Item::Separator,
    Item::Command(Command::Quit),
];

const EDIT: &[Item] = &[
    Item::Command(Command::Undo),
    Item::Command(Command::Redo),
    Item::Command(Command::Revert),
    Item::Separator,
    Item::Command(Command::Deselect),
    Item::Command(Command::HideSelection),
    Item::Command(Command::ShowAll),
    Item::Separator,
    Item::Command(Command::UseViewAsCamera),
];

const VIEW: &[Item] = &[
    Item::Command(Command::FrameAll),
    Item::Command(Command::FrameSelection),
    Item::Command(Command::Home),
    Item::Submenu(
        Phrase::new("Look along an axis", "Regarder le long d’un axe"),
        &[
            Item::Command(Command::Front),
            Item::Command(Command::Back),
            Item::Command(Command::Right),
            Item::Command(Command::Left),
            Item::Command(Command::Top),
            Item::Command(Command::Bottom),
        ],
    ),
    Item::Separator,
    Item::Submenu(
        Phrase::new("Show", "Montrer"),
        &[
            Item::Command(Command::ShowPicture),
            Item::Command(Command::ShowDepth),
            Item::Command(Command::ShowNormals),
            Item::Command(Command::ShowObjects),
            Item::Command(Command::ShowOcclusion),
        ],
    ),
    Item::Submenu(
        Phrase::new("Overlays", "Repères"),
        &[
            Item::Command(Command::Grid),
            Item::Command(Command::Axes),
            Item::Command(Command::Lights),
            Item::Command(Command::Bounds),
            Item::Command(Command::Interest),
            Item::Separator,
            Item::Command(Command::Tree),
            Item::Command(Command::TreeDeeper),
            Item::Command(Command::TreeShallower),
        ],
    ),
    Item::Separator,
    Item::Command(Command::ScenePanel),
    Item::Command(Command::SettingsPanel),
    Item::Command(Command::RendersPanel),
    Item::Command(Command::MouseHints),
    Item::Command(Command::FullScreen),
    Item::Separator,
    Item::Submenu(
        Phrase::new("Mouse", "Souris"),
        &[
            Item::Command(Command::MouseAssignment),
            Item::Command(Command::MouseOrbit),
            Item::Command(Command::MouseTrackpad),
        ],
    ),
    Item::Submenu(
        Phrase::new("Theme", "Thème"),
        &[
            Item::Command(Command::ThemeSystem),
            Item::Command(Command::ThemeLight),
            Item::Command(Command::ThemeDark),
        ],
    ),
    // Both words in both languages: whoever looks for it may not read the one that is shown.
    Item::Submenu(
        Phrase::new("Language · Langue", "Langue · Language"),
        &[
            Item::Command(Command::LanguageSystem),
            Item::Command(Command::LanguageEnglish),
            Item::Command(Command::LanguageFrench),
        ],
    ),
    Item::Submenu(
        Phrase::new("Text and controls", "Taille de l’interface"),
        &[
            Item::Command(Command::LargerInterface),
            Item::Command(Command::SmallerInterface),
            Item::Command(Command::NormalInterface),
        ],
    ),
];

const RENDER: &[Item] = &[
    Item::Command(Command::Render),
    Item::Command(Command::Cancel),
    Item::Separator,
    Item::Command(Command::ShowView),
    Item::Command(Command::PreviousRender),
    Item::Command(Command::NextRender),
    Item::Command(Command::Compare),
    Item::Command(Command::DeleteRender),
    Item::Separator,
    Item::Command(Command::ZoomIn),
    Item::Command(Command::ZoomOut),
    Item::Command(Command::ActualSize),
    Item::Command(Command::Fit),
];

const HELP: &[Item] = &[
    Item::Command(Command::Palette),
    Item::Command(Command::Shortcuts),
    Item::Separator,
    Item::Command(Command::About),
];
