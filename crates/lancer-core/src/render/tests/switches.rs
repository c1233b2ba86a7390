//! Terms turned off by the settings, against scenes that do not have them.

use super::*;

fn render_scene(scene: &Scene, settings: &Settings) -> Render {
    let world = World::compile(scene, &CompileOptions::default()).unwrap();
    render(&world, &scene.camera, settings, None, &Control::default()).unwrap()
}

/// The scene with each material changed.
fn with_materials(change: impl Fn(&mut Material)) -> Scene {
    let mut scene = scene();
    scene.materials_mut().iter_mut().for_each(change);
    scene
}

#[test]
fn without_reflection_the_picture_is_that_of_no_k_r() {
    let off = Settings { reflection: false, ..scene().settings };
    let found = render_scene(&scene(), &off);
    let black = with_materials(|material| material.reflect = Rgb::BLACK);
    let expected = render_scene(&black, &black.settings);
    assert_eq!(bits(&found), bits(&expected));
    assert_eq!((found.rays, found.rays.reflection), (expected.rays, 0));
}

#[test]
fn without_refraction_the_picture_is_that_of_no_k_t() {
    let off = Settings { refraction: false, ..scene().settings };
    let found = render_scene(&scene(), &off);
    let opaque = with_materials(|material| material.transmit = Rgb::BLACK);
    let expected = render_scene(&opaque, &opaque.settings);
    assert_eq!(bits(&found), bits(&expected));
    assert_eq!((found.rays, found.rays.refraction), (expected.rays, 0));
}

#[test]
fn a_picture_with_a_hidden_node_is_that_of_the_scene_without_it() {
    for root in 0..scene().roots().len() {
        let with = |change: fn(&mut Node)| {
            let mut scene = scene();
            let id = scene.roots()[root];
            change(scene.node_mut(id));
            render_scene(&scene, &scene.settings)
        };
        let found = with(|node| node.hidden = true);
        let expected = with(|node| (node.shape, node.children) = (None, Vec::new()));
        assert_eq!(bits(&found), bits(&expected), "root {root}");
        assert_eq!(found.rays, expected.rays, "root {root}");
    }
}
