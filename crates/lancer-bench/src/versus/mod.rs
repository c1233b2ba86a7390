//! Lancer against Embree, in turns: by ray kind, by frame, by build, and over the size of the scene.

mod builds;
mod directions;
mod embree_side;
mod frames;
mod kinds;
mod lancer_side;
mod rays;
mod scale;
mod stage;

pub(crate) use stage::Stage;

use crate::Failure;
use crate::embree::device;
use crate::embree::ffi::{Device, Library};
use crate::record::keep;
use std::path::PathBuf;
use std::sync::Arc;

/// What to measure.
pub(crate) struct Plan {
    pub(crate) models: PathBuf,
    /// The scenes; all if it names none.
    pub(crate) only: Vec<String>,
    pub(crate) embree: Option<PathBuf>,
    /// Embree's configuration text.
    pub(crate) config: String,
    pub(crate) tables: Vec<Table>,
    pub(crate) runs: usize,
    pub(crate) threads: Vec<usize>,
    pub(crate) raw: Option<PathBuf>,
    /// Where both sides' frames go.
    pub(crate) images: Option<PathBuf>,
}

/// A table of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Table {
    /// Rays a second, by kind.
    Kinds,
    /// Milliseconds a frame, and how far the pictures differ.
    Frames,
    /// Seconds to build, and bytes kept and at the peak.
    Builds,
}

/// Prints the plan's tables.
#[expect(clippy::print_stdout, reason = "the tables are what the command is for")]
pub(crate) fn measure(plan: &Plan) -> Result<(), Failure> {
    let library = device::find(plan.embree.as_deref())?;
    let device = device_with(&library, plan, 0)?;
    println!("Embree {}; {} runs in turns.", device.version(), plan.runs);
    let mut records = Vec::new();
    for table in &plan.tables {
        let heading = match table {
            Table::Kinds => kinds::HEADING,
            Table::Frames => frames::HEADING,
            Table::Builds => builds::HEADING,
        };
        println!("{heading}");
        stage::each(&plan.models, &plan.only, |stage| {
            records.extend(match table {
                Table::Kinds => kinds::measure(stage, &device, plan)?,
                Table::Frames => frames::measure(stage, &device, plan)?,
                Table::Builds => builds::measure(stage, &library, plan)?,
            });
            Ok(())
        })?;
    }
    save(plan, "embree", &records)
}

/// Prints how times grow, up to `most` triangles or instances.
#[expect(clippy::print_stdout, reason = "the tables are what the command is for")]
pub(crate) fn measure_scale(plan: &Plan, most: u32) -> Result<(), Failure> {
    let library = device::find(plan.embree.as_deref())?;
    println!("Embree {}; {} runs in turns.", device_with(&library, plan, 0)?.version(), plan.runs);
    let records = scale::measure(&library, plan, most)?;
    save(plan, "scale", &records)
}

/// Prints how soon a picture of the dragon, or of what the plan names, is there.
pub(crate) fn measure_first_light(plan: &Plan) -> Result<(), Failure> {
    let only = if plan.only.is_empty() { vec!["dragon".to_owned()] } else { plan.only.clone() };
    stage::each(&plan.models, &only, |stage| {
        crate::first_light::measure(stage, &plan.threads, plan.runs, plan.raw.as_deref())
    })
}

/// A device that builds on so many threads; 0 for all.
fn device_with(library: &Arc<Library>, plan: &Plan, threads: usize) -> Result<Arc<Device>, Failure> {
    Device::new(library, &format!("threads={threads},{}", plan.config))
}

#[expect(clippy::print_stdout, reason = "where the figures are is part of the answer")]
fn save(plan: &Plan, name: &str, records: &[serde_json::Value]) -> Result<(), Failure> {
    if let Some(directory) = &plan.raw {
        println!("all figures: {}", keep(directory, name, records)?.display());
    }
    Ok(())
}
