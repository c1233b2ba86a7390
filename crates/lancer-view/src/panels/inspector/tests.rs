//! Each control by its name, in both languages, and what it changes.

use super::*;
use crate::Source;
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Material, Node, Shape, Texture};

/// An inspector over a document that the actions are carried out on.
struct World {
    state: InspectorState,
    document: Document,
    selection: Selection,
    language: Language,
    actions: Vec<Action>,
}

/// A ball of clay, a sheared cube, a spare material and a lamp.
fn scene() -> Scene {
    let mut scene = Scene::new("still life");
    let clay = scene.add_material(Material { diffuse: Rgb::grey(1.0 / 3.0), ..Material::named("clay") });
    scene.add_material(Material::named("gold"));
    scene.add(Node::shape("ball", Shape::Sphere).with_material(clay));
    let shear = Transform::from_columns(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z, DVec3::ZERO);
    scene.add(Node::shape("cube", Shape::Cube).with_transform(shear));
    scene.add_light(DVec3::new(1.0, 2.0, 3.0), Rgb::grey(100.0));
    scene
}

fn window(select: impl Fn(&Scene) -> Selection, language: Language) -> Harness<'static, World> {
    let scene = scene();
    let world = World {
        state: InspectorState::default(),
        selection: select(&scene),
        document: Document::new(Source::File("still life.yaml".into()), scene),
        language,
        actions: Vec::new(),
    };
    let draw = |ui: &mut Ui, world: &mut World| {
        let mut actions = Vec::new();
        show(ui, &world.document, world.selection, &mut world.state, world.language, &mut actions);
        for action in actions {
            match &action {
                Action::Edit(edit) => world.document.apply(edit.clone()),
                Action::EndGesture => world.document.end_gesture(),
                Action::Select(selection) => world.selection = *selection,
                _ => {}
            }
            world.actions.push(action);
        }
    };
    crate::theme::test_window([340.0, 800.0]).build_ui_state(draw, world)
}

fn ball(scene: &Scene) -> Selection {
    Selection::Node(scene.roots()[0])
}

fn clay(scene: &Scene) -> Selection {
    Selection::Material(scene.material_ids().next().unwrap())
}

fn lamp(_: &Scene) -> Selection {
    Selection::Light(0)
}

fn scene_of<'a>(window: &'a Harness<World>) -> &'a Scene {
    window.state().document.scene()
}

fn node_of<'a>(window: &'a Harness<World>) -> &'a Node {
    let scene = scene_of(window);
    scene.node(scene.roots()[0])
}

fn material_of<'a>(window: &'a Harness<World>) -> &'a Material {
    &scene_of(window).materials()[0]
}

/// Types a value into the number of that name.
fn type_number(window: &mut Harness<World>, name: &str, text: &str) {
    window.get_by_role_and_label(Role::SpinButton, name).click();
    window.run();
    let field = window.get_all_by_label(name).find(|node| node.accesskit_node().is_focused()).expect(name);
    field.type_text(text);
    window.run();
    window.key_press(Key::Enter);
    window.run();
}

fn type_text(window: &mut Harness<World>, name: &str, text: &str) {
    window.get_by_role_and_label(Role::TextInput, name).focus();
    window.run();
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.get_by_role_and_label(Role::TextInput, name).type_text(text);
    window.run();
    window.key_press(Key::Enter);
    window.run();
}

fn click(window: &mut Harness<World>, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).click();
    window.run();
}

/// Drags a control to the right by some points, in several moves, and lets go.
fn drag(window: &mut Harness<World>, name: &str, moves: u32) {
    let from = window.get_by_role_and_label(Role::SpinButton, name).rect().center();
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.hover_at(from);
    window.event(button(from, true));
    window.step();
    let mut at = from;
    for _ in 0..moves {
        at = pos2(at.x + 10.0, at.y);
        window.hover_at(at);
        window.step();
    }
    window.event(button(at, false));
    window.run();
}

/// How many steps it takes to undo all.
fn steps(window: &Harness<World>) -> usize {
    let mut document = window.state().document.clone();
    std::iter::from_fn(|| document.undo()).count()
}

#[test]
fn each_number_of_a_material_is_set_by_its_name_in_both_languages() {
    type Get = fn(&Material) -> f64;
    let numbers: [(&str, &str, Get); 8] = [
        ("k_a ambient", "k_a ambiant", |material| material.ambient.g),
        ("k_d diffuse", "k_d diffus", |material| material.diffuse.g),
        ("k_s specular", "k_s spéculaire", |material| material.specular.g),
        ("m metallic", "m métallique", |material| material.metallic.g),
        ("k_r mirror", "k_r miroir", |material| material.reflect.g),
        ("k_t glass", "k_t verre", |material| material.transmit.g),
        ("n shininess", "n brillance", |material| material.shininess),
        ("Refractive index", "Indice optique", |material| material.ior),
    ];
    for language in Language::ALL {
        let mut window = window(clay, language);
        for (english, french, get) in numbers {
            let name = language.say(Phrase::new(english, french));
            type_number(&mut window, name, "0,625");
            assert_eq!(get(material_of(&window)), 0.625, "{name}");
        }
        assert_eq!(steps(&window), numbers.len());
    }
}

#[test]
fn the_colour_the_name_and_fresnel_are_set_in_both_languages() {
    for (language, red, name, fresnel) in [
        (Language::English, "S colour, red", "Name", "Fresnel"),
        (Language::French, "S couleur, rouge", "Nom", "Fresnel"),
    ] {
        let mut window = window(clay, language);
        type_number(&mut window, red, "0.25");
        type_text(&mut window, name, "terra");
        click(&mut window, Role::CheckBox, fresnel);
        let material = material_of(&window);
        assert_eq!(material.color, Texture::Solid(Rgb::new(0.25, 1.0, 1.0)));
        assert_eq!(material.name, "terra");
        assert!(material.fresnel);
    }
}

#[test]
fn a_coefficient_is_one_number_or_one_a_channel() {
    for (language, name, split, blue) in [
        (Language::English, "k_r mirror", "k_r mirror, by channel", "k_r mirror, blue"),
        (Language::French, "k_r miroir", "k_r miroir, par canal", "k_r miroir, bleu"),
    ] {
        let mut window = window(clay, language);
        assert!(window.query_by_role_and_label(Role::SpinButton, blue).is_none());
        click(&mut window, Role::Button, split);
        type_number(&mut window, blue, "0.75");
        assert_eq!(material_of(&window).reflect, Rgb::new(0.0, 0.0, 0.75));
        click(&mut window, Role::Button, split);
        assert_eq!(material_of(&window).reflect, Rgb::grey(0.25));
        assert!(window.query_by_role_and_label(Role::SpinButton, name).is_some());
    }
}

#[test]
fn what_is_out_of_range_is_set_to_the_end_of_it() {
    let mut window = window(clay, Language::English);
    type_number(&mut window, "k_s specular", "-3");
    assert_eq!(material_of(&window).specular, Rgb::BLACK);
    type_number(&mut window, "Refractive index", "0");
    assert_eq!(material_of(&window).ior, 0.01);
}

#[test]
fn a_field_that_is_left_as_it_was_loses_no_decimals() {
    let mut window = window(clay, Language::English);
    window.get_by_role_and_label(Role::SpinButton, "k_d diffuse").click();
    window.run();
    window.key_press(Key::Enter);
    window.run();
    assert_eq!(material_of(&window).diffuse, Rgb::grey(1.0 / 3.0));
    assert_eq!(steps(&window), 0);
}

#[test]
fn a_drag_is_one_step_and_the_next_drag_another() {
    let mut window = window(clay, Language::English);
    drag(&mut window, "n shininess", 5);
    let once = material_of(&window).shininess;
    assert!(once > 32.0);
    assert_eq!(steps(&window), 1);
    drag(&mut window, "n shininess", 5);
    assert!(material_of(&window).shininess > once);
    assert_eq!(steps(&window), 2);
    drag(&mut window, "k_a ambient", 5);
    assert_eq!(steps(&window), 3);
}

#[test]
fn a_value_that_was_changed_can_be_reset_and_one_that_was_not_has_no_button() {
    for (language, name, reset) in [
        (Language::English, "k_a ambient", "Reset k_a ambient"),
        (Language::French, "k_a ambiant", "Rétablir : k_a ambiant"),
    ] {
        let mut window = window(clay, language);
        assert!(window.query_by_label(reset).is_none());
        type_number(&mut window, name, "0.5");
        click(&mut window, Role::Button, reset);
        assert_eq!(*scene_of(&window), scene());
    }
}

#[test]
fn a_node_is_named_and_hidden_in_both_languages() {
    for (language, name) in [(Language::English, "Name"), (Language::French, "Nom")] {
        let mut window = window(ball, language);
        type_text(&mut window, name, "globe");
        click(&mut window, Role::CheckBox, "Visible");
        assert_eq!(node_of(&window).name, "globe");
        assert!(node_of(&window).hidden);
        assert_eq!(steps(&window), 2);
    }
}

#[test]
fn a_node_is_moved_turned_and_scaled_in_both_languages() {
    for (language, scale) in [(Language::English, "Scale"), (Language::French, "Échelle")] {
        let mut window = window(ball, language);
        type_number(&mut window, &format!("{scale}, z"), "2");
        type_number(&mut window, "Rotation, y", "90");
        type_number(&mut window, "Translation, x", "5");
        let expected = Transform::scale(DVec3::new(1.0, 1.0, 2.0))
            .then(Transform::rotate(DVec3::Y, 90.0))
            .then(Transform::translate(DVec3::X * 5.0));
        assert_eq!(node_of(&window).transform, expected);
    }
}

#[test]
fn angles_stay_as_they_were_typed() {
    let mut window = window(ball, Language::English);
    type_number(&mut window, "Rotation, y", "200");
    type_number(&mut window, "Rotation, x", "30");
    let expected = Transform::rotate(DVec3::X, 30.0).then(Transform::rotate(DVec3::Y, 200.0));
    assert_eq!(node_of(&window).transform, expected);
}

#[test]
fn a_node_is_not_flattened_and_it_is_said_why() {
    let mut window = window(ball, Language::English);
    type_number(&mut window, "Scale, x", "0");
    assert_eq!(node_of(&window).transform, Transform::IDENTITY);
    assert!(window.query_by_label_contains("flatten").is_some());
    type_number(&mut window, "Scale, x", "2");
    assert!(window.query_by_label_contains("flatten").is_none());
}

#[test]
fn a_sheared_node_shows_its_matrix_in_both_languages() {
    for (language, entry) in
        [(Language::English, "Matrix, row 1, column 2"), (Language::French, "Matrice, ligne 1, colonne 2")]
    {
        let mut window = window(|scene| Selection::Node(scene.roots()[1]), language);
        type_number(&mut window, entry, "0.25");
        let scene = scene_of(&window);
        assert_eq!(scene.node(scene.roots()[1]).transform.linear().y_axis, DVec3::new(0.25, 1.0, 0.0));
    }
}

#[test]
fn a_node_gets_another_material_or_its_parents_in_both_languages() {
    for (language, list, inherited) in
        [(Language::English, "Material", "As its parent"), (Language::French, "Matériau", "Comme son parent")]
    {
        let mut window = window(ball, language);
        for (entry, index) in [("gold", Some(1)), (inherited, None)] {
            click(&mut window, Role::ComboBox, list);
            click(&mut window, Role::Button, entry);
            assert_eq!(node_of(&window).material.map(lancer_core::scene::MaterialId::index), index);
        }
    }
}

#[test]
fn the_material_of_a_node_is_edited_below_it_and_can_be_selected() {
    for (language, name, button) in [
        (Language::English, "k_d diffuse", "Select the material"),
        (Language::French, "k_d diffus", "Sélectionner le matériau"),
    ] {
        let mut window = window(ball, language);
        type_number(&mut window, name, "0.5");
        assert_eq!(material_of(&window).diffuse, Rgb::grey(0.5));
        click(&mut window, Role::Button, button);
        assert_eq!(window.state().selection, clay(scene_of(&window)));
    }
}

#[test]
fn a_light_is_moved_and_dimmed_in_both_languages() {
    for (language, intensity) in [(Language::English, "L_i intensity"), (Language::French, "L_i intensité")]
    {
        let mut window = window(lamp, language);
        type_number(&mut window, "Position, y", "-4");
        type_number(&mut window, intensity, "50");
        let light = &scene_of(&window).lights[0];
        assert_eq!(light.position, DVec3::new(1.0, -4.0, 3.0));
        assert_eq!(light.intensity, Rgb::grey(50.0));
    }
}

#[test]
fn lights_are_added_and_removed_in_both_languages() {
    for (language, add, remove) in [
        (Language::English, "Add a light", "Remove this light"),
        (Language::French, "Ajouter une lumière", "Supprimer cette lumière"),
    ] {
        let mut window = window(|_| Selection::None, language);
        click(&mut window, Role::Button, add);
        assert_eq!(scene_of(&window).lights.len(), 2);
        assert_eq!(window.state().selection, Selection::Light(1));
        click(&mut window, Role::Button, remove);
        assert_eq!(*scene_of(&window), scene());
        assert_eq!(window.state().selection, Selection::None);
        assert_eq!(steps(&window), 2);
    }
}

#[test]
fn a_selection_that_is_no_longer_there_shows_nothing_to_edit() {
    for selection in [Selection::Light(9), Selection::Material(scene_with_many_materials())] {
        let window = window(move |_| selection, Language::English);
        assert!(window.query_by_role(Role::SpinButton).is_none());
    }
}

fn scene_with_many_materials() -> lancer_core::scene::MaterialId {
    let mut scene = Scene::new("many");
    (0..9).map(|_| scene.add_material(Material::default())).last().unwrap()
}
