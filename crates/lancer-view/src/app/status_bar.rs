//! The line at the bottom: what is being done, and what lies under the cursor.

use super::shelf::Showing;
use super::{Action, App};
use crate::commands::Command;
use crate::language::{Language, Phrase};
use crate::picture::Readout;
use crate::worker::OpenStage;
use eframe::egui::{Align, Button, Layout, ProgressBar, RichText, Ui};
use lancer_core::integrator::RayCounts;
use std::time::Duration;

const READING: Phrase = Phrase::new("Reading", "Lecture de");
const BUILDING: Phrase = Phrase::new("Building the trees of", "Construction des arbres de");
const REFINING: Phrase = Phrase::new("Refining", "Affinage");
const READY: Phrase = Phrase::new("Final picture", "Image finale");
const MOVING: Phrase = Phrase::new("Preview", "Aperçu");
const CANCEL: Phrase = Phrase::new("Cancel", "Annuler");
const LEFT: Phrase = Phrase::new("left", "restant");
const NOTHING: Phrase = Phrase::new("background", "arrière-plan");
const UNNAMED: Phrase = Phrase::new("(unnamed)", "(sans nom)");
const DISTANCE: Phrase = Phrase::new("distance", "distance");
const DEPTH: Phrase = Phrase::new("depth", "profondeur");
const WRITING: Phrase = Phrase::new("Writing…", "Écriture…");

impl App {
    /// Shows the line.
    pub(super) fn status_bar(&self, ui: &mut Ui, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            self.activity(ui, actions);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if let Some(readout) = &self.readout {
                    ui.add(
                        eframe::egui::Label::new(
                            RichText::new(readout_text(readout, self.language())).monospace().size(11.5),
                        )
                        .truncate(),
                    );
                }
            });
        });
    }

    fn activity(&self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let language = self.language();
        let mut cancel = |ui: &mut Ui| {
            if ui.add(Button::new(language.say(CANCEL)).small()).clicked() {
                actions.push(Action::Command(Command::Cancel));
            }
        };
        if let Some((source, stage)) = &self.opening {
            ui.spinner();
            let doing = match stage {
                OpenStage::Reading => READING,
                OpenStage::Building => BUILDING,
            };
            ui.label(format!("{} {}…", language.say(doing), source.title()));
            cancel(ui);
        } else if let Some(running) = &self.shelf.running {
            let done = running.done;
            ui.add(ProgressBar::new(done).desired_width(140.0).text(format!("{:.0} %", 100.0 * done)));
            ui.label(progress_text(done, running.elapsed, &running.rays, language));
            cancel(ui);
        } else if let Some(fault) = &self.view_fault {
            let color = ui.visuals().error_fg_color;
            ui.colored_label(color, fault);
        } else if self.shelf.showing == Showing::Live {
            self.live_activity(ui);
        } else if let Some(kept) = self.shelf.shown() {
            ui.label(format!("{}   {}", kept.title, kept.summary()));
        }
        if self.saver.is_busy() {
            ui.spinner();
            ui.label(language.say(WRITING));
        }
    }

    fn live_activity(&self, ui: &mut Ui) {
        let language = self.language();
        let Some(frame) = self.live.frame() else { return };
        let size = format!("{} × {}", frame.width, frame.height);
        if self.live.is_final() {
            let per_second = rate(frame.rays.total(), Duration::from_secs_f64(frame.seconds));
            ui.label(format!("{}   {size}   {:.2} s   {per_second}", language.say(READY), frame.seconds));
        } else if frame.passes == 0 || self.navigator.is_active() {
            ui.label(format!("{}   {size}", language.say(MOVING)));
        } else {
            ui.add(ProgressBar::new(frame.tiles_done).desired_width(90.0));
            ui.label(format!("{} {}/{}   {size}", language.say(REFINING), frame.pass + 1, frame.passes));
        }
    }
}

fn progress_text(done: f32, elapsed: Duration, rays: &RayCounts, language: Language) -> String {
    let mut parts = vec![time(elapsed)];
    if done > 0.01 {
        let left = elapsed.mul_f32((1.0 - done) / done);
        parts.push(format!("{} {}", time(left), language.say(LEFT)));
    }
    for (name, count) in [
        (Phrase::new("primary", "primaires"), rays.primary),
        (Phrase::new("shadow", "ombre"), rays.shadow),
        (Phrase::new("AO", "OA"), rays.ao),
        (Phrase::new("reflection", "réflexion"), rays.reflection),
        (Phrase::new("refraction", "réfraction"), rays.refraction),
    ] {
        if count > 0 {
            parts.push(format!("{} {}", language.say(name), rate(count, elapsed)));
        }
    }
    parts.join("   ")
}

/// Rays per second, in the unit that suits.
fn rate(rays: u64, elapsed: Duration) -> String {
    let per_second = rays as f64 / elapsed.as_secs_f64().max(1e-6);
    if per_second >= 1e6 {
        format!("{:.1} M/s", per_second / 1e6)
    } else {
        format!("{:.0} k/s", per_second / 1e3)
    }
}

/// Seconds, or minutes and seconds.
fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else {
        format!("{}:{:02}", seconds as u64 / 60, seconds as u64 % 60)
    }
}

fn readout_text(readout: &Readout, language: Language) -> String {
    let mut parts = vec![format!("({}, {})", readout.x, readout.y)];
    if let Some([r, g, b]) = readout.value {
        parts.push(format!("RGB {r:.4} {g:.4} {b:.4}"));
    }
    let named = |name: &str| if name.is_empty() { language.say(UNNAMED).to_owned() } else { name.to_owned() };
    match &readout.surface {
        None => parts.push(language.say(NOTHING).to_owned()),
        Some(surface) => {
            let n = surface.feature.shading_normal;
            parts.push(format!("{} · {}", named(&surface.object), named(&surface.material)));
            parts.push(format!("{} {:.4}", language.say(DEPTH), surface.depth));
            parts.push(format!("{} {:.4}", language.say(DISTANCE), surface.feature.distance));
            parts.push(format!("N ({:.3}, {:.3}, {:.3})", n.x, n.y, n.z));
        }
    }
    parts.join("  ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_rates_are_told_in_units_that_suit() {
        assert_eq!(time(Duration::from_millis(1340)), "1.3 s");
        assert_eq!(time(Duration::from_secs(125)), "2:05");
        assert_eq!(rate(3_000_000, Duration::from_secs(2)), "1.5 M/s");
        assert_eq!(rate(3_000, Duration::from_secs(2)), "2 k/s");
    }
}
