//! How the time of a ray grows with the number of triangles, for each accelerator, on one thread.

use super::{Rays, nanoseconds};
use crate::Failure;
use crate::record::{command_line, growth, seconds, write};
use crate::speed::scene_of;
use crate::subjects::terrain;
use lancer_core::accel::Accelerator;
use lancer_core::render::with_threads;
use lancer_core::scene::Scene;
use lancer_core::world::{CompileOptions, World};
use serde_json::{Value, json};
use std::path::Path;

/// The least mesh; each of the next has four times as many triangles.
const LEAST: u32 = 512;
/// Brute force stops here, and traces only as many rays as make about so many tests.
const MOST_BY_FORCE: u32 = 1 << 15;
const TESTS_BY_FORCE: usize = 20_000_000;
/// Exponents are fitted from here on: below, the time of a ray is not that of the search.
const FITTED: f64 = 8000.0;

/// One accelerator on one mesh. Times are the least of the runs: whatever else the machine does can only add to them.
struct Row {
    accelerator: Accelerator,
    triangles: usize,
    build_seconds: f64,
    camera: f64,
    mirror: f64,
}

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(most: u32, runs: usize, data: Option<&Path>) -> Result<(), Failure> {
    println!("A terrain; nanoseconds a ray to its nearest hit, one thread, the least of {runs} runs");
    println!(
        "{:<12} {:>9} {:>9} {:>10} {:>10}",
        "accelerator", "triangles", "build s", "camera ns", "mirror ns"
    );
    let sizes =
        std::iter::successors(Some(LEAST), |size| size.checked_mul(4)).take_while(|&size| size <= most);
    let mut rows = Vec::new();
    for size in sizes {
        let subject = terrain(size)?;
        let scene = scene_of(&subject);
        let rays = Rays::new(&scene)?;
        for accelerator in Accelerator::ALL {
            if accelerator != Accelerator::BruteForce || size <= MOST_BY_FORCE {
                let row = with_threads(1, || Row::measure(&scene, &rays, accelerator, runs))??;
                println!(
                    "{:<12} {:>9} {:>9.4} {:>10.0} {:>10.0}",
                    accelerator.name(),
                    row.triangles,
                    row.build_seconds,
                    row.camera,
                    row.mirror
                );
                rows.push(row);
            }
        }
    }
    println!("\nExponents e of time ~ triangles^e from {FITTED} triangles: build, camera, mirror");
    let mut exponents = Vec::new();
    for accelerator in Accelerator::ALL {
        let fit = |time: fn(&Row) -> f64| {
            let of_this = rows.iter().filter(|row| row.accelerator == accelerator);
            let points = of_this.map(|row| (row.triangles as f64, time(row)));
            growth(&points.filter(|&(size, _)| size >= FITTED).collect::<Vec<_>>())
        };
        let [build, camera, mirror] =
            [fit(|row| row.build_seconds), fit(|row| row.camera), fit(|row| row.mirror)];
        println!("{:<12} {build:.2} {camera:.2} {mirror:.2}", accelerator.name());
        exponents.push(json!({
            "accelerator": accelerator.name(), "build": build, "camera": camera, "mirror": mirror
        }));
    }
    if let Some(path) = data {
        let rows: Vec<Value> = rows.iter().map(Row::to_json).collect();
        write(
            path,
            json!({ "command": command_line(), "mesh": "terrain", "rows": rows, "exponents": exponents }),
        )?;
    }
    Ok(())
}

impl Row {
    fn measure(scene: &Scene, rays: &Rays, accelerator: Accelerator, runs: usize) -> Result<Self, Failure> {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        let (mut build, mut camera, mut mirror) = (Vec::new(), Vec::new(), Vec::new());
        let mut triangles = 0;
        for _ in 0..runs {
            let (time, world) = seconds(|| World::compile(scene, &options));
            let world = world?;
            triangles = world.statistics().triangles as usize;
            let step = match accelerator {
                Accelerator::BruteForce => (triangles * rays.camera.len()).div_ceil(TESTS_BY_FORCE),
                _ => 1,
            };
            build.push(time);
            camera.push(nanoseconds(&world, rays.camera.iter().step_by(step)));
            mirror.push(nanoseconds(&world, rays.mirror.iter().step_by(step)));
        }
        let least = |times: Vec<f64>| times.into_iter().fold(f64::INFINITY, f64::min);
        let [build_seconds, camera, mirror] = [build, camera, mirror].map(least);
        Ok(Self { accelerator, triangles, build_seconds, camera, mirror })
    }

    fn to_json(&self) -> Value {
        json!({
            "accelerator": self.accelerator.name(),
            "triangles": self.triangles,
            "build_seconds": self.build_seconds,
            "camera_nanoseconds": self.camera,
            "mirror_nanoseconds": self.mirror,
        })
    }
}
