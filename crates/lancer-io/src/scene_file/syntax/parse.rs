//! Text to tree, over the events of `saphyr_parser`.
//!
//! Nothing here recurses, and every bound is checked before a node is kept: a bomb of aliases or brackets is
//! refused where it goes off.

use super::{Entry, Node, Origin, Place, Problem, Scalar, Value};
use crate::limits::Limits;
use saphyr_parser::{Event, Marker, Parser, ScalarStyle, ScanError, Span, Tag};
use std::collections::{HashMap, hash_map};
use std::rc::Rc;

/// A text that has a tree.
pub(crate) struct Parsed {
    /// `None` for a text with nothing in it.
    pub(crate) root: Option<Rc<Node>>,
    /// What left a tree to read on with: repeated keys, keys that are no words, foreign tags.
    pub(crate) problems: Vec<Problem>,
}

/// The tree of a text that holds one document.
///
/// # Errors
/// The problems of a text that has no tree, the fatal one last.
pub(crate) fn parse(text: &str, origin: Origin, limits: &Limits) -> Result<Parsed, Vec<Problem>> {
    let mut builder = Builder::new(origin, *limits);
    let mut parser = Parser::new_from_str(text);
    while let Some(event) = parser.next_event() {
        let step = match event {
            Ok((event, span)) => builder.take(event, span),
            Err(error) => Err(builder.syntax_error(&error)),
        };
        if let Err(fatal) = step {
            builder.problems.push(fatal);
            return Err(builder.problems);
        }
    }
    Ok(Parsed { root: builder.root, problems: builder.problems })
}

/// A finished node, with what it counts for wherever it is repeated.
#[derive(Clone)]
struct Built {
    node: Rc<Node>,
    /// Nodes in it, itself and those of its aliases included.
    nodes: usize,
    /// Levels of nodes in it; 1 for a scalar.
    height: usize,
}

/// A list or mapping whose end has not come yet.
struct Open {
    place: Place,
    anchor: usize,
    content: Content,
    nodes: usize,
    height: usize,
}

enum Content {
    Sequence(Vec<Rc<Node>>),
    Mapping { entries: Vec<Entry>, first_places: HashMap<Rc<str>, Place>, pending: Pending },
}

/// What a mapping waits for.
enum Pending {
    Key,
    ValueOf(Rc<str>, Place),
    /// The value of a key that was refused.
    NoValue,
}

struct Builder {
    origin: Origin,
    limits: Limits,
    open: Vec<Open>,
    /// By the parser's id; 0 means none.
    anchors: HashMap<usize, Built>,
    root: Option<Rc<Node>>,
    nodes: usize,
    problems: Vec<Problem>,
}

impl Builder {
    fn new(origin: Origin, limits: Limits) -> Self {
        Self {
            origin,
            limits,
            open: Vec::new(),
            anchors: HashMap::new(),
            root: None,
            nodes: 0,
            problems: Vec::new(),
        }
    }

    fn place(&self, marker: Marker) -> Place {
        let narrow = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Place { origin: self.origin, line: narrow(marker.line()), column: narrow(marker.col() + 1) }
    }

    fn syntax_error(&self, error: &ScanError) -> Problem {
        let problem = Problem::new(self.place(*error.marker()), error.info());
        if error.info().contains("tab") { problem.with_hint("indent with spaces") } else { problem }
    }

    fn take(&mut self, event: Event<'_>, span: Span) -> Result<(), Problem> {
        let place = self.place(span.start);
        match event {
            Event::DocumentStart(_) if self.root.is_some() => {
                Err(Problem::new(place, "a second document begins here, must be one")
                    .with_hint("`---` stands at most once, above everything"))
            }
            Event::Scalar(text, style, anchor, tag) => {
                self.scalar(place, &text, style, anchor, tag.as_deref())
            }
            Event::Alias(anchor) => self.alias(place, anchor),
            Event::SequenceStart(anchor, tag) => {
                self.check_tag(place, tag.as_deref(), "seq");
                self.begin(place, anchor, Content::Sequence(Vec::new()))
            }
            Event::MappingStart(anchor, tag) => {
                self.check_tag(place, tag.as_deref(), "map");
                let content = Content::Mapping {
                    entries: Vec::new(),
                    first_places: HashMap::new(),
                    pending: Pending::Key,
                };
                self.begin(place, anchor, content)
            }
            Event::SequenceEnd | Event::MappingEnd => {
                self.end();
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn scalar(
        &mut self,
        place: Place,
        text: &str,
        style: ScalarStyle,
        anchor: usize,
        tag: Option<&Tag>,
    ) -> Result<(), Problem> {
        self.count(place, 1)?;
        if let Some(Open { content: Content::Mapping { pending: Pending::Key, .. }, .. }) = self.open.last() {
            self.key(place, text);
            self.anchor(anchor, &leaf(place, Scalar::text(text)));
            return Ok(());
        }
        let value = match (tag.map(|tag| (tag.handle.as_str(), tag.suffix.as_str())), style) {
            (None, ScalarStyle::Plain) => Scalar::from_plain(text),
            (None | Some((CORE_TAGS, "str") | ("", "!")), _) => Scalar::text(text),
            (Some((CORE_TAGS, "null" | "bool" | "int" | "float")), _) => Scalar::from_plain(text),
            (Some(_), _) => {
                self.foreign_tag(place, tag);
                Scalar::from_plain(text)
            }
        };
        let built = leaf(self.place_of_value(place, text), value);
        self.anchor(anchor, &built);
        self.put(built);
        Ok(())
    }

    /// A value that was left out is where its key is; the parser finds it at whatever comes next.
    fn place_of_value(&self, place: Place, text: &str) -> Place {
        match self.open.last() {
            Some(Open { content: Content::Mapping { pending: Pending::ValueOf(_, key), .. }, .. })
                if text.is_empty() =>
            {
                *key
            }
            _ => place,
        }
    }

    fn alias(&mut self, place: Place, anchor: usize) -> Result<(), Problem> {
        let Some(built) = self.anchors.get(&anchor).cloned() else {
            return Err(Problem::new(place, "the alias stands inside of what it stands for"));
        };
        self.count(place, built.nodes)?;
        self.check_depth(place, built.height)?;
        self.put(built);
        Ok(())
    }

    fn begin(&mut self, place: Place, anchor: usize, content: Content) -> Result<(), Problem> {
        self.count(place, 1)?;
        self.check_depth(place, 1)?;
        self.open.push(Open { place, anchor, content, nodes: 1, height: 1 });
        Ok(())
    }

    fn end(&mut self) {
        let Some(open) = self.open.pop() else { return };
        let value = match open.content {
            Content::Sequence(items) => Value::Sequence(items),
            Content::Mapping { entries, .. } => Value::Mapping(entries),
        };
        let node = Rc::new(Node::new(open.place, value));
        let built = Built { node, nodes: open.nodes, height: open.height };
        self.anchor(open.anchor, &built);
        self.put(built);
    }

    fn anchor(&mut self, anchor: usize, built: &Built) {
        if anchor != 0 {
            self.anchors.insert(anchor, built.clone());
        }
    }

    /// Puts a finished node where it belongs: into the innermost open one.
    fn put(&mut self, built: Built) {
        let Some(open) = self.open.last_mut() else {
            self.root = Some(built.node);
            return;
        };
        open.nodes += built.nodes;
        open.height = open.height.max(built.height + 1);
        match &mut open.content {
            Content::Sequence(items) => items.push(built.node),
            Content::Mapping { entries, pending, .. } => match std::mem::replace(pending, Pending::Key) {
                Pending::ValueOf(key, key_place) => entries.push(Entry { key, key_place, value: built.node }),
                Pending::NoValue => {}
                Pending::Key => match &built.node.value {
                    Value::Scalar(Scalar::Text(text)) => {
                        let text = Rc::clone(text);
                        self.key(built.node.place, &text);
                    }
                    _ => {
                        *pending = Pending::NoValue;
                        self.problems.push(Problem::new(built.node.place, "a key must be a word"));
                    }
                },
            },
        }
    }

    fn key(&mut self, place: Place, text: &str) {
        let Some(Open { content: Content::Mapping { first_places, pending, .. }, .. }) = self.open.last_mut()
        else {
            return;
        };
        let key: Rc<str> = text.into();
        *pending = match first_places.entry(Rc::clone(&key)) {
            hash_map::Entry::Vacant(vacant) => {
                vacant.insert(place);
                Pending::ValueOf(key, place)
            }
            hash_map::Entry::Occupied(first) => {
                let message = format!("the key `{text}` is repeated");
                let hint = format!("it stands first on line {}", first.get().line);
                self.problems.push(Problem::new(place, message).with_hint(hint));
                Pending::NoValue
            }
        };
    }

    fn count(&mut self, place: Place, nodes: usize) -> Result<(), Problem> {
        self.nodes = self.nodes.saturating_add(nodes);
        let most = self.limits.syntax_nodes;
        if self.nodes <= most {
            return Ok(());
        }
        Err(Problem::new(place, format!("the file holds more than {most} values, those of aliases included")))
    }

    fn check_depth(&self, place: Place, height: usize) -> Result<(), Problem> {
        let deepest = self.limits.nesting;
        if self.open.len() + height <= deepest {
            return Ok(());
        }
        Err(Problem::new(place, format!("nested more than {deepest} deep"))
            .with_hint("a part that is `use`d from `assets` begins anew"))
    }

    fn check_tag(&mut self, place: Place, tag: Option<&Tag>, legal: &str) {
        if tag.is_some_and(|tag| tag.handle != CORE_TAGS || tag.suffix != legal) {
            self.foreign_tag(place, tag);
        }
    }

    fn foreign_tag(&mut self, place: Place, tag: Option<&Tag>) {
        let name = tag.map_or("", |tag| &tag.suffix);
        self.problems.push(Problem::new(place, format!("the tag `{name}` means nothing here")));
    }
}

/// What `!!` stands for.
const CORE_TAGS: &str = "tag:yaml.org,2002:";

fn leaf(place: Place, scalar: Scalar) -> Built {
    Built { node: Rc::new(Node::new(place, Value::Scalar(scalar))), nodes: 1, height: 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(text: &str) -> Rc<Node> {
        let Ok(Parsed { root, problems }) = parse(text, Origin::File, &Limits::default()) else {
            panic!("{text}")
        };
        assert_eq!(problems, []);
        root.unwrap()
    }

    fn problems(text: &str) -> Vec<(u32, u32, String)> {
        let problems = match parse(text, Origin::File, &Limits::default()) {
            Ok(Parsed { problems, .. }) | Err(problems) => problems,
        };
        problems.into_iter().map(|p| (p.place.line, p.place.column, p.message)).collect()
    }

    fn position(node: &Node) -> (u32, u32) {
        (node.place.line, node.place.column)
    }

    #[test]
    fn nodes_know_their_places() {
        let root = tree("a: 1\nbé: [x, {c: 2}]\nd:\n  - e: 3\nf:\ng: 1\n");
        assert_eq!(position(&root), (1, 1));
        assert_eq!(position(root.get("a").unwrap()), (1, 4));
        let Value::Sequence(items) = &root.get("bé").unwrap().value else { panic!() };
        assert_eq!(items.iter().map(|item| position(item)).collect::<Vec<_>>(), [(2, 6), (2, 9)]);
        let Value::Sequence(items) = &root.get("d").unwrap().value else { panic!() };
        assert_eq!(position(&items[0]), (4, 5));
        assert_eq!(position(root.get("f").unwrap()), (5, 1), "a value left out is where its key is");
    }

    #[test]
    fn aliases_share_the_node_of_their_anchor() {
        let root = tree("a: &x [1, 2]\nb: *x\n");
        assert!(std::ptr::eq(root.get("a").unwrap(), root.get("b").unwrap()));
    }

    #[test]
    fn repeated_and_wordless_keys_are_problems_that_leave_a_tree() {
        let found = problems("a: 1\nb: 2\na: 3\n[c]: 4\n");
        assert_eq!(found[0], (3, 1, "the key `a` is repeated".into()));
        assert_eq!(found[1], (4, 1, "a key must be a word".into()));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn tags_of_the_core_schema_are_followed_and_others_told() {
        let root = tree("a: !!str 5\nb: !!float 1\nc: ! 7\nd: !!seq []\n");
        let scalar = |key: &str| match &root.get(key).unwrap().value {
            Value::Scalar(scalar) => scalar.clone(),
            _ => panic!(),
        };
        assert_eq!(scalar("a"), Scalar::text("5"));
        assert_eq!(scalar("b"), Scalar::Integer(1));
        assert_eq!(scalar("c"), Scalar::text("7"));
        assert_eq!(problems("a: !color red\n")[0].2, "the tag `color` means nothing here");
    }

    #[test]
    fn what_goes_off_is_refused_where_it_does() {
        let mut bomb = String::from("a0: &a0 [1]\n");
        for i in 1..64 {
            bomb += &format!("a{i}: &a{i} [*a{0}, *a{0}]\n", i - 1);
        }
        assert!(problems(&bomb)[0].2.contains("more than 4000000 values"));

        for open in ["[", "{a: ", "- ", "? "] {
            assert!(!problems(&open.repeat(100_000)).is_empty(), "{open}");
        }
        assert!(problems(&"- ".repeat(201))[0].2.contains("nested more than 200 deep"));
        let through_an_alias = format!(
            "- &a {}1{}\n- {}*a{}",
            "[".repeat(150),
            "]".repeat(150),
            "[".repeat(150),
            "]".repeat(150)
        );
        assert!(problems(&through_an_alias)[0].2.contains("nested more than 200 deep"));
        assert_eq!(problems("a: &a [*a]\n")[0].2, "the alias stands inside of what it stands for");
        assert_eq!(problems("a: 1\n---\nb: 2\n")[0].0, 2);
    }
}
