//! Where to part a range of primitives: the border of bins with the least expected cost.

use super::cost::leaf_cost;
use super::extent::Extent;
use glam::Vec4;

/// Bins an axis, at most. Fewer miss good borders, more cost time in every node.
const MAX_BINS: usize = 32;

/// The bins of an axis, as a function of the centres of boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Half a bin above the least centre: the place is found by rounding to the nearest.
    origin: Vec4,
    /// Bins in a unit of length; 0 on the axes where all centres are one, or too far apart to be told so.
    scale: Vec4,
    bins: usize,
}

/// Adding this leaves a small number, rounded, in the lower bits.
const ROUNDER: f32 = 12_582_912.0;

/// Keeps rounding from moving the greatest centre past the last bin.
const SHRINK: f32 = 0.999;

/// Axes along which the centres are less far apart than this count as flat: its inverse is still a number.
const FLAT: f32 = 1e-30;

impl Grid {
    pub(super) fn new(centers: &Extent, bins: usize) -> Self {
        let extent = -(centers.low + centers.high);
        let bins = bins.min(MAX_BINS);
        let scale = Vec4::from_array(extent.to_array().map(|extent| {
            if extent > FLAT && extent < f32::INFINITY { bins as f32 * SHRINK / extent } else { 0.0 }
        }));
        let width = extent * (0.5 / (bins as f32 * SHRINK));
        Self { origin: centers.low + width, scale, bins }
    }

    /// The bin of a box on each axis.
    #[inline(always)]
    pub(super) fn places(&self, item: &Extent) -> [usize; 3] {
        let [x, y, z, _] = ((item.center() - self.origin) * self.scale + Vec4::splat(ROUNDER)).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % MAX_BINS)
    }
}

/// The primitives in the bins below `bin` of an axis are parted from the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) axis: usize,
    pub(super) bin: usize,
    pub(super) below: usize,
    pub(super) cost: f32,
}

/// The best split of at least two items, if any grid line parts them.
pub(super) fn best_split(items: &[Extent], grid: &Grid) -> Option<Split> {
    let mut boxes = [[Extent::EMPTY; MAX_BINS]; 3];
    let mut counts = [[0_u32; MAX_BINS]; 3];
    for item in items {
        for (axis, place) in grid.places(item).into_iter().enumerate() {
            boxes[axis][place] = boxes[axis][place].union(item);
            counts[axis][place] += 1;
        }
    }
    let mut best = None::<Split>;
    for axis in 0..3 {
        if grid.scale[axis] == 0.0 {
            continue;
        }
        let mut above = [0.0; MAX_BINS];
        let (mut rest, mut count) = (Extent::EMPTY, 0);
        for bin in (1..grid.bins).rev() {
            rest = rest.union(&boxes[axis][bin]);
            count += counts[axis][bin] as usize;
            above[bin] = if count == 0 { 0.0 } else { rest.half_area() * leaf_cost(count) };
        }
        let (mut rest, mut count) = (Extent::EMPTY, 0);
        for bin in 1..grid.bins {
            rest = rest.union(&boxes[axis][bin - 1]);
            count += counts[axis][bin - 1] as usize;
            if count == 0 || count == items.len() {
                continue;
            }
            let cost = rest.half_area() * leaf_cost(count) + above[bin];
            if best.is_none_or(|best| cost < best.cost) {
                best = Some(Split { axis, bin, below: count, cost });
            }
        }
    }
    best
}
