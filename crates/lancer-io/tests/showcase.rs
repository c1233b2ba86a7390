//! Bare models made into scenes.

use lancer_core::geometry::Bounds;
use lancer_core::geometry::DVec3;
use lancer_core::scene::Scene;
use lancer_core::scene::Settings;
use lancer_io::limits::Limits;
use lancer_io::model::{self, Model, ModelOptions};
use lancer_io::resolver::Resolver;
use lancer_io::showcase::{framing_camera, hide_ground, scene_of_model, turning_camera};

fn obj(text: &str) -> Model {
    let directory = tempfile::TempDir::new().unwrap();
    let path = directory.path().join("model.obj");
    std::fs::write(&path, text).unwrap();
    model::load(&path, &Resolver::for_file(&path, false, Limits::default()), &ModelOptions::default())
        .unwrap()
}

#[test]
fn the_showcase_frames_models_of_any_size_anywhere() {
    for (size, offset) in [(1e-3, 0.0), (1.0, 0.0), (1e3, -1e6), (1.0, 1e5), (0.0, 2.0)] {
        let vertex = |x: f64, y: f64, z: f64| {
            format!("v {} {} {}\n", offset + size * x, offset + size * y, offset + size * z)
        };
        let text = [vertex(0.0, 0.0, 0.0), vertex(1.0, 0.0, 0.5), vertex(0.2, 2.0, 1.0)].concat();
        let model = obj(&(text + "f 1 2 3\n"));
        let bounds = model.bounds();
        let scene = scene_of_model(model);
        scene.settings.validate().unwrap();
        let (tall, wide) = extent_in_picture(&scene, bounds.corners());
        assert!(tall < 1.0 && wide < 1.0, "cut off: {tall} x {wide}");
        assert!(size == 0.0 || tall.max(wide) > 0.85, "too small: {tall} x {wide}");
        let ground = scene.node(scene.roots()[0]).transform.translation().y;
        assert!(ground < bounds.min.y && ground > bounds.min.y - 1e-3 * size.max(2.0));
        assert_eq!(scene.lights.len(), 3);
    }
}

#[test]
fn a_model_that_is_nothing_beside_its_distance_from_the_origin_has_a_camera() {
    for size in ["1e-17", "1e-30", "1e-320"] {
        let model = obj(&format!("v 1 0 0\nv 1 {size} 0\nv 1 0 {size}\nf 1 2 3\n"));
        let scene = scene_of_model(model);
        assert!(scene.camera.frame().is_ok(), "{size}");
        assert!(scene.lights.iter().all(|light| light.position.is_finite()), "{size}");
        let turning = turning_camera(
            Bounds { min: DVec3::ONE, max: DVec3::new(1.0, 1.0, 1.0 + 3e-16) },
            &scene.settings,
        );
        assert!(turning.frame().is_ok());
    }
}

/// How far up and across points reach from the picture's middle; 1 is its edge.
fn extent_in_picture(scene: &Scene, points: [DVec3; 8]) -> (f64, f64) {
    let [right, up, backward] = scene.camera.frame().unwrap();
    let tangent = lancer_core::geometry::portable::tan(0.5 * scene.camera.fov.to_radians());
    let aspect = f64::from(scene.settings.width) / f64::from(scene.settings.height);
    let reach = |axis: DVec3, tangent: f64| {
        let across = |point: &DVec3| {
            let from_eye = *point - scene.camera.eye;
            from_eye.dot(axis).abs() / (-from_eye.dot(backward) * tangent)
        };
        points.iter().map(across).fold(0.0, f64::max)
    };
    (reach(up, tangent), reach(right, tangent * aspect))
}

#[test]
fn a_turning_model_stays_in_the_picture_and_fills_it_from_some_side() {
    let boxes = [(1.0, 1.0, 1.0), (9.0, 1.0, 0.1), (0.1, 5.0, 0.2), (3.0, 0.0, 3.0), (0.0, 0.0, 2.0)];
    for (x, y, z) in boxes {
        let min = DVec3::new(50.0, -20.0, 7.0);
        let bounds = Bounds { min, max: min + DVec3::new(x, y, z) };
        for (width, height) in [(800, 600), (300, 900)] {
            let mut scene = Scene::new("turning");
            scene.settings = Settings { width, height, ..Settings::default() };
            let camera = turning_camera(bounds, &scene.settings);
            let off_axis = (camera.target - bounds.center()).with_y(0.0).length();
            assert!(off_axis < 1e-12 * 50.0, "the target is {off_axis} off the axis");
            let mut largest = 0.0_f64;
            for degrees in 0..360 {
                scene.camera = camera.orbited(DVec3::Y, f64::from(degrees));
                let (tall, wide) = extent_in_picture(&scene, bounds.corners());
                assert!(tall < 1.0 && wide < 1.0, "cut off at {degrees}: {tall} x {wide}");
                largest = largest.max(tall).max(wide);
            }
            assert!(largest > 0.8, "too small: {largest}");
        }
    }
}

#[test]
fn a_model_is_framed_in_pictures_of_any_shape() {
    let bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(4.0, 1.0, 2.0) };
    let mut scene = Scene::new("framed");
    for (width, height) in [(256, 256), (100, 900), (900, 100)] {
        scene.settings = Settings { width, height, ..Settings::default() };
        scene.camera = framing_camera(bounds, &scene.settings);
        let (tall, wide) = extent_in_picture(&scene, bounds.corners());
        assert!(tall < 1.0 && wide < 1.0 && tall.max(wide) > 0.85, "{tall} x {wide}");
    }
}

#[test]
fn without_its_ground_only_the_model_is_drawn() {
    let mut scene = scene_of_model(obj("v -1 0 -1\nv 1 0 1\nv 0 2 0\nf 1 2 3\n"));
    hide_ground(&mut scene);
    let hidden = scene.roots().iter().filter(|id| scene.node(**id).hidden).count();
    assert_eq!((hidden, scene.roots().len()), (1, 2));
    let world = lancer_core::world::World::compile(&scene, &lancer_core::world::CompileOptions::default());
    assert_eq!(world.unwrap().statistics().objects, 1);
}

#[test]
fn light_on_a_white_surface_is_bright_and_not_clipped() {
    let model = obj("v -1 0 -1\nv 1 0 1\nv 0 2 0\nf 1 2 3\n");
    let center = model.bounds().center();
    let scene = scene_of_model(model);
    let facing = |normal: DVec3| {
        let light = |light: &lancer_core::scene::Light| {
            let toward = light.position - center;
            let cosine = toward.normalize().dot(normal).max(0.0);
            light.intensity.r * cosine / (std::f64::consts::PI * toward.length_squared())
        };
        scene.ambient.r + scene.lights.iter().map(light).sum::<f64>()
    };
    let brightest = scene.lights.iter().map(|light| facing((light.position - center).normalize()));
    let brightest = brightest.fold(0.0, f64::max);
    assert!((0.8..1.2).contains(&brightest), "{brightest}");
}

#[test]
fn parts_without_a_material_are_of_plaster() {
    let scene = scene_of_model(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    let group = scene.node(*scene.roots().last().unwrap());
    assert_eq!(scene.material(group.material.unwrap()).name, "plaster");
    assert_eq!(scene.node(group.children[0]).material, None);
}
