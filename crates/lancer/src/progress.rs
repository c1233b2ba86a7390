//! Progress, drawn on standard error while it is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lancer_core::integrator::RayCounts;
use lancer_core::render::Tile;
use lancer_io::progress::ReadProgress;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Often enough to look alive, seldom enough to cost nothing.
const REDRAW: Duration = Duration::from_millis(100);

/// Draws what goes on, or nothing.
pub(crate) struct Progress {
    quiet: bool,
}

impl Progress {
    /// Progress that is drawn unless it is to be quiet.
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet }
    }

    /// Draws that `work` goes on, of which nobody knows how long it takes.
    pub(crate) fn during<T>(&self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let bar = self.start(ProgressBar::no_length(), "{spinner} {msg} {elapsed}");
        bar.set_message(name);
        let result = work();
        bar.finish_and_clear();
        result
    }

    /// Draws that files are read: how long it takes, and how far it is through a model that is worth a bar.
    pub(crate) fn reading(&self) -> Reading {
        let bar = self.start(ProgressBar::no_length(), "{spinner} reading {elapsed}");
        Reading { bar }
    }

    /// Draws how a render of so many pixels goes on.
    pub(crate) fn pixels(&self, pixels: u64) -> PixelProgress {
        let template = "rendering {percent:>3}% [{bar:30}] {msg}, {eta} left";
        let bar = self.start(ProgressBar::new(pixels), template);
        bar.set_message(rays_per_second(0, Duration::ZERO));
        PixelProgress { bar, rays: AtomicU64::new(0) }
    }

    fn start(&self, bar: ProgressBar, template: &str) -> ProgressBar {
        // Neither target draws on anything but a terminal.
        let target = if self.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        bar.set_draw_target(target);
        bar.set_style(style(template));
        bar.enable_steady_tick(REDRAW);
        bar
    }
}

/// No colours: then there are none to leave out for NO_COLOR.
fn style(template: &str) -> ProgressStyle {
    let style = ProgressStyle::with_template(template).expect("the templates in this file are well formed");
    style.progress_chars("=> ")
}

/// Draws how far the reading of files is. Cleared when it is dropped.
pub(crate) struct Reading {
    bar: ProgressBar,
}

impl Reading {
    /// What hears of each model's bytes.
    pub(crate) fn hears(&self) -> ReadProgress {
        let bar = self.bar.clone();
        ReadProgress::new(move |read, total| {
            if bar.length() != Some(total) {
                bar.set_length(total);
                bar.set_style(style(
                    "reading {percent:>3}% [{bar:30}] {binary_bytes} of {binary_total_bytes}",
                ));
            }
            bar.set_position(read);
        })
    }
}

impl Drop for Reading {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Draws how a render goes on. Cleared when it is dropped.
pub(crate) struct PixelProgress {
    bar: ProgressBar,
    rays: AtomicU64,
}

impl PixelProgress {
    /// A tile is done. May be called from any thread.
    pub(crate) fn advance(&self, tile: &Tile, rays: &RayCounts) {
        let total = self.rays.fetch_add(rays.total(), Ordering::Relaxed) + rays.total();
        self.bar.inc(tile.pixels.len() as u64);
        if !self.bar.is_hidden() {
            self.bar.set_message(rays_per_second(total, self.bar.elapsed()));
        }
    }
}

impl Drop for PixelProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A rate for people, as in `3.4 M rays/s`.
pub(crate) fn rays_per_second(rays: u64, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64();
    let rate = if seconds > 0.0 { rays as f64 / seconds } else { 0.0 };
    format!("{} rays/s", short_count(rate))
}

/// A count for people, with three digits or so: `812`, `3.4 k`, `1.2 G`.
pub(crate) fn short_count(count: f64) -> String {
    /// Each a thousand times the one before.
    const UNITS: [&str; 5] = ["", " k", " M", " G", " T"];
    let mut scaled = count;
    let mut unit = 0;
    // At 999.95 one decimal would round up to 1000.0.
    while scaled >= 999.95 && unit + 1 < UNITS.len() {
        scaled /= 1000.0;
        unit += 1;
    }
    let decimals = usize::from(unit > 0);
    format!("{scaled:.decimals$}{}", UNITS[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_short_at_every_size() {
        let shown = [0.0, 812.0, 1000.0, 3449.0, 999_999.0, 1.25e9, 7e15].map(short_count);
        assert_eq!(shown, ["0", "812", "1.0 k", "3.4 k", "1.0 M", "1.2 G", "7000.0 T"]);
    }

    #[test]
    fn no_time_means_no_rate() {
        assert_eq!(rays_per_second(5, Duration::ZERO), "0 rays/s");
        assert_eq!(rays_per_second(5000, Duration::from_secs(2)), "2.5 k rays/s");
    }
}
