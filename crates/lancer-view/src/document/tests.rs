use super::*;
use crate::Language;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Light, Material, MaterialId, Node, NodeId, Settings, Shape};
use proptest::prelude::*;

/// Two nodes, two materials, two lights.
fn scene() -> Scene {
    let mut scene = Scene::new("pair");
    let red = scene.add_material(Material::named("red"));
    let blue = scene.add_material(Material::named("blue"));
    scene.add(Node::shape("left", Shape::Sphere).with_material(red));
    scene.add(Node::shape("right", Shape::Cube).with_material(blue));
    scene.add_light(DVec3::Y, Rgb::WHITE);
    scene.add_light(DVec3::X, Rgb::WHITE);
    scene
}

fn document() -> Document {
    Document::new(Source::File("pair.yaml".into()), scene())
}

fn nodes() -> [NodeId; 2] {
    let scene = scene();
    [scene.roots()[0], scene.roots()[1]]
}

fn materials() -> [MaterialId; 2] {
    let scene = scene();
    nodes().map(|id| scene.node(id).material.unwrap())
}

fn light(x: f64) -> Light {
    Light { name: String::new(), position: DVec3::new(x, 0.0, 0.0), intensity: Rgb::WHITE }
}

fn moved(x: f64) -> Edit {
    Edit::Transform(nodes()[0], Transform::translate(DVec3::X * x))
}

#[test]
fn undo_restores_the_value_and_redo_makes_the_change_again() {
    let mut document = document();
    let before = Arc::clone(document.scene());
    document.apply(Edit::Ambient(Rgb::grey(0.25)));
    let after = Arc::clone(document.scene());
    assert_eq!(after.ambient, Rgb::grey(0.25));
    assert_eq!(document.undo(), Some(EditKind::Ambient));
    assert_eq!(**document.scene(), *before);
    assert_eq!(document.redo(), Some(EditKind::Ambient));
    assert_eq!(**document.scene(), *after);
    assert_eq!(document.redo(), None);
}

#[test]
fn edits_of_one_value_in_one_gesture_are_one_step() {
    let mut document = document();
    for x in 1..10 {
        document.apply(moved(f64::from(x)));
    }
    document.end_gesture();
    document.apply(moved(20.0));
    document.undo();
    assert_eq!(document.scene().node(nodes()[0]).transform.translation().x, 9.0);
    document.undo();
    assert_eq!(**document.scene(), scene());
    assert!(!document.can_undo());
}

#[test]
fn edits_of_different_values_are_steps_of_their_own_even_in_one_gesture() {
    let mut document = document();
    document.apply(Edit::Hidden(nodes()[0], true));
    document.apply(Edit::Hidden(nodes()[1], true));
    document.undo();
    assert!(document.scene().node(nodes()[0]).hidden);
    assert!(!document.scene().node(nodes()[1]).hidden);
}

#[test]
fn a_gesture_that_ends_where_it_began_leaves_no_step_and_no_change() {
    let mut document = document();
    let revision = document.revision();
    document.apply(moved(3.0));
    document.apply(moved(0.0));
    document.end_gesture();
    assert!(!document.can_undo());
    assert!(!document.is_changed());
    assert_eq!(document.revision(), revision);
}

#[test]
fn what_changes_nothing_or_has_no_target_is_no_step() {
    let mut document = document();
    let revision = document.revision();
    document.apply(Edit::Settings(document.scene().settings));
    document.apply(Edit::Light(7, light(0.0)));
    let foreign = {
        let mut larger = scene();
        larger.add(Node::shape("third", Shape::Sphere))
    };
    document.apply(Edit::Hidden(foreign, true));
    assert_eq!(document.revision(), revision);
    assert!(!document.can_undo());
}

#[test]
fn an_edit_after_undo_forgets_what_was_undone() {
    let mut document = document();
    document.apply(moved(1.0));
    document.undo();
    document.apply(Edit::Tone(Tone { exposure: 1.0, ..Tone::default() }));
    assert!(!document.can_redo());
    assert_eq!(document.undo_name(), Some(EditKind::Tone));
}

#[test]
fn revisions_differ_between_documents_and_return_with_undo() {
    let (mut a, b) = (document(), document());
    assert_ne!(a.revision(), b.revision());
    let loaded = a.revision();
    a.apply(moved(1.0));
    let edited = a.revision();
    assert_ne!(edited, loaded);
    a.undo();
    assert_eq!(a.revision(), loaded);
    a.redo();
    assert_eq!(a.revision(), edited);
}

#[test]
fn a_renderer_keeps_the_scene_that_it_was_given() {
    let mut document = document();
    let given = Arc::clone(document.scene());
    document.apply(moved(1.0));
    assert_eq!(*given, scene());
}

#[test]
fn a_saved_document_is_changed_on_both_sides_of_the_saved_state() {
    let mut document = document();
    document.apply(moved(1.0));
    document.mark_saved();
    assert!(!document.is_changed());
    document.apply(moved(2.0));
    assert!(document.is_changed());
    document.undo();
    assert!(!document.is_changed(), "the save ended the gesture");
    document.undo();
    assert!(document.is_changed());
}

#[test]
fn revert_is_one_step_back_to_what_was_saved() {
    let mut document = document();
    document.apply(moved(1.0));
    document.mark_saved();
    document.apply(Edit::Lights(vec![]));
    document.apply(Edit::Hidden(nodes()[1], true));
    let edited = Arc::clone(document.scene());
    document.revert();
    assert!(!document.is_changed());
    assert_eq!(document.scene(), document.saved());
    assert_eq!(document.undo(), Some(EditKind::Revert));
    assert_eq!(**document.scene(), *edited);
    assert!(document.is_changed());
}

#[test]
fn every_kind_is_named_in_both_languages() {
    for kind in EditKind::ALL {
        let [english, french] = Language::ALL.map(|language| kind.undo_text(language));
        assert!(english.starts_with("Undo ") && french.starts_with("Annuler : "));
        assert!(english.len() > "Undo ".len() && french.len() > "Annuler : ".len());
    }
    assert_eq!(EditKind::Material.undo_text(Language::English), "Undo Material");
    assert_eq!(EditKind::Material.redo_text(Language::French), "Rétablir : Matériau");
}

#[derive(Clone, Debug)]
enum Act {
    Apply(Edit),
    EndGesture,
    Undo,
    Redo,
    Save,
    Revert,
}

/// Few values, so that edits often meet, join and change nothing.
fn any_edit() -> impl Strategy<Value = Edit> {
    (0..12, 0..2_usize, 0..3_u8).prop_map(|(kind, which, value)| {
        let (node, material, number) = (nodes()[which], materials()[which], f64::from(value));
        match kind {
            0 => Edit::Settings(Settings { depth: u32::from(value), ..Settings::default() }),
            1 => Edit::Tone(Tone { exposure: number, ..Tone::default() }),
            2 => Edit::Ambient(Rgb::grey(number)),
            3 => Edit::Background(Rgb::grey(number)),
            4 => Edit::Material(material, Box::new(Material { ior: number, ..Material::named("new") })),
            5 => Edit::Lights(vec![light(number); usize::from(value)]),
            6 => Edit::Light(which, light(number)),
            7 => Edit::Transform(node, Transform::translate(DVec3::X * number)),
            8 => Edit::Hidden(node, value == 1),
            9 => Edit::NodeMaterial(node, (value > 0).then_some(material)),
            10 => Edit::NodeName(node, format!("node {value}")),
            _ => Edit::SceneCamera(Camera { fov: 10.0 + number, ..Camera::default() }),
        }
    })
}

fn any_act() -> impl Strategy<Value = Act> {
    prop_oneof![
        6 => any_edit().prop_map(Act::Apply),
        2 => Just(Act::EndGesture),
        3 => Just(Act::Undo),
        2 => Just(Act::Redo),
        1 => Just(Act::Save),
        1 => Just(Act::Revert),
    ]
}

/// The history as a pile of whole scenes, which needs no inverse of anything.
struct Replay {
    scenes: Vec<Scene>,
    now: usize,
    saved: Scene,
}

impl Replay {
    fn go_to(&mut self, scene: Scene) {
        self.scenes.truncate(self.now + 1);
        self.scenes.push(scene);
        self.now += 1;
    }

    fn act(&mut self, act: &Act) {
        let mut scene = self.scenes[self.now].clone();
        match act {
            Act::Apply(edit) if edit.would_change(&scene) => {
                edit.clone().swap(&mut scene);
                self.go_to(scene);
            }
            Act::Revert if scene != self.saved => self.go_to(self.saved.clone()),
            Act::Undo => self.now = self.now.saturating_sub(1),
            Act::Redo => self.now = (self.now + 1).min(self.scenes.len() - 1),
            Act::Save => self.saved = scene,
            Act::Apply(_) | Act::Revert | Act::EndGesture => {}
        }
    }
}

fn act(document: &mut Document, act: &Act) {
    match act {
        Act::Apply(edit) => document.apply(edit.clone()),
        Act::EndGesture => document.end_gesture(),
        Act::Undo => drop(document.undo()),
        Act::Redo => drop(document.redo()),
        Act::Save => document.mark_saved(),
        Act::Revert => document.revert(),
    }
}

proptest! {
    #[test]
    fn edits_undos_and_redos_equal_those_of_a_pile_of_whole_scenes(
        acts in prop::collection::vec(any_act(), 0..60)
    ) {
        let mut document = document();
        let mut replay = Replay { scenes: vec![scene()], now: 0, saved: scene() };
        for each in &acts {
            // A revert from a state that equals the saved one by another way is a step here and none there.
            if matches!(each, Act::Revert) && document.is_changed() && *document.scene() == *document.saved() {
                continue;
            }
            act(&mut document, each);
            document.end_gesture();
            replay.act(each);
            prop_assert_eq!(&**document.scene(), &replay.scenes[replay.now]);
            prop_assert_eq!(document.can_undo(), replay.now > 0);
            prop_assert_eq!(document.can_redo(), replay.now + 1 < replay.scenes.len());
            prop_assert!(document.is_changed() || *document.scene() == *document.saved());
        }
    }

    #[test]
    fn undoing_all_gives_the_loaded_scene_and_redoing_all_the_edited_one(
        acts in prop::collection::vec(any_act(), 0..60)
    ) {
        let mut document = document();
        for each in &acts {
            act(&mut document, each);
        }
        while document.redo().is_some() {}
        let (edited, revision) = (Arc::clone(document.scene()), document.revision());
        while document.undo().is_some() {}
        prop_assert_eq!(&**document.scene(), &scene());
        while document.redo().is_some() {}
        prop_assert_eq!(document.scene(), &edited);
        prop_assert_eq!(document.revision(), revision);
    }
}

#[test]
fn showing_all_is_one_step_and_undo_hides_again_what_was_hidden() {
    let mut document = document();
    let loaded = Arc::clone(document.scene());
    for id in loaded.node_ids() {
        document.apply(Edit::Hidden(id, true));
        document.end_gesture();
    }
    let hidden = Arc::clone(document.scene());
    document.show_all();
    assert_eq!(document.scene(), &loaded);
    assert_eq!(document.undo(), Some(EditKind::Hidden));
    assert_eq!(document.scene(), &hidden);
}
