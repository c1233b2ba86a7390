//! `lancer [SCENE]`: the window, which this version does not have.

use crate::args::Args;
use crate::error::Error;
use crate::source::{self, Source};
use clap::CommandFactory;
use std::ffi::OsStr;

/// Says how to do without.
///
/// # Errors
/// Always: there is no window. Or else: SCENE is nothing, perhaps a subcommand with a wrong letter.
pub(crate) fn run(scene: Option<&OsStr>) -> Result<(), Error> {
    match Source::find(scene) {
        Ok(source) => Err(Error::usage_with_hint(
            "this version of lancer has no window",
            format!("to render without one: lancer render {source} --output picture.png"),
        )),
        Err(error) => Err(scene.and_then(mistyped_command).unwrap_or(error)),
    }
}

fn mistyped_command(typed: &OsStr) -> Option<Error> {
    let typed = typed.to_str()?;
    let program = Args::command();
    let mut commands = program.get_subcommands().map(clap::Command::get_name);
    let meant = commands.find(|command| source::are_alike(typed, command))?;
    let message = format!("there is neither a command nor a scene `{typed}`");
    Some(Error::usage_with_hint(message, format!("did you mean `lancer {meant}`?")))
}
