//! The tree as a list of the rows that are unfolded. It knows nothing of how a row looks.

use crate::{Language, Phrase, Selection};
use lancer_core::scene::{MaterialId, Node, NodeId, Scene, Shape};
use std::borrow::Cow;
use std::collections::HashSet;

/// What a row stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Item {
    /// The head of a list.
    Section(Section),
    /// A node, in one of the places where it is drawn.
    Node(NodeId),
    /// A light, by its place in the scene's list.
    Light(usize),
    /// A material.
    Material(MaterialId),
    /// The main camera, or one of those with names.
    Camera(Option<usize>),
    /// So many children that are not listed.
    More(usize),
}

/// A list of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Objects,
    Lights,
    Materials,
    Cameras,
}

/// Which row: the way to it, in one number. A node that is drawn in several places has as many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key(pub(super) u64);

/// A row as it is listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) item: Item,
    pub(super) key: Key,
    /// How many rows it lies below: 0 for a section.
    pub(super) depth: u32,
    /// Whether it is unfolded; none where nothing lies below.
    pub(super) unfolded: Option<bool>,
}

/// The most children of a node that are listed: more than anybody scrolls through, and few enough to be listed anew
/// in each frame in which something changes.
const MOST_CHILDREN: usize = 100_000;

impl Section {
    pub(super) const ALL: [Self; 4] = [Self::Objects, Self::Lights, Self::Materials, Self::Cameras];

    pub(super) const fn key(self) -> Key {
        Key(self as u64)
    }

    pub(super) const fn name(self) -> Phrase {
        match self {
            Self::Objects => Phrase::new("Objects", "Objets"),
            Self::Lights => Phrase::new("Lights", "Lumières"),
            Self::Materials => Phrase::new("Materials", "Matériaux"),
            Self::Cameras => Phrase::new("Cameras", "Caméras"),
        }
    }
}

impl Key {
    /// The key of the child at a place. Source: the finaliser of splitmix64, Steele et al. (2014); two of a million
    /// rows share a key with a probability of 3e-8, and would then be unfolded together.
    fn child(self, place: usize) -> Self {
        let mut z = self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(place as u64 + 0x100);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self(z ^ z >> 31)
    }
}

impl Item {
    /// What it is to select it, if it can be.
    pub(super) fn selection(self) -> Option<Selection> {
        match self {
            Self::Node(id) => Some(Selection::Node(id)),
            Self::Light(index) => Some(Selection::Light(index)),
            Self::Material(id) => Some(Selection::Material(id)),
            Self::Section(_) | Self::Camera(_) | Self::More(_) => None,
        }
    }

    /// What it is called: by its author, or else after what it is.
    pub(super) fn name(self, scene: &Scene, language: Language) -> Cow<'_, str> {
        let numbered = |what, index: usize| format!("{} {}", language.say(what), index + 1);
        let (name, otherwise) = match self {
            Self::Section(section) => ("", language.say(section.name()).to_owned()),
            Self::Node(id) => {
                let node = scene.nodes().get(id.index());
                let kind = node.map_or("", |node| language.say(kind_of(node)));
                (node.map_or("", |node| &node.name), kind.to_owned())
            }
            Self::Light(index) => {
                let name = scene.lights.get(index).map_or("", |light| &light.name);
                (name, numbered(Phrase::new("Light", "Lumière"), index))
            }
            Self::Material(id) => {
                let name = scene.materials().get(id.index()).map_or("", |material| &material.name);
                (name, numbered(Phrase::new("Material", "Matériau"), id.index()))
            }
            Self::Camera(None) => {
                ("", language.say(Phrase::new("Main camera", "Caméra principale")).to_owned())
            }
            Self::Camera(Some(index)) => {
                let name = scene.cameras.get(index).map_or("", |(name, _)| name);
                (name, numbered(Phrase::new("Camera", "Caméra"), index))
            }
            Self::More(count) => ("", format!("… {count} {}", language.say(Phrase::new("more", "de plus")))),
        };
        if name.is_empty() { otherwise.into() } else { name.into() }
    }
}

/// What a node is: its shape, or a group.
pub(super) fn kind_of(node: &Node) -> Phrase {
    match node.shape {
        Some(Shape::Sphere) => Phrase::new("Sphere", "Sphère"),
        Some(Shape::Cube) => Phrase::same("Cube"),
        Some(Shape::Cylinder { .. }) => Phrase::new("Cylinder", "Cylindre"),
        Some(Shape::Plane) => Phrase::new("Plane", "Plan"),
        Some(Shape::Mesh(_)) => Phrase::new("Mesh", "Maillage"),
        None => Phrase::new("Group", "Groupe"),
    }
}

/// All rows that are unfolded, in order.
pub(super) fn list(scene: &Scene, unfolded: &HashSet<Key>) -> Vec<Row> {
    let mut rows = Vec::new();
    for section in Section::ALL {
        let key = section.key();
        let is_unfolded = unfolded.contains(&key);
        rows.push(Row { item: Item::Section(section), key, depth: 0, unfolded: Some(is_unfolded) });
        if is_unfolded {
            match section {
                Section::Objects => list_nodes(scene, unfolded, &mut rows),
                Section::Lights => list_plain(section, (0..scene.lights.len()).map(Item::Light), &mut rows),
                Section::Materials => {
                    list_plain(section, scene.material_ids().map(Item::Material), &mut rows);
                }
                Section::Cameras => {
                    let named = (0..scene.cameras.len()).map(|index| Item::Camera(Some(index)));
                    list_plain(section, std::iter::once(Item::Camera(None)).chain(named), &mut rows);
                }
            }
        }
    }
    rows
}

fn list_plain(section: Section, items: impl Iterator<Item = Item>, rows: &mut Vec<Row>) {
    rows.extend(items.enumerate().map(|(place, item)| Row {
        item,
        key: section.key().child(place),
        depth: 1,
        unfolded: None,
    }));
}

/// By a pile of its own, not by recursion: a tree may be deeper than the stack.
fn list_nodes(scene: &Scene, unfolded: &HashSet<Key>, rows: &mut Vec<Row>) {
    let mut pile = vec![(scene.roots(), 0, Section::Objects.key(), 1)];
    while let Some((children, place, parent, depth)) = pile.pop() {
        let Some(&id) = children.get(place) else { continue };
        let key = parent.child(place);
        if place == MOST_CHILDREN {
            rows.push(Row { item: Item::More(children.len() - place), key, depth, unfolded: None });
            continue;
        }
        pile.push((children, place + 1, parent, depth));
        let below = &scene.node(id).children;
        let is_unfolded = (!below.is_empty()).then(|| unfolded.contains(&key));
        rows.push(Row { item: Item::Node(id), key, depth, unfolded: is_unfolded });
        if is_unfolded == Some(true) {
            pile.push((below, 0, key, depth + 1));
        }
    }
}

/// The rows from the top to the first place of a selection: those above are to be unfolded to see the last.
pub(super) fn way_to(scene: &Scene, selection: Selection) -> Vec<Key> {
    let plain = |section: Section, place: usize| vec![section.key(), section.key().child(place)];
    match selection {
        Selection::None => Vec::new(),
        Selection::Light(index) => plain(Section::Lights, index),
        Selection::Material(id) => plain(Section::Materials, id.index()),
        Selection::Node(id) => way_to_node(scene, id),
    }
}

/// Each node is visited once, however many places it has.
fn way_to_node(scene: &Scene, wanted: NodeId) -> Vec<Key> {
    // The parent, none at the top, and the place among its children.
    let mut came_from: Vec<Option<(Option<NodeId>, usize)>> = vec![None; scene.nodes().len()];
    let mut waiting = vec![None];
    while let Some(parent) = waiting.pop() {
        let children = parent.map_or(scene.roots(), |id| &scene.node(id).children);
        for (place, &child) in children.iter().enumerate() {
            if let from @ None = &mut came_from[child.index()] {
                *from = Some((parent, place));
                waiting.push(Some(child));
            }
        }
    }
    let mut places = Vec::new();
    let mut at = Some(wanted);
    while let Some(id) = at {
        let Some(Some((parent, place))) = came_from.get(id.index()).copied() else { return Vec::new() };
        places.push(place);
        at = parent;
    }
    let mut way = vec![Section::Objects.key()];
    for place in places.into_iter().rev() {
        way.push(way[way.len() - 1].child(place));
    }
    way
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair of the same ball, and a ball without a name.
    fn scene() -> Scene {
        let mut scene = Scene::new("pair");
        let ball = scene.insert(Node::shape("ball", Shape::Sphere));
        scene.add(Node::group("pair", [ball, ball]));
        scene.add(Node::shape("", Shape::Sphere));
        scene
    }

    fn unfolded(keys: &[Key]) -> HashSet<Key> {
        keys.iter().copied().collect()
    }

    #[test]
    fn folded_rows_hide_what_lies_below() {
        let scene = scene();
        assert_eq!(list(&scene, &unfolded(&[])).len(), 4);
        let objects = Section::Objects.key();
        let rows = list(&scene, &unfolded(&[objects]));
        assert_eq!(rows.iter().map(|row| row.depth).collect::<Vec<_>>(), [0, 1, 1, 0, 0, 0]);
        let rows = list(&scene, &unfolded(&[objects, rows[1].key]));
        assert_eq!(rows.iter().map(|row| row.depth).collect::<Vec<_>>(), [0, 1, 2, 2, 1, 0, 0, 0]);
    }

    #[test]
    fn a_node_in_two_places_has_two_keys() {
        let scene = scene();
        let ball = scene.node(scene.roots()[0]).children[0];
        let way = way_to(&scene, Selection::Node(ball));
        let rows = list(&scene, &unfolded(&way));
        assert_eq!((rows[2].item, rows[3].item), (Item::Node(ball), Item::Node(ball)));
        assert_ne!(rows[2].key, rows[3].key);
    }

    #[test]
    fn the_way_to_a_node_unfolds_it() {
        for builtin in lancer_gallery::SCENES {
            let scene = builtin.build();
            let deepest = list_all(&scene).into_iter().max_by_key(|row| row.depth).unwrap();
            let Item::Node(id) = deepest.item else { continue };
            let way = way_to(&scene, Selection::Node(id));
            let rows = list(&scene, &unfolded(&way));
            let last = rows.iter().find(|row| Some(&row.key) == way.last());
            assert_eq!(last.map(|row| row.item), Some(Item::Node(id)), "{}", scene.name);
        }
    }

    /// Some rows, from unfolding the first child of each as deep as it goes.
    fn list_all(scene: &Scene) -> Vec<Row> {
        let mut open = unfolded(&[Section::Objects.key()]);
        loop {
            let rows = list(scene, &open);
            let Some(folded) =
                rows.iter().filter(|row| row.unfolded == Some(false)).max_by_key(|row| row.depth)
            else {
                return rows;
            };
            if folded.depth < rows.iter().map(|row| row.depth).max().unwrap_or(0) || !open.insert(folded.key)
            {
                return rows;
            }
        }
    }

    #[test]
    fn what_is_not_drawn_has_no_way() {
        let mut scene = scene();
        let spare = scene.insert(Node::shape("spare", Shape::Cube));
        assert!(way_to(&scene, Selection::Node(spare)).is_empty());
        assert!(way_to(&scene, Selection::None).is_empty());
    }

    #[test]
    fn too_many_children_are_counted_and_not_listed() {
        let mut scene = Scene::new("many");
        for _ in 0..MOST_CHILDREN + 7 {
            scene.add(Node::shape("", Shape::Sphere));
        }
        let rows = list(&scene, &unfolded(&[Section::Objects.key()]));
        assert_eq!(rows[MOST_CHILDREN + 1].item, Item::More(7));
        assert_eq!(rows.iter().map(|row| row.key).collect::<HashSet<_>>().len(), rows.len());
    }

    #[test]
    fn what_has_no_name_is_called_after_what_it_is() {
        let scene = scene();
        let nameless = Item::Node(scene.roots()[1]);
        assert_eq!(nameless.name(&scene, Language::English), "Sphere");
        assert_eq!(nameless.name(&scene, Language::French), "Sphère");
        assert_eq!(Item::Node(scene.roots()[0]).name(&scene, Language::French), "pair");
        assert_eq!(Item::Light(1).name(&scene, Language::English), "Light 2");
    }
}
