//! Edits of a loaded scene, as overrides of its file.

use crate::common::{load_bytes, vector, wood};
use crate::whole::EXAMPLE;
use lancer_core::Rgb;
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::geometry::Transform;
use lancer_core::scene::{Light, Node, Scene, Shape, Texture};
use lancer_io::Loaded;
use lancer_io::scene_file::{Changes, Origins, Unsaved, changes, patch};
use proptest::prelude::*;
use std::path::Path;

const FILE: &str = "
format: 1
ambient: 0.1
lights: [{position: [4, 6, 4], intensity: 200}]
materials:
  glass: {transmit: 0.8}     # clear
  Material.001: {color: {image: wood.png}}
assets:
  lamp: {shape: sphere, material: {color: 0.5}}
objects:
  - {name: ball, shape: sphere, material: glass}
  - name: group
    children:
      - {name: lamp, use: lamp}
      - {name: bunny, shape: {mesh: bunny.obj}}
      - {name: box, shape: cube, material: {diffuse: 0.5}, transform: [{scale: 2}]}
  - {name: floor, shape: plane, material: Material.001}
";

fn load(text: &str) -> Loaded {
    load_bytes(text.as_bytes(), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn edited(text: &str, edit: impl FnOnce(&mut Scene)) -> (Changes, Scene, String) {
    let Loaded { scene: old, origins, .. } = load(text);
    let mut new = old.clone();
    edit(&mut new);
    let found = changes(&old, &new, &origins);
    let patched = patch(Path::new("dir/scene.yaml"), text, &found.overrides);
    (found, new, patched.unwrap_or_else(|error| panic!("{error}")))
}

/// The overrides of an edit, in words, after checking that the file with them is the edited scene.
#[track_caller]
fn overrides(text: &str, edit: impl FnOnce(&mut Scene)) -> Vec<String> {
    let (found, new, patched) = edited(text, edit);
    assert_eq!(found.unsaved, []);
    assert_eq!(load(&patched).scene, new, "{patched}");
    found.overrides.iter().map(|edit| edit.to_string().replacen("--set ", "", 1)).collect()
}

fn unsaved(edit: impl FnOnce(&mut Scene)) -> Vec<Unsaved> {
    edited(FILE, edit).0.unsaved
}

fn node_mut<'a>(scene: &'a mut Scene, name: &str) -> &'a mut Node {
    let mut waiting = scene.roots().to_vec();
    while let Some(id) = waiting.pop() {
        if scene.node(id).name == name {
            return scene.node_mut(id);
        }
        waiting.extend(&scene.node(id).children);
    }
    panic!("there is no `{name}`");
}

#[test]
fn a_scene_that_did_not_change_needs_nothing() {
    assert_eq!(overrides(FILE, |_| {}), [""; 0]);
    assert_eq!(overrides(EXAMPLE, |_| {}), [""; 0]);
}

#[test]
fn each_value_that_changed_is_told_by_its_path() {
    let found = overrides(FILE, |scene| {
        scene.name = "a name".into();
        scene.camera.eye.x = 0.1 + 0.2;
        scene.cameras.push(("side".into(), scene.camera));
        scene.background = Rgb::grey(0.5);
        scene.lights[0].intensity = Rgb::new(1.0, 2.0, 3.0);
        scene.settings.ao.samples = 9;
        scene.settings.shadows = false;
        scene.tone = Tone { exposure: -1.0, curve: ToneCurve::Reinhard };
        scene.materials_mut()[0].ior = 1.3;
        scene.materials_mut()[1].diffuse = Rgb::grey(0.25);
        node_mut(scene, "ball").transform = Transform::translate(vector(1.0, 2.0, 3.0));
        let glass = node_mut(scene, "ball").material;
        node_mut(scene, "box").hidden = true;
        node_mut(scene, "floor").material = glass;
    });
    let expected = [
        "name=a name",
        "background=0.5",
        "camera.eye=[0.30000000000000004, 0, 5]",
        "render.shadows=false",
        "render.exposure=-1",
        "render.tone=reinhard",
        "render.ao.samples=9",
        "lights.0.intensity=[1, 2, 3]",
        "cameras.side={eye: [0.30000000000000004, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 40}",
        "materials.glass.ior=1.3",
        "materials.Material.001.diffuse=0.25",
        "objects.0.transform=[{translate: [1, 2, 3]}]",
        "objects.1.children.2.hidden=true",
        "objects.2.material=glass",
    ];
    let sorted = |mut texts: Vec<String>| {
        texts.sort();
        texts
    };
    assert_eq!(sorted(found), sorted(expected.map(str::to_owned).to_vec()));
}

#[test]
fn a_material_written_in_its_object_is_reached_there() {
    let found = overrides(FILE, |scene| {
        let id = node_mut(scene, "box").material.unwrap();
        scene.materials_mut()[id.index()].color =
            Texture::Checker { even: Rgb::WHITE, odd: Rgb::BLACK, size: 0.5 };
    });
    let color = "{checker: {even: 1, odd: 0, size: 0.5}}";
    assert_eq!(found, [format!("objects.1.children.2.material.color={color}")]);
}

#[test]
fn lights_are_added_and_removed_as_a_list() {
    let light = Light { name: "lamp".into(), position: vector(0.0, 1.0, 0.0), intensity: Rgb::WHITE };
    let (_, _, patched) = edited(FILE, |scene| scene.lights.push(light.clone()));
    let added =
        "lights: [{position: [4, 6, 4], intensity: 200}, {name: lamp, position: [0, 1, 0], intensity: 1}]";
    assert_eq!(patched, FILE.replace("lights: [{position: [4, 6, 4], intensity: 200}]", added));
    overrides(FILE, |scene| scene.lights.push(light));
    assert_eq!(overrides(FILE, |scene| scene.lights.clear()), ["lights=[]"]);
}

#[test]
fn transforms_are_steps_where_these_say_the_same_and_matrices_elsewhere() {
    let of = |transform: Transform| {
        overrides(FILE, |scene| node_mut(scene, "ball").transform = transform).remove(0)
    };
    let scale = |x, y, z| Transform::scale(vector(x, y, z));
    assert_eq!(of(scale(2.0, 2.0, 2.0)), "objects.0.transform=[{scale: 2}]");
    assert_eq!(
        of(scale(1.0, -2.0, 1.0).then(Transform::translate(vector(0.1, 0.0, 0.0)))),
        "objects.0.transform=[{scale: [1, -2, 1]}, {translate: [0.1, 0, 0]}]"
    );
    assert!(
        of(Transform::rotate(vector(1.0, 2.0, 3.0), 30.0)).starts_with("objects.0.transform=[{matrix: [")
    );
    let identity = overrides(FILE, |scene| node_mut(scene, "box").transform = Transform::IDENTITY);
    assert_eq!(identity, ["objects.1.children.2.transform=[]"]);
}

#[test]
fn what_the_file_does_not_hold_is_told() {
    let object = |name: &str| Unsaved::Object(name.into());
    let below = |scene: &mut Scene, name: &str| {
        let child = node_mut(scene, name).children[0];
        scene.node_mut(child).hidden = true;
        scene.node(child).name.clone()
    };
    assert_eq!(unsaved(|scene| _ = below(scene, "lamp")), [object("")]);
    assert_eq!(unsaved(|scene| node_mut(scene, "ball").shape = Some(Shape::Cube)), [object("ball")]);
    assert_eq!(
        unsaved(|scene| node_mut(scene, "bunny").material = node_mut(scene, "ball").material),
        [object("bunny")],
        "it would take the model's own materials away"
    );
    assert_eq!(unsaved(|scene| _ = scene.add(Node::shape("new", Shape::Cube))), [Unsaved::Structure]);
    let image = |scene: &mut Scene| scene.materials_mut()[0].color = wood().into();
    assert_eq!(unsaved(image), [Unsaved::Material("glass".into())]);
    assert_eq!(
        unsaved(|scene| scene.materials_mut()[0].name = "x".into()),
        [Unsaved::Material("glass".into())]
    );
    let in_asset = unsaved(|scene| {
        let child = node_mut(scene, "lamp").children[0];
        let id = scene.node(child).material.unwrap();
        scene.materials_mut()[id.index()].ior = 2.0;
    });
    assert_eq!(in_asset, [Unsaved::Material(String::new())]);
    assert_eq!(unsaved(|scene| scene.cameras.push(("a".into(), scene.camera))), []);
    let Loaded { scene: old, origins, .. } = load(EXAMPLE);
    let mut new = old.clone();
    new.cameras.clear();
    assert_eq!(changes(&old, &new, &origins).unsaved, [Unsaved::Camera("top".into())]);
}

#[test]
fn of_a_scene_that_comes_from_no_file_objects_and_materials_are_unsaved() {
    let old = load(FILE).scene;
    let mut new = old.clone();
    new.camera.fov = 30.0;
    new.materials_mut()[0].ior = 2.0;
    node_mut(&mut new, "ball").hidden = true;
    let found = changes(&old, &new, &Origins::default());
    assert_eq!(found.overrides, ["camera.fov=30".parse().unwrap()]);
    assert_eq!(found.unsaved, [Unsaved::Material("glass".into()), Unsaved::Object("ball".into())]);
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0, Just(1e-300), Just(-1e15), Just(123_456_789.125)]
}

proptest! {
    #[test]
    fn the_file_with_the_changes_is_the_edited_scene(
        numbers in prop::array::uniform6(number()),
        matrix in prop::array::uniform9(-2.0..2.0),
        in_example: bool,
    ) {
        let [a, b, c, d, e, f] = numbers;
        let text = if in_example { EXAMPLE } else { FILE };
        overrides(text, |scene| {
            scene.camera.target = vector(a, b, c);
            scene.camera.eye = vector(a, b, c + 20.0 + d.abs());
            scene.lights[0].position = vector(d, e, f);
            scene.ambient = Rgb::new(a.abs(), b.abs(), b.abs());
            scene.materials_mut()[0].shininess = c.abs();
            let root = scene.roots()[0];
            let [x, y, z] = [0, 3, 6].map(|i| vector(matrix[i], matrix[i + 1], matrix[i + 2]));
            let axes = [x + vector(5.0, 0.0, 0.0), y + vector(0.0, 5.0, 0.0), z + vector(0.0, 0.0, 5.0)];
            scene.node_mut(root).transform =
                Transform::from_columns(axes[0], axes[1], axes[2], vector(e, f, a));
        });
    }
}
