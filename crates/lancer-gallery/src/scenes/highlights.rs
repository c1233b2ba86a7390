//! The specular term alone on the move: its exponent along one axis, its colour along the other.

use crate::BuiltinScene;
use crate::parts::{at, lamp, melt_horizon};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Material, Node, Scene, Settings, Shape};
use lancer_core::shade::specular_normalization;

/// From plastic to metal, from dull to sharp.
pub(crate) struct Highlights;

/// n from left to right: each highlight is half as wide as its left neighbour's.
const SHININESS: [f64; 6] = [4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0];
/// m from the front row to the back row.
const METALLIC: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl BuiltinScene for Highlights {
    fn name(&self) -> &'static str {
        "highlights"
    }

    fn summary(&self) -> &'static str {
        "Shininess growing to the right, from plastic in front to metal behind"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("highlights");
        scene.camera = Camera {
            eye: DVec3::new(0.0, 13.5, 16.5),
            target: DVec3::new(0.0, 0.5, 0.5),
            fov: 35.0,
            ..Camera::default()
        };
        let corner =
            Camera { eye: DVec3::new(9.0, 5.0, 9.0), target: DVec3::new(2.5, 0.4, 0.0), ..scene.camera };
        scene.cameras = vec![("corner".into(), corner)];
        scene.ambient = Rgb::new(0.14, 0.16, 0.22);
        scene.settings = Settings { samples: 4, depth: 2, ..Settings::default() };
        add_window(&mut scene);
        let blue = Rgb::new(0.2, 0.3, 0.55);
        scene.lights.push(lamp("rim", DVec3::new(12.0, 8.0, -14.0), DVec3::ZERO, blue));

        let slate = Rgb::from_srgb_hex(0x39414f);
        let floor = scene.add_material(Material {
            color: slate.into(),
            reflect: Rgb::grey(0.12),
            ..Material::named("floor")
        });
        scene.add(Node::shape("floor", Shape::Plane).with_material(floor));
        melt_horizon(&mut scene, slate);

        for (row, &metallic) in METALLIC.iter().enumerate() {
            for (column, &shininess) in SHININESS.iter().enumerate() {
                let name = format!("n {shininess} m {metallic}");
                let material = scene.add_material(copper(&name, shininess, metallic));
                let place = at(2.3 * (column as f64 - 2.5), 1.0, 2.3 * (2.0 - row as f64));
                scene.add(Node::shape(name, Shape::Sphere).with_material(material).with_transform(place));
            }
        }
        scene
    }
}

/// Nine lamps in a square: a dull highlight melts them into one, a sharp one tells them apart.
fn add_window(scene: &mut Scene) {
    let warm = Rgb::new(1.05, 1.0, 0.92);
    for i in 0..9 {
        let (across, up) = (f64::from(i % 3 - 1), f64::from(i / 3 - 1));
        let position =
            DVec3::new(-8.0, 15.0, 7.0) + DVec3::new(2.2 * across, 1.6 * up, 2.2 * across - 1.6 * up);
        scene.lights.push(lamp(&format!("window {i}"), position, DVec3::ZERO, warm * (1.0 / 9.0)));
    }
}

fn copper(name: &str, shininess: f64, metallic: f64) -> Material {
    // c_s k_s is what a highlight reaches at its middle. With one k_s for all, the sharpest would be a thousand
    // times as bright as the dullest, since c_s keeps the light that a highlight sends out and not its peak; the
    // root lies half way between that and one peak for all, which would make small highlights look faint.
    let peak = 0.17 * shininess.sqrt();
    Material {
        color: Rgb::from_srgb_hex(0xf0732e).into(),
        // A metal has no diffuse reflection to speak of; some is left, to show its shape.
        diffuse: Rgb::grey(0.85 - 0.5 * metallic),
        specular: Rgb::grey(peak * (1.0 + 2.0 * metallic) / specular_normalization(shininess)),
        metallic: Rgb::grey(metallic),
        shininess,
        ..Material::named(name)
    }
}
