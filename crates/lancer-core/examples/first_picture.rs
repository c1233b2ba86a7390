//! A scene built in code, rendered, and written as a PPM to standard output:
//! `cargo run --release -p lancer-core --example first_picture > picture.ppm`

use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::to_srgb8;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::render::{Control, render};
use lancer_core::scene::{AmbientOcclusion, Material, Node, Scene, Settings, Shape, Texture};
use lancer_core::world::{CompileOptions, World};
use std::error::Error;
use std::io::Write;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default())?;
    let picture = render(&world, &scene.camera, &scene.settings, None, &Control::default())?;

    let mut out = std::io::stdout().lock();
    write!(out, "P6\n{} {}\n255\n", picture.image.width(), picture.image.height())?;
    out.write_all(to_srgb8(&picture.image).as_flattened())?;
    Ok(())
}

fn scene() -> Scene {
    let mut scene = Scene::new("a glass ball, a mirror ball and a block");
    scene.camera = Camera { eye: DVec3::new(1.5, 3.0, 9.0), target: DVec3::Y * 0.8, ..Camera::default() };
    scene.ambient = Rgb::grey(0.3);
    scene.background = Rgb::from_srgb_hex(0x87ceeb);
    scene.settings = Settings {
        samples: 3,
        depth: 8,
        ao: AmbientOcclusion { samples: 64, distance: 2.0 },
        ..Settings::default()
    };
    scene.add_light(DVec3::new(5.0, 8.0, 5.0), Rgb::grey(250.0));

    let dull = Rgb::grey(0.05);
    let glass = scene.add_material(Material {
        diffuse: dull,
        ambient: dull,
        specular: Rgb::grey(0.02),
        shininess: 300.0,
        reflect: Rgb::WHITE,
        transmit: Rgb::WHITE,
        fresnel: true,
        ..Material::named("glass")
    });
    let mirror = scene.add_material(Material {
        color: Rgb::new(1.0, 0.8, 0.5).into(),
        diffuse: dull,
        ambient: dull,
        reflect: Rgb::new(0.9, 0.7, 0.4),
        ..Material::named("gold")
    });
    let red =
        scene.add_material(Material { color: Rgb::new(0.7, 0.1, 0.08).into(), ..Material::named("red") });
    let floor = scene.add_material(Material {
        color: Texture::Checker { even: Rgb::grey(0.8), odd: Rgb::grey(0.25), size: 1.0 },
        ..Material::named("floor")
    });

    let at = |x, y, z| Transform::translate(DVec3::new(x, y, z));
    scene.add(Node::shape("floor", Shape::Plane).with_material(floor));
    scene
        .add(Node::shape("glass ball", Shape::Sphere).with_material(glass).with_transform(at(0.3, 1.0, 2.2)));
    scene.add(
        Node::shape("gold ball", Shape::Sphere).with_material(mirror).with_transform(at(-2.0, 1.0, 0.0)),
    );
    let block = Transform::scale(DVec3::new(0.7, 1.3, 0.7))
        .then(Transform::rotate(DVec3::Y, 30.0))
        .then(at(1.6, 1.3, -1.2));
    scene.add(Node::shape("block", Shape::Cube).with_material(red).with_transform(block));
    scene
}
