//! Balls upon balls upon balls: one subtree a level, drawn 66,430 times.
//!
//! Source: Haines, "A proposal for standard graphics environments" (IEEE Computer Graphics and Applications 7(11),
//! 1987), the scene `balls`. His nine children are here; the turn that shows them best is ours.

use super::sky::Sky;
use crate::BuiltinScene;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Material, MaterialId, Node, NodeId, Scene, Settings, Shape};

/// The scene `sphereflake`.
pub(crate) struct Sphereflake;

impl BuiltinScene for Sphereflake {
    fn name(&self) -> &'static str {
        "sphereflake"
    }

    fn summary(&self) -> &'static str {
        "Haines' flake of 66,430 mirror balls, each level one shared subtree"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("Sphereflake");
        scene.camera = Camera {
            eye: DVec3::new(2.9, 2.0, 7.0),
            target: DVec3::new(0.05, 1.12, 0.0),
            fov: 29.0,
            ..Camera::default()
        };
        let close =
            Camera { eye: DVec3::new(1.3, 1.7, 2.9), target: DVec3::new(0.35, 1.15, 0.7), ..scene.camera };
        scene.cameras.push(("close".into(), close));
        scene.ambient = Rgb::new(0.32, 0.34, 0.4);
        scene.settings = Settings { samples: 3, depth: 3, ..Settings::default() };
        scene.add_light(DVec3::new(-6.0, 10.0, 7.0), Rgb::new(1.0, 0.92, 0.8) * 620.0);
        scene.add_light(DVec3::new(8.0, 5.0, 3.0), Rgb::new(0.55, 0.7, 1.0) * 90.0);
        Sky { zenith: Rgb::from_srgb_hex(0x14224a), horizon: Rgb::from_srgb_hex(0xf0b98c), clearness: 7.0 }
            .put_over(&mut scene, 3000.0);
        ground(&mut scene);
        flake(&mut scene);
        scene
    }
}

/// From the largest ball down: 1 + 9 + 81 + 729 + 6,561 + 59,049 balls.
const LEVELS: [u32; 6] = [0xf0b848, 0xe88a4a, 0xd86060, 0xb468a0, 0x7f8fd8, 0x9fd8ee];

/// A child's radius in its parent's.
const SHRINK: f64 = 1.0 / 3.0;

/// The height in degrees at which the upper three children sit. With six at the equator they are nine of the
/// twelve balls that fit around a thirteenth of their size; the other three would lie toward the parent's own parent.
const UPPER: f64 = 54.735_610_317_245_35;

fn flake(scene: &mut Scene) {
    let mut smaller = None;
    for (level, &color) in LEVELS.iter().enumerate().rev() {
        let material = metal(scene, level, Rgb::from_srgb_hex(color));
        smaller = Some(add_level(scene, level, material, smaller));
    }
    let whole = Transform::rotate(DVec3::Y, 20.0).then(Transform::translate(DVec3::Y));
    scene.add(Node::group("flake", smaller).with_transform(whole));
}

/// A ball of radius 1 with nine smaller flakes upon it, to be used as often as there are balls of its level.
fn add_level(scene: &mut Scene, level: usize, material: MaterialId, smaller: Option<NodeId>) -> NodeId {
    let mut children = Vec::new();
    for seat in smaller.iter().flat_map(|_| seats()) {
        children.push(scene.insert(Node::group("", smaller).with_transform(seat)));
    }
    let ball = Node::shape(format!("ball {level}"), Shape::Sphere).with_material(material);
    scene.insert(Node { children, ..ball })
}

/// Where a ball's children sit, each with its own north pole away from the parent.
fn seats() -> impl Iterator<Item = Transform> {
    let equator = (0..6).map(|i| (90.0, 60.0 * f64::from(i)));
    let upper = (0..3).map(|i| (90.0 - UPPER, 30.0 + 120.0 * f64::from(i)));
    equator.chain(upper).map(|(from_pole, around)| {
        Transform::scale(DVec3::splat(SHRINK))
            .then(Transform::translate(DVec3::Y * (1.0 + SHRINK)))
            .then(Transform::rotate(DVec3::X, from_pole))
            .then(Transform::rotate(DVec3::Y, around))
    })
}

fn metal(scene: &mut Scene, level: usize, color: Rgb) -> MaterialId {
    scene.add_material(Material {
        color: color.into(),
        diffuse: Rgb::grey(0.5),
        ambient: Rgb::grey(0.4),
        specular: Rgb::grey(0.012),
        metallic: Rgb::WHITE,
        shininess: 150.0,
        reflect: color * 0.5 + Rgb::grey(0.15),
        ..Material::named(format!("metal {level}"))
    })
}

fn ground(scene: &mut Scene) {
    let stone = scene.add_material(Material {
        color: Rgb::from_srgb_hex(0x8f9aa8).into(),
        diffuse: Rgb::grey(0.7),
        ambient: Rgb::grey(0.7),
        reflect: Rgb::grey(0.3),
        ..Material::named("polished stone")
    });
    scene.add(Node::shape("ground", Shape::Plane).with_material(stone));
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::world::{CompileOptions, World};

    #[test]
    fn six_levels_are_66430_balls_from_few_nodes() {
        let scene = Sphereflake.build();
        let balls: usize = (0..LEVELS.len() as u32).map(|level| 9_usize.pow(level)).sum();
        assert_eq!(balls, 66_430);
        let world = World::compile(&scene, &CompileOptions::default()).unwrap();
        // The ground and the sky are the other two.
        assert_eq!(world.objects().len(), balls + 2);
        assert!(scene.nodes().len() < 60);
    }
}
