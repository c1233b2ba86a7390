//! What is seen where.

use super::*;
use crate::integrator::{Listener, RayCounts, Scratch, Whitted};
use crate::sampling::Key;
use crate::scene::MaterialId;
use crate::world::{Intersection, Media, ObjectId};

fn features(scene: &Scene, width: u32, height: u32) -> (World, Features) {
    let world = World::compile(scene, &CompileOptions::default()).unwrap();
    let features = render_features(&world, &scene.camera, width, height, &CancelToken::default()).unwrap();
    (world, features)
}

fn ball_scene() -> Scene {
    let mut scene = Scene::new("ball");
    let red = scene.add_material(Material::named("red"));
    scene.add(Node::shape("ball", Shape::Sphere).with_material(red));
    scene
}

#[test]
fn a_ball_is_seen_at_its_nearest_point_and_nothing_beside_it() {
    let scene = ball_scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let at = |x: f64, y: f64| feature_at(&world, &scene.camera, 100, 80, x, y).unwrap();
    let found = at(50.0, 40.0).unwrap();
    assert_eq!((found.node, found.material), (scene.roots()[0], MaterialId::from_index(0)));
    assert_eq!((found.distance, found.point), (4.0, DVec3::Z));
    assert_eq!((found.geometric_normal, found.shading_normal), (DVec3::Z, DVec3::Z));
    for (x, y) in [(0.0, 0.0), (-1e9, 40.0), (f64::NAN, 40.0), (50.0, f64::INFINITY)] {
        assert_eq!(at(x, y), None, "{x}, {y}");
    }
}

#[test]
fn normals_face_the_eye_from_inside_too() {
    let mut scene = ball_scene();
    scene.camera.eye = DVec3::Z * 0.5;
    let (world, features) = features(&scene, 9, 9);
    let seen = feature_at(&world, &scene.camera, 9, 9, 4.5, 4.5).unwrap().unwrap();
    assert_eq!((seen.point, seen.geometric_normal), (DVec3::NEG_Z, DVec3::Z));
    assert_eq!((features.normal(4, 4), features.distance(4, 4)), (Some(DVec3::Z), Some(1.5)));
}

#[test]
fn the_features_of_a_pixel_are_those_at_its_center() {
    let scene = scene();
    let (world, features) = features(&scene, 61, 47);
    assert_eq!((features.width(), features.height()), (61, 47));
    let mut nothing = 0;
    for (x, y) in (0..61).flat_map(|x| (0..47).map(move |y| (x, y))) {
        let center = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let expected = feature_at(&world, &scene.camera, 61, 47, center.0, center.1).unwrap();
        assert_eq!(features.object(x, y), expected.map(|it| it.object));
        assert_eq!(features.node(x, y), expected.map(|it| it.node));
        assert_eq!(features.material(x, y), expected.map(|it| it.material));
        assert_eq!(features.distance(x, y), expected.map(|it| f64::from(it.distance as f32)));
        let normal = expected.map(|it| it.shading_normal.as_vec3().as_dvec3());
        assert_eq!(features.normal(x, y), normal);
        nothing += u32::from(expected.is_none());
    }
    assert!(nothing > 0 && nothing < 61 * 47);
}

/// Hears of the first surface.
#[derive(Default)]
struct First(Option<(ObjectId, DVec3)>);

impl Listener for First {
    fn surface(&mut self, at: &Intersection, _: Rgb) {
        self.0.get_or_insert((at.object, at.point));
    }
}

#[test]
fn what_is_seen_is_what_the_picture_shows() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let integrator = Whitted::new(&world, &scene.settings);
    let projection = scene.camera.project(61, 47).unwrap();
    let media = Media::around(&world, scene.camera.eye);
    for (x, y) in (0..61).flat_map(|x| (0..47).map(move |y| (f64::from(x), f64::from(y)))) {
        let mut first = First::default();
        let (scratch, counts) = (&mut Scratch::default(), &mut RayCounts::default());
        let key = Key::camera(0, 0, 0);
        integrator.radiance(projection.ray(x, y), &media, key, scratch, counts, &mut first);
        let found = feature_at(&world, &scene.camera, 61, 47, x, y).unwrap();
        assert_eq!(found.map(|it| (it.object, it.point)), first.0, "{x}, {y}");
    }
}

#[test]
fn of_a_table_and_the_glass_that_touches_it_the_table_is_seen() {
    let mut scene = Scene::new("inlay");
    let glass = scene.add_material(Material { transmit: Rgb::WHITE, ..Material::named("glass") });
    let inlay = Transform::translate(DVec3::NEG_Y);
    scene.add(Node::shape("inlay", Shape::Cube).with_material(glass).with_transform(inlay));
    let table = scene.add(Node::shape("table", Shape::Plane));
    scene.camera.eye = DVec3::new(0.3, 4.0, 1.0);
    let (world, features) = features(&scene, 9, 9);
    let middle = scene.camera.project(9, 9).unwrap().ray(4.5, 4.5);
    let first = world.intersect(&middle).unwrap().object;
    assert_ne!(world.object(first).node(), table, "the first hit would be wrong");
    assert_eq!(features.node(4, 4), Some(table));
}

#[test]
fn features_are_refused_and_cancelled_as_a_picture_is() {
    let scene = ball_scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let of = |camera: &Camera, width: u32, cancel: &CancelToken| {
        render_features(&world, camera, width, 8, cancel).map(drop)
    };
    let cancel = CancelToken::default();
    assert_eq!(of(&scene.camera, 8, &cancel), Ok(()));
    assert!(matches!(of(&scene.camera, 0, &cancel), Err(RenderError::Settings(_))));
    let nowhere = Camera { target: scene.camera.eye, ..scene.camera };
    assert!(matches!(of(&nowhere, 8, &cancel), Err(RenderError::Camera(_))));
    cancel.cancel();
    assert_eq!(of(&scene.camera, 8, &cancel), Err(RenderError::Cancelled));
}
