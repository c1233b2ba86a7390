//! `lancer [SCENE]`: the window.

use crate::args::Args;
use crate::error::Error;
use crate::source::{self, Source};
use clap::CommandFactory;
use std::ffi::OsStr;

/// Shows the scene, until the user has seen enough.
///
/// A scene that cannot be read is told of in the window; only one that is not there ends the program.
///
/// # Errors
/// There is no window here, and what to do without is said. Or else: SCENE is nothing, perhaps a subcommand with a
/// wrong letter.
pub(crate) fn run(scene: Option<&OsStr>) -> Result<(), Error> {
    let source = Source::find(scene);
    let source = source.map_err(|error| scene.and_then(mistyped_command).unwrap_or(error))?;
    let hint = format!("to render without one: lancer render {source} --output picture.png");
    open(source).map_err(|why| Error::usage_with_hint(why, hint))
}

/// Runs the window; or says why there is none.
#[cfg(feature = "window")]
fn open(source: Source) -> Result<(), String> {
    if !has_display() {
        return Err("there is no display to open the window on".into());
    }
    let load = lancer_io::LoadOptions::default();
    let options = lancer_view::Options { source: source.into(), load };
    lancer_view::run(options).map_err(|error| error.to_string())
}

#[cfg(not(feature = "window"))]
fn open(_: Source) -> Result<(), String> {
    Err("this lancer was built without its window".into())
}

/// Whether the system has something to show windows on, as far as its variables tell. Where a display is named but
/// not there, the window says so itself.
#[cfg(feature = "window")]
fn has_display() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos")))
        || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(is_set)
}

#[cfg(feature = "window")]
impl From<Source> for lancer_view::Source {
    fn from(source: Source) -> Self {
        match source {
            Source::Builtin(builtin) => Self::Builtin(builtin),
            Source::File(path) => Self::File(path),
        }
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
