//! The ambient factor alone.

use super::*;

/// The scene in which c_a is all that is seen: L_a, k_a, S and the background are 1, all else is 0.
fn only_ambient() -> Scene {
    let mut scene = scene();
    (scene.ambient, scene.background) = (Rgb::WHITE, Rgb::WHITE);
    scene.lights.clear();
    scene.settings.depth = 0;
    let glass = scene.materials()[0].transmit;
    let white = Material { ambient: Rgb::WHITE, diffuse: Rgb::BLACK, ..Material::named("white") };
    let white = Material { color: Rgb::WHITE.into(), specular: Rgb::BLACK, ..white };
    let opaque = scene.add_material(white.clone());
    scene.materials_mut()[0] = Material { transmit: glass, ..white };
    for id in scene.roots().to_vec() {
        scene.node_mut(id).material.get_or_insert(opaque);
    }
    scene
}

#[test]
fn occlusion_alone_is_the_picture_of_a_scene_that_is_only_its_ambient_term() {
    let scene = only_ambient();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let region = Some(Region { x: 5, y: 3, width: 50, height: 40 });
    for region in [None, region] {
        let control = Control::default();
        let expected = render(&world, &scene.camera, &scene.settings, region, &control).unwrap();
        let found = render_occlusion(&world, &scene.camera, &scene.settings, region, &control).unwrap();
        assert_eq!(bits(&found), bits(&expected));
        assert_eq!(found.rays, expected.rays);
        assert!(found.rays.ao > 0);
    }
}

#[test]
fn occlusion_depends_on_no_material_and_no_light() {
    let (lit, plain) = (scene(), only_ambient());
    let [found, expected] = [lit, plain].map(|scene| {
        let world = World::compile(&scene, &CompileOptions::default()).unwrap();
        let settings = Settings { depth: 3, ..scene.settings };
        render_occlusion(&world, &scene.camera, &settings, None, &Control::default()).unwrap()
    });
    assert_eq!(bits(&found), bits(&expected));
    assert_eq!(found.rays, expected.rays);
}

#[test]
fn occlusion_is_refused_and_cancelled_as_a_picture_is() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let wide = Settings { width: 0, ..scene.settings };
    let refused = render_occlusion(&world, &scene.camera, &wide, None, &Control::default());
    assert!(matches!(refused, Err(RenderError::Settings(_))));
    let control = Control::default();
    control.cancel.cancel();
    let cancelled = render_occlusion(&world, &scene.camera, &scene.settings, None, &control);
    assert_eq!(cancelled, Err(RenderError::Cancelled));
}
