//! Further entries and items, in the style of those that are there.

use super::edits::Edits;
use super::layout::{Entry, Layout};
use std::ops::Range;

/// Adds entries, each `key: value`, on lines of their own below the last entry of a block mapping.
pub(super) fn lines(text: &str, entries: &[Entry], added: &[String], edits: &mut Edits) -> Option<()> {
    let indent = " ".repeat(column(text, entries.first()?.key.span.start));
    let place = end_of_line(text, entries.last()?.value.span.end);
    for line in added {
        edits.insert(place, format!("\n{indent}{line}"));
    }
    Some(())
}

/// Adds items on lines of their own below the last item of a block list. `None` where no dash is seen before it.
pub(super) fn items(text: &str, items: &[Layout], added: &[String], edits: &mut Edits) -> Option<()> {
    let before = text[..items.first()?.span.start].trim_end();
    let indent = " ".repeat(column(text, before.strip_suffix('-')?.len()));
    let place = end_of_line(text, items.last()?.span.end);
    for line in added {
        edits.insert(place, format!("\n{indent}- {line}"));
    }
    Some(())
}

/// Adds items, or entries, to a list or mapping in brackets: on the last one's line, or on lines of their own
/// where all begin one. `starts` are those of what there is, `last_end` is where the last ends.
pub(super) fn in_brackets(
    text: &str,
    span: &Range<usize>,
    starts: &[usize],
    last_end: Option<usize>,
    added: &[String],
    edits: &mut Edits,
) -> Option<()> {
    let Some(end) = last_end else {
        // An anchor or a tag may stand before the bracket.
        let opening = span.start + text[span.clone()].find(['{', '['])?;
        edits.insert(opening + 1, added.join(", "));
        return Some(());
    };
    let rest = &text[end..];
    let after_blanks = rest.trim_start_matches([' ', '\t']);
    let has_comma = after_blanks.starts_with(',');
    let place = if has_comma { end + rest.len() - after_blanks.len() + 1 } else { end };
    let own_lines = starts.iter().all(|&start| text[line_start(text, start)..start].trim().is_empty());
    let (gap, line_end) = if own_lines {
        let indent = &text[line_start(text, *starts.last()?)..*starts.last()?];
        (format!("\n{indent}"), end_of_line(text, place))
    } else {
        (" ".to_owned(), place)
    };
    let tail = text[place..line_end].trim();
    let only_comment = tail.is_empty() || tail.starts_with('#');
    let place_of_rest = if only_comment { line_end } else { place };
    if !has_comma {
        edits.insert(place, ",");
    }
    edits.insert(place_of_rest, format!("{gap}{}", added.join(&format!(",{gap}"))));
    Some(())
}

/// Characters between the start of the line and a place in it.
fn column(text: &str, place: usize) -> usize {
    text[line_start(text, place)..place].chars().count()
}

fn line_start(text: &str, place: usize) -> usize {
    text[..place].rfind('\n').map_or(0, |newline| newline + 1)
}

fn end_of_line(text: &str, place: usize) -> usize {
    text[place..].find('\n').map_or(text.len(), |length| place + length)
}
