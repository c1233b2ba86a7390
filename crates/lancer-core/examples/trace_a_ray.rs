//! Traces one ray, and listens to every term of what it sees:
//! `cargo run -p lancer-core --example trace_a_ray`

use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Ray};
use lancer_core::integrator::{Listener, RayCounts, RayId, RayKind, Scratch, Whitted};
use lancer_core::sampling::Key;
use lancer_core::scene::{Light, Material, Node, Scene, Settings, Shape};
use lancer_core::shade::{AmbientTerm, LightTerm};
use lancer_core::world::{CompileOptions, Media, World};
use std::error::Error;
use std::io::Write;

/// Writes down what it is told.
#[derive(Default)]
struct Diary(Vec<String>);

impl Listener for Diary {
    fn begin_ray(&mut self, id: RayId, kind: RayKind, throughput: Rgb, _: &Ray) {
        self.0.push(format!("ray {} ({kind:?}) counts {throughput:?}", id.0));
    }
    fn background(&mut self, radiance: Rgb) {
        self.0.push(format!("  background {radiance:?}"));
    }
    fn ambient(&mut self, term: &AmbientTerm) {
        self.0.push(format!("  ambient {:?}", term.radiance()));
    }
    fn light(&mut self, index: usize, _: &Light, term: &LightTerm, visible: bool) {
        let hidden = if visible { "" } else { " (in shadow)" };
        self.0.push(format!("  light {index}: {:?}{hidden}", term.radiance()));
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new("a mirror ball");
    scene.ambient = Rgb::grey(0.1);
    scene.background = Rgb::new(0.2, 0.4, 0.8);
    scene.add_light(DVec3::new(0.0, 5.0, 5.0), Rgb::grey(100.0));
    let mirror = scene.add_material(Material { reflect: Rgb::grey(0.5), ..Material::named("mirror") });
    scene.add(Node::shape("ball", Shape::Sphere).with_material(mirror));
    let world = World::compile(&scene, &CompileOptions::default())?;

    let mut out = std::io::stdout().lock();
    let ray = Ray::new(DVec3::new(0.0, 0.5, 4.0), DVec3::NEG_Z);
    let hit = world.intersect(&ray).ok_or("the ray passes by")?;
    let at = world.intersection(&ray, &hit);
    writeln!(out, "t {}, point {}, normal {}", at.t, at.point, at.geometric_normal)?;
    writeln!(out, "in shadow: {}", world.occluded(&at.segment_to(world.lights()[0].position)))?;

    let whitted = Whitted::new(&world, &Settings::default());
    let mut diary = Diary::default();
    let radiance = whitted.radiance(
        ray,
        &Media::around(&world, ray.origin),
        Key::camera(0, 0, 0),
        &mut Scratch::default(),
        &mut RayCounts::default(),
        &mut diary,
    );
    writeln!(out, "{}\nradiance {radiance:?}", diary.0.join("\n"))?;
    Ok(())
}
