//! What is said to the user: results on standard output, everything else on standard error.
//!
//! Colours are for terminals that want them: `anstream` strips them elsewhere, and under `NO_COLOR`.

use crate::error::Error;
use clap::builder::styling::{AnsiColor, Style};
use std::fmt::Display;
use std::io::{self, Write};

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const HINT: Style = AnsiColor::Green.on_default();

/// Prints a result.
///
/// # Errors
/// [`Error::ReaderGone`] where nobody reads it any more, else [`Error::Output`].
pub(crate) fn print(text: impl AsRef<[u8]>) -> Result<(), Error> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_ref()).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Error::ReaderGone,
        _ => Error::output(STDOUT, &error),
    })
}

/// How messages call standard output.
pub(crate) const STDOUT: &str = "standard output";

/// Tells why the program ends.
pub(crate) fn tell_error(error: &Error) {
    match error {
        Error::Usage { message, hint } => {
            tell("error", ERROR, message);
            match hint {
                Some(hint) => tell("hint", HINT, hint),
                None => note("For more, try `lancer --help`."),
            }
        }
        Error::Scene(error) => error.diagnostics.iter().for_each(|fault| tell("error", ERROR, fault)),
        Error::Output { to, reason } => tell("error", ERROR, format_args!("cannot write {to}: {reason}")),
        Error::Render(message) => tell("error", ERROR, message),
        Error::Interrupted => note("interrupted"),
        Error::ReaderGone | Error::Different => {}
    }
}

/// Tells something that is not right, although the work goes on.
pub(crate) fn tell_warning(message: impl Display) {
    tell("warning", WARNING, message);
}

/// Tells something worth knowing.
pub(crate) fn note(message: impl Display) {
    // There is nobody to tell that standard error is closed.
    let _ = writeln!(anstream::stderr(), "{message}");
}

fn tell(kind: &str, style: Style, message: impl Display) {
    note(format_args!("{style}{kind}:{style:#} {}", harmless(&message.to_string())));
}

/// A text in which names out of a file may stand, without what would command a terminal.
pub(crate) fn harmless(text: &str) -> String {
    text.replace(|c: char| c.is_control() && c != '\n', "\u{fffd}")
}
