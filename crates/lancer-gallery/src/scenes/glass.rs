//! Refraction in nested dielectrics: water in glass, air in glass, and total internal reflection in a prism.

use crate::BuiltinScene;
use crate::parts::{Finish, at, checker, clear, lacquer, lamp, lathe, matte, scale, standing, stretch, turn};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{MaterialId, Node, Scene, Settings, Shape};

/// A table of glass things.
pub(crate) struct Glass;

/// The dielectrics of the table.
struct Clear {
    glass: MaterialId,
    water: MaterialId,
    /// What a bubble and the empty part of a tumbler are filled with: a thing of index 1 within a thing of glass.
    air: MaterialId,
}

impl BuiltinScene for Glass {
    fn name(&self) -> &'static str {
        "glass"
    }

    fn summary(&self) -> &'static str {
        "A tumbler of water, a ball, a block with bubbles and a prism that reflects totally"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("glass");
        scene.camera = Camera {
            eye: DVec3::new(0.4, 2.1, 9.6),
            target: DVec3::new(0.1, 1.2, 0.0),
            fov: 32.0,
            ..Camera::default()
        };
        let tumbler =
            Camera { eye: DVec3::new(-2.0, 2.4, 4.6), target: DVec3::new(-2.3, 1.2, 0.0), ..scene.camera };
        let prism =
            Camera { eye: DVec3::new(1.2, 1.6, 6.0), target: DVec3::new(1.2, 0.75, 1.6), ..scene.camera };
        scene.cameras = vec![("tumbler".into(), tumbler), ("prism".into(), prism)];
        scene.ambient = Rgb::new(0.62, 0.64, 0.68);
        scene.background = Rgb::from_srgb_hex(0xdfe9f2);
        scene.settings = Settings { samples: 3, depth: 6, ..Settings::default() };
        scene.lights = vec![
            // Shadows are hard and black even under glass: from high up they stay small.
            lamp("key", DVec3::new(-1.5, 14.0, 3.0), DVec3::ZERO, Rgb::new(0.42, 0.39, 0.33)),
            lamp("window", DVec3::new(-7.0, 6.0, 8.0), DVec3::ZERO, Rgb::new(0.12, 0.13, 0.15)),
        ];
        add_backdrop(&mut scene);

        let clear = Clear {
            glass: scene.add_material(clear("glass", 1.5, Rgb::new(0.975, 0.99, 0.985))),
            water: scene.add_material(clear("water", 1.33, Rgb::new(0.90, 0.97, 0.99))),
            air: scene.add_material(clear("air", 1.0, Rgb::WHITE)),
        };
        add_tumbler(&mut scene, &clear);
        let ball = scale(0.85).then(at(-0.25, 0.85, 0.1));
        scene.add(Node::shape("ball", Shape::Sphere).with_material(clear.glass).with_transform(ball));
        add_block(&mut scene, &clear);
        add_prism(&mut scene, &clear);
        scene
    }
}

fn add_backdrop(scene: &mut Scene) {
    let cloth = checker(Rgb::from_srgb_hex(0xe9dcc3), Rgb::from_srgb_hex(0xd9c39b), 0.05);
    let cloth = scene.add_material(matte("cloth", cloth));
    scene.add(
        Node::shape("table", Shape::Cylinder { capped: true })
            .with_material(cloth)
            .with_transform(stretch(4.6, 0.2, 4.6).then(at(0.0, -0.2, 0.0))),
    );
    // All around, so that whatever is refracted or reflected, any way, shows it.
    let colors = [0x1d4e89, 0x00a6a6, 0xf4b942, 0xe4572e, 0x8c2f5d];
    let paints =
        colors.map(|hex| scene.add_material(matte(&format!("paint {hex:06x}"), Rgb::from_srgb_hex(hex))));
    for i in 0..60 {
        let place =
            standing(0.7, 16.0, 0.1).then(at(0.0, -8.0, -12.0)).then(turn(DVec3::Y, 6.0 * i as f64 + 3.0));
        let stripe = Node::shape(format!("stripe {i}"), Shape::Cube);
        scene.add(stripe.with_material(paints[i % paints.len()]).with_transform(place));
    }
}

/// Glass around water and air, which touch each other and its rim exactly; and a straw.
fn add_tumbler(scene: &mut Scene, clear: &Clear) {
    let red =
        scene.add_material(lacquer("red straw", checker(Rgb::new(0.8, 0.05, 0.04), Rgb::grey(0.9), 0.1)));
    let round = || Shape::Cylinder { capped: true };
    let part = |name: &str, material, transform: Transform| {
        Node::shape(name, round()).with_material(material).with_transform(transform)
    };
    let parts = [
        part("wall", clear.glass, standing(0.95, 2.4, 0.95)),
        part("water", clear.water, standing(0.86, 1.4, 0.86).then(at(0.0, 0.2, 0.0))),
        part("air", clear.air, standing(0.86, 0.8, 0.86).then(at(0.0, 1.6, 0.0))),
        part("straw", red, standing(0.07, 3.2, 0.07).then(turn(DVec3::Z, -22.0)).then(at(-0.62, 0.27, 0.0))),
    ];
    let parts = parts.map(|part| scene.insert(part));
    scene.add(Node::group("tumbler", parts).with_transform(at(-2.3, 0.0, 0.0)));
}

/// A block with bubbles in it.
fn add_block(scene: &mut Scene, clear: &Clear) {
    let bubbles = [
        (0.30, DVec3::new(0.0, 0.8, 0.0)),
        (0.16, DVec3::new(-0.45, 1.25, 0.2)),
        (0.13, DVec3::new(0.42, 1.35, -0.1)),
        (0.10, DVec3::new(0.35, 0.4, 0.4)),
        (0.08, DVec3::new(-0.4, 0.35, 0.3)),
    ];
    let cube =
        Node::shape("cube", Shape::Cube).with_material(clear.glass).with_transform(standing(0.8, 1.6, 0.8));
    let mut parts = vec![scene.insert(cube)];
    for (i, (radius, center)) in bubbles.into_iter().enumerate() {
        let place = scale(radius).then(Transform::translate(center));
        let bubble =
            Node::shape(format!("bubble {i}"), Shape::Sphere).with_material(clear.air).with_transform(place);
        parts.push(scene.insert(bubble));
    }
    let place = turn(DVec3::Y, 28.0).then(at(2.7, 0.0, -0.7));
    scene.add(Node::group("block", parts).with_transform(place));
}

/// A three-sided prism: what enters one side meets the next beyond the critical angle, and leaves by the third.
fn add_prism(scene: &mut Scene, clear: &Clear) {
    let sides = lathe(&[[0.0, 0.0], [0.6, 0.0], [0.6, 1.4], [0.0, 1.4]], 3, Finish::Cut);
    let place = turn(DVec3::Y, 40.0).then(at(1.28, 0.0, 1.6));
    scene.add(Node::mesh("prism", sides).with_material(clear.glass).with_transform(place));
}
