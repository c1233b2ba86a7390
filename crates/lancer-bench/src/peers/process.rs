//! Runs a program once and measures it from outside.

use super::Entry;
use crate::Failure;
use serde_json::Value;
use std::fmt;
use std::fs;
use std::process::Command;
use std::time::Instant;

/// What one run of a program took, in seconds.
pub(super) struct Outcome {
    /// From before its start until after its end.
    pub(super) whole: f64,
    /// Of all processors together; NaN where the system does not tell.
    pub(super) cpu: f64,
    /// What it says itself, without the start of an interpreter.
    pub(super) own: Option<f64>,
    /// Lancer's seconds by stage, and its rays by kind.
    pub(super) report: Option<Value>,
}

/// Where the programs run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pinning {
    /// On processor 0, by `taskset`.
    OneProcessor,
    /// Wherever the system puts their threads.
    Free,
}

impl Pinning {
    /// One thread belongs on one processor, if there is a way to keep it there: some renderers start helpers that
    /// their own options do not count.
    pub(super) fn choose(threads: usize) -> Self {
        let works = || Command::new("taskset").args(["-c", "0", "true"]).status().is_ok_and(|s| s.success());
        if threads == 1 && works() { Self::OneProcessor } else { Self::Free }
    }
}

impl fmt::Display for Pinning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OneProcessor => "by the renderers' options and bound to processor 0 by taskset",
            Self::Free => "by the renderers' options",
        })
    }
}

/// Runs an entry, and checks that it drew something.
pub(super) fn run(entry: &Entry, pinning: Pinning) -> Result<Outcome, Failure> {
    if entry.image.exists() {
        fs::remove_file(&entry.image)?;
    }
    let mut words = entry.command.iter();
    let mut command = match pinning {
        Pinning::OneProcessor => Command::new("taskset"),
        Pinning::Free => Command::new(words.next().ok_or("an empty command")?),
    };
    if pinning == Pinning::OneProcessor {
        command.args(["-c", "0"]);
    }
    command.args(words);
    let cpu_before = cpu_of_children();
    let start = Instant::now();
    let output = command.output().map_err(|error| format!("{}: {error}", entry.label))?;
    let whole = start.elapsed().as_secs_f64();
    let cpu = cpu_of_children() - cpu_before;
    let said = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() || !entry.image.exists() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{}: {}\n{said}\n{complaint}", entry.label, output.status).into());
    }
    let report = serde_json::from_str::<Value>(&said).ok();
    let report = report.map(|report| {
        let parts = ["seconds", "rays", "triangles", "peak_memory_bytes"];
        parts.into_iter().map(|part| (part.to_owned(), report[part].clone())).collect::<Value>()
    });
    let told = report.as_ref().and_then(|report| report["seconds"]["total"].as_f64());
    let own = told
        .or_else(|| said.lines().find_map(|line| line.strip_prefix("seconds after import: ")?.parse().ok()));
    Ok(Outcome { whole, cpu, own, report })
}

/// Seconds of user and system time of all children that have ended.
fn cpu_of_children() -> f64 {
    /// Linux counts in hundredths for programs, whatever it does inside.
    const TICK: f64 = 0.01;
    let status = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which may hold anything, from field 3 on: cutime and cstime are 16 and 17.
    let fields = status.rsplit_once(')').map_or("", |(_, rest)| rest).split_whitespace();
    let ticks = fields.skip(13).take(2).filter_map(|field| field.parse::<f64>().ok()).collect::<Vec<_>>();
    if ticks.len() == 2 { (ticks[0] + ticks[1]) * TICK } else { f64::NAN }
}

/// How many programs wanted a processor in the last minute, where the system tells it.
pub(super) fn load() -> Option<f64> {
    fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}
