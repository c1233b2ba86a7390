//! Reflections of reflections: two facing mirrors, and curved ones that see the whole room.

use crate::BuiltinScene;
use crate::parts::{
    Finish, at, checker, lacquer, lamp, lathe, matte, mirror, ring_profile, scale, standing, stretch, turn,
};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform, portable};
use lancer_core::scene::{MaterialId, Node, Scene, Settings, Shape};
use std::f64::consts::PI;

/// A corridor without an end.
pub(crate) struct Mirrors;

impl BuiltinScene for Mirrors {
    fn name(&self) -> &'static str {
        "mirrors"
    }

    fn summary(&self) -> &'static str {
        "Two facing mirrors with a corridor of reflections, a mirror ball and a mirror bowl"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("mirrors");
        scene.camera = Camera {
            eye: DVec3::new(1.3, 2.6, 5.2),
            target: DVec3::new(-0.1, 1.65, -2.5),
            fov: 46.0,
            ..Camera::default()
        };
        let side =
            Camera { eye: DVec3::new(11.0, 5.0, 5.0), target: DVec3::new(0.0, 1.5, 0.8), ..scene.camera };
        scene.cameras = vec![("side".into(), side)];
        scene.ambient = Rgb::new(0.3, 0.32, 0.38);
        scene.background = Rgb::from_srgb_hex(0x58789f);
        scene.settings = Settings { samples: 3, depth: 48, ..Settings::default() };
        scene.lights = vec![
            lamp("key", DVec3::new(-3.5, 7.0, 2.0), DVec3::ZERO, Rgb::new(0.9, 0.78, 0.6)),
            lamp("fill", DVec3::new(6.0, 6.0, -1.0), DVec3::ZERO, Rgb::new(0.3, 0.36, 0.5)),
        ];

        let floor = checker(Rgb::from_srgb_hex(0xd9c7a8), Rgb::from_srgb_hex(0x6f3b2c), 1.0);
        let floor = scene.add_material(matte("floor", floor));
        scene.add(Node::shape("floor", Shape::Plane).with_material(floor));

        let wood = scene.add_material(lacquer("gilt wood", Rgb::from_srgb_hex(0xb8893a)));
        // Like window glass, it keeps green best: the corridor turns green as it recedes.
        let silver = scene.add_material(mirror("silvered glass", Rgb::new(0.92, 0.955, 0.93)));
        // Not quite parallel, so that the corridor bends aside instead of hiding behind its first image.
        add_framed_mirror(
            &mut scene,
            "far mirror",
            [silver, wood],
            turn(DVec3::Y, 1.5).then(at(0.0, 0.0, -2.5)),
        );
        add_framed_mirror(
            &mut scene,
            "near mirror",
            [silver, wood],
            turn(DVec3::Y, 180.0).then(at(0.0, 0.0, 5.5)),
        );
        add_curved_mirrors(&mut scene);
        add_totem(&mut scene);
        scene
    }
}

/// A standing mirror that faces +z, four units wide and high, in its frame.
fn add_framed_mirror(scene: &mut Scene, name: &str, [glass, wood]: [MaterialId; 2], place: Transform) {
    let mut part = |name: &str, material, transform| {
        scene.insert(Node::shape(name, Shape::Cube).with_material(material).with_transform(transform))
    };
    let post = standing(0.15, 4.3, 0.15);
    let rail = stretch(2.15, 0.15, 0.15);
    let parts = [
        part("pane", glass, standing(2.0, 4.0, 0.02)),
        part("left post", wood, post.then(at(-2.15, 0.0, 0.0))),
        part("right post", wood, post.then(at(2.15, 0.0, 0.0))),
        part("lower rail", wood, rail.then(at(0.0, 0.15, 0.0))),
        part("upper rail", wood, rail.then(at(0.0, 4.15, 0.0))),
    ];
    scene.add(Node::group(name, parts).with_transform(place));
}

fn add_curved_mirrors(scene: &mut Scene) {
    let chrome = scene.add_material(mirror("chrome", Rgb::grey(0.88)));
    let gold = scene.add_material(mirror("gold", Rgb::new(0.95, 0.70, 0.32)));
    scene.add(Node::shape("ball", Shape::Sphere).with_material(chrome).with_transform(at(-2.1, 1.0, -0.5)));

    scene.add(
        Node::mesh("bowl", lathe(&bowl_profile(), 96, Finish::Polished))
            .with_material(gold)
            .with_transform(turn(DVec3::X, 35.0).then(scale(0.7)).then(at(1.95, 0.68, 0.3))),
    );
}

/// Half of a hollow ball: up along the outside, then down along the inside.
fn bowl_profile() -> Vec<[f64; 2]> {
    let arc = |radius: f64| {
        (0..=32).map(move |i| {
            let (sin, cos) = portable::sin_cos(PI / 2.0 * f64::from(i) / 32.0);
            [radius * sin, -radius * cos]
        })
    };
    arc(1.0).chain(arc(0.94).rev()).collect()
}

/// What the mirrors look at: rings on a stick.
fn add_totem(scene: &mut Scene) {
    let colors = [0xc0392b, 0xe08e1b, 0xf2cf4a, 0x2f9e6a, 0x2c6fb3, 0x6b3fa0];
    for (i, hex) in colors.into_iter().enumerate() {
        let name = format!("ring {i}");
        let material = scene.add_material(lacquer(&name, Rgb::from_srgb_hex(hex)));
        let radius = 0.62 - 0.08 * i as f64;
        let ring = lathe(&ring_profile(radius, 0.16, 24), 64, Finish::Polished);
        let place = at(0.0, 0.17 + 0.31 * i as f64, 0.4);
        scene.add(Node::mesh(name, ring).with_material(material).with_transform(place));
    }
}
