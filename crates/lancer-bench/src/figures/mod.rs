//! The figures of the report that are plots: what a k-d tree costs, and how tracing grows with the scene.
//!
//! Both trace the same kind of rays through a generated mesh, for the nearest hit: camera rays that meet the mesh, which
//! are coherent, and their mirror rays, which are not.

mod growth;
mod kd_tree;

pub(crate) use growth::measure as measure_growth;
pub(crate) use kd_tree::measure as measure_kd_tree;

use crate::Failure;
use lancer_core::geometry::Ray;
use lancer_core::scene::Scene;
use lancer_core::shade::reflect;
use lancer_core::world::{CompileOptions, World};
use std::time::Instant;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

/// Rays that meet a mesh, and those that they are reflected into.
struct Rays {
    camera: Vec<Ray>,
    mirror: Vec<Ray>,
}

impl Rays {
    fn new(scene: &Scene) -> Result<Self, Failure> {
        let world = World::compile(scene, &CompileOptions::default())?;
        let projection = scene.camera.project(WIDTH, HEIGHT)?;
        let mut rays = Self { camera: Vec::new(), mirror: Vec::new() };
        for (y, x) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (y, x))) {
            let ray = projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some(hit) = world.intersect(&ray) else { continue };
            let at = world.intersection(&ray, &hit);
            rays.camera.push(ray);
            rays.mirror.push(at.spawn(reflect(ray.direction, at.facing_geometric_normal())));
        }
        if rays.camera.is_empty() { Err("no camera ray meets the mesh".into()) } else { Ok(rays) }
    }

    fn all(&self) -> impl Iterator<Item = &Ray> {
        self.camera.iter().chain(&self.mirror)
    }
}

/// Nanoseconds that a ray takes to its nearest hit, on the thread of the caller.
fn nanoseconds<'a>(world: &World, rays: impl Iterator<Item = &'a Ray>) -> f64 {
    let start = Instant::now();
    let mut count = 0_u64;
    for ray in rays {
        std::hint::black_box(world.intersect(ray));
        count += 1;
    }
    start.elapsed().as_secs_f64() * 1e9 / count as f64
}
