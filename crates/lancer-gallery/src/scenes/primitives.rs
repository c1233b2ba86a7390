//! Every shape under the transforms that change it most: stretched, sheared, mirrored, and nested.

use crate::BuiltinScene;
use crate::parts::{
    Finish, at, checker, lacquer, lamp, lathe, matte, melt_horizon, ring_profile, scale, standing, stretch,
    turn,
};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{AmbientOcclusion, MaterialId, Node, NodeId, Scene, Settings, Shape};

/// Sphere, cube, cylinder, plane and meshes.
pub(crate) struct Primitives;

impl BuiltinScene for Primitives {
    fn name(&self) -> &'static str {
        "primitives"
    }

    fn summary(&self) -> &'static str {
        "Every shape, stretched, sheared, mirrored and nested"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("primitives");
        scene.camera = Camera {
            eye: DVec3::new(0.0, 4.8, 13.5),
            target: DVec3::new(0.0, 1.3, 0.0),
            fov: 36.0,
            ..Camera::default()
        };
        let above = Camera { eye: DVec3::new(-4.5, 17.5, 8.0), target: DVec3::Y * 0.5, ..scene.camera };
        scene.cameras = vec![("above".into(), above)];
        scene.ambient = Rgb::new(0.36, 0.46, 0.60);
        scene.settings = Settings {
            samples: 3,
            depth: 3,
            ao: AmbientOcclusion { samples: 32, distance: 1.5 },
            ..Settings::default()
        };
        scene.lights = vec![
            lamp("key", DVec3::new(-12.0, 20.0, 14.0), DVec3::ZERO, Rgb::new(0.95, 0.76, 0.50)),
            lamp("fill", DVec3::new(18.0, 14.0, 8.0), DVec3::ZERO, Rgb::new(0.08, 0.12, 0.2)),
        ];
        add_floor(&mut scene);
        add_horns(&mut scene);
        add_front_row(&mut scene);
        scene
    }
}

fn add_floor(scene: &mut Scene) {
    let (light, dark) = (Rgb::from_srgb_hex(0xd5cfc4), Rgb::from_srgb_hex(0xbfb7aa));
    let floor = scene.add_material(matte("floor", checker(light, dark, 1.0)));
    scene.add(Node::shape("floor", Shape::Plane).with_material(floor));
    melt_horizon(scene, (light + dark) * 0.5);
}

/// A chain of groups, each in the space of the one before it, and the same chain again in a mirror.
fn add_horns(scene: &mut Scene) {
    let ivory = scene.add_material(lacquer("ivory", Rgb::from_srgb_hex(0xf2e3c2)));
    let bronze = scene.add_material(lacquer("bronze", Rgb::from_srgb_hex(0x9c5a2c)));
    let step = scale(0.93).then(turn(DVec3::Z, -15.0)).then(turn(DVec3::Y, 9.0)).then(at(0.16, 0.52, 0.0));
    let horn = add_horn(scene, step, [ivory, bronze], 40);

    let stand = turn(DVec3::Z, 30.0).then(scale(1.1)).then(at(1.5, 0.6, -2.2));
    let mirrored = stand.then(stretch(-1.0, 1.0, 1.0));
    scene.add(Node::group("right horn", [horn]).with_transform(stand));
    scene.add(Node::group("left horn", [horn]).with_transform(mirrored));
}

/// A horn of `rings` rings that lies beyond its own first ring; made from the tip, since a node names its
/// children.
fn add_horn(scene: &mut Scene, step: Transform, colors: [MaterialId; 2], rings: usize) -> NodeId {
    let mut horn = None;
    for ring in (0..rings).rev() {
        let node = Node::shape(format!("ring {ring}"), Shape::Sphere)
            .with_transform(stretch(0.62, 0.38, 0.62))
            .with_material(colors[ring % 2]);
        let here = scene.insert(node);
        let group = Node::group(format!("horn from ring {ring}"), horn.into_iter().chain([here]));
        horn = Some(scene.insert(group.with_transform(step)));
    }
    horn.expect("a horn has rings")
}

fn add_front_row(scene: &mut Scene) {
    let white = Rgb::from_srgb_hex(0xf4efe4);
    let mut painted = |name: &str, hex: u32, size: f64| {
        scene.add_material(lacquer(name, checker(Rgb::from_srgb_hex(hex), white, size)))
    };
    let red = painted("red squares", 0xb3261e, 1.0 / 12.0);
    let blue = painted("blue squares", 0x1c4f9c, 0.25);
    let green = painted("green squares", 0x1e7b57, 1.0 / 8.0);
    let yellow = painted("yellow squares", 0xe09a10, 1.0 / 8.0);
    let violet = painted("violet squares", 0x6a3390, 1.0 / 16.0);
    let teal = scene.add_material(lacquer("teal", Rgb::from_srgb_hex(0x168a94)));

    let egg = stretch(0.75, 1.15, 0.75).then(turn(DVec3::Z, 20.0)).then(at(-4.6, 1.12, 0.6));
    scene.add(Node::shape("stretched sphere", Shape::Sphere).with_material(red).with_transform(egg));

    // The y axis leans toward +x: a square becomes a rhomb.
    let shear = Transform::from_columns(DVec3::X, DVec3::new(0.55, 1.0, 0.0), DVec3::Z, DVec3::ZERO);
    let leaning = standing(0.7, 1.6, 0.7).then(shear).then(turn(DVec3::Y, 25.0)).then(at(-2.7, 0.0, 1.6));
    scene.add(Node::shape("sheared cube", Shape::Cube).with_material(blue).with_transform(leaning));

    let column = standing(0.6, 1.9, 0.6).then(at(4.7, 0.0, 0.4));
    scene.add(
        Node::shape("closed cylinder", Shape::Cylinder { capped: true })
            .with_material(green)
            .with_transform(column),
    );
    let pipe =
        stretch(0.7, 0.9, 0.7).then(turn(DVec3::X, 90.0)).then(turn(DVec3::Y, 40.0)).then(at(2.8, 0.7, 2.0));
    scene.add(
        Node::shape("open cylinder", Shape::Cylinder { capped: false })
            .with_material(yellow)
            .with_transform(pipe),
    );

    let torus = lathe(&ring_profile(1.0, 0.42, 32), 64, Finish::Polished);
    let upright = turn(DVec3::X, 90.0).then(turn(DVec3::Y, -20.0)).then(at(0.0, 1.42, -0.6));
    scene.add(Node::mesh("torus", torus).with_material(violet).with_transform(upright));

    let cut = [[0.0, 0.0], [0.75, 0.75], [0.75, 0.85], [0.45, 1.1], [0.0, 1.1]];
    let gem = lathe(&cut, 8, Finish::Cut);
    scene.add(
        Node::mesh("gem", gem)
            .with_material(teal)
            .with_transform(turn(DVec3::Z, -44.0).then(at(-0.2, 0.0, 3.2))),
    );
}
