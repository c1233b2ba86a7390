//! Builds: time, memory kept and memory at the peak.

use super::embree_side::{scene_of, triangles_of};
use super::stage::Stage;
use super::{Plan, device_with};
use crate::embree::ffi::{Build, Library, Quality, Triangles};
use crate::record::{Ratio, median, seconds};
use crate::{Failure, MEMORY};
use lancer_core::render::with_threads;
use lancer_core::world::{CompileOptions, World};
use serde_json::{Value, json};
use std::sync::Arc;

pub(super) const HEADING: &str = "\nBuilds. Seconds for a million elements, triangles and instances, and the ratio of \
Lancer's time to Embree's at high quality; bytes an element, kept / at the peak, vertices and indices \
included.\n
| scene | elements | threads | Lancer, s | Embree high | medium | low | ratio | Lancer, bytes | Embree high | medium \
| low |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|";

const QUALITIES: [Quality; 3] = [Quality::High, Quality::Medium, Quality::Low];

/// What a build took.
#[derive(Clone, Default)]
pub(super) struct Took {
    /// One entry a run.
    pub(super) seconds: Vec<f64>,
    /// In bytes, as is the peak.
    pub(super) kept: u64,
    pub(super) peak: u64,
}

/// Prints a stage's rows; returns its figures.
#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(super) fn measure(stage: &Stage, library: &Arc<Library>, plan: &Plan) -> Result<Vec<Value>, Failure> {
    let triangles = triangles_of(stage);
    let mut records = Vec::new();
    for &threads in &plan.threads {
        let mut ours = Took::default();
        let mut theirs = [Took::default(), Took::default(), Took::default()];
        for _ in 0..plan.runs {
            lancer(stage, threads, &mut ours)?;
            for (quality, took) in QUALITIES.into_iter().zip(&mut theirs) {
                embree(stage, &triangles, library, plan, threads, quality, took)?;
            }
        }
        println!("{}", row(stage, threads, &ours, &theirs));
        records.push(json!({
            "table": "builds",
            "scene": stage.name,
            "elements": elements(stage),
            "threads": threads,
            "lancer": to_json(&ours),
            "embree_high": to_json(&theirs[0]),
            "embree_medium": to_json(&theirs[1]),
            "embree_low": to_json(&theirs[2]),
        }));
    }
    Ok(records)
}

/// Triangles that are stored, and instances.
fn elements(stage: &Stage) -> usize {
    stage.mesh.triangle_count() + stage.places.len()
}

/// Compiles the stage's scene once.
pub(super) fn lancer(stage: &Stage, threads: usize, took: &mut Took) -> Result<World, Failure> {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let (time, world) =
        with_threads(threads, || seconds(|| World::compile(&stage.scene, &CompileOptions::default())))?;
    let world = world?;
    let statistics = world.statistics();
    took.seconds.push(time);
    took.kept = (MEMORY.current_usage().saturating_sub(before)) as u64 + statistics.mesh_bytes;
    took.peak = (MEMORY.peak_usage().saturating_sub(before)) as u64 + statistics.mesh_bytes;
    Ok(world)
}

/// Builds the stage's scene once on a device of its own.
pub(super) fn embree(
    stage: &Stage,
    triangles: &Arc<Triangles>,
    library: &Arc<Library>,
    plan: &Plan,
    threads: usize,
    quality: Quality,
    took: &mut Took,
) -> Result<(), Failure> {
    let device = device_with(library, plan, threads)?;
    let build = Build { quality, robust: false };
    let (time, scene) = seconds(|| scene_of(stage, triangles, &device, build));
    let _scene = scene?;
    let given = triangles.bytes() + size_of::<[f32; 12]>() as u64 * stage.places.len() as u64;
    took.seconds.push(time);
    took.kept = device.bytes() + given;
    took.peak = device.peak_bytes() + given;
    Ok(())
}

fn row(stage: &Stage, threads: usize, ours: &Took, theirs: &[Took; 3]) -> String {
    let elements = elements(stage) as f64;
    let time = |took: &Took| format!("{:.3}", median(&took.seconds) / elements * 1e6);
    let bytes =
        |took: &Took| format!("{:.0} / {:.0}", took.kept as f64 / elements, took.peak as f64 / elements);
    format!(
        "| {} | {elements} | {threads} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
        stage.name,
        time(ours),
        time(&theirs[0]),
        time(&theirs[1]),
        time(&theirs[2]),
        Ratio::of(&ours.seconds, &theirs[0].seconds),
        bytes(ours),
        bytes(&theirs[0]),
        bytes(&theirs[1]),
        bytes(&theirs[2]),
    )
}

fn to_json(took: &Took) -> Value {
    json!({ "seconds": took.seconds, "bytes_kept": took.kept, "bytes_at_peak": took.peak })
}
