//! What went wrong while a node was read, from bare fact to words.

use crate::diagnostics::{most_similar, name_hint};
use crate::scene_file::syntax::{Node, Place, Problem};
use serde::de::{self, Expected, Unexpected};
use std::fmt::{self, Display};

/// An error of the deserialiser.
///
/// serde raises it without a place and knowing nothing of what surrounds the value; both are filled in on the
/// way out: the place by the innermost node, the subject (`lights[0].position[1]` shortened to `position[1]`) by
/// the lists up to the nearest mapping.
#[derive(Debug)]
pub(crate) struct Error(Box<Facts>);

#[derive(Debug)]
struct Facts {
    fault: Fault,
    place: Option<Place>,
    subject: String,
    subject_is_complete: bool,
    /// Whether it only follows from another error, which is told already.
    echo: bool,
}

#[derive(Debug)]
enum Fault {
    Mismatch { found: Found, expected: String },
    UnknownKey { key: String, known: &'static [&'static str] },
    UnknownWord { word: String, known: &'static [&'static str] },
    MissingKey(&'static str),
    Other(String),
}

/// A value in words, and whether it is a scalar that quotes would turn into text.
#[derive(Debug)]
struct Found {
    words: String,
    quotable: bool,
}

impl Error {
    fn new(fault: Fault) -> Self {
        Self(Box::new(Facts {
            fault,
            place: None,
            subject: String::new(),
            subject_is_complete: false,
            echo: false,
        }))
    }

    /// The value is not what is wanted; both in words.
    pub(crate) fn mismatch(found: impl Into<String>, expected: impl Into<String>) -> Self {
        let found = Found { words: found.into(), quotable: false };
        Self::new(Fault::Mismatch { found, expected: expected.into() })
    }

    /// The error as one of this node, unless a node within is at fault. Takes the node at fault out of the
    /// document, for the next reading.
    pub(crate) fn of_node(mut self, node: &Node) -> Self {
        if self.0.place.is_none() {
            self.0.place = Some(node.place);
            self.0.echo = self.echoes_a_part_of(node);
            node.removed.set(true);
        }
        self
    }

    /// The error as one of a key, whose entry it takes out.
    pub(crate) fn of_key(mut self, place: Place, value: &Node) -> Self {
        self.0.place.get_or_insert(place);
        value.removed.set(true);
        self
    }

    /// The error as one in the item of a list.
    pub(crate) fn in_item(mut self, index: usize) -> Self {
        if !self.0.subject_is_complete {
            self.0.subject.insert_str(0, &format!("[{index}]"));
        }
        self
    }

    /// The error as one in the value of a key.
    pub(crate) fn in_key(mut self, key: &str) -> Self {
        if !self.0.subject_is_complete {
            self.0.subject.insert_str(0, key);
            self.0.subject_is_complete = true;
        }
        self
    }

    fn echoes_a_part_of(&self, node: &Node) -> bool {
        match self.0.fault {
            // Only the loss of that very key, be it misspelt, explains that it is missing.
            Fault::MissingKey(missing) => node
                .entries()
                .iter()
                .filter(|entry| entry.value.removed.get())
                .any(|entry| most_similar(&entry.key, [missing]).is_some()),
            _ => node.lost_a_part(),
        }
    }

    /// The error in words, or `None` for an echo.
    pub(crate) fn into_problem(self, root: &Node) -> Option<Problem> {
        let facts = *self.0;
        if facts.echo {
            return None;
        }
        let subject = if facts.subject.is_empty() { "the file".into() } else { facts.subject };
        let (message, hint) = facts.fault.into_words(&subject);
        Some(Problem { place: facts.place.unwrap_or(root.place), message, hint })
    }
}

impl Fault {
    /// The message and the hint.
    fn into_words(self, subject: &str) -> (String, Option<String>) {
        match self {
            Self::Mismatch { found, expected } => {
                let wants_text = found.quotable && expected.starts_with(TEXT);
                let hint = wants_text.then(|| format!("write it in quotes: \"{}\"", found.words));
                (format!("{subject} is {}, must be {expected}", found.words), hint)
            }
            Self::UnknownKey { key, known } => {
                (format!("unknown key `{}`", clipped(&key)), name_hint(&key, known.iter().copied()))
            }
            Self::UnknownWord { word, known } => (
                format!("{subject} is `{}`, which is not known", clipped(&word)),
                name_hint(&word, known.iter().copied()),
            ),
            Self::MissingKey(key) => (format!("`{key}` is missing"), None),
            Self::Other(message) => (message, None),
        }
    }
}

/// How expectations of text begin; see [`Fault::into_words`].
const TEXT: &str = "text";

impl de::Error for Error {
    fn custom<T: Display>(message: T) -> Self {
        Self::new(Fault::Other(message.to_string()))
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let quotable = matches!(
            found,
            Unexpected::Bool(_) | Unexpected::Signed(_) | Unexpected::Unsigned(_) | Unexpected::Float(_)
        );
        let found = Found { words: in_words(found), quotable };
        Self::new(Fault::Mismatch { found, expected: expectation(expected) })
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::mismatch(in_words(found), expectation(expected))
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::mismatch(format!("a list of {length}"), expectation(expected))
    }

    fn unknown_variant(word: &str, known: &'static [&'static str]) -> Self {
        Self::new(Fault::UnknownWord { word: word.into(), known })
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        Self::new(Fault::UnknownKey { key: key.into(), known })
    }

    fn missing_field(key: &'static str) -> Self {
        Self::new(Fault::MissingKey(key))
    }
}

/// What serde's own types expect, in the words of a scene file.
fn expectation(expected: &dyn Expected) -> String {
    match expected.to_string().as_str() {
        "a string" => TEXT.into(),
        "a boolean" => "true or false".into(),
        "a sequence" => "a list".into(),
        words => words.replace("an array of length", "a list of length"),
    }
}

pub(crate) fn in_words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(value) => value.to_string(),
        Unexpected::Signed(value) => value.to_string(),
        Unexpected::Unsigned(value) => value.to_string(),
        Unexpected::Float(value) if value.is_nan() => ".nan".into(),
        Unexpected::Float(value) if value.is_infinite() => if value > 0.0 { ".inf" } else { "-.inf" }.into(),
        Unexpected::Float(value) if value.abs() >= 1e15 => format!("{value:e}"),
        Unexpected::Float(value) => value.to_string(),
        Unexpected::Str(text) => format!("the text `{}`", clipped(text)),
        Unexpected::Unit => "empty".into(),
        Unexpected::Seq => "a list".into(),
        Unexpected::Map => "a mapping".into(),
        Unexpected::Other(words) => words.into(),
        other => other.to_string(),
    }
}

/// A text short enough for a message.
fn clipped(text: &str) -> String {
    const SHOWN: usize = 40;
    let mut clipped =
        text.chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect::<String>();
    if text.chars().nth(SHOWN).is_some() {
        clipped.push_str("...");
    }
    clipped
}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0.fault)
    }
}

impl std::error::Error for Error {}
