//! Rays per second by kind, Lancer against each of Embree's forms.

use super::embree_side::{Form, Met, Prepared, scene_of, triangles_of};
use super::rays::{Lot, lots};
use super::stage::Stage;
use super::{Plan, lancer_side};
use crate::Failure;
use crate::embree::ffi::{Build, Device, Quality, Scene};
use crate::record::{Ratio, median, seconds};
use lancer_core::render::with_threads;
use lancer_core::world::{CompileOptions, Hit, World};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::sync::Arc;

/// Rays that one call of Lancer gets.
const CHUNK: usize = 1024;
/// Points, or packets, that one call of Lancer gets.
const FANS: usize = 64;

pub(super) const HEADING: &str =
    "\nRays, millions a second. Ratios are Lancer's to Embree's, medians over the runs \
(least..most).\n
| scene | kind | threads | Lancer, 1 ray | Embree, 1 ray | ratio | Lancer, together | Embree's best | its form | ratio |
|---|---|---:|---:|---:|---:|---:|---:|---|---:|";

/// Embree's scenes of a stage: as it is by default, and otherwise.
struct Scenes {
    high: Scene,
    others: Vec<(&'static str, Scene)>,
}

/// Prints a stage's rows; returns its figures.
#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(super) fn measure(stage: &Stage, device: &Arc<Device>, plan: &Plan) -> Result<Vec<Value>, Failure> {
    let world = World::compile(&stage.scene, &CompileOptions::default())?;
    let triangles = triangles_of(stage);
    let build = |quality, robust| scene_of(stage, &triangles, device, Build { quality, robust });
    let scenes = Scenes {
        high: build(Quality::High, false)?,
        others: vec![("medium", build(Quality::Medium, false)?), ("robust", build(Quality::High, true)?)],
    };
    let mut records = Vec::new();
    let mut notes = Vec::new();
    for lot in lots(stage, &world)? {
        let prepared = Prepared::new(&lot);
        for &threads in &plan.threads {
            let rates =
                with_threads(threads, || Rates::measure(&world, &scenes, &lot, &prepared, plan.runs))?;
            println!("{}", rates.row(stage, &lot, threads));
            notes.push(rates.note(&lot, threads));
            let mut record = rates.to_json(stage, &lot, threads);
            if threads == plan.threads[0] {
                let difference = Difference::between(&world, &scenes.high, &lot, &prepared, rates.best());
                notes.push(format!("{}: {difference}", lot.kind.name()));
                record["difference"] = difference.to_json();
            }
            records.push(record);
        }
    }
    println!("\n{}, all forms:\n", stage.name);
    notes.iter().for_each(|note| println!("- {note}"));
    println!();
    Ok(records)
}

/// Millions of rays a second, one entry a run.
struct Rates {
    alone: Vec<f64>,
    together: Vec<f64>,
    forms: Vec<(Form, Vec<f64>)>,
    /// The best form on scenes that were built otherwise.
    others: Vec<(&'static str, Vec<f64>)>,
}

impl Rates {
    /// Takes turns: Lancer, then each form of Embree, and again.
    fn measure(world: &World, scenes: &Scenes, lot: &Lot, prepared: &Prepared, runs: usize) -> Self {
        let mut rates = Self {
            alone: Vec::new(),
            together: Vec::new(),
            forms: Form::all(lot).into_iter().map(|form| (form, Vec::new())).collect(),
            others: scenes.others.iter().map(|(name, _)| (*name, Vec::new())).collect(),
        };
        let rate = |seconds: f64| lot.rays.len() as f64 / seconds / 1e6;
        for _ in 0..runs {
            rates.alone.push(rate(seconds(|| std::hint::black_box(trace_alone(world, lot))).0));
            rates.together.push(rate(seconds(|| std::hint::black_box(trace(world, lot))).0));
            for (form, values) in &mut rates.forms {
                values.push(rate(seconds(|| std::hint::black_box(prepared.trace(&scenes.high, *form))).0));
            }
            let best = rates.best();
            for ((_, values), (_, scene)) in rates.others.iter_mut().zip(&scenes.others) {
                values.push(rate(seconds(|| std::hint::black_box(prepared.trace(scene, best))).0));
            }
        }
        rates
    }

    fn best(&self) -> Form {
        let by_median = |a: &&(Form, Vec<f64>), b: &&(Form, Vec<f64>)| median(&a.1).total_cmp(&median(&b.1));
        self.forms.iter().max_by(by_median).map_or(self.forms[0].0, |best| best.0)
    }

    fn of(&self, form: Form) -> &[f64] {
        self.forms.iter().find(|entry| entry.0 == form).map_or(&[], |entry| &entry.1)
    }

    fn row(&self, stage: &Stage, lot: &Lot, threads: usize) -> String {
        let (best, single) = (self.best(), self.forms[0].0);
        format!(
            "| {} | {} | {threads} | {:.2} | {:.2} | {} | {:.2} | {:.2} | {} | {} |",
            stage.name,
            lot.kind.name(),
            median(&self.alone),
            median(self.of(single)),
            Ratio::of(&self.alone, self.of(single)),
            median(&self.together),
            median(self.of(best)),
            best.name(lot),
            Ratio::of(&self.together, self.of(best)),
        )
    }

    fn note(&self, lot: &Lot, threads: usize) -> String {
        let forms =
            self.forms.iter().map(|(form, values)| format!("{} {:.2}", form.name(lot), median(values)));
        let others =
            self.others.iter().map(|(name, values)| format!("best form, {name} {:.2}", median(values)));
        let all: Vec<String> = forms.chain(others).collect();
        format!("{}, {} rays, threads {threads}: {}", lot.kind.name(), lot.rays.len(), all.join("; "))
    }

    fn to_json(&self, stage: &Stage, lot: &Lot, threads: usize) -> Value {
        let forms: serde_json::Map<String, Value> = self
            .forms
            .iter()
            .map(|(form, values)| (form.name(lot), json!(values)))
            .chain(self.others.iter().map(|(name, values)| (format!("best form, {name}"), json!(values))))
            .collect();
        json!({
            "table": "kinds",
            "scene": stage.name,
            "triangles": stage.triangles(),
            "kind": lot.kind.name(),
            "rays": lot.rays.len(),
            "threads": threads,
            "lancer_alone_mrays": self.alone,
            "lancer_together_mrays": self.together,
            "embree_mrays": forms,
        })
    }
}

/// Traces a lot on the threads of the current pool, the rays of a point or of a block of pixels together. Returns how
/// many rays met something.
pub(super) fn trace(world: &World, lot: &Lot) -> usize {
    if !lot.fans.is_empty() {
        let trace = |fans: &[_], blocked: &mut _| lancer_side::occluded_fans(world, fans, lot.reach, blocked);
        count(&lot.fans, FANS, trace, |blocked| *blocked)
    } else if lot.kind.is_occlusion() {
        let trace = |packets: &[_], blocked: &mut _| lancer_side::occluded_packets(world, packets, blocked);
        count(&lot.packets, FANS, trace, |blocked| *blocked)
    } else {
        let trace = |packets: &[_], hits: &mut _| lancer_side::intersect_packets(world, packets, hits);
        count(&lot.packets, FANS, trace, Option::is_some)
    }
}

/// As [`trace`], ray by ray.
fn trace_alone(world: &World, lot: &Lot) -> usize {
    if lot.kind.is_occlusion() {
        let trace = |rays: &[_], blocked: &mut _| lancer_side::occluded(world, rays, blocked);
        count(&lot.rays, CHUNK, trace, |blocked| *blocked)
    } else {
        let trace = |rays: &[_], hits: &mut _| lancer_side::intersect(world, rays, hits);
        count(&lot.rays, CHUNK, trace, Option::is_some)
    }
}

/// Traces so much of `all` at once. Returns how many of the answers are that something was met.
fn count<T: Sync, A: Send>(
    all: &[T],
    at_once: usize,
    trace: impl Fn(&[T], &mut Vec<A>) + Sync,
    is_met: impl Fn(&A) -> bool + Sync,
) -> usize {
    let met = |answers: &mut Vec<A>, part: &[T]| {
        trace(part, answers);
        answers.iter().filter(|answer| is_met(answer)).count()
    };
    all.par_chunks(at_once).map_init(Vec::new, met).sum()
}

/// How far the answers of both sides differ.
struct Difference {
    /// Of the rays, those that only one side says meet something.
    hit_or_miss: f64,
    /// Of the rays, those that meet another triangle.
    primitive: f64,
    /// The largest relative difference of t where both meet the same triangle.
    t: f64,
}

impl Difference {
    fn between(world: &World, scene: &Scene, lot: &Lot, prepared: &Prepared, form: Form) -> Self {
        let theirs = prepared.answers(scene, form);
        let ours: Vec<Option<Met>> = if lot.kind.is_occlusion() {
            let mut blocked = Vec::new();
            if lot.fans.is_empty() {
                lancer_side::occluded_packets(world, &lot.packets, &mut blocked);
            } else {
                lancer_side::occluded_fans(world, &lot.fans, lot.reach, &mut blocked);
            }
            blocked.iter().map(|blocked| blocked.then_some(Met { t: 0.0, object: 0, primitive: 0 })).collect()
        } else {
            let mut hits = Vec::new();
            lancer_side::intersect_packets(world, &lot.packets, &mut hits);
            let met = |hit: &Hit| Met {
                t: hit.t as f32,
                object: hit.object.index() as u32,
                primitive: hit.primitive,
            };
            hits.iter().map(|hit| hit.as_ref().map(met)).collect()
        };
        let (mut unlike, mut elsewhere, mut t) = (0, 0, 0.0_f64);
        for pair in ours.iter().zip(&theirs) {
            match pair {
                (Some(ours), Some(theirs)) => {
                    if (ours.object, ours.primitive) != (theirs.object, theirs.primitive) {
                        elsewhere += 1;
                    } else if ours.t != theirs.t {
                        t = t.max(f64::from((ours.t - theirs.t) / ours.t).abs());
                    }
                }
                (None, None) => {}
                _ => unlike += 1,
            }
        }
        let rays = lot.rays.len() as f64;
        Self { hit_or_miss: f64::from(unlike) / rays, primitive: f64::from(elsewhere) / rays, t }
    }

    fn to_json(&self) -> Value {
        json!({ "hit_or_miss": self.hit_or_miss, "primitive": self.primitive, "largest_relative_t": self.t })
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { hit_or_miss, primitive, t } = self;
        write!(
            f,
            "hit or miss differs for {hit_or_miss:.1e} of the rays, the triangle for {primitive:.1e}; t by {t:.1e}"
        )
    }
}
