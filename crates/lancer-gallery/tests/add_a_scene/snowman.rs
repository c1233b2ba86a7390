//! A snowman at dusk.

use crate::BuiltinScene;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{AmbientOcclusion, Light, Material, Node, Scene, Settings, Shape};

/// The scene `snowman`.
pub(crate) struct Snowman;

impl BuiltinScene for Snowman {
    fn name(&self) -> &'static str {
        "snowman"
    }

    fn summary(&self) -> &'static str {
        "A snowman at dusk, from three balls, coal and a carrot"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("A snowman at dusk");
        scene.camera = Camera {
            eye: DVec3::new(5.0, 2.6, 7.0),
            target: DVec3::new(0.4, 1.9, 0.0),
            fov: 34.0,
            ..Camera::default()
        };
        scene.ambient = Rgb::new(0.25, 0.32, 0.50);
        scene.background = Rgb::from_srgb_hex(0x5b6fa3);
        scene.settings = Settings {
            samples: 3,
            ao: AmbientOcclusion { samples: 32, distance: 2.0 },
            ..Settings::default()
        };
        scene.lights.push(Light {
            name: "low sun".into(),
            position: DVec3::new(-14.0, 10.0, 16.0),
            intensity: Rgb::new(1.0, 0.62, 0.36) * 1600.0,
        });

        let snow = scene
            .add_material(Material { color: Rgb::new(0.9, 0.9, 0.92).into(), ..Material::named("snow") });
        let carrot = scene.add_material(Material {
            color: Rgb::from_srgb_hex(0xe8711a).into(),
            specular: Rgb::grey(0.05),
            shininess: 40.0,
            ..Material::named("carrot")
        });

        scene.add(Node::shape("field", Shape::Plane).with_material(snow));
        let man = scene.add(Node::group("snowman", []).with_material(snow));
        for (name, radius, height) in [("belly", 1.1, 0.9), ("chest", 0.8, 2.3), ("head", 0.55, 3.3)] {
            let place = Transform::scale(DVec3::splat(radius)).then(Transform::translate(DVec3::Y * height));
            scene.add_child(man, Node::shape(name, Shape::Sphere).with_transform(place));
        }
        let coal = scene.add_material(Material { color: Rgb::grey(0.02).into(), ..Material::named("coal") });
        let coals =
            [("left eye", -0.2, 3.5, 0.47), ("right eye", 0.2, 3.5, 0.47), ("button", 0.0, 2.5, 0.77)];
        for (name, x, y, z) in coals {
            let place = Transform::scale(DVec3::splat(0.08)).then(Transform::translate(DVec3::new(x, y, z)));
            scene.add_child(man, Node::shape(name, Shape::Sphere).with_material(coal).with_transform(place));
        }
        let nose = Transform::scale(DVec3::new(0.1, 0.1, 0.5))
            .then(Transform::translate(DVec3::new(0.0, 3.32, 0.75)));
        scene.add_child(man, Node::shape("nose", Shape::Sphere).with_material(carrot).with_transform(nose));
        scene
    }
}
