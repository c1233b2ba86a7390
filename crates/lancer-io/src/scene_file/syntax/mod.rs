//! A document as its author wrote it: a tree of scalars, lists and mappings, each with its place.
//!
//! In: text, by [`parse()`]. Out: a [`Node`], to be edited by overrides and read by the deserialiser. It knows YAML
//! and nothing of scenes.

mod parse;
mod scalar;
mod text;
mod write;

pub(crate) use parse::{Parsed, parse};
pub(crate) use scalar::{Scalar, same_scalar};
pub(crate) use text::{RawOffsets, decode};
pub(crate) use write::{Language, block, flow, flow_key};

use std::cell::Cell;
use std::rc::Rc;

/// Who wrote a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Origin {
    /// The file.
    File,
    /// The override of that index.
    Override(u32),
}

/// Where a node was written. Lines and columns start at 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    pub(crate) origin: Origin,
    pub(crate) line: u32,
    pub(crate) column: u32,
}

impl Place {
    /// The first character of what `origin` wrote.
    pub(crate) fn start_of(origin: Origin) -> Self {
        Self { origin, line: 1, column: 1 }
    }
}

/// Something wrong at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    pub(crate) place: Place,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Problem {
    pub(crate) fn new(place: Place, message: impl Into<String>) -> Self {
        Self { place, message: message.into(), hint: None }
    }

    #[must_use]
    pub(crate) fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

/// A value and its place. Aliases share the node of their anchor, so that a file with many takes no more memory
/// than it has bytes; an edit goes through [`Rc::make_mut`], which parts what it touches.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) value: Value,
    /// Whether a reader found this node at fault and took it out, to go on with the rest of the document.
    pub(crate) removed: Cell<bool>,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    Scalar(Scalar),
    Sequence(Vec<Rc<Node>>),
    Mapping(Vec<Entry>),
}

/// A key and its value. A mapping holds each key once.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: Rc<str>,
    pub(crate) key_place: Place,
    pub(crate) value: Rc<Node>,
}

impl Node {
    pub(crate) fn new(place: Place, value: Value) -> Self {
        Self { place, value, removed: Cell::new(false) }
    }

    /// The entries of a mapping; none where the node is no mapping.
    pub(crate) fn entries(&self) -> &[Entry] {
        match &self.value {
            Value::Mapping(entries) => entries,
            _ => &[],
        }
    }

    /// The value of a key, even where it was taken out.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries().iter().find(|entry| &*entry.key == key).map(|entry| &*entry.value)
    }

    /// Whether it is a list or a mapping with nothing in it.
    pub(crate) fn is_empty(&self) -> bool {
        match &self.value {
            Value::Scalar(_) => false,
            Value::Sequence(items) => items.is_empty(),
            Value::Mapping(entries) => entries.is_empty(),
        }
    }

    /// Whether something directly in this node was taken out, so that a fault of the node may be its echo.
    pub(crate) fn lost_a_part(&self) -> bool {
        match &self.value {
            Value::Scalar(_) => false,
            Value::Sequence(items) => items.iter().any(|item| item.removed.get()),
            Value::Mapping(entries) => entries.iter().any(|entry| entry.value.removed.get()),
        }
    }
}

/// Whether two trees mean the same, wherever their nodes stand.
pub(crate) fn same_tree(a: &Node, b: &Node) -> bool {
    match (&a.value, &b.value) {
        (Value::Scalar(a), Value::Scalar(b)) => same_scalar(a, b),
        (Value::Sequence(a), Value::Sequence(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_tree(a, b))
        }
        (Value::Mapping(a), Value::Mapping(b)) => {
            let same = |(a, b): (&Entry, &Entry)| a.key == b.key && same_tree(&a.value, &b.value);
            a.len() == b.len() && a.iter().zip(b).all(same)
        }
        _ => false,
    }
}
