//! What is wrong with a file, told to a person: where, what, and what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// A place in a text file; both counts start at 1, the column counts characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

/// One error or warning.
///
/// Displayed as `scene.yaml:12:8: radius is -1, must be positive`, then the line with a mark under the place,
/// then `hint: ...`; each part only where it is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file that is at fault.
    pub file: PathBuf,
    /// Where in it.
    pub location: Option<Location>,
    /// What is wrong, in words without a full stop.
    pub message: String,
    /// The text of the line, if it is to be shown.
    pub source_line: Option<String>,
    /// What may have been meant, or what to do.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// A diagnostic of a file as a whole.
    pub fn new(file: impl Into<PathBuf>, message: impl Into<String>) -> Self {
        Self { file: file.into(), location: None, message: message.into(), source_line: None, hint: None }
    }

    /// The diagnostic at a place.
    #[must_use]
    pub fn at(mut self, line: usize, column: usize) -> Self {
        self.location = Some(Location { line, column });
        self
    }

    /// The diagnostic with the line of `text` that it speaks of, unless that line is absurdly long.
    #[must_use]
    pub fn showing(mut self, text: &str) -> Self {
        self.source_line = self
            .location
            .and_then(|location| text.lines().nth(location.line.checked_sub(1)?))
            .filter(|line| line.len() <= LONGEST_LINE_KEPT)
            .map(str::to_owned);
        self
    }

    /// The diagnostic with advice.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The line with its number, and below it a mark under the place, for a font whose letters are equally wide.
    pub fn excerpt(&self) -> Option<String> {
        let (source, Location { line, column }) = (self.source_line.as_ref()?, self.location?);
        let (shown, mark) = excerpt(source, column);
        let gutter = line.to_string().len();
        Some(format!("{line} | {shown}\n{:gutter$} | {:>mark$}", "", "^"))
    }
}

/// Longest line that a diagnostic keeps, in bytes: enough for a scene that a program wrote on one line, and small
/// enough that a list of errors in a hostile one takes no memory to speak of.
const LONGEST_LINE_KEPT: usize = 1 << 20;

/// Longest part of a source line that is shown, in characters: a terminal's width or so.
const SHOWN_CHARACTERS: usize = 100;

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(Location { line, column }) = self.location {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", self.message)?;
        for line in self.excerpt().iter().flat_map(|excerpt| excerpt.lines()) {
            write!(f, "\n  {line}")?;
        }
        if let Some(hint) = &self.hint {
            write!(f, "\nhint: {hint}")?;
        }
        Ok(())
    }
}

/// The part of a line around a column, with control characters made harmless, and the column in it.
fn excerpt(line: &str, column: usize) -> (String, usize) {
    let start = column.saturating_sub(SHOWN_CHARACTERS / 2 + 1);
    let start = if column <= SHOWN_CHARACTERS { 0 } else { start };
    let shown = line
        .chars()
        .skip(start)
        .take(SHOWN_CHARACTERS)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect::<String>();
    (shown.trim_end().to_owned(), (column - start).max(1))
}

/// A hint for a name that is none of those known: the one that it is a misspelling of, or else what there is.
///
/// ```
/// use lancer_io::diagnostics::name_hint;
/// assert_eq!(name_hint("sphrere", ["cube", "sphere"]).unwrap(), "did you mean `sphere`?");
/// assert_eq!(name_hint("torus", ["cube", "sphere"]).unwrap(), "there are `cube`, `sphere`");
/// ```
pub fn name_hint<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Option<String> {
    if let Some(meant) = most_similar(name, known.clone()) {
        return Some(format!("did you mean `{meant}`?"));
    }
    let mut known = known.into_iter();
    let mut listed = known.by_ref().take(NAMES_LISTED).map(|name| format!("`{name}`")).collect::<Vec<_>>();
    if known.next().is_some() {
        listed.push("...".into());
    }
    match listed.as_slice() {
        [] => None,
        [one] => Some(format!("there is only {one}")),
        _ => Some(format!("there are {}", listed.join(", "))),
    }
}

/// The known name that `name` may be a misspelling of.
pub fn most_similar<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    let length = name.chars().count();
    if length > LONGEST_NAME_COMPARED {
        return None;
    }
    let most_edits = (length / LETTERS_PER_EDIT).max(1);
    known
        .into_iter()
        .filter(|known| known.len() <= 2 * LONGEST_NAME_COMPARED)
        .map(|known| (strsim::damerau_levenshtein(&name, &known.to_lowercase()), known))
        .filter(|&(edits, known)| edits <= most_edits && edits < known.chars().count())
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, known)| known)
}

/// Names that a hint lists: a terminal's line or two.
const NAMES_LISTED: usize = 12;

/// Longest name that is compared with others, in characters: the comparison's time grows with its square.
const LONGEST_NAME_COMPARED: usize = 64;

/// One slip is forgiven for this many letters of a name. With fewer, hints turn into guesses; with more, a
/// swapped or missing letter in a short name goes without one. Untuned.
const LETTERS_PER_EDIT: usize = 3;

/// Why a file could not be loaded: all of its errors, in the order of their places. Never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The errors.
    pub diagnostics: Vec<Diagnostic>,
}

impl LoadError {
    /// An error of a file as a whole.
    pub fn new(file: &Path, message: impl Into<String>) -> Self {
        Diagnostic::new(file, message).into()
    }
}

impl From<Diagnostic> for LoadError {
    fn from(diagnostic: Diagnostic) -> Self {
        Self { diagnostics: vec![diagnostic] }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for LoadError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnostic_shows_the_place_the_line_and_the_hint() {
        let text = "a: 1\nradius: -1\n";
        let shown = Diagnostic::new("scene.yaml", "radius is -1, must be positive")
            .at(2, 9)
            .showing(text)
            .with_hint("use 1")
            .to_string();
        assert_eq!(
            shown,
            "scene.yaml:2:9: radius is -1, must be positive\n  2 | radius: -1\n    |         ^\nhint: use 1"
        );
    }

    #[test]
    fn misspellings_are_recognised_and_other_names_are_not() {
        let known = ["color", "shininess", "ior"];
        assert_eq!(most_similar("colour", known), Some("color"));
        assert_eq!(most_similar("Shinyness", known), Some("shininess"));
        assert_eq!(most_similar("iro", known), Some("ior"));
        assert_eq!(most_similar("roughness", known), None);
        assert_eq!(most_similar("x", ["y"]), None, "a name of one letter is nothing but itself");
        assert_eq!(name_hint("x", []), None);
        assert_eq!(name_hint("x", ["lamp"]).unwrap(), "there is only `lamp`");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let text = format!("{}x{}", "-".repeat(5000), "-".repeat(5000));
        let shown = Diagnostic::new("f", "m").at(1, 5001).showing(&text).to_string();
        let lines = shown.lines().collect::<Vec<_>>();
        assert!(lines[1].len() < 120);
        assert_eq!(lines[1].find('x'), lines[2].find('^'));
    }
}
