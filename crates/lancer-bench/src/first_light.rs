//! How soon a window could show something of a large model: the time from a compiled world to a whole image.

use crate::Failure;
use crate::record::{keep, median, seconds};
use crate::versus::Stage;
use lancer_core::render::{Control, render, with_threads};
use lancer_core::scene::Settings;
use lancer_core::world::{CompileOptions, World};
use serde_json::json;
use std::path::Path;

/// Columns and rows of the image.
const SIZE: (u32, u32) = (800, 600);
/// One pixel of so many is traced along each side: the whole image, and coarse ones to show first.
const STEPS: [u32; 3] = [1, 4, 8];

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(
    stage: &Stage,
    threads: &[usize],
    runs: usize,
    raw: Option<&Path>,
) -> Result<(), Failure> {
    let world = World::compile(&stage.scene, &CompileOptions::default())?;
    println!(
        "First light of the {}, {} x {}, without ambient occlusion: milliseconds.\n",
        stage.name, SIZE.0, SIZE.1
    );
    println!("| threads | one pixel of | median | least | most |\n|---:|---:|---:|---:|---:|");
    let mut records = Vec::new();
    for &threads in threads {
        for step in STEPS {
            let (width, height) = (SIZE.0 / step, SIZE.1 / step);
            let settings = Settings { width, height, samples: 1, depth: 0, ..stage.scene.settings };
            let times = with_threads(threads, || {
                let frame =
                    || seconds(|| render(&world, &stage.scene.camera, &settings, None, &Control::default()));
                let milliseconds = |_| {
                    let (time, picture) = frame();
                    picture.map(|_| 1e3 * time)
                };
                (0..runs).map(milliseconds).collect::<Result<Vec<f64>, _>>()
            })??;
            let least = times.iter().copied().fold(f64::INFINITY, f64::min);
            let most = times.iter().copied().fold(0.0, f64::max);
            println!("| {threads} | {step} x {step} | {:.1} | {least:.1} | {most:.1} |", median(&times));
            records.push(json!({
                "scene": stage.name,
                "threads": threads,
                "width": width,
                "height": height,
                "milliseconds": times,
            }));
        }
    }
    if let Some(directory) = raw {
        println!("all figures: {}", keep(directory, "first-light", &records)?.display());
    }
    Ok(())
}
