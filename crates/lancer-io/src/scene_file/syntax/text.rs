//! Bytes to text that the YAML parser takes.

use super::{Origin, Place, Problem};
use std::borrow::Cow;

/// The text of a file: UTF-8 without a byte order mark, lines ended by line feeds.
///
/// # Errors
/// The place of the first byte that is not UTF-8.
pub(crate) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, Problem> {
    let text = std::str::from_utf8(bytes).map_err(|error| not_utf8(bytes, error.valid_up_to()))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let text = line_feeds(text);
    Ok(if text.trim_start().starts_with('{') { join_surrogates(text) } else { text })
}

fn not_utf8(bytes: &[u8], offset: usize) -> Problem {
    let before = String::from_utf8_lossy(&bytes[..offset]);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
    let place = place_at(line, column);
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Problem::new(place, "the file is UTF-16, must be UTF-8").with_hint("save it as UTF-8");
    }
    Problem::new(place, format!("the byte 0x{:02x} is not UTF-8 text", bytes[offset]))
        .with_hint("a scene file is text: YAML or JSON, saved as UTF-8")
}

fn place_at(line: usize, column: usize) -> Place {
    let narrow = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Place { origin: Origin::File, line: narrow(line), column: narrow(column) }
}

/// YAML knows three ends of a line; told lines are split at line feeds, so that all must be these.
fn line_feeds(text: &str) -> Cow<'_, str> {
    if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n").into() } else { text.into() }
}

/// Writes the pairs of UTF-16 escapes by which JSON names a character beyond U+FFFF as the one escape that YAML
/// has for it. Columns later in such a line are two less than they were.
fn join_surrogates(text: Cow<'_, str>) -> Cow<'_, str> {
    if !text.contains("\\u") {
        return text;
    }
    let mut joined = String::with_capacity(text.len());
    let mut rest = &*text;
    while let Some(start) = rest.find('\\') {
        joined.push_str(&rest[..start]);
        rest = &rest[start..];
        let taken = match surrogate_pair(rest) {
            Some(character) => {
                joined.push_str(&format!("\\U{:08x}", u32::from(character)));
                SURROGATE_PAIR_BYTES
            }
            None => {
                // The escaped character goes along, so that an escaped backslash escapes nothing.
                let taken = 1 + rest[1..].chars().next().map_or(0, char::len_utf8);
                joined.push_str(&rest[..taken]);
                taken
            }
        };
        rest = &rest[taken..];
    }
    joined.push_str(rest);
    joined.into()
}

const SURROGATE_PAIR_BYTES: usize = r"\ud83d\ude00".len();

fn surrogate_pair(text: &str) -> Option<char> {
    let unit = |start: usize| {
        let digits = text.get(start..start + 6)?.strip_prefix("\\u")?;
        u16::from_str_radix(digits, 16).ok()
    };
    char::decode_utf16([unit(0)?, unit(6)?]).next()?.ok().filter(|character| character.len_utf16() == 2)
}

/// Where in the text of a file the bytes of its decoded text stand.
pub(crate) struct RawOffsets {
    /// Where the distance between the two changes: places in the decoded text and in the file's, in order.
    steps: Vec<(usize, usize)>,
}

impl RawOffsets {
    /// For a text and what [`decode`] made of it.
    pub(crate) fn of(raw: &str, decoded: &str) -> Self {
        let start = raw.len() - raw.strip_prefix('\u{feff}').unwrap_or(raw).len();
        let mut steps = vec![(0, start)];
        let (mut at, mut raw_at) = (0, start);
        let (raw, decoded) = (raw.as_bytes(), decoded.as_bytes());
        while at < decoded.len() {
            let (taken, raw_taken) = if raw[raw_at..].starts_with(b"\r\n") {
                (1, 2)
            } else if raw[raw_at..].starts_with(b"\\u") && decoded[at..].starts_with(b"\\U") {
                (CHARACTER_BYTES, SURROGATE_PAIR_BYTES)
            } else {
                (1, 1)
            };
            at += taken;
            raw_at += raw_taken;
            if taken != raw_taken {
                steps.push((at, raw_at));
            }
        }
        Self { steps }
    }

    /// The place in the file's text of a place in the decoded one.
    pub(crate) fn get(&self, place: usize) -> usize {
        let after = self.steps.partition_point(|&(decoded, _)| decoded <= place);
        let (decoded, raw) = self.steps[after - 1];
        raw + (place - decoded)
    }
}

/// Of the escape that [`join_surrogates`] writes.
const CHARACTER_BYTES: usize = r"\U0001f600".len();

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_and_line_ends_are_made_plain() {
        assert_eq!(decode("\u{feff}a: 1\r\nb: 2\rc: 3\n".as_bytes()).unwrap(), "a: 1\nb: 2\nc: 3\n");
    }

    #[test]
    fn decoded_places_are_found_in_the_file() {
        let raw = "\u{feff}{\"a\": \"\\ud83d\\ude00\",\r\n\"b\": 1,\r\"c\": 2}";
        let decoded = decode(raw.as_bytes()).unwrap();
        let offsets = RawOffsets::of(raw, &decoded);
        for key in ["{", "\"b\"", "\"c\"", "1", "2}"] {
            assert_eq!(offsets.get(decoded.find(key).unwrap()), raw.find(key).unwrap(), "{key}");
        }
        assert_eq!(
            offsets.get(decoded.find('\n').unwrap()),
            raw.find('\r').unwrap(),
            "before both of its bytes"
        );
        assert_eq!(offsets.get(decoded.len()), raw.len());
    }

    #[test]
    fn a_byte_that_is_no_text_is_located() {
        let problem = decode(b"a: 1\nb: \xff\n").unwrap_err();
        assert_eq!((problem.place.line, problem.place.column), (2, 4));
        assert!(decode(b"\xff\xfea\0").unwrap_err().message.contains("UTF-16"));
    }

    #[test]
    fn surrogate_pairs_of_json_become_one_escape() {
        assert_eq!(decode(br#"{"a": "\ud83d\ude00!"}"#).unwrap(), r#"{"a": "\U0001f600!"}"#);
        for left_alone in
            [r#"{"a": "\\ud83d\\ude00"}"#, r#"{"a": "\u00e9\ud83d"}"#, r#"{"a": "\ud83d\u0041"}"#, r"{\"]
        {
            assert_eq!(decode(left_alone.as_bytes()).unwrap(), left_alone);
        }
    }
}
