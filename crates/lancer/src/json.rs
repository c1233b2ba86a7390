//! JSON as the program prints it.

use lancer_io::diagnostics::Diagnostic;
use serde::Serialize;
use std::path::Path;

/// A value as indented text with a line end.
pub(crate) fn object(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("the program's JSON has only text for keys");
    text.push('\n');
    text
}

/// A warning for programs.
#[derive(Serialize)]
pub(crate) struct DiagnosticJson<'a> {
    #[serde(serialize_with = "lossy")]
    file: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<usize>,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    hint: Option<&'a str>,
}

impl<'a> From<&'a Diagnostic> for DiagnosticJson<'a> {
    fn from(diagnostic: &'a Diagnostic) -> Self {
        Self {
            file: &diagnostic.file,
            line: diagnostic.location.map(|location| location.line),
            column: diagnostic.location.map(|location| location.column),
            message: &diagnostic.message,
            hint: diagnostic.hint.as_deref(),
        }
    }
}

/// A path as text, even where it is no Unicode: JSON has nothing else.
fn lossy<S: serde::Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}
