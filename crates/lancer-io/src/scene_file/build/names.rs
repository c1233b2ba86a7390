//! Things that a file defines by name and refers to by name.

use crate::diagnostics::{most_similar, name_hint};
use crate::scene_file::deserialize::Spanned;
use crate::scene_file::syntax::{self, Node, Place, Problem};
use std::collections::{HashMap, HashSet};

/// The things of one kind, and which of them are in use.
pub(super) struct Names<'a, T> {
    /// What they are called, as in "unknown material".
    kind: &'static str,
    entries: Vec<Entry<'a, T>>,
    by_name: HashMap<&'a str, usize>,
    unread: Unread<'a>,
    hints_left: usize,
}

/// How many unknown names of a kind get a hint: more than are ever told. Each is compared with all that are known,
/// so that without a bound a hostile file would take time by the square of its length.
const MOST_HINTS: usize = 100;

struct Entry<'a, T> {
    name: &'a Spanned<String>,
    thing: T,
    used: bool,
}

/// Names that stand in the file, but whose things were at fault; that they are unknown is no news.
enum Unread<'a> {
    All,
    These(HashSet<&'a str>),
}

impl<'a> Unread<'a> {
    /// What was taken out of a section of the document.
    fn of(root: &'a Node, section: &str) -> Self {
        let lost = |entry: &&syntax::Entry| entry.value.removed.get();
        // Lost as a whole, be it under a misspelt name.
        if root.entries().iter().filter(lost).any(|entry| most_similar(&entry.key, [section]).is_some()) {
            return Self::All;
        }
        let entries = root.get(section).map_or(&[][..], Node::entries);
        Self::These(entries.iter().filter(lost).map(|entry| &*entry.key).collect())
    }

    fn has(&self, name: &str) -> bool {
        match self {
            Self::All => true,
            Self::These(names) => names.contains(name),
        }
    }
}

impl<'a, T> Names<'a, T> {
    /// None yet; those of `section` in the document are to come.
    pub(super) fn new(kind: &'static str, root: &'a Node, section: &str) -> Self {
        Self {
            kind,
            entries: Vec::new(),
            by_name: HashMap::new(),
            unread: Unread::of(root, section),
            hints_left: MOST_HINTS,
        }
    }

    pub(super) fn add(&mut self, name: &'a Spanned<String>, thing: T) {
        self.by_name.insert(&name.value, self.entries.len());
        self.entries.push(Entry { name, thing, used: false });
    }

    /// Replaces the thing that was added as number `index`.
    pub(super) fn set(&mut self, index: usize, thing: T) {
        self.entries[index].thing = thing;
    }

    /// The thing of that name, which is in use from now on; `None` where the file has it, but at fault.
    ///
    /// # Errors
    /// No such name; to be told at `place`.
    pub(super) fn find(&mut self, name: &str, place: Place) -> Result<Option<&T>, Problem> {
        if let Some(&index) = self.by_name.get(name) {
            let entry = &mut self.entries[index];
            entry.used = true;
            return Ok(Some(&entry.thing));
        }
        if self.unread.has(name) {
            return Ok(None);
        }
        Err(self.unknown(name, place))
    }

    fn unknown(&mut self, name: &str, place: Place) -> Problem {
        let problem = Problem::new(place, format!("unknown {} `{name}`", self.kind));
        if self.hints_left == 0 {
            return problem;
        }
        self.hints_left -= 1;
        match name_hint(name, self.entries.iter().map(|entry| entry.name.value.as_str())) {
            Some(hint) => problem.with_hint(hint),
            None => problem.with_hint(format!("the file has no {}s", self.kind)),
        }
    }

    /// Warnings of the things that nothing uses.
    pub(super) fn unused(&self) -> impl Iterator<Item = Problem> {
        self.entries.iter().filter(|entry| !entry.used).map(|entry| {
            Problem::new(entry.name.place, format!("the {} `{}` is never used", self.kind, entry.name.value))
        })
    }
}
