//! Scene files: YAML 1.2, and JSON as a part of it, to scenes.
//!
//! In: the text of a file, and overrides of what it says. Out: a [`Scene`](lancer_core::scene::Scene), or all that
//! is wrong with the file. A file goes through
//!
//! 1. `syntax`: text to a tree of nodes with places, which the `overrides` edit;
//! 2. `deserialize`: the tree to the types of `model`, once for every fault, so that all are found;
//! 3. `build`: names looked up, models and images fetched through [`Assets`].
//!
//! The JSON Schema is made from the same `model`. No other module knows YAML.

mod apply;
mod assets;
mod build;
mod changes;
mod deserialize;
mod export;
mod model;
mod origins;
mod overrides;
mod patch;
mod report;
mod schema;
mod syntax;
mod write;

pub use apply::apply_overrides;
pub use assets::{Assets, Model};
pub use changes::{Changes, Unsaved, changes};
pub use origins::Origins;
pub use overrides::{Override, OverrideError};
pub use patch::patch;
pub use schema::json_schema;
pub use write::write_whole;

use crate::Loaded;
use crate::diagnostics::LoadError;
use crate::limits::Limits;
use model::{FORMAT, SceneFile};
use report::Report;
use std::path::Path;
use std::rc::Rc;
use syntax::{Node, Origin, Parsed, Place, Problem};

/// Reads a scene file.
///
/// `path` is what the file is called in messages, and where its references start from; `bytes` is what is in it.
///
/// # Errors
/// All that is wrong with the file, its overrides and what it refers to, in the order of their places.
pub fn read(
    path: &Path,
    bytes: &[u8],
    overrides: &[Override],
    assets: &mut dyn Assets,
    limits: &Limits,
) -> Result<Loaded, LoadError> {
    let text = match syntax::decode(bytes) {
        Ok(text) => text,
        Err(problem) => {
            let shown = String::from_utf8_lossy(bytes);
            return Err(Report::of_file(path, &shown, overrides, limits).error(vec![problem]));
        }
    };
    let report = Report::of_file(path, &text, overrides, limits);
    let failed = |problems| report.error(problems);
    let (root, mut problems) = tree(&text, overrides, limits).map_err(failed)?;
    let (file, unread) = deserialize::read::<SceneFile>(&root, report.most);
    problems.extend(unread);
    let Some(file) = file else { return Err(failed(problems)) };
    problems.extend(missing_format(&file, &root));
    let built = build::build(&file, &root, path, assets, problems);
    if !built.problems.is_empty() {
        return Err(failed(built.problems));
    }
    let origins = Origins::of(&file, &built.scene);
    Ok(Loaded { scene: built.scene, warnings: report.warnings(built.warnings), origins })
}

/// The edited tree of a file, and the problems that left one.
fn tree(
    text: &str,
    overrides: &[Override],
    limits: &Limits,
) -> Result<(Rc<Node>, Vec<Problem>), Vec<Problem>> {
    let Parsed { root, mut problems } = syntax::parse(text, Origin::File, limits)?;
    let Some(mut root) = root else {
        let empty = Problem::new(Place::start_of(Origin::File), "the file is empty");
        return Err(vec![empty.with_hint("a scene file begins with `format: 1`")]);
    };
    problems.extend(overrides::apply(&mut root, overrides, limits));
    Ok((root, problems))
}

fn missing_format(file: &SceneFile, root: &Node) -> Option<Problem> {
    let is_missing = file.format.is_none() && root.get("format").is_none();
    is_missing.then(|| {
        Problem::new(root.place, "`format` is missing")
            .with_hint(format!("write `format: {FORMAT}` at the top of the file"))
    })
}
