//! Where in a text each node of its tree stands, in bytes.
//!
//! In: text that has a tree. Out: the same tree as [`Layout`], with spans in place of values. Spans end where the
//! last character of a node does, whatever blank lines and comments follow.

use saphyr_parser::{Event, Marker, Parser, ScalarStyle, Span};
use std::ops::Range;

/// A node's place.
#[derive(Debug)]
pub(super) struct Layout {
    /// From its anchor or tag, where it has one. Where the value was left out, empty, and at no place to rely on.
    pub(super) span: Range<usize>,
    /// The parser's id of its anchor; 0 where it has none.
    pub(super) anchor: usize,
    pub(super) kind: Kind,
}

#[derive(Debug)]
pub(super) enum Kind {
    Scalar,
    /// A value that was left out, as in `key:`.
    Missing,
    /// Of the anchor of that id.
    Alias(usize),
    Sequence(Style, Vec<Layout>),
    Mapping(Style, Vec<Entry>),
}

/// A key and its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: Layout,
    pub(super) value: Layout,
}

/// How a list or mapping is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// By lines and indentation.
    Block,
    /// Within brackets.
    Flow,
}

/// The layout of a text. `None` where the text has no tree.
pub(super) fn layout(text: &str) -> Option<Layout> {
    let mut builder = Builder { text, offsets: Offsets::of(text), open: Vec::new(), root: None };
    let mut parser = Parser::new_from_str(text);
    while let Some(event) = parser.next_event() {
        let (event, span) = event.ok()?;
        builder.take(&event, span)?;
    }
    builder.root
}

/// Bytes before each character, to find a parser's markers by, which count characters.
enum Offsets {
    /// All characters are of one byte.
    Ascii,
    Wide(Vec<usize>),
}

impl Offsets {
    fn of(text: &str) -> Self {
        if text.is_ascii() {
            return Self::Ascii;
        }
        let starts = text.char_indices().map(|(offset, _)| offset);
        Self::Wide(starts.chain([text.len()]).collect())
    }

    fn get(&self, marker: Marker) -> Option<usize> {
        match self {
            Self::Ascii => Some(marker.index()),
            Self::Wide(offsets) => offsets.get(marker.index()).copied(),
        }
    }
}

struct Builder<'a> {
    text: &'a str,
    offsets: Offsets,
    open: Vec<Open>,
    root: Option<Layout>,
}

/// A list or mapping whose end has not come yet.
struct Open {
    start: usize,
    anchor: usize,
    style: Style,
    is_mapping: bool,
    /// Of a mapping, keys and values in turn.
    children: Vec<Layout>,
}

impl Builder<'_> {
    fn take(&mut self, event: &Event<'_>, span: Span) -> Option<()> {
        let span = self.offsets.get(span.start)?..self.offsets.get(span.end)?;
        match event {
            Event::Scalar(text, style, anchor, tag) => {
                let is_missing =
                    text.is_empty() && *style == ScalarStyle::Plain && *anchor == 0 && tag.is_none();
                let kind = if is_missing { Kind::Missing } else { Kind::Scalar };
                let span = if is_missing { span.start..span.start } else { self.trimmed(span)? };
                self.put(Layout { span, anchor: *anchor, kind });
            }
            Event::Alias(anchor) => {
                let span = self.trimmed(span)?;
                self.put(Layout { span, anchor: 0, kind: Kind::Alias(*anchor) });
            }
            Event::SequenceStart(anchor, _) => self.begin(&span, *anchor, false)?,
            Event::MappingStart(anchor, _) => self.begin(&span, *anchor, true)?,
            Event::SequenceEnd | Event::MappingEnd => self.end(&span)?,
            _ => {}
        }
        Some(())
    }

    fn trimmed(&self, span: Range<usize>) -> Option<Range<usize>> {
        let length = self.text.get(span.clone())?.trim_end().len();
        Some(span.start..span.start + length)
    }

    fn begin(&mut self, span: &Range<usize>, anchor: usize, is_mapping: bool) -> Option<()> {
        let bracket = if is_mapping { '{' } else { '[' };
        let style = if self.text.get(span.clone())?.ends_with(bracket) { Style::Flow } else { Style::Block };
        self.open.push(Open { start: span.start, anchor, style, is_mapping, children: Vec::new() });
        Some(())
    }

    fn end(&mut self, span: &Range<usize>) -> Option<()> {
        let Open { start, anchor, style, is_mapping, children } = self.open.pop()?;
        let last = children.last().map_or(start, |child| child.span.end);
        let end = if style == Style::Flow { span.end } else { last };
        let kind = if is_mapping {
            let mut entries = Vec::with_capacity(children.len() / 2);
            let mut children = children.into_iter();
            while let (Some(key), Some(value)) = (children.next(), children.next()) {
                entries.push(Entry { key, value });
            }
            Kind::Mapping(style, entries)
        } else {
            Kind::Sequence(style, children)
        };
        self.put(Layout { span: start..end, anchor, kind });
        Some(())
    }

    /// Puts a finished node into the innermost open one.
    fn put(&mut self, mut node: Layout) {
        let Some(open) = self.open.last_mut() else {
            self.root = Some(node);
            return;
        };
        // What was left out ends where its key does, or after the colon.
        if let (Kind::Missing, true, Some(key)) = (&node.kind, open.is_mapping, open.children.last()) {
            let place = after_colon(self.text, key.span.end).unwrap_or(key.span.end);
            node.span = place..place;
        }
        open.children.push(node);
    }
}

/// The place after the colon that follows a key. `None` where none stands there.
pub(super) fn after_colon(text: &str, key_end: usize) -> Option<usize> {
    let rest = text.get(key_end..)?;
    let trimmed = rest.trim_start();
    trimmed.starts_with(':').then(|| key_end + rest.len() - trimmed.len() + 1)
}
