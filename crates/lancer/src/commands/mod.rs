//! What the program does, one file a subcommand.

mod check;
mod compare;
mod completions;
mod info;
mod man;
mod render;
mod scenes;
mod schema;
mod verify;
mod window;

use crate::args::{Args, Command};
use crate::error::Error;

/// Does what was asked.
///
/// # Errors
/// Why it could not be done.
pub(crate) fn run(args: Args) -> Result<(), Error> {
    match args.command {
        None => window::run(args.scene.as_deref()),
        Some(Command::Render(args)) => render::run(*args),
        Some(Command::Scenes(args)) => scenes::run(&args),
        Some(Command::Info(args)) => info::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Schema) => schema::run(),
        Some(Command::Completions(args)) => completions::run(&args),
        Some(Command::Man) => man::run(),
        Some(Command::Verify(args)) => verify::run(*args),
        Some(Command::Compare(args)) => compare::run(&args),
    }
}
