//! Which images the viewport gets, one after the other.
//!
//! In: what is asked for, what images cost, what is shown. Out: the settings of the images to come. It traces
//! nothing.
//!
//! Coarse images have one sample a pixel and few directions of ambient occlusion, or none; the depth of recursion
//! and all else is as it was asked for, so that a mirror is a mirror in all of them.

use super::cost::Cost;
use lancer_core::scene::Settings;

/// An image of the viewport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pass {
    /// How many pixels of the viewport lie along the side of one of this image.
    pub(super) divisor: u32,
    /// What to render.
    pub(super) settings: Settings,
    /// Whether these are the full settings.
    pub(super) is_final: bool,
}

/// How long an image may take while the view moves, in seconds: 25 images a second. Longer, and the scene drags
/// behind the mouse; shorter, and it is coarser than it need be.
const MOVING_BUDGET: f64 = 0.040;

/// The part of the budget that an image of the same size as the last one may take, so that the size does not go up
/// and down with every little change.
const KEPT: std::ops::Range<f64> = 0.35..1.5;

/// The sizes of images while the view moves. Each step costs about twice the one before.
const MOVING_DIVISORS: [u32; 8] = [1, 2, 3, 4, 6, 8, 12, 16];

/// The coarsest image that is worth having ambient occlusion while the view moves: one coarser is read for its
/// shapes alone, and is better finer.
const COARSEST_WITH_AO: u32 = 4;

/// The sizes of images at rest, before the last one.
const RESTING_DIVISORS: [u32; 4] = [8, 4, 2, 1];

/// An image that is followed by a better one sooner than this is not worth making, in seconds.
const SOON: f64 = 0.080;

/// An image must take less than this part of the time of the one after it.
const WORTH: f64 = 0.5;

/// The fewest pixels along a side of an image that shows anything.
const FEWEST_PIXELS: u32 = 16;

/// Directions of ambient occlusion in coarse images: noisy, and close enough in brightness to what follows.
const COARSE_AO: u32 = 8;

/// The image while the view moves; `last` is the one before.
pub(super) fn moving(full: &Settings, cost: &Cost, last: Option<&Pass>) -> Pass {
    let fits = |pass: &Pass, budget: f64| cost.of(&pass.settings) <= budget;
    // What was chosen last is chosen again if it still fits, and if nothing else has changed.
    if let Some(last) = last {
        let same = coarse(full, last.divisor, last.settings.ao.samples);
        let part = cost.of(&same.settings) / MOVING_BUDGET;
        if same == *last && (KEPT.contains(&part) || part <= KEPT.end && last.divisor == MOVING_DIVISORS[0]) {
            return same;
        }
    }
    let with_ao = MOVING_DIVISORS.into_iter().filter(|&divisor| divisor <= COARSEST_WITH_AO);
    let with_ao = with_ao.map(|divisor| coarse(full, divisor, COARSE_AO));
    let without = MOVING_DIVISORS.into_iter().map(|divisor| coarse(full, divisor, 0));
    let coarsest = coarse(full, MOVING_DIVISORS[MOVING_DIVISORS.len() - 1], 0);
    with_ao.chain(without).find(|pass| fits(pass, MOVING_BUDGET)).unwrap_or(coarsest)
}

/// The images still to come at rest, the last one at full settings; `shown` is the divisor of what is shown of the
/// same picture.
pub(super) fn resting(full: &Settings, cost: &Cost, shown: Option<u32>) -> Vec<Pass> {
    let last = Pass { divisor: 1, settings: *full, is_final: true };
    let mut passes = vec![last];
    let mut next = cost.of(full);
    for divisor in RESTING_DIVISORS.into_iter().rev() {
        let pass = coarse(full, divisor, COARSE_AO);
        let takes = cost.of(&pass.settings);
        let is_finer = shown.is_none_or(|shown| divisor < shown);
        let shows_something = divisor == 1 || pass.settings.width.min(pass.settings.height) >= FEWEST_PIXELS;
        if is_finer && shows_something && next >= SOON && takes <= WORTH * next {
            passes.push(pass);
            next = takes;
        }
    }
    passes.reverse();
    passes
}

fn coarse(full: &Settings, divisor: u32, most_ao: u32) -> Pass {
    let mut settings = *full;
    settings.width = full.width.div_ceil(divisor);
    settings.height = full.height.div_ceil(divisor);
    settings.samples = 1;
    settings.ao.samples = full.ao.samples.min(most_ao);
    Pass { divisor, settings, is_final: false }
}
