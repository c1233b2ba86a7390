//! Measures Lancer: how fast it builds and traces, and how its estimates converge.
//!
//! `cargo run --release -p lancer-bench -- speed` prints build times and rays per second by kind;
//! `... -- convergence` plots the error of ambient occlusion against the number of its samples.

mod convergence;
mod plot;

use clap::{Parser, Subcommand};
use std::error::Error;
use std::path::PathBuf;

/// Measures the Lancer ray tracer.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// The error of ambient occlusion against N, as an SVG plot and a table.
    Convergence {
        /// The plot.
        #[arg(long, default_value = "docs/images/ao-convergence.svg")]
        output: PathBuf,
    },
}

fn main() -> Result<(), Box<dyn Error>> {
    match Arguments::parse().command {
        Command::Convergence { output } => convergence::measure(&output),
    }
}
