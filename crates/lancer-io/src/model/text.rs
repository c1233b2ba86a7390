//! Text model files as bytes: lines, words, numbers, and the places of errors.
//!
//! Bytes, since these files are of no declared encoding and their numbers are ASCII in all of them; and since
//! a model has millions of words, nothing is allocated for one. It knows no keyword of any format.

use crate::diagnostics::Diagnostic;
use std::borrow::Cow;
use std::path::Path;

/// A file's text and its name.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) bytes: &'a [u8],
}

impl Source<'_> {
    /// A diagnostic of the byte at `offset`, which shows its line.
    ///
    /// It counts lines from the beginning, so it is for errors, not for every line.
    pub(super) fn diagnostic(&self, offset: usize, message: impl Into<String>) -> Diagnostic {
        let before = &self.bytes[..offset.min(self.bytes.len())];
        let start = before.iter().rposition(|&byte| is_newline(byte)).map_or(0, |newline| newline + 1);
        let line = lines_ended_in(&before[..start]) + 1;
        let column = decode(&before[start..]).chars().count() + 1;
        let rest = &self.bytes[start..];
        let end = rest.iter().position(|&byte| is_newline(byte)).unwrap_or(rest.len());
        let mut diagnostic = Diagnostic::new(self.path, message).at(line, column);
        diagnostic.source_line = (end <= LONGEST_LINE_KEPT).then(|| decode(&rest[..end]).into_owned());
        diagnostic
    }
}

/// Longest line that a diagnostic keeps, in bytes: longer than any that a person wrote, and short enough that
/// the errors of a hostile file take no memory to speak of.
const LONGEST_LINE_KEPT: usize = 1 << 16;

/// Newlines in `bytes`: `\n`, `\r\n` and `\r`, as files of different systems end their lines.
fn lines_ended_in(bytes: &[u8]) -> usize {
    let lone_return = |(i, &byte): (usize, &u8)| byte == b'\r' && bytes.get(i + 1) != Some(&b'\n');
    bytes.iter().filter(|&&byte| byte == b'\n').count()
        + bytes.iter().enumerate().filter(|&pair| lone_return(pair)).count()
}

/// Text of unknown encoding: UTF-8 if it is that, else Latin-1, in which every byte is a character.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Text to be quoted in a message: what is far longer than a person writes is cut off.
pub(super) fn quoted(bytes: &[u8]) -> Cow<'_, str> {
    const LONGEST: usize = 80;
    match bytes.get(..LONGEST) {
        Some(start) if bytes.len() > LONGEST => format!("{}...", String::from_utf8_lossy(start)).into(),
        _ => decode(bytes),
    }
}

/// Bytes between blanks, and where they stand in the file.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) offset: usize,
}

impl Word<'_> {
    /// The number that is written here, in any locale's program with a decimal point; `None` for anything
    /// else, for NaN, and for what no `f64` can hold.
    pub(super) fn number(&self) -> Option<f64> {
        let number = std::str::from_utf8(self.bytes).ok()?.parse::<f64>().ok()?;
        number.is_finite().then_some(number)
    }
}

/// The error that a word is no number that single precision can hold.
pub(super) fn not_a_number(source: Source, word: Word) -> Diagnostic {
    let text = quoted(word.bytes);
    let error = source.diagnostic(word.offset, format!("`{text}` is not a finite number"));
    let is_with_comma =
        text.contains(',') && Word { bytes: text.replace(',', ".").as_bytes(), ..word }.number().is_some();
    if is_with_comma {
        error.with_hint("numbers are written with a decimal point, in every language")
    } else {
        error
    }
}

/// Reads words, line by line.
///
/// A line may be continued by `\` at its end. A word that begins with `#` begins a comment.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// A cursor at an offset.
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// Where the cursor stands.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// The first word of the next line that has one.
    pub(super) fn first_word(&mut self) -> Option<Word<'a>> {
        while self.at < self.bytes.len() {
            if let Some(word) = self.word() {
                return Some(word);
            }
            self.skip_line();
        }
        None
    }

    /// The next word of the line.
    pub(super) fn word(&mut self) -> Option<Word<'a>> {
        self.skip_blanks();
        let start = self.at;
        if self.bytes.get(start) == Some(&b'#') {
            return None;
        }
        let length = self.bytes[start..].iter().position(|&byte| is_separator(byte));
        let mut end = length.map_or(self.bytes.len(), |length| start + length);
        if end > start && self.bytes[end - 1] == b'\\' && self.newline_at(end) > 0 {
            end -= 1;
        }
        self.at = end;
        (end > start).then(|| Word { bytes: &self.bytes[start..end], offset: start })
    }

    /// The rest of the line without the blanks around it: a name, which may hold blanks and `#`.
    pub(super) fn rest_of_line(&mut self) -> Word<'a> {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&byte| is_newline(byte)).unwrap_or(rest.len());
        let blanks = rest[..end].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let word = Word { bytes: rest[..end].trim_ascii(), offset: self.at + blanks };
        self.at += end;
        word
    }

    /// Moves past the end of the line, and of the lines that continue it.
    pub(super) fn skip_line(&mut self) {
        while self.word().is_some() {}
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&byte| is_newline(byte)).unwrap_or(rest.len());
        self.at += self.newline_at(self.at);
    }

    fn skip_blanks(&mut self) {
        loop {
            match self.bytes.get(self.at) {
                Some(b' ' | b'\t' | b'\x0b' | b'\x0c') => self.at += 1,
                Some(b'\\') if self.newline_at(self.at + 1) > 0 => {
                    self.at += 1 + self.newline_at(self.at + 1);
                }
                _ => return,
            }
        }
    }

    /// The length of the newline that begins at an offset; 0 where none does.
    fn newline_at(&self, offset: usize) -> usize {
        match self.bytes.get(offset..) {
            Some([b'\r', b'\n', ..]) => 2,
            Some([b'\r' | b'\n', ..]) => 1,
            _ => 0,
        }
    }
}

fn is_newline(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

fn is_separator(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | b'\x0b' | b'\x0c')
}

/// A name as models keep it: no longer than a person writes, since what a file says once a model may hold for each of
/// a million parts.
pub(super) fn kept_name(name: &str) -> String {
    name.chars().take(LONGEST_NAME_KEPT).collect()
}

/// The longest name of a part or a material, in characters.
const LONGEST_NAME_KEPT: usize = 255;

/// A name in the file, and where.
pub(super) struct Reference {
    pub(super) name: String,
    pub(super) offset: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<Vec<&str>> {
        let mut cursor = Cursor::new(text.as_bytes(), 0);
        let mut lines = Vec::new();
        while let Some(first) = cursor.first_word() {
            let mut line = vec![std::str::from_utf8(first.bytes).unwrap()];
            while let Some(word) = cursor.word() {
                line.push(std::str::from_utf8(word.bytes).unwrap());
            }
            lines.push(line);
            cursor.skip_line();
        }
        lines
    }

    #[test]
    fn lines_end_as_on_any_system() {
        assert_eq!(words("a b\nc\r\n\r\nd\re"), [vec!["a", "b"], vec!["c"], vec!["d"], vec!["e"]]);
    }

    #[test]
    fn a_backslash_continues_a_line_and_a_comment_does_not() {
        assert_eq!(words("a \\\nb\\\r\nc\n# x \\\nd"), [vec!["a", "b", "c"], vec!["d"]]);
        assert_eq!(words("a # b\n\tc\\d \\"), [vec!["a"], vec!["c\\d", "\\"]]);
    }

    #[test]
    fn names_keep_blanks_and_hashes() {
        let mut cursor = Cursor::new(b"usemtl  Material #25 \r\nnext", 0);
        cursor.first_word();
        let name = cursor.rest_of_line();
        assert_eq!((name.bytes, name.offset), (&b"Material #25"[..], 8));
    }

    #[test]
    fn places_count_lines_and_characters() {
        let source = Source { path: Path::new("f"), bytes: "a\r\nb\r\u{e9}\u{e9} x\n".as_bytes() };
        let at = source.diagnostic(9 + 1, "m");
        assert_eq!(at.to_string(), "f:3:4: m\n  3 | éé x\n    |    ^");
        let latin1 = Source { path: Path::new("f"), bytes: b"\xe9\xe9 x" };
        assert_eq!(latin1.diagnostic(3, "m").to_string(), "f:1:4: m\n  1 | éé x\n    |    ^");
    }

    #[test]
    fn quotations_are_short() {
        assert_eq!(quoted(&[b'x'; 80]), "x".repeat(80));
        assert_eq!(quoted(&[b'x'; 1 << 20]), "x".repeat(80) + "...");
    }

    #[test]
    fn only_finite_decimal_numbers_are_numbers() {
        let number = |text: &str| Word { bytes: text.as_bytes(), offset: 0 }.number();
        assert_eq!(number("-1.5e2"), Some(-150.0));
        assert_eq!(number("+.5"), Some(0.5));
        for junk in ["nan", "inf", "1e999", "1,5", "0x10", "", "1.#QNAN", "1_000"] {
            assert_eq!(number(junk), None, "{junk}");
        }
    }
}
