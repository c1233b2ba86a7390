//! What to change in a text so that it says what another tree does.
//!
//! In: the text, where its nodes stand, the tree that it has, and the one that it shall have. Out: [`Edits`]. What
//! the trees share (as one node in memory) is left alone, comments and all; of the rest, scalars are replaced,
//! entries and items are added in the style of those that are there, and only what changed its kind or lost a part
//! is written anew.

use super::edits::Edits;
use super::insert;
use super::layout::{Entry as KeyAndValue, Kind, Layout, Style};
use crate::scene_file::syntax::{Entry, Language, Node, Value, flow, flow_key, same_scalar};
use std::collections::HashSet;
use std::rc::Rc;

/// The edits that make `new` of `old`. `None` where the text is written in a way that leaves no place for them.
pub(super) fn reconcile(
    text: &str,
    layout: &Layout,
    old: &Rc<Node>,
    new: &Rc<Node>,
    language: Language,
) -> Option<Edits> {
    let mut reconciler =
        Reconciler { text, language, changed_anchors: HashSet::new(), edits: Edits::default() };
    reconciler.node(layout, old, new)?;
    Some(reconciler.edits)
}

struct Reconciler<'a> {
    text: &'a str,
    language: Language,
    /// The anchors that stand for something else now, or for nothing; their aliases are written out.
    changed_anchors: HashSet<usize>,
    edits: Edits,
}

impl Reconciler<'_> {
    /// Recurses as deep as the tree is, which [`Limits::nesting`](crate::limits::Limits::nesting) bounds.
    fn node(&mut self, layout: &Layout, old: &Rc<Node>, new: &Rc<Node>) -> Option<()> {
        let is_same = Rc::ptr_eq(old, new);
        if layout.anchor != 0 && !is_same {
            self.changed_anchors.insert(layout.anchor);
        }
        if let Kind::Alias(anchor) = layout.kind {
            if !is_same || self.changed_anchors.contains(&anchor) {
                self.replace(layout, new);
            }
            return Some(());
        }
        if !is_same && is_written_anew(layout, old, new) {
            self.replace(layout, new);
            return Some(());
        }
        match (&layout.kind, &old.value, &new.value) {
            (Kind::Scalar | Kind::Missing, Value::Scalar(_), Value::Scalar(_)) => Some(()),
            (Kind::Sequence(style, items), Value::Sequence(old), Value::Sequence(new)) => {
                self.sequence(layout, (*style, items), old, new)
            }
            (Kind::Mapping(style, entries), Value::Mapping(old), Value::Mapping(new)) => {
                self.mapping(layout, (*style, entries), old, new)
            }
            _ => None,
        }
    }

    fn sequence(
        &mut self,
        layout: &Layout,
        (style, items): (Style, &[Layout]),
        old: &[Rc<Node>],
        new: &[Rc<Node>],
    ) -> Option<()> {
        for (item, (old, new)) in items.iter().zip(old.iter().zip(new)) {
            self.node(item, old, new)?;
        }
        let added = new[old.len()..].iter().map(|item| flow(item, self.language)).collect::<Vec<_>>();
        match style {
            _ if added.is_empty() => Some(()),
            Style::Block => insert::items(self.text, items, &added, &mut self.edits),
            Style::Flow => {
                let starts = items.iter().map(|item| item.span.start).collect::<Vec<_>>();
                insert::in_brackets(
                    self.text,
                    &layout.span,
                    &starts,
                    last_end(items.last()),
                    &added,
                    &mut self.edits,
                )
            }
        }
    }

    fn mapping(
        &mut self,
        layout: &Layout,
        (style, entries): (Style, &[KeyAndValue]),
        old: &[Entry],
        new: &[Entry],
    ) -> Option<()> {
        for (entry, (old, new)) in entries.iter().zip(old.iter().zip(new)) {
            self.key(&entry.key, &old.key);
            self.entry(entry, &old.value, &new.value)?;
        }
        let language = self.language;
        let line =
            |entry: &Entry| format!("{}: {}", flow_key(&entry.key, language), flow(&entry.value, language));
        let added = new[old.len()..].iter().map(line).collect::<Vec<_>>();
        match style {
            _ if added.is_empty() => Some(()),
            Style::Block => insert::lines(self.text, entries, &added, &mut self.edits),
            Style::Flow => {
                let starts = entries.iter().map(|entry| entry.key.span.start).collect::<Vec<_>>();
                let last = last_end(entries.last().map(|entry| &entry.value));
                insert::in_brackets(self.text, &layout.span, &starts, last, &added, &mut self.edits)
            }
        }
    }

    /// A key stays, but may be an alias of what changes.
    fn key(&mut self, layout: &Layout, key: &str) {
        if let Kind::Alias(anchor) = layout.kind
            && self.changed_anchors.contains(&anchor)
        {
            self.edits.replace(layout.span.clone(), flow_key(key, self.language));
        }
    }

    /// The value of a key. A block that gives way to one line leaves the lines that it had.
    fn entry(
        &mut self,
        KeyAndValue { key, value }: &KeyAndValue,
        old: &Rc<Node>,
        new: &Rc<Node>,
    ) -> Option<()> {
        let is_anew = !Rc::ptr_eq(old, new) && is_written_anew(value, old, new);
        if is_anew && matches!(value.kind, Kind::Missing) {
            let has_colon = self.text[..value.span.start].ends_with(':');
            let colon = if has_colon { " " } else { ": " };
            self.edits.insert(value.span.start, format!("{colon}{}", flow(new, self.language)));
            return Some(());
        }
        let is_block = matches!(value.kind, Kind::Sequence(Style::Block, _) | Kind::Mapping(Style::Block, _));
        if !is_anew || !is_block {
            return self.node(value, old, new);
        }
        self.forget_anchors(value);
        let colon = super::layout::after_colon(self.text, key.span.end)?;
        self.edits.insert(colon, format!(" {}", flow(new, self.language)));
        let between = &self.text[colon..value.span.start];
        let kept = if between.trim().is_empty() { 0 } else { between.rfind('\n')? };
        self.edits.replace(colon + kept..value.span.end, "");
        Some(())
    }

    /// Writes a value in the place of what stands there.
    fn replace(&mut self, layout: &Layout, new: &Node) {
        self.forget_anchors(layout);
        self.edits.replace(layout.span.clone(), flow(new, self.language));
    }

    /// Notes that the anchors in what is taken out are gone.
    fn forget_anchors(&mut self, layout: &Layout) {
        if layout.anchor != 0 {
            self.changed_anchors.insert(layout.anchor);
        }
        match &layout.kind {
            Kind::Scalar | Kind::Missing | Kind::Alias(_) => {}
            Kind::Sequence(_, items) => items.iter().for_each(|item| self.forget_anchors(item)),
            Kind::Mapping(_, entries) => {
                for KeyAndValue { key, value } in entries {
                    self.forget_anchors(key);
                    self.forget_anchors(value);
                }
            }
        }
    }
}

fn last_end(last: Option<&Layout>) -> Option<usize> {
    last.map(|last| last.span.end)
}

/// Whether a value that changed is replaced as a whole: it is another scalar, or its parts are not all there.
fn is_written_anew(layout: &Layout, old: &Node, new: &Node) -> bool {
    match (&layout.kind, &old.value, &new.value) {
        (Kind::Scalar | Kind::Missing, Value::Scalar(old), Value::Scalar(new)) => !same_scalar(old, new),
        (Kind::Sequence(_, items), Value::Sequence(old), Value::Sequence(new)) => {
            items.len() != old.len() || new.len() < old.len()
        }
        (Kind::Mapping(_, entries), Value::Mapping(old), Value::Mapping(new)) => {
            entries.len() != old.len() || !begins_with_keys_of(new, old)
        }
        _ => true,
    }
}

/// Whether the first entries of `new` have the keys of `old`.
fn begins_with_keys_of(new: &[Entry], old: &[Entry]) -> bool {
    new.len() >= old.len() && old.iter().zip(new).all(|(old, new)| old.key == new.key)
}
