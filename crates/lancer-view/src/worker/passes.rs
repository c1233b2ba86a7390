//! Which images the viewport gets, one after the other.
//!
//! In: what is asked for, what images cost, what is shown. Out: the settings of the images to come. It traces
//! nothing.
//!
//! Coarse images have one sample a pixel and few directions of ambient occlusion, or none; the depth of recursion
//! and all else is as it was asked for, so that a mirror is a mirror in all of them.

use super::Channel;
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
const RESTING_DIVISORS: [u32; 5] = [16, 8, 4, 2, 1];

/// An image that is followed by a better one sooner than this is not worth making, in seconds.
const SOON: f64 = 0.080;

/// An image must take less than this part of the time of the one after it.
const WORTH: f64 = 0.5;

/// The fewest pixels along a side of an image that shows anything.
const FEWEST_PIXELS: u32 = 16;

/// Directions of ambient occlusion in coarse images: noisy, and close enough in brightness to what follows.
const COARSE_AO: u32 = 8;

/// The image while the view moves; `last` is the one before.
pub(super) fn moving(full: &Settings, channel: Channel, cost: &Cost, last: Option<&Pass>) -> Pass {
    let part = |pass: &Pass| cost.of(&pass.settings) / MOVING_BUDGET;
    if let Some(last) = last {
        // The same size serves again, if nothing else has changed.
        let same = coarse(full, last.divisor, last.settings.ao.samples);
        let cannot_be_finer = last.divisor == MOVING_DIVISORS[0];
        if same == *last && part(&same) <= KEPT.end && (part(&same) >= KEPT.start || cannot_be_finer) {
            return same;
        }
    }
    let is_about_ao = channel == Channel::Occlusion;
    let with_ao = MOVING_DIVISORS.into_iter().filter(|&divisor| is_about_ao || divisor <= COARSEST_WITH_AO);
    let with_ao = with_ao.map(|divisor| coarse(full, divisor, COARSE_AO));
    let without = MOVING_DIVISORS.into_iter().filter(|_| !is_about_ao);
    let without = without.map(|divisor| coarse(full, divisor, 0));
    let coarsest =
        coarse(full, MOVING_DIVISORS[MOVING_DIVISORS.len() - 1], if is_about_ao { COARSE_AO } else { 0 });
    with_ao.chain(without).find(|pass| part(pass) <= 1.0).unwrap_or(coarsest)
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

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::integrator::RayCounts;
    use lancer_core::scene::AmbientOcclusion;

    fn full(samples: u32, ao: u32) -> Settings {
        let ao = AmbientOcclusion { samples: ao, distance: 1.0 };
        Settings { width: 1300, height: 900, samples, ao, ..Settings::default() }
    }

    /// Where a coarse image without ambient occlusion, as large as the viewport, takes so many seconds.
    fn cost(seconds: f64) -> Cost {
        let mut cost = Cost::default();
        let image = full(1, 0);
        let primary = u64::from(image.width * image.height);
        cost.learn(&image, &RayCounts { primary, shadow: primary, ..RayCounts::default() }, seconds);
        cost
    }

    fn divisors(passes: &[Pass]) -> Vec<u32> {
        passes.iter().map(|pass| pass.divisor).collect()
    }

    #[test]
    fn at_rest_the_last_pass_has_the_full_settings_and_no_other_is_final() {
        for (full, seconds) in [(full(1, 0), 0.001), (full(3, 64), 0.5), (full(8, 256), 30.0)] {
            for shown in [None, Some(16), Some(4), Some(1)] {
                let passes = resting(&full, &cost(seconds), shown);
                let (last, others) = passes.split_last().unwrap();
                assert!(last.is_final && last.settings == full && last.divisor == 1);
                assert!(others.iter().all(|pass| !pass.is_final && pass.settings != full));
            }
        }
    }

    #[test]
    fn at_rest_each_pass_is_finer_than_what_is_shown_and_costs_more_than_the_one_before() {
        for (full, seconds) in
            [(full(1, 0), 0.3), (full(1, 64), 0.3), (full(4, 0), 2.0), (full(8, 256), 30.0)]
        {
            let cost = cost(seconds);
            for shown in [None, Some(16), Some(6), Some(4), Some(2), Some(1)] {
                let passes = resting(&full, &cost, shown);
                let coarse = &passes[..passes.len() - 1];
                assert!(coarse.iter().all(|pass| shown.is_none_or(|shown| pass.divisor < shown)));
                let costs = passes.iter().map(|pass| cost.of(&pass.settings));
                assert!(costs.clone().zip(costs.skip(1)).all(|(before, after)| before <= 0.5 * after));
            }
        }
    }

    #[test]
    fn a_picture_that_comes_at_once_has_one_pass_and_a_slow_one_has_all() {
        assert_eq!(divisors(&resting(&full(1, 0), &cost(0.02), None)), [1]);
        assert_eq!(divisors(&resting(&full(4, 0), &cost(60.0), None)), [16, 8, 4, 2, 1, 1]);
    }

    #[test]
    fn an_image_at_one_sample_is_not_made_twice() {
        assert_eq!(divisors(&resting(&full(1, 0), &cost(60.0), None)), [16, 8, 4, 2, 1]);
        assert_eq!(divisors(&resting(&full(1, COARSE_AO), &cost(60.0), Some(2))), [1]);
    }

    #[test]
    fn a_small_viewport_has_no_images_of_a_few_pixels() {
        let small = Settings { width: 40, height: 30, ..full(8, 1024) };
        assert_eq!(divisors(&resting(&small, &cost(60.0), None)), [1, 1]);
    }

    #[test]
    fn in_motion_the_image_keeps_up_and_is_as_fine_as_that_allows() {
        let full = full(4, 0);
        for seconds in [0.001, 0.05, 0.2, 1.0, 3.0, 9.0] {
            let cost = cost(seconds);
            let pass = moving(&full, Channel::Picture, &cost, None);
            assert!(cost.of(&pass.settings) <= MOVING_BUDGET, "{seconds}: 1/{}", pass.divisor);
            let finer = MOVING_DIVISORS.iter().rev().find(|&&divisor| divisor < pass.divisor);
            let finer = finer.map(|&divisor| cost.of(&coarse(&full, divisor, 0).settings));
            assert!(finer.is_none_or(|seconds| seconds > MOVING_BUDGET), "{seconds}: 1/{}", pass.divisor);
            assert_eq!((pass.settings.samples, pass.settings.depth), (1, full.depth));
        }
        assert_eq!(moving(&full, Channel::Picture, &cost(1e6), None).divisor, 16);
    }

    #[test]
    fn in_motion_ambient_occlusion_is_kept_where_the_image_stays_fine_enough() {
        let full = full(4, 256);
        assert_eq!(moving(&full, Channel::Picture, &cost(0.1), None).settings.ao.samples, COARSE_AO);
        assert_eq!(moving(&full, Channel::Picture, &cost(3.0), None).settings.ao.samples, 0);
        assert_eq!(moving(&full, Channel::Occlusion, &cost(3.0), None).settings.ao.samples, COARSE_AO);
    }

    #[test]
    fn in_motion_the_size_stays_while_costs_waver_and_follows_when_they_change() {
        let full = full(1, 0);
        let first = moving(&full, Channel::Picture, &cost(1.0), None);
        for seconds in [0.8, 1.2, 0.7, 1.0] {
            assert_eq!(moving(&full, Channel::Picture, &cost(seconds), Some(&first)), first);
        }
        assert!(moving(&full, Channel::Picture, &cost(4.0), Some(&first)).divisor > first.divisor);
        assert!(moving(&full, Channel::Picture, &cost(0.1), Some(&first)).divisor < first.divisor);
    }
}
