//! Lancer against Embree, in turns: by ray kind, by frame, by build, and over the size of the scene.

mod directions;
mod embree_side;
mod kinds;
mod lancer_side;
mod rays;
mod stage;

use crate::Failure;
use crate::embree::device;
use crate::embree::ffi::Device;
use crate::record::keep;
use std::path::PathBuf;

/// What to measure.
pub(crate) struct Plan {
    pub(crate) models: PathBuf,
    /// A part of the names of the scenes.
    pub(crate) only: String,
    pub(crate) embree: Option<PathBuf>,
    /// Embree's configuration text.
    pub(crate) config: String,
    pub(crate) tables: Vec<Table>,
    pub(crate) runs: usize,
    pub(crate) threads: Vec<usize>,
    pub(crate) raw: Option<PathBuf>,
}

/// A table of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Table {
    /// Rays a second, by kind.
    Kinds,
}

#[expect(clippy::print_stdout, reason = "the tables are what the command is for")]
pub(crate) fn measure(plan: &Plan) -> Result<(), Failure> {
    let library = device::find(plan.embree.as_deref())?;
    let device = Device::new(&library, &plan.config)?;
    println!("Embree {}; {} runs in turns.", device.version(), plan.runs);
    let mut records = Vec::new();
    if plan.tables.contains(&Table::Kinds) {
        println!("{}", kinds::HEADING);
        for stage in stage::all(&plan.models, &plan.only)? {
            records.extend(kinds::measure(&stage, &device, plan)?);
        }
    }
    if let Some(directory) = &plan.raw {
        let path = keep(directory, "embree", &records)?;
        println!("all figures: {}", path.display());
    }
    Ok(())
}
