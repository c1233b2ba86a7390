//! The teapot of Utah, on a table by a window.

mod patches;
mod tessellate;
#[cfg(test)]
mod tests;

use crate::BuiltinScene;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{AmbientOcclusion, Material, Node, Scene, Settings, Shape};
use patches::patches;
use tessellate::tessellate;

/// The scene `teapot`.
pub(crate) struct Teapot;

/// Squares along a patch's edge: 12,432 triangles in all. With half as many the outline shows corners.
const STEPS: u32 = 14;

impl BuiltinScene for Teapot {
    fn name(&self) -> &'static str {
        "teapot"
    }

    fn summary(&self) -> &'static str {
        "Newell's teapot from its Bézier patches, glazed, on a polished table"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("The teapot of Utah");
        scene.camera = Camera {
            eye: DVec3::new(3.6, 4.3, 8.6),
            target: DVec3::new(0.15, 1.25, 0.0),
            fov: 34.0,
            ..Camera::default()
        };
        scene.cameras.push(("spout".into(), Camera { eye: DVec3::new(9.2, 3.0, 4.2), ..scene.camera }));
        scene.ambient = Rgb::new(0.36, 0.38, 0.42);
        scene.background = Rgb::from_srgb_hex(0xcdbfad);
        scene.settings = Settings {
            samples: 3,
            depth: 3,
            ao: AmbientOcclusion { samples: 32, distance: 3.0 },
            ..Settings::default()
        };
        scene.add_light(DVec3::new(-5.0, 9.0, 6.0), Rgb::new(1.0, 0.93, 0.8) * 330.0);
        scene.add_light(DVec3::new(9.0, 6.0, 2.0), Rgb::new(0.6, 0.75, 1.0) * 90.0);
        table(&mut scene);
        windows(&mut scene);
        teapot(&mut scene);
        scene
    }
}

fn teapot(scene: &mut Scene) {
    let glaze = scene.add_material(Material {
        color: Rgb::from_srgb_hex(0x2f8f8a).into(),
        diffuse: Rgb::grey(0.9),
        specular: Rgb::grey(0.006),
        shininess: 500.0,
        reflect: Rgb::WHITE,
        fresnel: true,
        ..Material::named("glaze")
    });
    let mesh = tessellate(&patches(), STEPS);
    let upright = Transform::rotate(DVec3::X, -90.0).then(Transform::rotate(DVec3::Y, 20.0));
    scene.add(Node::mesh("teapot", mesh).with_material(glaze).with_transform(upright));
}

/// A round top of dark wood under lacquer.
fn table(scene: &mut Scene) {
    let lacquer = scene.add_material(Material {
        color: Rgb::from_srgb_hex(0x5a2e18).into(),
        specular: Rgb::grey(0.004),
        shininess: 400.0,
        reflect: Rgb::WHITE,
        fresnel: true,
        ..Material::named("lacquer")
    });
    let top = Transform::scale(DVec3::new(5.2, 0.15, 5.2)).then(Transform::translate(DVec3::Y * -0.15));
    scene.add(
        Node::shape("table", Shape::Cylinder { capped: true }).with_material(lacquer).with_transform(top),
    );
}

/// Bright panes behind the eye, for the glaze to reflect.
fn windows(scene: &mut Scene) {
    let daylight = scene.add_material(Material {
        color: Rgb::WHITE.into(),
        ambient: scene.ambient.map(|channel| 4.0 / channel),
        diffuse: Rgb::BLACK,
        ..Material::named("daylight")
    });
    for (name, x, y) in [("left pane", -8.2, 9.5), ("right pane", -3.8, 9.5)] {
        let pane =
            Transform::scale(DVec3::new(2.0, 3.0, 0.05)).then(Transform::translate(DVec3::new(x, y, 14.0)));
        scene.add(Node::shape(name, Shape::Cube).with_material(daylight).with_transform(pane));
    }
}
