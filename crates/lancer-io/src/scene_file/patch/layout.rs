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
                let is_bare = *anchor == 0 && tag.is_none();
                let is_missing = text.is_empty() && *style == ScalarStyle::Plain && is_bare;
                let kind = if is_missing { Kind::Missing } else { Kind::Scalar };
                let span = self.span_of_scalar(*style, is_bare, span)?;
                self.put(Layout { span, anchor: *anchor, kind });
            }
            Event::Alias(anchor) => self.put(Layout { span, anchor: 0, kind: Kind::Alias(*anchor) }),
            Event::SequenceStart(anchor, _) => self.begin(span.start, *anchor, false),
            Event::MappingStart(anchor, _) => self.begin(span.start, *anchor, true),
            Event::SequenceEnd | Event::MappingEnd => self.end(span.start)?,
            _ => {}
        }
        Some(())
    }

    /// The span without the blanks and comments that the parser counts in.
    fn span_of_scalar(&self, style: ScalarStyle, is_bare: bool, span: Range<usize>) -> Option<Range<usize>> {
        let trimmed = span.start + self.text.get(span.clone())?.trim_end().len();
        Some(match style {
            ScalarStyle::Plain => span.start..trimmed,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => {
                span.start..after_quotes(self.text, after_properties(self.text, span.start))?
            }
            ScalarStyle::Literal | ScalarStyle::Folded if is_bare => self.header_of_lines()?..trimmed,
            ScalarStyle::Literal | ScalarStyle::Folded => span.start..trimmed,
        })
    }

    /// Where the `|` or `>` of a text in lines stands; the parser tells only where its first line does. `None` in
    /// lists, none of which is of texts in a scene file.
    fn header_of_lines(&self) -> Option<usize> {
        let open = self.open.last().filter(|open| open.is_mapping)?;
        let colon = after_colon(self.text, open.children.last()?.span.end)?;
        Some(after_blanks(self.text, colon))
    }

    fn begin(&mut self, start: usize, anchor: usize, is_mapping: bool) {
        let content = &self.text[after_properties(self.text, start)..];
        let style = if content.starts_with(['{', '[']) { Style::Flow } else { Style::Block };
        self.open.push(Open { start, anchor, style, is_mapping, children: Vec::new() });
    }

    fn end(&mut self, parsed_end: usize) -> Option<()> {
        let Open { start, anchor, style, is_mapping, children } = self.open.pop()?;
        let end = match style {
            Style::Block => children.last().map_or(start, |child| child.span.end),
            Style::Flow => self.after_bracket(parsed_end)?,
        };
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

    /// The place after a closing bracket, of which the parser tells where it is, or the comma before it.
    fn after_bracket(&self, place: usize) -> Option<usize> {
        let comma = usize::from(self.text.get(place..)?.starts_with(','));
        let bracket = after_blanks(self.text, place + comma);
        self.text[bracket..].starts_with(['}', ']']).then_some(bracket + 1)
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
    let colon = after_blanks(text, key_end);
    text[colon..].starts_with(':').then_some(colon + 1)
}

/// The place after blanks, ends of lines and comments.
fn after_blanks(text: &str, place: usize) -> usize {
    let mut rest = text[place..].trim_start();
    while let Some(comment) = rest.strip_prefix('#') {
        rest = comment.trim_start_matches(|c| c != '\n').trim_start();
    }
    text.len() - rest.len()
}

/// The place after a node's anchor and tag, where its content begins.
fn after_properties(text: &str, start: usize) -> usize {
    let mut place = start;
    while text[place..].starts_with(['&', '!']) {
        let property = text[place..].find(char::is_whitespace);
        place = property.map_or(text.len(), |length| after_blanks(text, place + length));
    }
    place
}

/// The place after the closing quote of a text that begins with a quote here.
fn after_quotes(text: &str, start: usize) -> Option<usize> {
    let quote = text[start..].chars().next()?;
    let mut rest = &text[start + 1..];
    loop {
        let stop = rest.find([quote, '\\'])?;
        let taken = match (quote, &rest[stop..]) {
            ('"', escaped) if escaped.starts_with('\\') => 1 + escaped[1..].chars().next()?.len_utf8(),
            ('\'', quotes) if quotes.starts_with("''") => 2,
            ('\'', other) if other.starts_with('\\') => 1,
            _ => return Some(text.len() - rest.len() + stop + 1),
        };
        rest = &rest[stop + taken..];
    }
}
