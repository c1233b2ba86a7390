//! Overrides written into the text of a scene file, which keeps every other byte.
//!
//! In: a text and overrides. Out: the text that says what the overrides mean. `layout` finds where each node
//! stands, `reconcile` compares the tree that is there with the one that shall be, `insert` knows how what is new is
//! laid out. Since a text may be laid out in more ways than these know, the result is read again and compared: a text
//! that would say something else is never given out.

mod edits;
mod insert;
mod layout;
mod reconcile;

use super::deserialize;
use super::model::SceneFile;
use super::overrides::{self, Override};
use super::report::Report;
use super::syntax::{self, Language, Node, Origin, RawOffsets, same_tree};
use super::tree;
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use serde::de::IgnoredAny;
use std::path::Path;
use std::rc::Rc;

/// Makes overrides lasting: the text of a scene file with the values changed, and every other byte as it was.
///
/// Comments, order, quotes, anchors, indentation and the ends of lines stay; keys that are missing are added in the
/// style of their neighbours. An alias of something that changes is written out, so that it still means what it
/// did. JSON stays JSON. `path` is what the file is called in messages.
///
/// ```
/// use lancer_io::scene_file::patch;
/// let text = "format: 1\ncamera: {fov: 40} # wide\nobjects: [{shape: cube}]\n";
/// let patched = patch("scene.yaml".as_ref(), text, &["camera.fov=30".parse()?, "ambient=0.5".parse()?])?;
/// assert_eq!(patched, "format: 1\ncamera: {fov: 30} # wide\nobjects: [{shape: cube}]\nambient: 0.5\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// All that is wrong with the text and with the overrides, or that the text leaves no place for them.
pub fn patch(path: &Path, text: &str, changes: &[Override]) -> Result<String, LoadError> {
    let limits = Limits::default();
    let plain = syntax::decode(text.as_bytes())
        .map_err(|problem| Report::of_file(path, text, changes, &limits).error(vec![problem]))?;
    let report = Report::of_file(path, &plain, changes, &limits);
    let (old, mut problems) = tree(&plain, &[], &limits).map_err(|problems| report.error(problems))?;
    let mut new = Rc::clone(&old);
    problems.extend(overrides::apply(&mut new, changes, &limits));
    problems.extend(deserialize::read::<SceneFile>(&new, report.most).1);
    if !problems.is_empty() {
        return Err(report.error(problems));
    }
    let patched = edited(text, &plain, &old, &new);
    patched.filter(|patched| says(patched, &new) && (!is_json(text) || is_json(patched))).ok_or_else(|| {
        Diagnostic::new(path, "the changes find no place in the text as it is laid out")
            .with_hint("change it by hand, or save the scene as another file")
            .into()
    })
}

/// The text that says `new`, if one is found.
fn edited(text: &str, plain: &str, old: &Rc<Node>, new: &Rc<Node>) -> Option<String> {
    let layout = layout::layout(plain)?;
    let language = if looks_like_json(plain) { Language::Json } else { Language::Yaml };
    let edits = reconcile::reconcile(plain, &layout, old, new, language)?;
    let offsets = RawOffsets::of(text, plain);
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    edits.apply(text, |place| offsets.get(place), line_end)
}

/// Whether keys stand in quotes, so that others should.
fn looks_like_json(plain: &str) -> bool {
    plain.trim_start().strip_prefix('{').is_some_and(|rest| rest.trim_start().starts_with('"'))
}

fn is_json(text: &str) -> bool {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    serde_json::from_str::<IgnoredAny>(text).is_ok()
}

/// Whether a text has this tree.
fn says(text: &str, expected: &Node) -> bool {
    let Ok(plain) = syntax::decode(text.as_bytes()) else { return false };
    let parsed = syntax::parse(&plain, Origin::File, &Limits::default());
    let Some(found) = parsed.ok().filter(|parsed| parsed.problems.is_empty()).and_then(|parsed| parsed.root)
    else {
        return false;
    };
    same_tree(&found, expected)
}
