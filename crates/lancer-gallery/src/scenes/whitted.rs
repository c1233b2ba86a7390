//! Two balls over a chequered floor: the picture that this kind of ray tracing began with.
//!
//! Source: the first figure of Whitted, "An improved illumination model for shaded display" (CACM 23(6), 1980).
//! His balls, floor and sky are here; the places and the colours are ours.

use super::sky::Sky;
use crate::BuiltinScene;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Material, Node, Scene, Settings, Shape, Texture};

/// The scene `whitted`.
pub(crate) struct Whitted;

impl BuiltinScene for Whitted {
    fn name(&self) -> &'static str {
        "whitted"
    }

    fn summary(&self) -> &'static str {
        "A hollow glass ball before a mirror ball over a chequered floor, after Whitted's picture of 1980"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("Whitted, 1980");
        scene.camera = Camera {
            eye: DVec3::new(-0.4, 3.4, 10.0),
            target: DVec3::new(0.35, 1.75, 0.0),
            fov: 30.0,
            ..Camera::default()
        };
        let low =
            Camera { eye: DVec3::new(-6.0, 1.0, 8.0), target: DVec3::new(0.3, 1.95, 0.0), ..scene.camera };
        scene.cameras.push(("low".into(), low));
        scene.ambient = Rgb::new(0.30, 0.34, 0.42);
        Sky { zenith: Rgb::from_srgb_hex(0x1b4f9c), horizon: Rgb::from_srgb_hex(0xa4d0f4), clearness: 5.0 }
            .put_over(&mut scene, 200.0);
        scene.settings = Settings { samples: 3, depth: 6, ..Settings::default() };
        scene.add_light(DVec3::new(-7.0, 13.0, 9.0), Rgb::new(1.0, 0.96, 0.88) * 700.0);
        floor(&mut scene);
        mirror_ball(&mut scene);
        glass_ball(&mut scene);
        scene
    }
}

/// A board of 12 by 12 squares. Like his, it ends before the horizon, where squares would be smaller than pixels.
fn floor(scene: &mut Scene) {
    let squares = scene.add_material(Material {
        color: Texture::Checker {
            even: Rgb::from_srgb_hex(0xf0bf2e),
            odd: Rgb::from_srgb_hex(0xb3201a),
            size: 1.0 / 12.0,
        },
        ..Material::named("squares")
    });
    let board =
        Transform::scale(DVec3::new(8.4, 0.1, 8.4)).then(Transform::translate(DVec3::new(0.0, -0.1, 0.0)));
    scene.add(Node::shape("floor", Shape::Cube).with_material(squares).with_transform(board));
}

fn mirror_ball(scene: &mut Scene) {
    let mirror = scene.add_material(Material {
        color: Rgb::grey(0.8).into(),
        ambient: Rgb::grey(0.08),
        diffuse: Rgb::grey(0.08),
        specular: Rgb::grey(0.02),
        shininess: 250.0,
        reflect: Rgb::new(0.86, 0.87, 0.9),
        ..Material::named("mirror")
    });
    scene.add(ball("mirror ball", 1.4, DVec3::new(1.5, 1.5, -1.4)).with_material(mirror));
}

/// A thick shell: a ball of glass around a ball of air.
fn glass_ball(scene: &mut Scene) {
    let glass = scene.add_material(Material {
        ambient: Rgb::BLACK,
        diffuse: Rgb::BLACK,
        specular: Rgb::grey(0.02),
        shininess: 400.0,
        reflect: Rgb::WHITE,
        transmit: Rgb::grey(0.97),
        ior: 1.5,
        fresnel: true,
        ..Material::named("glass")
    });
    // Without a mirror image of its own: the outer surface has one already, and a second would double the rays.
    let air = scene.add_material(Material {
        name: "air".into(),
        reflect: Rgb::BLACK,
        ior: 1.0,
        fresnel: false,
        ..scene.material(glass).clone()
    });
    let center = DVec3::new(-0.55, 2.35, 1.8);
    scene.add(ball("glass ball", 1.2, center).with_material(glass));
    scene.add(ball("air in the glass ball", 1.1, center).with_material(air));
}

fn ball(name: &str, radius: f64, center: DVec3) -> Node {
    let place = Transform::scale(DVec3::splat(radius)).then(Transform::translate(center));
    Node::shape(name, Shape::Sphere).with_transform(place)
}
