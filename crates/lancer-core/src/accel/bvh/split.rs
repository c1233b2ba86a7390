//! Where to part a range: at the border of bins, or between any two neighbours, with the least expected cost.

use super::Quality;
use super::cost::leaf_cost;
use super::extent::{Extent, around, around_centers};
use glam::Vec4;

/// The bins of an axis, as a function of the centres of boxes.
#[derive(Clone, Copy, Debug)]
struct Grid<const BINS: usize> {
    /// Half a bin above the least centre: the place is found by rounding to the nearest.
    origin: Vec4,
    /// Bins in a unit of length; 0 on the axes where all centres are one, or too far apart to be told so.
    scale: Vec4,
}

/// Adding this leaves a small number, rounded, in the lower bits.
const ROUNDER: f32 = 12_582_912.0;

/// Axes along which the centres are less far apart than this count as flat: its inverse is still a number.
const FLAT: f32 = 1e-30;

impl<const BINS: usize> Grid<BINS> {
    fn new(centers: &Extent) -> Self {
        let sides = centers.sides();
        let scale = Vec4::from_array(
            sides
                .to_array()
                .map(|side| if side > FLAT && side < f32::INFINITY { BINS as f32 / side } else { 0.0 }),
        );
        let half_bin = sides * (0.5 / BINS as f32);
        Self { origin: centers.low + half_bin, scale }
    }

    /// The bin of a box on each axis.
    #[inline(always)]
    fn places(&self, item: &Extent) -> [usize; 3] {
        // Rounding may move the outermost centres out of the bins, and infinite ones are nowhere.
        let places =
            ((item.center() - self.origin) * self.scale).max(Vec4::ZERO).min(Vec4::splat((BINS - 1) as f32));
        let [x, y, z, _] = (places + Vec4::splat(ROUNDER)).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % BINS)
    }

    /// The bin of a box on one axis: the same.
    #[inline(always)]
    fn place(&self, item: &Extent, axis: usize) -> usize {
        let place = ((item.low[axis] - item.high[axis]) - self.origin[axis]) * self.scale[axis];
        let place = if place > 0.0 { place } else { 0.0 };
        let last = (BINS - 1) as f32;
        let place = if place < last { place } else { last };
        (place + ROUNDER).to_bits() as usize % BINS
    }
}

/// The border below `bin` of an axis.
#[derive(Clone, Copy, Debug)]
struct Border {
    axis: usize,
    bin: usize,
}

/// Two ranges that follow each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// Items in the first.
    pub(super) length: usize,
    /// Around the first and the second.
    pub(super) bounds: [Extent; 2],
}

/// Reorders more than one item into two parts. Equal halves where no place is better than any other.
pub(super) fn part<const BLOCK: usize>(items: &mut [Extent], quality: Quality) -> Parts {
    let centers = around_centers(items);
    let parts = match quality {
        Quality::High => part_along::<BLOCK, 3>(items, &centers, [0, 1, 2]),
        Quality::Fast => part_along::<BLOCK, 1>(items, &centers, [longest(&centers)]),
    };
    parts.unwrap_or_else(|| halves(items, items.len() / 2))
}

/// Tries some of the axes.
///
/// Fewer bins miss good borders, more cost time in every node; small ranges have few places to be parted at.
#[inline(always)]
fn part_along<const BLOCK: usize, const A: usize>(
    items: &mut [Extent],
    centers: &Extent,
    axes: [usize; A],
) -> Option<Parts> {
    match items.len() {
        0..=8 => part_swept::<BLOCK, 8, A>(items, axes),
        9..=16 => part_swept::<BLOCK, 16, A>(items, axes),
        17..64 => part_binned::<BLOCK, 8, A>(items, centers, axes),
        64..512 => part_binned::<BLOCK, 16, A>(items, centers, axes),
        _ => part_binned::<BLOCK, 32, A>(items, centers, axes),
    }
}

fn longest(centers: &Extent) -> usize {
    centers.sides().truncate().max_position()
}

fn halves(items: &[Extent], length: usize) -> Parts {
    let (below, above) = items.split_at(length);
    Parts { length, bounds: [below, above].map(around) }
}

/// Reorders items into two parts of the same number, by their centres on the longest axis.
pub(super) fn part_at_median(items: &mut [Extent]) -> Parts {
    let half = items.len() / 2;
    let axis = longest(&around_centers(items));
    items.select_nth_unstable_by(half, |a, b| a.center()[axis].total_cmp(&b.center()[axis]));
    halves(items, half)
}

fn part_binned<const BLOCK: usize, const BINS: usize, const A: usize>(
    items: &mut [Extent],
    centers: &Extent,
    axes: [usize; A],
) -> Option<Parts> {
    let grid = Grid::<BINS>::new(centers);
    let (border, bounds) = best_border::<BLOCK, BINS, A>(items, &grid, axes)?;
    let mut length = 0;
    for i in 0..items.len() {
        // Without a branch, which would be taken half of the time.
        let below = grid.place(&items[i], border.axis) < border.bin;
        items.swap(i, length);
        length += usize::from(below);
    }
    Some(Parts { length, bounds })
}

fn best_border<const BLOCK: usize, const BINS: usize, const A: usize>(
    items: &[Extent],
    grid: &Grid<BINS>,
    axes: [usize; A],
) -> Option<(Border, [Extent; 2])> {
    let mut boxes = [[Extent::EMPTY; A]; BINS];
    let mut weights = [[0_u32; A]; BINS];
    for item in items {
        let places = if A == 3 {
            axes.map(|axis| grid.places(item)[axis])
        } else {
            axes.map(|axis| grid.place(item, axis))
        };
        for (axis, place) in places.into_iter().enumerate() {
            boxes[place][axis] = boxes[place][axis].union(item);
            weights[place][axis] += item.weight();
        }
    }
    let mut above = [[0.0; A]; BINS];
    let (mut rest, mut weight) = ([Extent::EMPTY; A], [0; A]);
    for bin in (1..BINS).rev() {
        for axis in 0..A {
            rest[axis] = rest[axis].union(&boxes[bin][axis]);
            weight[axis] += weights[bin][axis];
            above[bin][axis] = rest[axis].half_area() * leaf_cost::<BLOCK>(weight[axis]);
        }
    }
    let total: [u32; A] = std::array::from_fn(|axis| weight[axis] + weights[0][axis]);
    let (mut rest, mut weight) = ([Extent::EMPTY; A], [0; A]);
    let mut best = None;
    let mut least = f32::INFINITY;
    for bin in 1..BINS {
        for axis in 0..A {
            rest[axis] = rest[axis].union(&boxes[bin - 1][axis]);
            weight[axis] += weights[bin - 1][axis];
            let cost = rest[axis].half_area() * leaf_cost::<BLOCK>(weight[axis]) + above[bin][axis];
            // Empty sides have no area that compares.
            if cost < least && weight[axis] > 0 && weight[axis] < total[axis] {
                least = cost;
                best = Some(Border { axis, bin });
            }
        }
    }
    let Border { axis, bin } = best?;
    let around = |bins: &[[Extent; A]]| bins.iter().fold(Extent::EMPTY, |sum, bin| sum.union(&bin[axis]));
    Some((Border { axis: axes[axis], bin }, [around(&boxes[..bin]), around(&boxes[bin..])]))
}

/// The items by centre on some axes, the first in the lowest place.
fn sorted<const N: usize, const A: usize>(
    items: &[Extent; N],
    length: usize,
    axes: [usize; A],
) -> [[u8; N]; A] {
    let mut keys = [[i32::MAX; N]; A];
    for (i, item) in items.iter().enumerate().take(length) {
        let center = item.center().to_array();
        for (keys, x) in keys.iter_mut().zip(axes.map(|axis| center[axis])) {
            // Ordered as the numbers are; the last bits give way to the place, so that no two are equal.
            let bits = x.to_bits() as i32;
            keys[i] = (bits ^ (bits >> 31 & i32::MAX)) & !(N as i32 - 1) | i as i32;
        }
    }
    keys.map(|keys| {
        let mut ranks = [0; N];
        for other in keys {
            for (rank, key) in ranks.iter_mut().zip(keys) {
                *rank += i32::from(other < key);
            }
        }
        let mut order = [0; N];
        for (i, rank) in ranks.into_iter().enumerate().take(length) {
            order[rank as usize % N] = i as u8;
        }
        order
    })
}

fn part_swept<const BLOCK: usize, const N: usize, const A: usize>(
    items: &mut [Extent],
    axes: [usize; A],
) -> Option<Parts> {
    let length = items.len();
    let mut local = [Extent::EMPTY; N];
    local[..length].copy_from_slice(items);
    let orders = sorted(&local, length, axes);
    let mut best = None;
    let mut least = f32::INFINITY;
    for order in &orders {
        let (mut below, mut above) = ([0.0; N], [0.0; N]);
        let (mut first, mut last) = (Extent::EMPTY, Extent::EMPTY);
        let (mut count_first, mut count_last) = (0, 0);
        for i in 1..length {
            let (low, high) = (&local[order[i - 1] as usize % N], &local[order[length - i] as usize % N]);
            (first, last) = (first.union(low), last.union(high));
            (count_first, count_last) = (count_first + low.weight(), count_last + high.weight());
            below[i] = first.half_area() * leaf_cost::<BLOCK>(count_first);
            above[length - i] = last.half_area() * leaf_cost::<BLOCK>(count_last);
        }
        for (i, (below, above)) in below.iter().zip(&above).enumerate().take(length).skip(1) {
            let cost = below + above;
            if cost < least {
                least = cost;
                best = Some((order, i));
            }
        }
    }
    let (order, first) = best?;
    for (item, &from) in items.iter_mut().zip(order) {
        *item = local[from as usize % N];
    }
    Some(halves(items, first))
}
