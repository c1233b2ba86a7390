//! Ambient occlusion and nothing else: white clay under a white sky, without a lamp.

use crate::BuiltinScene;
use crate::parts::{Finish, at, lathe, matte, ring_profile, scale, standing, stretch, turn};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{AmbientOcclusion, Node, NodeId, Scene, Settings, Shape};

/// Clay in corners.
pub(crate) struct Occlusion;

impl BuiltinScene for Occlusion {
    fn name(&self) -> &'static str {
        "occlusion"
    }

    fn summary(&self) -> &'static str {
        "White clay without a lamp: winding stairs, a lattice and balls in corners"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("occlusion");
        scene.camera = Camera {
            eye: DVec3::new(9.5, 8.2, 12.0),
            target: DVec3::new(0.15, 1.3, 0.1),
            fov: 30.0,
            ..Camera::default()
        };
        let stairs =
            Camera { eye: DVec3::new(5.0, 5.5, 6.0), target: DVec3::new(0.6, 1.5, -0.4), ..scene.camera };
        scene.cameras = vec![("stairs".into(), stairs)];
        scene.ambient = Rgb::WHITE;
        scene.background = Rgb::from_srgb_hex(0xdf9f84);
        scene.settings = Settings {
            samples: 3,
            depth: 0,
            ao: AmbientOcclusion { samples: 64, distance: 2.5 },
            ..Settings::default()
        };
        let clay = scene.add_material(matte("clay", Rgb::new(0.88, 0.85, 0.80)));
        let parts = [
            add_room(&mut scene),
            add_stairs(&mut scene),
            add_lattice(&mut scene),
            add_still_life(&mut scene),
        ];
        scene.add(Node::group("model", parts).with_material(clay));
        scene
    }
}

/// Adds a part that is drawn by the group it ends up in.
fn part(scene: &mut Scene, name: impl Into<String>, shape: Shape, transform: Transform) -> NodeId {
    scene.insert(Node::shape(name, shape).with_transform(transform))
}

fn add_room(scene: &mut Scene) -> NodeId {
    let slab =
        |half_width, height, half_depth, x, y, z| standing(half_width, height, half_depth).then(at(x, y, z));
    let parts = [
        part(scene, "floor", Shape::Cube, slab(3.5, 0.3, 3.5, 0.0, -0.3, 0.0)),
        part(scene, "back wall", Shape::Cube, slab(3.5, 4.4, 0.15, 0.0, 0.0, -3.35)),
        part(scene, "left wall", Shape::Cube, slab(0.15, 4.4, 3.35, -3.35, 0.0, 0.15)),
        part(scene, "ledge", Shape::Cube, slab(0.6, 1.1, 0.6, -2.6, 0.0, -2.6)),
    ];
    scene.insert(Node::group("room", parts))
}

/// Steps around a column.
fn add_stairs(scene: &mut Scene) -> NodeId {
    let column = Shape::Cylinder { capped: true };
    let mut parts = vec![part(scene, "column", column, standing(0.5, 4.4, 0.5))];
    for i in 0..24 {
        let step = standing(0.55, 0.16, 0.24)
            .then(at(1.0, 0.18 * f64::from(i), 0.0))
            .then(turn(DVec3::Y, 20.0 * f64::from(i) + 200.0));
        parts.push(part(scene, format!("step {i}"), Shape::Cube, step));
    }
    scene.insert(Node::group("stairs", parts).with_transform(at(0.9, 0.0, -1.0)))
}

/// Bars along all three axes: three groups of the same sixteen.
fn add_lattice(scene: &mut Scene) -> NodeId {
    let mut bars = Vec::new();
    for i in 0..4 {
        for j in 0..4 {
            let bar =
                stretch(0.06, 0.66, 0.06).then(at(0.4 * f64::from(i) - 0.6, 0.0, 0.4 * f64::from(j) - 0.6));
            bars.push(part(scene, format!("bar {i} {j}"), Shape::Cube, bar));
        }
    }
    let upright = scene.insert(Node::group("upright bars", bars));
    let across = scene.insert(Node::group("bars along x", [upright]).with_transform(turn(DVec3::Z, 90.0)));
    let along = scene.insert(Node::group("bars along z", [upright]).with_transform(turn(DVec3::X, 90.0)));
    let place = turn(DVec3::Y, 25.0).then(at(-1.6, 0.66, 1.5));
    scene.insert(Node::group("lattice", [upright, across, along]).with_transform(place))
}

fn add_still_life(scene: &mut Scene) -> NodeId {
    let ball = |radius, x, z| scale(radius).then(at(x, radius, z));
    let ring = Shape::Mesh(lathe(&ring_profile(0.5, 0.2, 32), 64, Finish::Polished).into());
    let parts = [
        part(scene, "ball on the ledge", Shape::Sphere, ball(0.5, -2.6, -2.6).then(at(0.0, 1.1, 0.0))),
        part(scene, "ball by the wall", Shape::Sphere, ball(0.6, -2.6, -1.3)),
        part(scene, "small ball", Shape::Sphere, ball(0.3, -1.75, -2.3)),
        part(scene, "front ball", Shape::Sphere, ball(0.55, 0.7, 2.3)),
        part(scene, "ring", ring, at(2.2, 0.2, 2.0)),
        part(scene, "ball in the ring", Shape::Sphere, ball(0.34, 2.2, 2.0)),
    ];
    scene.insert(Node::group("still life", parts))
}
