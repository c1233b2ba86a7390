//! Detail finer than a pixel: squares that run to the horizon, and a wheel of thin spokes.

use crate::BuiltinScene;
use crate::parts::{Finish, at, checker, lacquer, lamp, lathe, matte, ring_profile, stretch, turn};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{MaterialId, Node, NodeId, Scene, Settings, Shape};

/// What n x n subpixels are for.
pub(crate) struct Supersampling;

const SEATS: u32 = 16;
const RADIUS: f64 = 4.0;

impl BuiltinScene for Supersampling {
    fn name(&self) -> &'static str {
        "supersampling"
    }

    fn summary(&self) -> &'static str {
        "A wheel of thin spokes over squares that run to the horizon: render it with 1 sample, then with 4"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("supersampling");
        scene.camera = Camera {
            eye: DVec3::new(-6.5, 2.2, 12.0),
            target: DVec3::new(0.3, 4.3, 0.0),
            fov: 46.0,
            ..Camera::default()
        };
        let hub = Camera { eye: DVec3::new(-2.0, 5.6, 5.0), target: DVec3::Y * 5.0, ..scene.camera };
        let horizon = Camera {
            eye: DVec3::new(0.0, 1.0, 14.0),
            target: DVec3::new(0.0, 0.6, 0.0),
            fov: 12.0,
            ..scene.camera
        };
        scene.cameras = vec![("hub".into(), hub), ("horizon".into(), horizon)];
        scene.ambient = Rgb::new(0.36, 0.42, 0.55);
        scene.background = Rgb::from_srgb_hex(0x8fc1e3);
        scene.settings = Settings { samples: 4, depth: 1, ..Settings::default() };
        scene.lights =
            vec![lamp("sun", DVec3::new(-60.0, 80.0, 70.0), DVec3::ZERO, Rgb::new(1.0, 0.85, 0.62))];

        let squares = checker(Rgb::from_srgb_hex(0xf1e6d0), Rgb::from_srgb_hex(0x3d4f5c), 0.5);
        let squares = scene.add_material(matte("squares", squares));
        scene.add(Node::shape("ground", Shape::Plane).with_material(squares));
        let steel = scene.add_material(lacquer("white steel", Rgb::from_srgb_hex(0xf6f4ee)));
        add_wheel(&mut scene, steel);
        add_stand(&mut scene, steel);
        scene
    }
}

/// Two rims with their spokes, which cross as a bicycle's do, and the seats between them.
fn add_wheel(scene: &mut Scene, steel: MaterialId) {
    let round = Shape::Cylinder { capped: true };
    let lying = turn(DVec3::X, 90.0);
    let rim = lathe(&ring_profile(RADIUS, 0.06, 12), 128, Finish::Polished);
    let mut side = vec![scene.insert(Node::mesh("rim", rim).with_transform(lying))];
    for i in 0..2 * SEATS {
        // A spoke leaves the hub sideways, to the left and to the right by turns.
        let lean = if i % 2 == 0 { 0.35 } else { -0.35 };
        let spoke = stretch(0.012, 0.5 * RADIUS, 0.012)
            .then(at(lean, 0.5 * RADIUS, 0.0))
            .then(turn(DVec3::Z, 360.0 * f64::from(i) / f64::from(2 * SEATS)));
        side.push(scene.insert(Node::shape(format!("spoke {i}"), round.clone()).with_transform(spoke)));
    }
    let side = scene.insert(Node::group("side", side));
    let mut parts = vec![
        scene.insert(Node::group("front side", [side]).with_transform(at(0.0, 0.0, 0.55))),
        scene.insert(Node::group("back side", [side]).with_transform(at(0.0, 0.0, -0.55))),
        scene.insert(Node::shape("hub", round).with_transform(stretch(0.4, 0.7, 0.4).then(lying))),
    ];
    parts.extend(add_seats(scene));
    let wheel = Node::group("wheel", parts).with_material(steel);
    scene.add(wheel.with_transform(turn(DVec3::Z, 5.0).then(at(0.0, 5.0, 0.0))));
}

fn add_seats(scene: &mut Scene) -> Vec<NodeId> {
    let paints = [0xd9402f, 0xf0a818, 0x2a9d6f, 0x2b66b0]
        .map(|hex| scene.add_material(lacquer(&format!("paint {hex:06x}"), Rgb::from_srgb_hex(hex))));
    (0..SEATS)
        .map(|i| {
            let place = stretch(0.28, 0.28, 0.45)
                .then(at(0.0, RADIUS, 0.0))
                .then(turn(DVec3::Z, 360.0 * f64::from(i) / f64::from(SEATS)));
            let seat = Node::shape(format!("seat {i}"), Shape::Sphere);
            scene.insert(seat.with_material(paints[i as usize % paints.len()]).with_transform(place))
        })
        .collect()
}

/// Four legs that meet at the hub.
fn add_stand(scene: &mut Scene, steel: MaterialId) {
    for (i, (lean, z)) in [(26.0, 0.9), (-26.0, 0.9), (26.0, -0.9), (-26.0, -0.9)].into_iter().enumerate() {
        let leg = stretch(0.07, 2.85, 0.07)
            .then(at(0.0, -2.85, 0.0))
            .then(turn(DVec3::Z, lean))
            .then(at(0.0, 5.0, z));
        let node = Node::shape(format!("leg {i}"), Shape::Cylinder { capped: true });
        scene.add(node.with_material(steel).with_transform(leg));
    }
}
