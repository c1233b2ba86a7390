//! Measures Lancer: how fast it builds and traces, and how its estimates converge.
//!
//! `cargo run --release -p lancer-bench -- speed` prints build times and rays per second by kind; `... -- embree`
//! compares them with Embree's; `... -- convergence` plots the error of ambient occlusion against the number of
//! its samples; `... -- peers` times whole processes against other renderers; `... -- window` watches
//! the window. README.md says what to install.

mod chart;
mod convergence;
mod embree;
mod figures;
mod first_light;
mod peers;
mod plot;
mod record;
mod speed;
mod subjects;
mod versus;
mod window;

use clap::{Args, Parser, Subcommand};
use peak_alloc::PeakAlloc;
use std::path::PathBuf;

/// Why a measurement could not be made; any error will do, from any thread.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Counts the bytes in use, so that the peak of a build is known.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Measures the Lancer ray tracer.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Seconds to build, bytes a triangle, and millions of rays a second by kind.
    Speed {
        /// Model files to measure beside the generated meshes.
        models: Vec<PathBuf>,
        /// Repetitions; the median is printed, all are kept with --raw.
        #[arg(long, default_value_t = 5)]
        runs: usize,
        /// Triangles of each generated mesh, in thousands.
        #[arg(long, default_value_t = 1000)]
        thousands: u32,
        /// Write all figures, with the date and the machine's name, into this directory.
        #[arg(long)]
        raw: Option<PathBuf>,
    },
    /// Lancer against Embree in the same run: by ray kind, by frame and by build.
    Embree {
        /// The tables to print.
        #[arg(long, value_enum, value_delimiter = ',', default_value = "kinds,frames,builds")]
        tables: Vec<versus::Table>,
        /// Write the last frame of both sides into this directory, to look at.
        #[arg(long)]
        images: Option<PathBuf>,
        #[command(flatten)]
        versus: Versus,
    },
    /// Draws the frames of a raw run that `embree --raw` has kept, as an SVG file.
    Chart {
        /// The run.
        run: PathBuf,
        /// The chart.
        #[arg(long, default_value = "docs/images/performance-frames.svg")]
        output: PathBuf,
    },
    /// How building and tracing grow with the scene, for Lancer and Embree.
    Scale {
        /// The most triangles or instances.
        #[arg(long, default_value_t = 16_000_000)]
        most: u32,
        #[command(flatten)]
        versus: Versus,
    },
    /// The time from a compiled dragon to a whole picture of it, and to coarse ones.
    FirstLight {
        #[command(flatten)]
        versus: Versus,
    },
    /// The error of ambient occlusion against N, as an SVG plot and a table.
    Convergence {
        /// The plot.
        #[arg(long, default_value = "docs/images/ao-convergence.svg")]
        output: PathBuf,
        /// Write the figures into this file too.
        #[arg(long)]
        data: Option<PathBuf>,
    },
    /// What a k-d tree costs against the bounds of its leaves and its depth: steps and tests a ray.
    KdTree {
        /// Triangles of the generated mesh, in thousands.
        #[arg(long, default_value_t = 100)]
        thousands: u32,
        /// Repetitions of what is timed; the median counts.
        #[arg(long, default_value_t = 3)]
        runs: usize,
        /// Write the figures into this file too.
        #[arg(long)]
        data: Option<PathBuf>,
    },
    /// How the time of a ray grows with the number of triangles, for each accelerator, on one thread.
    Growth {
        /// The most triangles.
        #[arg(long, default_value_t = 2_200_000)]
        most: u32,
        /// Repetitions; the least time counts.
        #[arg(long, default_value_t = 9)]
        runs: usize,
        /// Write the figures into this file too.
        #[arg(long)]
        data: Option<PathBuf>,
    },
    /// Lancer's program against POV-Ray, Tachyon, Mitsuba and Cycles on matched scenes.
    Peers(peers::Plan),
    /// How soon the window shows, moves and sharpens its picture, and what it uses at rest.
    Window(window::Plan),
}

/// What all comparisons with Embree ask for.
#[derive(Args)]
struct Versus {
    /// Where npm and pip put the models; see README.md.
    #[arg(long, default_value = "models")]
    models: PathBuf,
    /// Only these scenes, of bunny, dragon-48k, dragon, sphereflake, terrain, samurai and instances.
    #[arg(long, value_delimiter = ',')]
    scene: Vec<String>,
    /// Embree's library, where it is not found by itself.
    #[arg(long)]
    embree: Option<PathBuf>,
    /// Embree's configuration; the default lets it use 512 bits on processors where it would not by itself.
    #[arg(long, default_value = "frequency_level=simd512")]
    embree_config: String,
    /// Runs, in which the sides take turns.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Numbers of threads: `1`, `all`, or several with commas.
    #[arg(long, value_delimiter = ',', default_value = "1,all", value_parser = number_of_threads)]
    threads: Vec<usize>,
    /// Write all figures, with the date and the machine's name, into this directory.
    #[arg(long)]
    raw: Option<PathBuf>,
}

impl Versus {
    fn plan(self, tables: Vec<versus::Table>) -> versus::Plan {
        let mut threads = self.threads;
        threads.dedup();
        versus::Plan {
            models: self.models,
            only: self.scene,
            embree: self.embree,
            config: self.embree_config,
            tables,
            runs: self.runs.max(1),
            threads,
            raw: self.raw,
            images: None,
        }
    }
}

/// A number from 1, or `all`.
fn number_of_threads(text: &str) -> Result<usize, Failure> {
    match text {
        "all" => Ok(std::thread::available_parallelism()?.get()),
        _ => Ok(text.parse::<std::num::NonZeroUsize>()?.get()),
    }
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().command {
        Command::Speed { models, runs, thousands, raw } => {
            speed::measure(&speed::Plan { models, runs: runs.max(1), thousands, raw })
        }
        Command::Embree { tables, images, versus } => {
            versus::measure(&versus::Plan { images, ..versus.plan(tables) })
        }
        Command::Chart { run, output } => chart::draw(&run, &output),
        Command::Scale { most, versus } => versus::measure_scale(&versus.plan(Vec::new()), most),
        Command::FirstLight { versus } => versus::measure_first_light(&versus.plan(Vec::new())),
        Command::Convergence { output, data } => convergence::measure(&output, data.as_deref()),
        Command::KdTree { thousands, runs, data } => {
            figures::measure_kd_tree(thousands * 1000, runs.max(1), data.as_deref())
        }
        Command::Growth { most, runs, data } => figures::measure_growth(most, runs.max(1), data.as_deref()),
        Command::Peers(plan) => peers::measure(&plan),
        Command::Window(plan) => window::measure(&plan),
    }
}
