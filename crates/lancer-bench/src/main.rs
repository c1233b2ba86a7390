//! Measures Lancer: how fast it builds and traces, and how its estimates converge.
//!
//! `cargo run --release -p lancer-bench -- speed` prints build times and rays per second by kind;
//! `... -- convergence` plots the error of ambient occlusion against the number of its samples;
//! `... -- peers` times whole processes against other renderers.

mod convergence;
mod peers;
mod plot;
mod speed;
mod subjects;

use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Why a measurement could not be made; any error will do, from any thread.
type Failure = Box<dyn std::error::Error + Send + Sync>;

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
    /// The error of ambient occlusion against N, as an SVG plot and a table.
    Convergence {
        /// The plot.
        #[arg(long, default_value = "docs/images/ao-convergence.svg")]
        output: PathBuf,
    },
    /// Lancer's program against POV-Ray, Tachyon, Mitsuba and Cycles on matched scenes.
    Peers(peers::Plan),
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().command {
        Command::Speed { models, runs, thousands, raw } => {
            speed::measure(&speed::Plan { models, runs: runs.max(1), thousands, raw })
        }
        Command::Convergence { output } => convergence::measure(&output),
        Command::Peers(plan) => peers::measure(&plan),
    }
}
