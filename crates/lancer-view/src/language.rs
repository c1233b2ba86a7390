//! English and French.
//!
//! A [`Phrase`] is written once in each language, beside the code that shows it, so that none can be missing.

use serde::{Deserialize, Serialize};

/// A language of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// English.
    #[default]
    English,
    /// French.
    French,
}

/// A text of the window in every language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phrase {
    english: &'static str,
    french: &'static str,
}

impl Phrase {
    /// A text in English and French.
    pub const fn new(english: &'static str, french: &'static str) -> Self {
        Self { english, french }
    }

    /// A text that is the same in both: a name or a symbol.
    pub const fn same(text: &'static str) -> Self {
        Self { english: text, french: text }
    }
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::English, Self::French];

    /// The language that the system asks for; English where that is none of these.
    pub fn of_system() -> Self {
        let locale = sys_locale::get_locale().unwrap_or_default();
        if locale.to_ascii_lowercase().starts_with("fr") { Self::French } else { Self::English }
    }

    /// A phrase in this language.
    pub const fn say(self, phrase: Phrase) -> &'static str {
        match self {
            Self::English => phrase.english,
            Self::French => phrase.french,
        }
    }

    /// The language's own name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::French => "Français",
        }
    }
}
