//! How times grow with the scene, and fall with threads.

use super::builds::{self, Took};
use super::embree_side::{Form, Prepared, scene_of, triangles_of};
use super::rays::{Kind, Lot, lots};
use super::stage::{self, Stage};
use super::{Plan, device_with, kinds};
use crate::Failure;
use crate::embree::ffi::{Build, Library, Quality, Scene};
use crate::record::{growth, median, seconds};
use lancer_core::render::with_threads;
use lancer_core::world::World;
use serde_json::{Value, json};
use std::sync::Arc;

const HEADING: &str = "\nSeconds to build (Embree at high quality), and millions of rays a second: primary (Embree: \
coherent packets of 16 across 4x4 pixels) and AO (Embree: packets of 16 of one point).\n
| scene | size | threads | Lancer builds | Embree builds | Lancer primary | Embree primary | Lancer AO | Embree AO |
|---|---:|---:|---:|---:|---:|---:|---:|---:|";

/// Medians at one size and number of threads, Lancer's and Embree's.
struct Point {
    size: f64,
    build: [f64; 2],
    primary: [f64; 2],
    ao: [f64; 2],
}

/// Prints how everything grows up to `most` triangles and instances; returns the figures.
#[expect(clippy::print_stdout, reason = "the tables are what the command is for")]
pub(super) fn measure(library: &Arc<Library>, plan: &Plan, most: u32) -> Result<Vec<Value>, Failure> {
    println!("{HEADING}");
    let threads = plan.threads.iter().copied().max().unwrap_or(1);
    let triangles = [10_000, 40_000, 160_000, 640_000, 2_500_000, 16_000_000];
    let instances = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000];
    type Make = fn(u32) -> Result<Stage, Failure>;
    let series: [(&str, &[u32], Make); 3] = [
        ("terrain", &triangles, stage::terrain),
        ("sphereflake", &triangles, stage::sphereflake),
        ("instances", &instances, stage::instances),
    ];
    let mut records = Vec::new();
    let mut fits = Vec::new();
    for (name, sizes, make) in series.into_iter().filter(|(name, ..)| stage::is_wanted(name, &plan.only)) {
        let mut points = Vec::new();
        for &size in sizes.iter().filter(|&&size| size <= most) {
            let stage = make(size)?;
            points.push(point(&stage, library, plan, threads, &mut records)?);
        }
        fits.push(fit(name, &points));
    }
    let fixed = stage::sphereflake(most.min(1_000_000))?;
    let doublings = std::iter::successors(Some(1), |threads| Some(threads * 2));
    for threads in doublings.take_while(|&doubled| doubled < threads).chain([threads]) {
        point(&fixed, library, plan, threads, &mut records)?;
    }
    println!("\nThe exponent e of the power law, time ~ size^e, that fits best: Lancer's and Embree's.\n");
    println!("| scene | build | primary | AO |\n|---|---:|---:|---:|");
    fits.iter().for_each(|fit| println!("{fit}"));
    Ok(records)
}

/// Measures, prints and records one point.
#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
fn point(
    stage: &Stage,
    library: &Arc<Library>,
    plan: &Plan,
    threads: usize,
    records: &mut Vec<Value>,
) -> Result<Point, Failure> {
    let triangles = triangles_of(stage);
    let (mut ours, mut theirs) = (Took::default(), Took::default());
    let mut world = builds::lancer(stage, threads, &mut ours)?;
    builds::embree(stage, &triangles, library, plan, threads, Quality::High, &mut theirs)?;
    for _ in 1..plan.runs {
        drop(world);
        world = builds::lancer(stage, threads, &mut ours)?;
        builds::embree(stage, &triangles, library, plan, threads, Quality::High, &mut theirs)?;
    }
    let device = device_with(library, plan, threads)?;
    let scene = scene_of(stage, &triangles, &device, Build { quality: Quality::High, robust: false })?;
    let lots = lots(stage, &world)?;
    let rates = |kind, coherent| {
        let lot = lots.iter().find(|lot| lot.kind == kind).ok_or("there is a lot of each kind")?;
        let form = Form { width: 16, coherent, grouping: 0 };
        with_threads(threads, || rates(&world, &scene, lot, form, plan.runs)).map_err(Failure::from)
    };
    let primary = rates(Kind::Primary, true)?;
    let ao = rates(Kind::AmbientOcclusion, false)?;
    let size = match stage.places.len() {
        0 => stage.mesh.triangle_count(),
        places => places,
    };
    let medians = |both: &[Vec<f64>; 2]| [median(&both[0]), median(&both[1])];
    let point = Point {
        size: size as f64,
        build: [median(&ours.seconds), median(&theirs.seconds)],
        primary: medians(&primary),
        ao: medians(&ao),
    };
    println!(
        "| {} | {size} | {threads} | {:.4} | {:.4} | {:.2} | {:.2} | {:.2} | {:.2} |",
        stage.name,
        point.build[0],
        point.build[1],
        point.primary[0],
        point.primary[1],
        point.ao[0],
        point.ao[1],
    );
    records.push(json!({
        "table": "scale",
        "scene": stage.name,
        "size": size,
        "threads": threads,
        "lancer": { "build_seconds": ours.seconds, "primary_mrays": primary[0], "ao_mrays": ao[0] },
        "embree": { "build_seconds": theirs.seconds, "primary_mrays": primary[1], "ao_mrays": ao[1] },
    }));
    Ok(point)
}

/// Lancer's and Embree's rates, in turns.
fn rates(world: &World, scene: &Scene, lot: &Lot, form: Form, runs: usize) -> [Vec<f64>; 2] {
    let prepared = Prepared::new(lot);
    let rate = |seconds: f64| lot.rays.len() as f64 / seconds / 1e6;
    let mut rates = [Vec::new(), Vec::new()];
    for _ in 0..runs {
        rates[0].push(rate(seconds(|| std::hint::black_box(kinds::trace(world, lot))).0));
        rates[1].push(rate(seconds(|| std::hint::black_box(prepared.trace(scene, form))).0));
    }
    rates
}

/// The exponents of one series as a row.
fn fit(name: &str, points: &[Point]) -> String {
    let exponents = |time: fn(&Point, usize) -> f64| {
        let of = |side: usize| {
            growth(&points.iter().map(|point| (point.size, time(point, side))).collect::<Vec<_>>())
        };
        format!("{:.2}, {:.2}", of(0), of(1))
    };
    format!(
        "| {name} | {} | {} | {} |",
        exponents(|point, side| point.build[side]),
        exponents(|point, side| 1.0 / point.primary[side]),
        exponents(|point, side| 1.0 / point.ao[side]),
    )
}
