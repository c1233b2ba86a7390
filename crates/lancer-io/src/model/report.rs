//! What a loader has to say about one file: errors up to a bound, and warnings.

use super::text::{Source, Word, quoted};
use crate::diagnostics::{Diagnostic, LoadError};
use std::path::Path;

/// Collects the diagnostics of one file.
pub(super) struct Report {
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    /// Errors beyond the bound, which are not told.
    untold: usize,
    bound: usize,
}

impl Report {
    /// An empty report that tells at most `bound` errors, and at least one.
    pub(super) fn new(bound: usize) -> Self {
        Self { errors: Vec::new(), warnings: Vec::new(), untold: 0, bound: bound.max(1) }
    }

    /// Adds an error, which is made only if it will be told.
    pub(super) fn error(&mut self, diagnostic: impl FnOnce() -> Diagnostic) {
        if self.errors.len() < self.bound {
            self.errors.push(diagnostic());
        } else {
            self.untold += 1;
        }
    }

    /// Adds a warning.
    pub(super) fn warn(&mut self, diagnostic: Diagnostic) {
        self.warnings.push(diagnostic);
    }

    /// Whether there is no error yet.
    pub(super) fn is_clean(&self) -> bool {
        self.errors.is_empty()
    }

    /// The warnings.
    ///
    /// # Errors
    /// The errors, in the order of their places, if there are any.
    pub(super) fn finish(mut self, path: &Path) -> Result<Vec<Diagnostic>, LoadError> {
        if self.errors.is_empty() {
            return Ok(self.warnings);
        }
        self.errors.sort_by_key(|diagnostic| diagnostic.location);
        if self.untold > 0 {
            self.errors.push(Diagnostic::new(path, format!("{} more errors", self.untold)));
        }
        Err(LoadError { diagnostics: self.errors })
    }
}

/// What a loader passes over in one file: for each kind the first place and how many there are, so that each
/// kind is told once.
pub(super) struct PassedOver<'a, Kind> {
    found: Vec<(Kind, Word<'a>, usize)>,
}

impl<'a, Kind: Copy + Eq> PassedOver<'a, Kind> {
    pub(super) fn new() -> Self {
        Self { found: Vec::new() }
    }

    /// Counts one more of a kind. There are few kinds, so they are searched.
    pub(super) fn add(&mut self, kind: Kind, word: Word<'a>) {
        match self.found.iter_mut().find(|(other, ..)| *other == kind) {
            Some((_, _, count)) => *count += 1,
            None => self.found.push((kind, word, 1)),
        }
    }

    /// A warning for each kind at its first place, in the words that `message` makes of the kind and the first
    /// word.
    pub(super) fn warnings(&self, source: Source, message: impl Fn(Kind, &str) -> String) -> Vec<Diagnostic> {
        let warning = |&(kind, word, count): &(Kind, Word, usize)| {
            let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
            source.diagnostic(word.offset, message(kind, &quoted(word.bytes)) + &more)
        };
        self.found.iter().map(warning).collect()
    }
}
