//! The tree by its accessible names, in both languages, and what it says.

use super::*;
use crate::Source;
use eframe::egui::PointerButton;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Material, Node, Shape as SceneShape};

/// A tree over a document that the actions are carried out on.
struct World {
    state: TreeState,
    document: Document,
    selection: Selection,
    language: Language,
    actions: Vec<Action>,
}

impl World {
    fn carry_out(&mut self, action: Action) {
        match &action {
            Action::Edit(edit) => self.document.apply(edit.clone()),
            Action::EndGesture => self.document.end_gesture(),
            Action::Select(selection) => self.selection = *selection,
            _ => {}
        }
        self.actions.push(action);
    }
}

/// A table with a cup and a nameless ball on it; a lamp; a camera.
fn scene() -> Scene {
    let mut scene = Scene::new("still life");
    scene.add_material(Material::named("clay"));
    let table = scene.add(Node::group("table", []));
    scene.add_child(table, Node::shape("cup", SceneShape::Cylinder { capped: true }));
    scene.add_child(table, Node::shape("", SceneShape::Sphere));
    scene.add_light(DVec3::Y, Rgb::WHITE);
    scene.lights[0].name = "lamp".into();
    scene.cameras.push(("close".into(), scene.camera));
    scene
}

fn window_of(scene: Scene, language: Language) -> Harness<'static, World> {
    let world = World {
        state: TreeState::default(),
        document: Document::new(Source::File("still life.yaml".into()), scene),
        selection: Selection::None,
        language,
        actions: Vec::new(),
    };
    let draw = |ui: &mut Ui, world: &mut World| {
        let mut actions = Vec::new();
        show(ui, &world.document, world.selection, &mut world.state, world.language, &mut actions);
        actions.into_iter().for_each(|action| world.carry_out(action));
    };
    // Short steps, so that two clicks can be one double click.
    crate::theme::test_window([280.0, 400.0])
        .with_step_dt(0.02)
        .with_max_steps(40)
        .build_ui_state(draw, world)
}

fn window(language: Language) -> Harness<'static, World> {
    window_of(scene(), language)
}

fn click(window: &mut Harness<World>, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).click();
    window.run();
}

fn press(window: &mut Harness<World>, key: Button) {
    window.key_press(key);
    window.run();
}

fn has(window: &Harness<World>, name: &str) -> bool {
    window.query_by_role_and_label(Role::TreeItem, name).is_some()
}

fn node_named(window: &Harness<World>, name: &str) -> NodeId {
    let scene = window.state().document.scene();
    let table = scene.roots()[0];
    std::iter::once(table)
        .chain(scene.node(table).children.iter().copied())
        .find(|id| scene.node(*id).name == name)
        .unwrap()
}

#[test]
fn lists_and_what_has_no_name_are_named_in_both_languages() {
    let words = [
        (Language::English, ["Objects", "Lights", "Materials", "Cameras", "Main camera", "Sphere"]),
        (Language::French, ["Objets", "Lumières", "Matériaux", "Caméras", "Caméra principale", "Sphère"]),
    ];
    for (language, words) in words {
        let mut window = window(language);
        click(&mut window, Role::TreeItem, words[3]);
        click(&mut window, Role::TreeItem, "table");
        press(&mut window, Button::ArrowRight);
        for word in words {
            assert!(has(&window, word), "{word}");
        }
    }
}

#[test]
fn a_click_selects_nodes_lights_and_materials() {
    let mut window = window(Language::English);
    let table = node_named(&window, "table");
    click(&mut window, Role::TreeItem, "table");
    assert_eq!(window.state().selection, Selection::Node(table));
    click(&mut window, Role::TreeItem, "lamp");
    assert_eq!(window.state().selection, Selection::Light(0));
    click(&mut window, Role::TreeItem, "clay");
    assert!(matches!(window.state().selection, Selection::Material(id) if id.index() == 0));
}

#[test]
fn a_click_on_the_sign_unfolds_and_folds_without_selecting() {
    for (language, unfold, fold) in [
        (Language::English, "Unfold table", "Fold table"),
        (Language::French, "Déplier table", "Replier table"),
    ] {
        let mut window = window(language);
        assert!(!has(&window, "cup"));
        click(&mut window, Role::DisclosureTriangle, unfold);
        assert!(has(&window, "cup"));
        click(&mut window, Role::DisclosureTriangle, fold);
        assert!(!has(&window, "cup"));
        assert_eq!(window.state().selection, Selection::None);
    }
}

#[test]
fn the_eye_hides_and_shows_as_one_step_of_the_history_each() {
    for (language, eye) in [(Language::English, "Visible: table"), (Language::French, "Visible : table")] {
        let mut window = window(language);
        let table = node_named(&window, "table");
        click(&mut window, Role::CheckBox, eye);
        assert!(window.state().document.scene().node(table).hidden);
        click(&mut window, Role::CheckBox, eye);
        assert!(!window.state().document.scene().node(table).hidden);
        window.state_mut().document.undo();
        assert!(window.state().document.scene().node(table).hidden);
    }
}

#[test]
fn a_double_click_frames() {
    let mut window = window(Language::English);
    let at = window.get_by_role_and_label(Role::TreeItem, "table").rect().center();
    for pressed in [true, false, true, false] {
        window.hover_at(at);
        let button = PointerButton::Primary;
        window.event(eframe::egui::Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    let table = node_named(&window, "table");
    let framed = |action: &Action| matches!(action, Action::Frame(Selection::Node(id)) if *id == table);
    assert!(window.state().actions.iter().any(framed));
}

#[test]
fn a_camera_is_looked_through() {
    let mut window = window(Language::English);
    click(&mut window, Role::TreeItem, "Cameras");
    click(&mut window, Role::TreeItem, "close");
    assert!(matches!(window.state().actions.last(), Some(Action::UseCamera(Some(name))) if name == "close"));
    click(&mut window, Role::TreeItem, "Main camera");
    assert!(matches!(window.state().actions.last(), Some(Action::UseCamera(None))));
}

#[test]
fn the_keys_go_through_the_tree() {
    let mut window = window(Language::English);
    let [table, cup] = ["table", "cup"].map(|name| node_named(&window, name));
    click(&mut window, Role::TreeItem, "table");
    press(&mut window, Button::ArrowRight);
    assert!(has(&window, "cup"), "right unfolds");
    press(&mut window, Button::ArrowRight);
    assert_eq!(window.state().selection, Selection::Node(cup), "right goes in");
    press(&mut window, Button::H);
    assert!(window.state().document.scene().node(cup).hidden, "H hides");
    press(&mut window, Button::Enter);
    assert!(matches!(window.state().actions.last(), Some(Action::Frame(Selection::Node(id))) if *id == cup));
    press(&mut window, Button::ArrowLeft);
    assert_eq!(window.state().selection, Selection::Node(table), "left goes out");
    press(&mut window, Button::ArrowLeft);
    assert!(!has(&window, "cup"), "left folds");
    press(&mut window, Button::ArrowDown);
    press(&mut window, Button::ArrowDown);
    assert_eq!(window.state().selection, Selection::Light(0), "down goes over the head of a list");
    press(&mut window, Button::ArrowUp);
    press(&mut window, Button::ArrowUp);
    assert_eq!(window.state().selection, Selection::Node(table));
}

#[test]
fn the_tabulator_stops_at_one_row_and_goes_on() {
    let mut window = window(Language::English);
    let focused = |window: &Harness<World>| {
        let rows = window.get_all_by_role(Role::TreeItem);
        rows.filter(egui_kittest::Node::is_focused)
            .filter_map(|row| row.accesskit_node().label())
            .collect::<Vec<_>>()
    };
    press(&mut window, Button::Tab);
    assert_eq!(focused(&window), ["Objects"]);
    press(&mut window, Button::ArrowDown);
    assert_eq!(focused(&window), ["table"]);
}

#[test]
fn what_is_selected_elsewhere_is_unfolded_and_scrolled_to() {
    let mut scene = Scene::new("long");
    for i in 0..500 {
        scene.add(Node::group(format!("group {i}"), []));
    }
    let last = *scene.roots().last().unwrap();
    let child = scene.add_child(last, Node::shape("the one", SceneShape::Cube));
    let mut window = window_of(scene, Language::English);
    assert!(!has(&window, "the one"));
    window.state_mut().selection = Selection::Node(child);
    window.run();
    assert!(has(&window, "the one"));
    assert!(!has(&window, "group 0"));
    press(&mut window, Button::Tab);
    press(&mut window, Button::Home);
    assert!(has(&window, "group 0"), "the list follows the keys");
    press(&mut window, Button::End);
    assert!(has(&window, "Cameras"));
}

#[test]
fn only_the_rows_in_sight_are_drawn() {
    let window = window_of(lancer_gallery::find("ten-thousand").unwrap().build(), Language::English);
    assert!(window.state().state.rows.len() > 10);
    let mut scene = Scene::new("many");
    for _ in 0..66_000 {
        scene.add(Node::shape("", SceneShape::Sphere));
    }
    let window = window_of(scene, Language::English);
    assert!(window.get_all_by_role(Role::TreeItem).count() < 40);
}
