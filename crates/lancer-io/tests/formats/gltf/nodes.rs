//! The tree of nodes, with its cameras and lights.

use super::{gltf, square, with};
use crate::common::{error_of, load, warnings_of};
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Scene, Shape};
use lancer_core::world::{CompileOptions, World};
use lancer_io::showcase::scene_of_model;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::fmt::Write;

#[test]
fn a_mesh_of_many_nodes_is_one_and_transforms_multiply() {
    let nodes = json!([
        {"name": "top", "children": [1, 2], "translation": [10, 0, 0]},
        {"name": "turned", "mesh": 0, "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "scale": [1, 3, 1]},
        {"name": "moved", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]},
    ]);
    let model = gltf(&with(square(), "/nodes", nodes)).unwrap();
    assert_eq!((model.parts.len(), model.triangle_count()), (1, 4));
    let bounds = model.bounds();
    // Scaled to 2 x 6, turned by a right angle to -6..0 x 0..2.
    assert!((bounds.min - DVec3::new(4.0, 0.0, 0.0)).length() < 1e-12, "{bounds:?}");
    assert!((bounds.max - DVec3::new(12.0, 2.0, 5.0)).length() < 1e-12, "{bounds:?}");
    let mut scene = Scene::new("scene");
    let node = model.insert_into(&mut scene);
    scene.add(node);
    let meshes = scene.nodes().iter().filter(|node| matches!(node.shape, Some(Shape::Mesh(_))));
    assert_eq!(meshes.map(|node| node.name.as_str()).collect::<Vec<_>>(), ["turned", "moved"]);
    assert_eq!(World::compile(&scene, &CompileOptions::default()).unwrap().statistics().meshes, 1);
}

#[test]
fn transforms_that_mirror_keep_their_normals() {
    let model = gltf(&with(square(), "/nodes/0/scale", json!([-1, 1, 1]))).unwrap();
    let transform = model.tree.as_ref().unwrap().nodes()[0].transform;
    assert_eq!(transform, Transform::scale(DVec3::new(-1.0, 1.0, 1.0)));
}

#[test]
fn nodes_that_are_flattened_are_left_out_and_told() {
    let nodes = json!([{"mesh": 0, "children": [1]}, {"mesh": 0, "scale": [0, 0, 0]}]);
    let model = gltf(&with(square(), "/nodes", nodes)).unwrap();
    assert_eq!(model.triangle_count(), 2);
    assert_eq!(warnings_of(&model), ["a.gltf: /nodes/1: is not drawn: its transform flattens it"]);
}

#[test]
fn two_parents_and_cycles_are_refused() {
    let nodes = |nodes: Value, roots: Value| {
        error_of(gltf(&with(with(square(), "/nodes", nodes), "/scenes/0/nodes", roots)))
    };
    assert_eq!(
        nodes(json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}]), json!([0, 1])),
        "a.gltf: /nodes/1/children/0: node 2 is a child of node 0 already"
    );
    assert_eq!(
        nodes(json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), json!([0])),
        "a.gltf: /nodes/1/children: the node is below itself"
    );
    assert_eq!(
        nodes(json!([{"children": [1]}, {"mesh": 0}]), json!([1])),
        "a.gltf: /scenes/0/nodes/0: node 1 is no root: it is a child of node 0"
    );
}

#[test]
fn chains_of_a_hundred_thousand_nodes_are_drawn() {
    let depth = 100_000;
    let mut document = square().to_string();
    let mut nodes = String::from("[");
    for next in 1..depth {
        write!(nodes, "{{\"children\":[{next}]}},").unwrap();
    }
    nodes.push_str("{\"mesh\":0}]");
    document = document.replace("[{\"mesh\":0}]", &nodes);
    let model = load("a.gltf", document).unwrap();
    assert_eq!((model.triangle_count(), model.bounds().max), (2, DVec3::new(2.0, 2.0, 0.0)));
    let scene = scene_of_model(model);
    World::compile(&scene, &CompileOptions::default()).unwrap();
}

#[test]
fn long_names_are_cut_off() {
    let document = with(square(), "/meshes/0/name", json!("é".repeat(300)));
    let model = gltf(&document).unwrap();
    assert_eq!(model.parts[0].name, "é".repeat(255));
    assert_eq!(model.tree.unwrap().nodes()[0].name, "é".repeat(255));
}

#[test]
fn cameras_and_lights_stand_where_their_nodes_do() {
    let nodes = json!([
        {"mesh": 0},
        {"translation": [1, 1, 0], "children": [2, 3, 4]},
        {"name": "eye", "camera": 0, "translation": [0, 0, 8]},
        {"name": "lamp", "translation": [0, 3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"name": "sun", "rotation": [1, 0, 0, 0], "extensions": {"KHR_lights_punctual": {"light": 1}}},
    ]);
    let document = with(with(square(), "/nodes", nodes), "/scenes/0/nodes", json!([0, 1]));
    let perspective = json!({"yfov": PI / 3.0, "aspectRatio": 2, "znear": 0.1});
    let document = with(document, "/cameras", json!([{"type": "perspective", "perspective": perspective}]));
    let lights = json!([
        {"type": "point", "color": [1, 0.5, 0], "intensity": 40},
        {"type": "directional", "intensity": 2},
    ]);
    let document = with(document, "/extensions", json!({"KHR_lights_punctual": {"lights": lights}}));
    let model = gltf(&document).unwrap();
    let camera = &model.cameras[0];
    assert_eq!((camera.name.as_str(), camera.aspect), ("eye", Some(2.0)));
    assert!((camera.camera.fov - 60.0).abs() < 1e-12);
    assert_eq!(
        (camera.camera.eye, camera.camera.target),
        (DVec3::new(1.0, 1.0, 8.0), DVec3::new(1.0, 1.0, 0.0))
    );
    assert_eq!(model.lights[0].position, DVec3::new(1.0, 4.0, 0.0));
    assert_eq!(model.lights[0].intensity, Rgb::new(40.0, 20.0, 0.0));
    // A sun turned about x by 180 degrees shines toward +z, from -z, and gives 2 lux wherever the model is.
    let sun = &model.lights[1];
    let from = sun.position - model.bounds().center();
    assert!(from.normalize().dot(DVec3::NEG_Z) > 1.0 - 1e-12);
    assert!((sun.intensity.r / from.length_squared() - 2.0).abs() < 1e-12);
    assert_eq!(
        warnings_of(&model),
        [
            "a.gltf: /extensions/KHR_lights_punctual/lights/1: a directional light is drawn as a point light far away"
        ]
    );

    let scene = scene_of_model(model);
    assert_eq!((scene.settings.width, scene.settings.height), (1200, 600));
    assert_eq!((scene.camera.eye.z, scene.cameras[0].0.as_str()), (8.0, "eye"));
    assert_eq!((scene.lights.len(), scene.roots().len()), (2, 1), "no ground under a scene");
}

#[test]
fn lights_in_candela_are_exposed_for() {
    let light = |intensity: f64| {
        let node =
            json!({"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 3]});
        let document = with(square(), "/nodes/0", node);
        let lights = json!([{"type": "point", "intensity": intensity}]);
        let document = with(document, "/extensions", json!({"KHR_lights_punctual": {"lights": lights}}));
        scene_of_model(gltf(&document).unwrap())
    };
    assert_eq!(light(5.0).tone.exposure, 0.0);
    let bright = light(54_351.0);
    assert!(bright.tone.exposure < -10.0);
    let shown = bright.ambient.g * f64::from(bright.tone.factor());
    assert!((shown - light(5.0).ambient.g).abs() < 1e-6, "ambient light looks as ever");
}
