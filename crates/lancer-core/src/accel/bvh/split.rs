//! Where to part a range: at the border of bins, or between any two neighbours, with the least expected cost.

use super::cost::leaf_cost;
use super::extent::{Extent, around_centers};
use glam::Vec4;

/// Bins an axis, at most. Fewer miss good borders, more cost time in every node.
const MAX_BINS: usize = 32;

/// Ranges of up to this many items try the places between any two neighbours.
pub(super) const SWEPT: usize = 16;

/// The bins of an axis, as a function of the centres of boxes.
#[derive(Clone, Copy, Debug)]
struct Grid {
    /// Half a bin above the least centre: the place is found by rounding to the nearest.
    origin: Vec4,
    /// Bins in a unit of length; 0 on the axes where all centres are one, or too far apart to be told so.
    scale: Vec4,
    last: Vec4,
    bins: usize,
}

/// Adding this leaves a small number, rounded, in the lower bits.
const ROUNDER: f32 = 12_582_912.0;

/// Axes along which the centres are less far apart than this count as flat: its inverse is still a number.
const FLAT: f32 = 1e-30;

impl Grid {
    fn new(centers: &Extent, bins: usize) -> Self {
        let sides = centers.sides();
        let scale = Vec4::from_array(
            sides
                .to_array()
                .map(|side| if side > FLAT && side < f32::INFINITY { bins as f32 / side } else { 0.0 }),
        );
        let half_bin = sides * (0.5 / bins as f32);
        Self { origin: centers.low + half_bin, scale, last: Vec4::splat((bins - 1) as f32), bins }
    }

    /// The bin of a box on each axis.
    #[inline(always)]
    fn places(&self, item: &Extent) -> [usize; 3] {
        // Rounding may move the outermost centres out of the bins, and infinite ones are nowhere.
        let places = ((item.center() - self.origin) * self.scale).max(Vec4::ZERO).min(self.last);
        let [x, y, z, _] = (places + Vec4::splat(ROUNDER)).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % MAX_BINS)
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
pub(super) fn part(items: &mut [Extent]) -> Parts {
    let parts = if items.len() <= SWEPT { part_swept(items) } else { part_binned(items) };
    parts.unwrap_or_else(|| halves(items, items.len() / 2))
}

fn halves(items: &[Extent], length: usize) -> Parts {
    let (below, above) = items.split_at(length);
    Parts { length, bounds: [below, above].map(super::extent::around) }
}

/// Reorders items into two parts of the same number, by their centres on the longest axis.
pub(super) fn part_at_median(items: &mut [Extent]) -> Parts {
    let half = items.len() / 2;
    let axis = around_centers(items).sides().truncate().max_position();
    items.select_nth_unstable_by(half, |a, b| a.center()[axis].total_cmp(&b.center()[axis]));
    halves(items, half)
}

/// Bins for a range: small ranges have few places to be parted at.
fn bins(length: usize) -> usize {
    match length {
        0..64 => 8,
        64..512 => 16,
        _ => MAX_BINS,
    }
}

fn part_binned(items: &mut [Extent]) -> Option<Parts> {
    let grid = Grid::new(&around_centers(items), bins(items.len()));
    let (border, bounds) = best_border(items, &grid)?;
    let mut length = 0;
    for i in 0..items.len() {
        // Without a branch, which would be taken half of the time.
        let below = grid.places(&items[i])[border.axis] < border.bin;
        items.swap(i, length);
        length += usize::from(below);
    }
    Some(Parts { length, bounds })
}

struct Bins {
    boxes: [[Extent; 3]; MAX_BINS],
    weights: [[u32; 3]; MAX_BINS],
}

fn best_border(items: &[Extent], grid: &Grid) -> Option<(Border, [Extent; 2])> {
    let mut bins = Bins { boxes: [[Extent::EMPTY; 3]; MAX_BINS], weights: [[0; 3]; MAX_BINS] };
    for item in items {
        for (axis, place) in grid.places(item).into_iter().enumerate() {
            let bin = &mut bins.boxes[place][axis];
            *bin = bin.union(item);
            bins.weights[place][axis] += item.weight();
        }
    }
    let mut above = [[0.0; 3]; MAX_BINS];
    let (mut rest, mut weight) = ([Extent::EMPTY; 3], [0; 3]);
    for bin in (1..grid.bins).rev() {
        for axis in 0..3 {
            rest[axis] = rest[axis].union(&bins.boxes[bin][axis]);
            weight[axis] += bins.weights[bin][axis];
            above[bin][axis] = rest[axis].half_area() * leaf_cost(weight[axis]);
        }
    }
    let total: [u32; 3] = std::array::from_fn(|axis| weight[axis] + bins.weights[0][axis]);
    let (mut rest, mut weight) = ([Extent::EMPTY; 3], [0; 3]);
    let mut best = None;
    let mut least = f32::INFINITY;
    for (bin, above) in above.iter().enumerate().take(grid.bins).skip(1) {
        for axis in 0..3 {
            rest[axis] = rest[axis].union(&bins.boxes[bin - 1][axis]);
            weight[axis] += bins.weights[bin - 1][axis];
            let cost = rest[axis].half_area() * leaf_cost(weight[axis]) + above[axis];
            // Empty sides have no area that compares.
            if cost < least && weight[axis] > 0 && weight[axis] < total[axis] {
                least = cost;
                best = Some((Border { axis, bin }, rest[axis]));
            }
        }
    }
    let (border, below) = best?;
    let above =
        (border.bin..grid.bins).fold(Extent::EMPTY, |sum, bin| sum.union(&bins.boxes[bin][border.axis]));
    Some((border, [below, above]))
}

fn part_swept(items: &mut [Extent]) -> Option<Parts> {
    let length = items.len();
    let mut sorted = [[Extent::EMPTY; SWEPT]; 3];
    let mut best = None;
    let mut least = f32::INFINITY;
    for (axis, sorted) in sorted.iter_mut().enumerate() {
        let mut keys = [f32::INFINITY; SWEPT];
        for (key, item) in keys.iter_mut().zip(&*items) {
            *key = item.center()[axis];
        }
        for (i, item) in items.iter().enumerate() {
            // Those before it may be equal; those after it must be less.
            let before = keys[..i].iter().filter(|&&key| key <= keys[i]).count();
            let after = keys[i + 1..].iter().filter(|&&key| key < keys[i]).count();
            sorted[before + after] = *item;
        }
        let mut above = [0.0; SWEPT];
        let mut rest = Extent::EMPTY;
        for first in (1..length).rev() {
            rest = rest.union(&sorted[first]);
            above[first] = rest.half_area() * leaf_cost((length - first) as u32);
        }
        let mut rest = Extent::EMPTY;
        for first in 1..length {
            rest = rest.union(&sorted[first - 1]);
            let cost = rest.half_area() * leaf_cost(first as u32) + above[first];
            if cost < least {
                least = cost;
                best = Some((axis, first));
            }
        }
    }
    let (axis, first) = best?;
    items.copy_from_slice(&sorted[axis][..length]);
    Some(halves(items, first))
}
