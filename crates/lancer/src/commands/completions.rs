//! `lancer completions`: what a shell offers after TAB.

use crate::args::{Args, CompletionsArgs};
use crate::error::Error;
use crate::terminal;
use clap::CommandFactory;

/// Prints the completions.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run(args: &CompletionsArgs) -> Result<(), Error> {
    // Not straight to standard output: the generator panics where it cannot write.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "lancer", &mut script);
    terminal::print(script)
}
