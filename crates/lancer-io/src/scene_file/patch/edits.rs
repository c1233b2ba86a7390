//! Changes of a text, by byte.

use std::ops::Range;

/// What is to be put in the place of which bytes.
#[derive(Debug, Default)]
pub(super) struct Edits(Vec<(Range<usize>, String)>);

impl Edits {
    /// Puts text in the place of a range. Ranges must not overlap; what is put at one place stands there in the
    /// order in which it was put.
    pub(super) fn replace(&mut self, range: Range<usize>, text: impl Into<String>) {
        self.0.push((range, text.into()));
    }

    pub(super) fn insert(&mut self, place: usize, text: impl Into<String>) {
        self.replace(place..place, text);
    }

    /// The text with the changes, each place first translated by `raw`, and each line that is put in ended by
    /// `line_end`. `None` where ranges overlap or lie outside of the text.
    pub(super) fn apply(
        mut self,
        text: &str,
        raw: impl Fn(usize) -> usize,
        line_end: &str,
    ) -> Option<String> {
        self.0.sort_by_key(|(range, _)| range.start);
        let mut edited = String::with_capacity(text.len());
        let mut done = 0;
        for (range, new) in self.0 {
            edited.push_str(text.get(done..raw(range.start))?);
            edited.push_str(&new.replace('\n', line_end));
            done = raw(range.end);
        }
        edited.push_str(text.get(done..)?);
        Some(edited)
    }
}
