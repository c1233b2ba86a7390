//! What is wrong with a document, and where in it.

use crate::diagnostics::{Diagnostic, LoadError};
use std::fmt::Display;
use std::path::Path;

/// A fault at a place of the document.
#[derive(Debug)]
pub(super) struct Fault {
    /// A JSON pointer, as `/meshes/0/primitives/1/attributes/POSITION`.
    pointer: String,
    message: String,
    hint: Option<&'static str>,
}

pub(super) type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    pub(super) fn new(pointer: impl Display, message: impl Into<String>) -> Self {
        Self { pointer: pointer.to_string(), message: message.into(), hint: None }
    }

    /// The fault with what the user can do.
    pub(super) fn with_hint(self, hint: impl Into<Option<&'static str>>) -> Self {
        Self { hint: hint.into(), ..self }
    }

    pub(super) fn pointer(&self) -> &str {
        &self.pointer
    }

    pub(super) fn message(&self) -> &str {
        &self.message
    }

    pub(super) fn into_error(self, path: &Path) -> LoadError {
        let error = Diagnostic::new(path, format!("{}: {}", self.pointer, self.message));
        match self.hint {
            Some(hint) => error.with_hint(hint).into(),
            None => error.into(),
        }
    }
}

/// The entry of an array of the document that `at` names by its place.
pub(super) fn entry<'a, T>(array: &'a [T], name: &str, index: usize, at: impl Display) -> Result<&'a T> {
    array.get(index).ok_or_else(|| {
        let there = match array.len() {
            0 => format!("there are no {name}"),
            count => format!("there are only {count} {name}"),
        };
        Fault::new(at, format!("is {index}, but {there}"))
    })
}

/// Warnings of a document, each kind once with its first place and how many there are.
#[derive(Default)]
pub(super) struct Warnings {
    told: Vec<(String, String, usize)>,
}

impl Warnings {
    pub(super) fn add(&mut self, pointer: impl Display, message: impl Into<String>) {
        let message = message.into();
        let known = self.told.iter().position(|(_, other, _)| *other == message);
        if let Some(known) = known {
            self.told[known].2 += 1;
        } else if self.told.len() < MOST_KINDS {
            self.told.push((pointer.to_string(), message, 1));
        }
    }

    pub(super) fn into_diagnostics(self, path: &Path) -> Vec<Diagnostic> {
        let diagnostic = |(pointer, message, count): (String, String, usize)| {
            let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
            Diagnostic::new(path, format!("{pointer}: {message}{more}"))
        };
        self.told.into_iter().map(diagnostic).collect()
    }
}

/// The most kinds of warnings that are told of a file; messages may quote it, so a hostile one has many.
const MOST_KINDS: usize = 100;
