//! Red, green and blue light from three sides: a shadow of one is the colour of the other two.

use crate::BuiltinScene;
use crate::parts::{at, lacquer, lamp, matte, scale, standing, stretch, turn};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{MaterialId, Node, NodeId, Scene, Settings, Shape};

/// Coloured hard shadows that cross.
pub(crate) struct Shadows;

impl BuiltinScene for Shadows {
    fn name(&self) -> &'static str {
        "shadows"
    }

    fn summary(&self) -> &'static str {
        "Hard shadows of three coloured lights crossing under a colonnade and a lattice"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("shadows");
        scene.camera = Camera {
            eye: DVec3::new(2.5, 11.0, 16.0),
            target: DVec3::new(0.0, 0.3, 0.3),
            fov: 36.0,
            ..Camera::default()
        };
        let overhead = Camera { eye: DVec3::new(0.0, 24.0, 0.1), target: DVec3::ZERO, ..scene.camera };
        scene.cameras = vec![("overhead".into(), overhead)];
        scene.ambient = Rgb::new(0.03, 0.03, 0.05);
        scene.background = Rgb::new(0.004, 0.004, 0.01);
        scene.settings = Settings { samples: 4, depth: 1, ..Settings::default() };
        let colors = [
            ("blue lamp", Rgb::new(0.06, 0.17, 1.0)),
            ("green lamp", Rgb::new(0.04, 0.8, 0.12)),
            ("red lamp", Rgb::new(1.0, 0.08, 0.04)),
        ];
        for (i, (name, color)) in colors.into_iter().enumerate() {
            // 75 degrees: none of the lamps is behind a column as the others see it.
            let around = turn(DVec3::Y, 120.0 * i as f64 + 75.0);
            scene.lights.push(lamp(name, around.point(DVec3::new(16.0, 19.0, 0.0)), DVec3::ZERO, color));
        }

        let plaster = scene.add_material(matte("plaster", Rgb::grey(0.85)));
        let stone = scene.add_material(lacquer("stone", Rgb::grey(0.8)));
        scene.add(
            Node::shape("stage", Shape::Cylinder { capped: true })
                .with_material(plaster)
                .with_transform(stretch(7.2, 0.25, 7.2).then(at(0.0, -0.25, 0.0))),
        );
        scene.add(
            Node::shape("ball", Shape::Sphere)
                .with_material(stone)
                .with_transform(scale(0.9).then(at(0.0, 0.9, 0.0))),
        );
        add_colonnade(&mut scene, stone);
        add_lattice(&mut scene, stone);
        scene
    }
}

/// Nine columns in a ring, each with its foot and its head: one group, used nine times.
fn add_colonnade(scene: &mut Scene, stone: MaterialId) {
    let round = Shape::Cylinder { capped: true };
    let shaft = Node::shape("shaft", round.clone()).with_transform(standing(0.24, 2.6, 0.24));
    let foot = Node::shape("foot", round).with_transform(standing(0.4, 0.2, 0.4));
    let head =
        Node::shape("head", Shape::Cube).with_transform(standing(0.36, 0.2, 0.36).then(at(0.0, 2.6, 0.0)));
    let parts = [shaft, foot, head].map(|part| scene.insert(part));
    let column = scene.insert(Node::group("column", parts));
    for i in 0..9 {
        let place = at(4.6, 0.0, 0.0).then(turn(DVec3::Y, 40.0 * f64::from(i) + 10.0));
        scene.add(Node::group(format!("column {i}"), [column]).with_material(stone).with_transform(place));
    }
}

/// A lattice of thin bars that floats over the ball.
fn add_lattice(scene: &mut Scene, stone: MaterialId) {
    let bars = (-4..=4)
        .map(|i| {
            let bar = Node::shape(format!("bar {i}"), Shape::Cube)
                .with_transform(stretch(1.7, 0.05, 0.05).then(at(0.0, 0.0, 0.4 * f64::from(i))));
            scene.insert(bar)
        })
        .collect::<Vec<NodeId>>();
    let layer = scene.insert(Node::group("bars", bars));
    let crossing = Node::group("crossing bars", [layer]).with_transform(turn(DVec3::Y, 90.0));
    let crossing = scene.insert(crossing);
    scene.add(
        Node::group("lattice", [layer, crossing])
            .with_material(stone)
            .with_transform(turn(DVec3::Y, 15.0).then(at(0.0, 3.6, 0.0))),
    );
}
