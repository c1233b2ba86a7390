//! Terms that add up to a pixel exactly.
//!
//! Terms that are each rounded to their nearest `f32` add up to something near the pixel: every sum rounds again,
//! in an order that is the compositor's. So terms are rounded to multiples of the pixel's last place instead, of
//! its ulp, by largest remainder: each down, and then those that lost most up by one, until the sum is the pixel.
//! Each is then within one ulp *of the pixel* of its true value, and one that is zero stays so. As all are
//! multiples of one power of two and no sum of them exceeds the pixel, which is less than 2^24 of it, every sum of
//! them is itself an `f32`: they add up without any rounding, in any order and in any precision from `f32` on.
//!
//! Not so where a term is negative, which takes a metallic coefficient above 1: it may then be larger than the
//! pixel, and all are rounded to their nearest.

use crate::color::Rgb;

/// Memory that one pixel leaves to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares {
    colors: Vec<[f32; 3]>,
    channel: Vec<f64>,
    by_remainder: Vec<(f64, usize)>,
}

impl Shares {
    /// The sums times `factor`, whose sum is nearly that of `whole`, as colours whose sum is `whole`.
    pub(super) fn of(&mut self, whole: [f32; 3], sums: &[Rgb], factor: f64) -> &[[f32; 3]] {
        self.colors.clear();
        self.colors.resize(sums.len(), [0.0; 3]);
        for (channel, &whole) in whole.iter().enumerate() {
            self.channel.clear();
            self.channel.extend(sums.iter().map(|sum| sum.to_array()[channel] * factor));
            share(whole, &mut self.channel, &mut self.by_remainder);
            for (color, &part) in self.colors.iter_mut().zip(&self.channel) {
                color[channel] = part as f32;
            }
        }
        &self.colors
    }
}

/// Rounds `parts` so that they add up to `whole`, the `f32` nearest to their sum.
fn share(whole: f32, parts: &mut [f64], by_remainder: &mut Vec<(f64, usize)>) {
    let rounds_to_nearest = !whole.is_finite() || parts.iter().any(|&part| part < 0.0);
    if rounds_to_nearest || parts.is_empty() {
        return;
    }
    let ulp = last_place(whole);
    // By powers of two: no division or product here rounds.
    let mut missing = f64::from(whole) / ulp;
    by_remainder.clear();
    for (index, part) in parts.iter_mut().enumerate() {
        let count = *part / ulp;
        let whole_count = count.floor();
        if count > whole_count {
            by_remainder.push((count - whole_count, index));
        }
        missing -= whole_count;
        *part = whole_count * ulp;
    }
    // The larger remainder first, and of equal ones the earlier part.
    by_remainder.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for &(_, index) in by_remainder.iter() {
        if missing < 1.0 {
            break;
        }
        parts[index] += ulp;
        missing -= 1.0;
    }
    if missing != 0.0 {
        settle(missing * ulp, parts);
    }
}

/// Gives what is left, an ulp or two of noise in the sums, to the greatest part.
fn settle(missing: f64, parts: &mut [f64]) {
    let greatest = parts.iter_mut().max_by(|a, b| a.total_cmp(b));
    if let Some(greatest) = greatest {
        *greatest += missing;
    }
}

/// The distance from a finite `f32` to the next larger one in its binade.
fn last_place(value: f32) -> f64 {
    /// The logarithm of the least `f32` above 0, which the smallest normal ones have for a last place.
    const LEAST: i64 = -149;
    /// What is added to the exponents of `f64`.
    const BIAS: i64 = 1023;
    let binade = i64::from(value.abs().to_bits() >> (f32::MANTISSA_DIGITS - 1)).max(1) - 1;
    // This power of two is a normal `f64`.
    f64::from_bits(((LEAST + binade + BIAS) as u64) << (f64::MANTISSA_DIGITS - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shared(parts: &[f64]) -> (f32, Vec<f32>) {
        let whole = parts.iter().sum::<f64>() as f32;
        let mut rounded = parts.to_vec();
        share(whole, &mut rounded, &mut Vec::new());
        (whole, rounded.iter().map(|&part| part as f32).collect())
    }

    #[test]
    fn the_last_place_is_the_step_to_the_next_float() {
        for value in [0.0, f32::MIN_POSITIVE / 4.0, f32::MIN_POSITIVE, 0.1, 1.0, 1.5, 16_777_215.0, 3e38] {
            assert_eq!(last_place(value), f64::from(value.next_up()) - f64::from(value), "{value}");
        }
    }

    /// Where nearest floats do not: 1 + 3 * 2^-25 is above 1, and each sum with 2^-25 is 1.
    #[test]
    fn parts_too_small_for_single_sums_are_given_together() {
        let small = 1.0 / f64::from(1 << 25);
        let (whole, parts) = shared(&[1.0, small, small, small]);
        assert_eq!(whole, 1.0 + f32::EPSILON);
        assert_eq!(parts, [1.0, f32::EPSILON, 0.0, 0.0]);
    }

    #[test]
    fn black_and_overflow_are_left_alone() {
        assert_eq!(shared(&[0.0, 0.0]), (0.0, vec![0.0, 0.0]));
        assert_eq!(shared(&[1e-60, 1e-60]), (0.0, vec![0.0, 0.0]));
        assert_eq!(shared(&[3e38, 3e38]), (f32::INFINITY, vec![3e38, 3e38]));
    }

    fn part() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), 0.0..1.0, (-60.0..20.0).prop_map(f64::exp2)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn parts_add_up_in_any_order_and_stay_near(
            parts in proptest::collection::vec(part(), 1..12).prop_shuffle(),
            turn in 0_usize..12,
        ) {
            let (whole, rounded) = shared(&parts);
            let forward = rounded.iter().sum::<f32>();
            let backward = rounded.iter().rev().sum::<f32>();
            let (head, tail) = rounded.split_at(turn % rounded.len());
            let grouped = tail.iter().sum::<f32>() + head.iter().sum::<f32>();
            prop_assert_eq!((forward, backward, grouped), (whole, whole, whole));
            for (&part, &rounded) in parts.iter().zip(&rounded) {
                prop_assert!((f64::from(rounded) - part).abs() < last_place(whole), "{} for {}", rounded, part);
                prop_assert!(part > 0.0 || rounded == 0.0);
            }
        }

        #[test]
        fn what_adds_up_already_is_left_as_it_is(parts in proptest::collection::vec(part(), 1..12)) {
            let (whole, rounded) = shared(&parts);
            let mut again = rounded.iter().map(|&part| f64::from(part)).collect::<Vec<_>>();
            let before = again.clone();
            share(whole, &mut again, &mut Vec::new());
            prop_assert_eq!(before, again);
        }
    }
}
