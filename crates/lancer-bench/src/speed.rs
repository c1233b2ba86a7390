//! Build times, and rays per second by kind.
//!
//! The rays of each kind are made first and traced then, so that only tracing is timed: primary rays of a 1024 x
//! 768 picture that frames the mesh; from what they hit, one shadow segment to a light, one mirror ray, and the
//! directions of 16 ambient occlusion samples that have weight, within 10% of the mesh's diagonal.

use crate::Failure;
use crate::record::{keep, median};
use crate::subjects::{self, Subject};
use lancer_core::Rgb;

use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Ray};
use lancer_core::render::{Control, render, with_threads};
use lancer_core::sampling::{HemisphereLattice, Key};
use lancer_core::scene::{AmbientOcclusion, Node, Scene, Settings};
use lancer_core::shade::reflect;
use lancer_core::world::{CompileOptions, World};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

pub(crate) struct Plan {
    pub(crate) models: Vec<PathBuf>,
    pub(crate) runs: usize,
    pub(crate) thousands: u32,
    pub(crate) raw: Option<PathBuf>,
}

const WIDTH: u32 = 1024;
const HEIGHT: u32 = 768;
const AO_SAMPLES: u32 = 16;

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(plan: &Plan) -> Result<(), Failure> {
    let mut subjects =
        vec![subjects::sphereflake(plan.thousands * 1000)?, subjects::terrain(plan.thousands * 1000)?];
    for path in &plan.models {
        subjects.push(subjects::from_file(path)?);
    }
    let all = std::thread::available_parallelism()?.get();
    println!("Medians of {} runs. Mrays/s; frame: primary, shadow and {AO_SAMPLES} AO samples.", plan.runs);
    println!(
        "{:<22} {:>9} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9}",
        "mesh", "triangles", "threads", "build s", "B/tri", "primary", "shadow", "mirror", "AO", "frame ms"
    );
    let mut records = Vec::new();
    for subject in &subjects {
        for threads in if all > 1 { vec![1, all] } else { vec![1] } {
            let row = with_threads(threads, || Row::measure(subject, plan.runs))??;
            println!(
                "{:<22} {:>9} {threads:>7} {:>8.2} {:>8.1} {:>8.2} {:>8.2} {:>8.2} {:>8.2} {:>9.0}",
                subject.name,
                subject.mesh.triangle_count(),
                median(&row.build_seconds),
                row.bytes_per_triangle,
                median(&row.primary),
                median(&row.shadow),
                median(&row.mirror),
                median(&row.ao),
                median(&row.frame_seconds) * 1e3,
            );
            records.push(row.to_json(subject, threads));
        }
    }
    if let Some(directory) = &plan.raw {
        let path = keep(directory, "speed", &records)?;
        println!("all figures: {}", path.display());
    }
    Ok(())
}

/// The figures of one mesh on a number of threads; a list has one entry a run.
struct Row {
    bytes_per_triangle: f64,
    build_seconds: Vec<f64>,
    /// Millions of rays a second, this and the next three.
    primary: Vec<f64>,
    shadow: Vec<f64>,
    mirror: Vec<f64>,
    ao: Vec<f64>,
    frame_seconds: Vec<f64>,
}

impl Row {
    fn measure(subject: &Subject, runs: usize) -> Result<Self, Failure> {
        let scene = scene_of(subject);
        let world = World::compile(&scene, &CompileOptions::default())?;
        let rays = Rays::new(&world, &scene)?;
        let mut row = Self {
            bytes_per_triangle: {
                let statistics = world.statistics();
                (statistics.tree_bytes + statistics.mesh_bytes) as f64 / statistics.triangles as f64
            },
            build_seconds: Vec::new(),
            primary: Vec::new(),
            shadow: Vec::new(),
            mirror: Vec::new(),
            ao: Vec::new(),
            frame_seconds: Vec::new(),
        };
        for _ in 0..runs {
            let start = Instant::now();
            World::compile(&scene, &CompileOptions::default())?;
            row.build_seconds.push(start.elapsed().as_secs_f64());
            row.primary.push(rate(&rays.primary, |ray| world.intersect(ray).is_some()));
            row.shadow.push(rate(&rays.shadow, |ray| world.occluded(ray)));
            row.mirror.push(rate(&rays.mirror, |ray| world.intersect(ray).is_some()));
            row.ao.push(rate(&rays.ao, |ray| world.occluded(ray)));
            let start = Instant::now();
            render(&world, &scene.camera, &scene.settings, None, &Control::default())?;
            row.frame_seconds.push(start.elapsed().as_secs_f64());
        }
        Ok(row)
    }

    fn to_json(&self, subject: &Subject, threads: usize) -> Value {
        json!({
            "mesh": subject.name,
            "triangles": subject.mesh.triangle_count(),
            "threads": threads,
            "bytes_per_triangle": self.bytes_per_triangle,
            "build_seconds": self.build_seconds,
            "primary_mrays": self.primary,
            "shadow_mrays": self.shadow,
            "mirror_mrays": self.mirror,
            "ao_mrays": self.ao,
            "frame_seconds": self.frame_seconds,
        })
    }
}

/// The mesh alone, framed from the front and above, with one light.
pub(crate) fn scene_of(subject: &Subject) -> Scene {
    let bounds = subject.mesh.bounds();
    let (center, diagonal) = (bounds.center(), bounds.diagonal());
    let mut scene = Scene::new(subject.name.clone());
    let toward_eye = DVec3::new(0.3, 0.4, 1.0).normalize();
    scene.camera = Camera { eye: center + toward_eye * diagonal * 1.3, target: center, ..Camera::default() };
    scene.ambient = Rgb::grey(0.3);
    scene.add_light(center + DVec3::new(1.0, 2.0, 2.0) * diagonal, Rgb::grey(20.0 * diagonal * diagonal));
    scene.settings = Settings {
        width: WIDTH,
        height: HEIGHT,
        samples: 1,
        depth: 0,
        ao: AmbientOcclusion { samples: AO_SAMPLES, distance: 0.1 * diagonal },
        ..Settings::default()
    };
    scene.add(Node::mesh(subject.name.clone(), Arc::clone(&subject.mesh)));
    scene
}

/// The rays of one picture, by kind.
struct Rays {
    primary: Vec<Ray>,
    shadow: Vec<Ray>,
    mirror: Vec<Ray>,
    ao: Vec<Ray>,
}

impl Rays {
    fn new(world: &World, scene: &Scene) -> Result<Self, Failure> {
        let projection = scene.camera.project(WIDTH, HEIGHT)?;
        let lattice = HemisphereLattice::new(AO_SAMPLES);
        let mut rays = Self { primary: Vec::new(), shadow: Vec::new(), mirror: Vec::new(), ao: Vec::new() };
        for (y, x) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (y, x))) {
            let ray = projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            rays.primary.push(ray);
            let Some(hit) = world.intersect(&ray) else { continue };
            let at = world.intersection(&ray, &hit);
            let normal = at.facing_normal();
            rays.shadow.extend(world.lights().iter().map(|light| at.segment_to(light.position)));
            rays.mirror.push(at.spawn(reflect(ray.direction, normal)));
            for fan in lattice.around(normal, &mut Key::camera(x, y, 0).stream()) {
                rays.ao.extend(
                    (0..fan.count)
                        .map(|i| Ray { t_max: scene.settings.ao.distance, ..at.spawn(fan.direction(i)) }),
                );
            }
        }
        Ok(rays)
    }
}

/// Millions of rays a second on all threads of the pool; the answers are counted so that none is left out.
fn rate(rays: &[Ray], trace: impl Fn(&Ray) -> bool + Sync) -> f64 {
    if rays.is_empty() {
        return f64::NAN;
    }
    let start = Instant::now();
    let hits = rays.par_iter().filter(|ray| trace(ray)).count();
    std::hint::black_box(hits);
    rays.len() as f64 / start.elapsed().as_secs_f64() / 1e6
}
