//! The rows that decide what every pixel equals, and how long it takes.

use super::super::fields::Rows;
use super::parameters as p;
use crate::Phrase;
use lancer_core::accel::{Accelerator, KdTree};
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::scene::{AmbientOcclusion, Settings};
use lancer_core::world::CompileOptions;

/// Whether one side of the picture follows the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LinkedSides {
    /// The sides whose ratio is kept. The first ones: rounded ones would drift.
    sides: Option<(u32, u32)>,
}

impl LinkedSides {
    fn is_on(self) -> bool {
        self.sides.is_some()
    }

    fn set(&mut self, on: bool, settings: &Settings) {
        self.sides = on.then_some((settings.width, settings.height));
    }

    /// The settings with the other side made to follow the one that is not as it was.
    fn follow(&mut self, before: &Settings, after: &mut Settings) {
        let Some((width, height)) = &mut self.sides else { return };
        if scaled(before.width, *width, *height) != before.height
            && scaled(before.height, *height, *width) != before.width
        {
            // Something else has set them: that is the ratio now.
            (*width, *height) = (before.width, before.height);
        }
        if after.width != before.width {
            after.height = scaled(after.width, *width, *height);
        } else if after.height != before.height {
            after.width = scaled(after.height, *height, *width);
        }
    }
}

/// `side * to / from`, rounded, within what a side may be.
fn scaled(side: u32, from: u32, to: u32) -> u32 {
    let side = (u64::from(side) * u64::from(to) + u64::from(from) / 2) / u64::from(from.max(1));
    u32::try_from(side).unwrap_or(u32::MAX).clamp(1, Settings::MAX_SIDE)
}

/// Sizes that pictures often have.
const SIZES: [(u32, u32, &str); 7] = [
    (640, 480, "VGA"),
    (800, 600, "SVGA"),
    (1024, 1024, "1 : 1"),
    (1280, 720, "HD"),
    (1920, 1080, "Full HD"),
    (2560, 1440, "QHD"),
    (3840, 2160, "4K"),
];

/// Width and height.
pub(super) fn size(rows: &mut Rows, linked: &mut LinkedSides, settings: &mut Settings, own: &Settings) {
    const SIZE: Phrase = Phrase::new("Usual sizes", "Tailles usuelles");
    const OWN: Phrase = Phrase::new("The scene’s own", "Celle de la scène");
    const LINK: Phrase = Phrase::new("Keep the ratio", "Garder le rapport");
    let before = *settings;
    let longest =
        |other: u32| u32::try_from(Settings::MAX_PIXELS / u64::from(other.max(1))).unwrap_or(u32::MAX);
    // With linked sides, both grow: what is too many pixels is only known afterwards.
    let most =
        |other| if linked.is_on() { Settings::MAX_SIDE } else { longest(other).min(Settings::MAX_SIDE) };
    let (widest, tallest) = (most(before.height), most(before.width));
    rows.number(&p::WIDTH, &mut settings.width, own.width, 1..=widest, 1.0);
    rows.number(&p::HEIGHT, &mut settings.height, own.height, 1..=tallest, 1.0);
    linked.follow(&before, settings);
    if settings.validate().is_err() {
        (settings.width, settings.height) = (before.width, before.height);
    }
    let language = rows.language;
    rows.ui.horizontal(|ui| {
        ui.menu_button(language.say(SIZE), |ui| {
            let sizes = [(own.width, own.height, language.say(OWN))].into_iter().chain(SIZES);
            for (width, height, name) in sizes {
                let is_chosen = (settings.width, settings.height) == (width, height);
                if ui.selectable_label(is_chosen, format!("{width} × {height}   {name}")).clicked() {
                    (settings.width, settings.height) = (width, height);
                    if linked.is_on() {
                        linked.set(true, settings);
                    }
                }
            }
        });
        let mut on = linked.is_on();
        if ui.checkbox(&mut on, language.say(LINK)).changed() {
            linked.set(on, settings);
        }
    });
}

/// How light becomes pixels.
pub(super) fn film(
    rows: &mut Rows,
    settings: &mut Settings,
    own: &Settings,
    tone: &mut Tone,
    own_tone: Tone,
) {
    rows.number(&p::SUBPIXELS, &mut settings.samples, own.samples, 1..=Settings::MAX_SAMPLES, 0.05);
    rows.number(&p::EXPOSURE, &mut tone.exposure, own_tone.exposure, -MAX_EXPOSURE..=MAX_EXPOSURE, 0.02);
    let curves = ToneCurve::ALL.map(|curve| (curve, curve_name(curve)));
    rows.choice(&p::CURVE, &mut tone.curve, own_tone.curve, &curves);
}

fn curve_name(curve: ToneCurve) -> Phrase {
    match curve {
        ToneCurve::Linear => Phrase::new("None: cut", "Aucune : coupé"),
        ToneCurve::Reinhard => Phrase::same("Reinhard"),
        ToneCurve::Filmic => Phrase::new("Filmic", "Film"),
        ToneCurve::Raw => Phrase::new("Raw: no sRGB", "Brut : sans sRGB"),
    }
}

/// Stops beyond which every picture is black or white.
const MAX_EXPOSURE: f64 = 32.0;

/// Which terms are traced, and how far.
pub(super) fn light(rows: &mut Rows, settings: &mut Settings, own: &Settings) {
    rows.number(&p::DEPTH, &mut settings.depth, own.depth, 0..=Settings::MAX_DEPTH, 0.05);
    rows.switch(&p::SHADOWS, &mut settings.shadows, own.shadows);
    rows.switch(&p::REFLECTIONS, &mut settings.reflection, own.reflection);
    rows.switch(&p::REFRACTIONS, &mut settings.refraction, own.refraction);
}

/// Ambient occlusion; `remembered` is N for when it is turned on again.
pub(super) fn occlusion(
    rows: &mut Rows,
    remembered: &mut u32,
    ao: &mut AmbientOcclusion,
    own: AmbientOcclusion,
) {
    if ao.samples > 0 {
        *remembered = ao.samples;
    }
    let mut on = ao.samples > 0;
    rows.switch(&p::OCCLUSION, &mut on, own.samples > 0);
    if on != (ao.samples > 0) {
        ao.samples = if on { *remembered } else { 0 };
    }
    if on {
        let usual = if own.samples > 0 { own.samples } else { *remembered };
        rows.number(&p::OCCLUSION_SAMPLES, &mut ao.samples, usual, 1..=Settings::MAX_AO_SAMPLES, 0.5);
        let speed = 0.01 * ao.distance.min(MAX_DISTANCE);
        rows.number(
            &p::OCCLUSION_DISTANCE,
            &mut ao.distance,
            own.distance,
            MIN_DISTANCE..=MAX_DISTANCE,
            speed,
        );
    }
}

/// Distances of occlusion that can be set here: far below and above the size of any scene that has occlusion to see.
const MIN_DISTANCE: f64 = 1e-6;
const MAX_DISTANCE: f64 = 1e9;

/// What changes the time that a picture takes, and nothing in it.
pub(super) fn speed(rows: &mut Rows, options: &mut CompileOptions, threads: &mut usize) {
    let accelerators = Accelerator::ALL.map(|accelerator| (accelerator, accelerator_name(accelerator)));
    rows.choice(&p::ACCELERATOR, &mut options.accelerator, Accelerator::default(), &accelerators);
    if options.accelerator == Accelerator::KdTree {
        rows.automatic(&p::LEAF, &mut options.kd.leaf, USUAL_LEAF, 1..=MAX_LEAF);
        rows.automatic(&p::TREE_DEPTH, &mut options.kd.depth, USUAL_DEPTH, 0..=KdTree::MAX_DEPTH);
    }
    let mut count = u32::try_from(*threads).ok().filter(|&count| count > 0);
    rows.automatic(&p::THREADS, &mut count, 1, 1..=MAX_THREADS);
    *threads = count.map_or(0, |count| count as usize);
}

/// Where numbers start that are no longer automatic: as the renderer chooses for a mesh of 100,000 triangles.
const USUAL_LEAF: u32 = 4;
const USUAL_DEPTH: u32 = 29;

/// The largest leaf that can be set here: a tree of one leaf for a mesh of a million triangles is no tree.
const MAX_LEAF: u32 = 1_000_000;

/// More than any machine has cores; each thread has a stack of its own.
const MAX_THREADS: u32 = 1024;

fn accelerator_name(accelerator: Accelerator) -> Phrase {
    match accelerator {
        Accelerator::Bvh => Phrase::new("Boxes (fastest)", "Boîtes (rapide)"),
        Accelerator::KdTree => Phrase::new("k-d tree", "Arbre k-d"),
        Accelerator::BruteForce => Phrase::new("None: try everything", "Aucune : tout essayer"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sized(width: u32, height: u32) -> Settings {
        Settings { width, height, ..Settings::default() }
    }

    #[test]
    fn sides_that_are_linked_keep_their_ratio_through_rounding() {
        let mut linked = LinkedSides::default();
        let mut now = sized(800, 600);
        linked.set(true, &now);
        for width in [801, 3, 7, 1600] {
            let before = now;
            now.width = width;
            linked.follow(&before, &mut now);
        }
        assert_eq!((now.width, now.height), (1600, 1200));
    }

    #[test]
    fn linked_sides_take_the_ratio_that_something_else_has_set() {
        let mut linked = LinkedSides::default();
        linked.set(true, &sized(800, 600));
        let mut now = sized(200, 100);
        linked.follow(&sized(100, 100), &mut now);
        assert_eq!((now.width, now.height), (200, 200));
    }

    #[test]
    fn sides_that_are_not_linked_do_not_follow() {
        let mut now = sized(200, 100);
        LinkedSides::default().follow(&sized(100, 100), &mut now);
        assert_eq!((now.width, now.height), (200, 100));
    }
}
