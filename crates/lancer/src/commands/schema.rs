//! `lancer schema`: the JSON Schema of scene files.

use crate::error::Error;
use crate::terminal;

/// Prints the schema.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run() -> Result<(), Error> {
    terminal::print(format!("{}\n", lancer_io::scene_file::json_schema().trim_end()))
}
