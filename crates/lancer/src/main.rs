//! The program: scenes and models to pictures, from the command line.
//!
//! The words of the user are parsed in [`args`], given their meaning in [`job`], and carried out in [`commands`].
//! Results go to standard output and everything else to standard error; see [`terminal`]. What went wrong becomes
//! an exit code in [`error`], and nowhere else. No algorithm lives here.

mod args;
mod bug;
mod commands;
mod destination;
#[cfg(test)]
mod documents;
mod error;
mod interrupt;
mod job;
mod json;
mod process;
mod progress;
mod report;
mod source;
mod terminal;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = args::Args::parse();
    interrupt::install();
    match bug::caught(|| commands::run(args)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::tell_error(&error);
            ExitCode::from(&error)
        }
    }
}
