//! `lancer scenes`: the gallery.

use crate::args::ScenesArgs;
use crate::error::Error;
use crate::{json, terminal};
use serde::Serialize;

#[derive(Serialize)]
struct SceneJson {
    name: &'static str,
    summary: &'static str,
}

/// Prints the built-in scenes, one a line.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run(args: &ScenesArgs) -> Result<(), Error> {
    let scenes = lancer_gallery::SCENES
        .iter()
        .map(|scene| SceneJson { name: scene.name(), summary: scene.summary() })
        .collect::<Vec<_>>();
    terminal::print(if args.json { json::object(&scenes) } else { lines(&scenes) })
}

fn lines(scenes: &[SceneJson]) -> String {
    let width = scenes.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    scenes.iter().map(|SceneJson { name, summary }| format!("{name:width$}  {summary}\n")).collect()
}
