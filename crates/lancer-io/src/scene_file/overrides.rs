//! `--set PATH=VALUE`: edits of a document before it is read.

use super::syntax::{Entry, Node, Origin, Parsed, Place, Problem, Scalar, Value, parse};
use crate::diagnostics::name_hint;
use crate::limits::Limits;
use std::fmt;
use std::rc::Rc;
use std::str::FromStr;

/// A value to put in the place of what a scene file says, as in `materials.glass.ior=1.3`.
///
/// The path goes from key to key, and in lists by index, counted from 0, or by the `name` of an item. The value is
/// YAML. Keys that are missing are made.
///
/// ```
/// use lancer_io::scene_file::Override;
/// let brighter: Override = "lights.0.intensity=[200, 200, 150]".parse()?;
/// assert_eq!(brighter.to_string(), "--set lights.0.intensity=[200, 200, 150]");
/// assert!("lights".parse::<Override>().is_err());
/// # Ok::<(), lancer_io::scene_file::OverrideError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    path: Vec<String>,
    value: String,
}

/// A text that is no override.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("must be PATH=VALUE, as in materials.glass.ior=1.3")]
pub struct OverrideError;

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        let (path, value) = text.split_once('=').ok_or(OverrideError)?;
        let path = path.split('.').map(|key| key.trim().to_owned()).collect::<Vec<_>>();
        if path.iter().any(String::is_empty) {
            return Err(OverrideError);
        }
        Ok(Self { path, value: value.trim().to_owned() })
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--set {}={}", self.path.join("."), self.value)
    }
}

impl Override {
    /// An override by its parts: keys, and items by their indices; `value` is YAML.
    pub(crate) fn new(path: Vec<String>, value: String) -> Self {
        Self { path, value }
    }

    /// The first key of the path.
    pub(crate) fn section(&self) -> &str {
        &self.path[0]
    }
}

/// Edits a document by all of the overrides, in their order; a later one sees what an earlier one did.
pub(crate) fn apply(root: &mut Rc<Node>, overrides: &[Override], limits: &Limits) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (index, edit) in (0..).zip(overrides) {
        let origin = Origin::Override(index);
        match parse_value(&edit.value, origin, limits) {
            Err(found) => problems.extend(found),
            Ok(value) => problems.extend(put(root, &edit.path, value, Place::start_of(origin)).err()),
        }
    }
    problems
}

fn parse_value(text: &str, origin: Origin, limits: &Limits) -> Result<Rc<Node>, Vec<Problem>> {
    let scalar = |scalar| Rc::new(Node::new(Place::start_of(origin), Value::Scalar(scalar)));
    // In YAML a comment; here nobody writes one, and everybody colours.
    if text.starts_with('#') {
        return Ok(scalar(Scalar::text(text)));
    }
    let Parsed { root, problems } = parse(text, origin, limits)?;
    if problems.is_empty() { Ok(root.unwrap_or_else(|| scalar(Scalar::Null))) } else { Err(problems) }
}

/// Puts a value at the end of a path.
fn put(root: &mut Rc<Node>, path: &[String], value: Rc<Node>, place: Place) -> Result<(), Problem> {
    let mut node = root;
    let mut walked = 0;
    while walked < path.len() {
        let (done, rest) = path.split_at(walked);
        // Parts the node from its aliases, which the author of the override does not mean.
        let current = Rc::make_mut(node);
        if matches!(current.value, Value::Scalar(Scalar::Null)) {
            *current = Node::new(place, Value::Mapping(Vec::new()));
        }
        let (child, taken) = match &mut current.value {
            Value::Mapping(entries) => in_mapping(entries, rest, place),
            Value::Sequence(items) => (in_list(items, done, &rest[0], place)?, 1),
            Value::Scalar(_) => {
                let message =
                    format!("`{}` is a single value, in which there is no `{}`", done.join("."), rest[0]);
                return Err(Problem::new(place, message));
            }
        };
        node = child;
        walked += taken;
    }
    *node = value;
    Ok(())
}

/// The value of the key that the path names, and how many of its parts that takes: names of materials may hold
/// points. The longest key that is there wins; where none is, one is made of the next part.
fn in_mapping<'a>(entries: &'a mut Vec<Entry>, path: &[String], place: Place) -> (&'a mut Rc<Node>, usize) {
    let found = (1..=path.len()).rev().find_map(|taken| {
        let key = path[..taken].join(".");
        entries.iter().position(|entry| *entry.key == *key).map(|index| (index, taken))
    });
    let (index, taken) = found.unwrap_or_else(|| {
        let nothing = Rc::new(Node::new(place, Value::Scalar(Scalar::Null)));
        entries.push(Entry { key: path[0].as_str().into(), key_place: place, value: nothing });
        (entries.len() - 1, 1)
    });
    (&mut entries[index].value, taken)
}

/// The item of a list by its index or its name.
fn in_list<'a>(
    items: &'a mut [Rc<Node>],
    walked: &[String],
    part: &str,
    place: Place,
) -> Result<&'a mut Rc<Node>, Problem> {
    let found = match part.parse::<usize>() {
        Ok(index) => Some(index).filter(|&index| index < items.len()),
        Err(_) => items.iter().position(|item| name_of(item) == Some(part)),
    };
    match found {
        Some(index) => Ok(&mut items[index]),
        None => Err(no_such_item(items, walked, part, place)),
    }
}

fn no_such_item(items: &[Rc<Node>], walked: &[String], part: &str, place: Place) -> Problem {
    let count = match items.len() {
        0 => "no items".into(),
        1 => "one item, 0".into(),
        length => format!("the items 0 to {}", length - 1),
    };
    let problem = Problem::new(place, format!("`{}` has {count}, but no `{part}`", walked.join(".")));
    let names = items.iter().filter_map(|item| name_of(item)).collect::<Vec<_>>();
    match name_hint(part, names) {
        Some(hint) => problem.with_hint(hint),
        None => problem,
    }
}

fn name_of(item: &Node) -> Option<&str> {
    match &item.get("name")?.value {
        Value::Scalar(Scalar::Text(name)) => Some(name),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edited(text: &str, edits: &[&str]) -> (Rc<Node>, Vec<String>) {
        let limits = Limits::default();
        let mut root = parse(text, Origin::File, &limits).ok().and_then(|parsed| parsed.root).unwrap();
        let edits = edits.iter().map(|edit| edit.parse().unwrap()).collect::<Vec<Override>>();
        let problems = apply(&mut root, &edits, &limits);
        (root, problems.into_iter().map(|problem| problem.message).collect())
    }

    fn integer(node: Option<&Node>) -> i64 {
        match node.map(|node| &node.value) {
            Some(Value::Scalar(Scalar::Integer(value))) => *value,
            other => panic!("{other:?} is no integer"),
        }
    }

    #[test]
    fn paths_go_by_key_index_and_name_and_make_keys() {
        let text = "a: [{name: x, v: 1}, {name: y, v: 2}]\nmany.parts: {v: 3}\n";
        let (root, problems) = edited(text, &["a.0.v=10", "a.y.v=20", "many.parts.v=30", "new.deep=40"]);
        assert_eq!(problems, [""; 0]);
        let Value::Sequence(items) = &root.get("a").unwrap().value else { panic!() };
        assert_eq!(integer(items[0].get("v")), 10);
        assert_eq!(integer(items[1].get("v")), 20);
        assert_eq!(integer(root.get("many.parts").unwrap().get("v")), 30);
        assert_eq!(integer(root.get("new").unwrap().get("deep")), 40);
    }

    #[test]
    fn an_edit_through_an_alias_leaves_the_anchor_alone() {
        let (root, _) = edited("a: &x {v: 1}\nb: *x\n", &["b.v=2"]);
        assert_eq!(integer(root.get("a").unwrap().get("v")), 1);
        assert_eq!(integer(root.get("b").unwrap().get("v")), 2);
    }

    #[test]
    fn paths_to_nowhere_are_problems() {
        let text = "a: [{name: sun}, {name: moon}]\nb: 1\n";
        let (_, problems) = edited(text, &["a.2.v=1", "a.sum=1", "b.c=1", "b=[", "b="]);
        assert_eq!(problems[0], "`a` has the items 0 to 1, but no `2`");
        assert_eq!(problems[1], "`a` has the items 0 to 1, but no `sum`");
        assert_eq!(problems[2], "`b` is a single value, in which there is no `c`");
        assert_eq!(problems.len(), 4);
    }

    #[test]
    fn a_color_needs_no_quotes() {
        let (root, _) = edited("a: 1", &["a=#ff8000"]);
        assert!(
            matches!(&root.get("a").unwrap().value, Value::Scalar(Scalar::Text(text)) if &**text == "#ff8000")
        );
    }
}
