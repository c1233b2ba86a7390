//! Figures, kept raw with what is needed to understand them later.

use crate::Failure;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// The middle of all values; NaN where there is none.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        length if length % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

/// How one side of a comparison stands to the other: the ratio in each run, where both sides had the same machine
/// in the same mood.
pub(crate) struct Ratio {
    pub(crate) median: f64,
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Ratio {
    /// Of `a` to `b`, run by run.
    pub(crate) fn of(a: &[f64], b: &[f64]) -> Self {
        let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
        Self {
            median: median(&ratios),
            least: ratios.iter().copied().fold(f64::INFINITY, f64::min),
            most: ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2} ({:.2}..{:.2})", self.median, self.least, self.most)
    }
}

/// The exponent e of the power law y = a x^e that fits best: least squares in logarithms of both.
pub(crate) fn growth(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs = points.iter().map(|&(x, y)| (x.log2(), y.log2()));
    let (sum_x, sum_y) = logs.clone().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    let (mean_x, mean_y) = (sum_x / n, sum_y / n);
    let across: f64 = logs.clone().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let along: f64 = logs.map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    across / along
}

/// Seconds that `work` takes.
pub(crate) fn seconds<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// Writes figures into a file of `directory`, named after the measurement and the time.
pub(crate) fn keep(directory: &Path, name: &str, rows: &[Value]) -> Result<PathBuf, Failure> {
    keep_fields(directory, name, json!({ "command": command_line(), "rows": rows }))
}

/// As [`keep`], with fields of the measurement's own beside the time, the machine and the version.
pub(crate) fn keep_fields(directory: &Path, name: &str, fields: Value) -> Result<PathBuf, Failure> {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs();
    std::fs::create_dir_all(directory)?;
    let path = directory.join(format!("{name}-{seconds}.json"));
    let mut record = json!({ "unix_time": seconds });
    if let (Value::Object(record), Value::Object(fields)) = (&mut record, fields) {
        record.extend(fields);
    }
    write(&path, record)?;
    Ok(path)
}

/// Writes fields, the machine and the version into a file of their own: the figures of a plot.
pub(crate) fn write(path: &Path, fields: Value) -> Result<(), Failure> {
    let mut record = json!({ "machine": processor_name(), "version": env!("CARGO_PKG_VERSION") });
    if let (Value::Object(record), Value::Object(fields)) = (&mut record, fields) {
        record.extend(fields);
    }
    Ok(std::fs::write(path, serde_json::to_string_pretty(&record)? + "\n")?)
}

/// The command as typed, without the directories of this machine.
pub(crate) fn command_line() -> String {
    let name = |word: String| match Path::new(&word).file_name() {
        Some(name) => name.to_string_lossy().into_owned(),
        None => word,
    };
    std::env::args().map(name).collect::<Vec<_>>().join(" ")
}

/// The processor's name where the system tells it.
fn processor_name() -> String {
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_an_even_number_lies_between_the_middle_two() {
        assert_eq!(median(&[4.0, 1.0, 3.0]), 3.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn ratio_is_the_median_of_the_runs_and_not_the_ratio_of_medians() {
        let ratio = Ratio::of(&[2.0, 20.0, 9.0], &[1.0, 10.0, 1.0]);
        assert_eq!((ratio.least, ratio.median, ratio.most), (2.0, 2.0, 9.0));
    }

    #[test]
    fn growth_of_a_power_law_is_its_exponent() {
        let points = [1.0_f64, 3.0, 10.0, 700.0].map(|x| (x, 5.0 * x * x.sqrt()));
        assert!((growth(&points) - 1.5).abs() < 1e-12);
        assert_eq!(growth(&[(1.0, 7.0), (4.0, 7.0)]), 0.0);
    }
}
