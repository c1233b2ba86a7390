//! Models of other files: shared, with their own materials or the scene's.

use crate::common::{Shelf, drawn, load_with, the_error};
use lancer_core::scene::{Scene, Shape};
use lancer_io::model::Crease;
use std::sync::Arc;

fn load(text: &str) -> (Scene, Shelf) {
    let mut shelf = Shelf::default();
    let loaded = load_with(text.as_bytes(), &[], &mut shelf).unwrap_or_else(|error| panic!("{error}"));
    (loaded.scene, shelf)
}

fn materials(scene: &Scene) -> Vec<Option<String>> {
    drawn(scene).into_iter().map(|(_, _, material)| material).collect()
}

#[test]
fn a_material_given_anywhere_in_the_scene_takes_the_place_of_the_models_own() {
    let (scene, shelf) = load(
        "
format: 1
ambient: 1
materials: {red: {}, green: {}}
objects:
  - {shape: {mesh: bunny.obj}}
  - {shape: {mesh: ./bunny.obj}, material: red}
  - {material: green, children: [{shape: {mesh: bunny.obj}}]}
",
    );
    assert_eq!(materials(&scene), [Some("fur".into()), Some("red".into()), Some("green".into())]);
    assert_eq!(shelf.models_read, 1);

    let meshes = scene.nodes().iter().filter_map(|node| match &node.shape {
        Some(Shape::Mesh(mesh)) => Some(mesh),
        _ => None,
    });
    let meshes = meshes.collect::<Vec<_>>();
    assert!(meshes.iter().all(|mesh| Arc::ptr_eq(mesh, meshes[0])));
}

#[test]
fn an_asset_with_a_model_takes_the_material_of_each_place_of_use() {
    let (scene, _) = load(
        "
format: 1
ambient: 1
materials: {red: {}, blue: {}}
assets:
  pair: {children: [{use: bunny}, {use: bunny, material: blue}]}
  bunny: {shape: {mesh: bunny.obj}}
objects:
  - {use: pair}
  - {use: pair, material: red}
",
    );
    let name = |name: &str| Some(name.to_owned());
    assert_eq!(materials(&scene), [name("fur"), name("blue"), name("red"), name("blue")]);
}

#[test]
fn a_model_is_read_once_for_each_crease_angle_that_it_is_asked_with() {
    let (_, shelf) = load(
        "
format: 1
ambient: 1
objects:
  - {shape: {mesh: bunny.obj}}
  - {shape: {mesh: {file: bunny.obj}}}
  - {shape: {mesh: {file: bunny.obj, crease: 30}}}
  - {shape: {mesh: {crease: 30.0, file: ./bunny.obj}}}
  - {shape: {mesh: {file: bunny.obj, crease: 0}}}
",
    );
    let creases = shelf.options.iter().map(|options| options.crease.map(Crease::degrees));
    assert_eq!(creases.collect::<Vec<_>>(), [None, Some(30.0), Some(0.0)]);
}

#[test]
fn faults_of_a_mesh_are_told_where_they_are() {
    let (error, _) = the_error("format: 1\nobjects:\n  - shape: {mesh: {file: gone.obj, crease: 3}}\n");
    assert_eq!(error, "3:26: cannot open `gone.obj`: no such file or directory");
    let (error, _) = the_error("format: 1\nobjects: [{shape: {mesh: {file: bunny.obj, crease: 181}}}]\n");
    assert_eq!(error, "2:52: crease is 181, must be a number from 0 to 180");
    let (error, _) = the_error("format: 1\nobjects: [{shape: {mesh: 3}}]\n");
    assert!(error.starts_with("2:26: "), "{error}");
}

#[test]
fn a_models_warnings_are_handed_on() {
    let text = "format: 1\nambient: 1\nobjects: [{shape: {mesh: bunny.obj}}, {shape: {mesh: bunny.obj}}]\n";
    let loaded = load_with(text.as_bytes(), &[], &mut Shelf::default()).unwrap();
    let warnings = loaded.warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(warnings, ["shelf/bunny.obj: the bunny has no normals"]);
}

#[test]
fn what_cannot_be_loaded_is_told_where_it_is_referred_to() {
    let (error, _) = the_error("format: 1\nobjects:\n  - shape: {mesh: gone.obj}\n");
    assert_eq!(error, "3:19: cannot open `gone.obj`: no such file or directory");
    let (error, _) = the_error("format: 1\nobjects:\n  - shape: {mesh: broken.obj}\n");
    assert_eq!(error, "3:19: cannot load `broken.obj`: shelf/broken.obj:7:3: a face has 2 corners");
    let (error, _) = the_error("format: 1\nobjects: [{shape: cube, material: {color: {image: no.png}}}]\n");
    assert_eq!(error, "2:51: cannot open `no.png`: no such file or directory");
}
