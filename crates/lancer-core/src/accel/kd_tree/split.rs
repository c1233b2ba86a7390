//! Where to split a node: the plane of least expected cost by the surface area heuristic.

use super::super::Aabb;
use rayon::prelude::*;

/// A primitive in a node: the box around the part of it inside of the node's cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub(super) bounds: Aabb,
    pub(super) primitive: u32,
}

/// A plane, and what it is expected to cost to trace a ray through the node that it splits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) axis: usize,
    pub(super) position: f32,
    /// Whether primitives that lie in the plane go below it.
    pub(super) flat_below: bool,
    pub(super) cost: f32,
}

/// Cost of a step from a node to its child. The unit of cost.
pub const STEP_COST: f32 = 1.0;
/// Cost of a test against a primitive. Less gives smaller trees with longer leaves, more gives deeper trees
/// with more duplicates.
pub const TEST_COST: f32 = 1.5;
/// What a split is worth that cuts off empty space: a ray through the empty side is done at once.
const EMPTY_FACTOR: f32 = 0.8;

/// Nodes with more primitives than this are split at the borders of bins, smaller ones at the best of all the
/// planes that touch a primitive. Sorting costs more than the better planes of larger nodes gain.
const SWEPT: usize = 64;
/// Bins an axis. Fewer miss good planes, more cost time in the many nodes just above [`SWEPT`].
const BINS: usize = 32;
/// Nodes from this size on are binned in parallel.
const PARALLEL: usize = 1 << 16;

/// The cost of making a node with `count` primitives a leaf.
pub(super) fn leaf_cost(count: usize) -> f32 {
    TEST_COST * count as f32
}

/// The best split of a node, if there is any plane inside of its cell.
pub(super) fn best_split(references: &[Reference], cell: &Aabb) -> Option<Split> {
    let candidates = if references.len() <= SWEPT { sweep } else { binned };
    candidates(references, &Costs::new(cell))
}

/// The cell's part of the heuristic.
struct Costs<'a> {
    cell: &'a Aabb,
    area: f32,
}

impl<'a> Costs<'a> {
    fn new(cell: &'a Aabb) -> Self {
        Self { cell, area: cell.half_area() }
    }

    /// The split with `below` and `above` primitives on its sides and `flat` more in the plane, or none where
    /// it cuts nothing off. Source: Wald, Havran (2006), section 3.
    fn split(&self, axis: usize, position: f32, below: usize, above: usize, flat: usize) -> Option<Split> {
        let inside = self.cell.min[axis] < position && position < self.cell.max[axis];
        if !inside || self.area <= 0.0 {
            return None;
        }
        let [lower, upper] = self.cell.split(axis, position).map(|half| half.half_area() / self.area);
        let cost = |below: usize, above: usize| {
            let factor = if below == 0 || above == 0 { EMPTY_FACTOR } else { 1.0 };
            factor * (STEP_COST + TEST_COST * (lower * below as f32 + upper * above as f32))
        };
        let (flat_in_lower, flat_in_upper) = (cost(below + flat, above), cost(below, above + flat));
        Some(Split {
            axis,
            position,
            flat_below: flat_in_lower <= flat_in_upper,
            cost: flat_in_lower.min(flat_in_upper),
        })
    }
}

/// The cheaper of two; the earlier one where they are equal.
fn cheaper(a: Option<Split>, b: Option<Split>) -> Option<Split> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// Tries every plane that bounds a primitive.
fn sweep(references: &[Reference], costs: &Costs) -> Option<Split> {
    let n = references.len();
    let mut starts = [0.0_f32; SWEPT];
    let mut ends = [0.0_f32; SWEPT];
    let mut best = None;
    for axis in 0..3 {
        for (i, reference) in references.iter().enumerate() {
            starts[i] = reference.bounds.min[axis];
            ends[i] = reference.bounds.max[axis];
        }
        starts[..n].sort_unstable_by(f32::total_cmp);
        ends[..n].sort_unstable_by(f32::total_cmp);
        let (mut started, mut ended) = (0, 0);
        while ended < n {
            let position = if started < n { starts[started].min(ends[ended]) } else { ends[ended] };
            let starting = starts[started..n].iter().take_while(|&&start| start == position).count();
            let ending = ends[ended..n].iter().take_while(|&&end| end == position).count();
            // What starts and ends here lies in the plane; flat primitives alone do both.
            let flat = if starting > 0 && ending > 0 { count_flat(references, axis, position) } else { 0 };
            let (below, above) = (started, n - ended - ending);
            best = cheaper(best, costs.split(axis, position, below, above, flat));
            started += starting;
            ended += ending;
        }
    }
    best
}

fn count_flat(references: &[Reference], axis: usize, position: f32) -> usize {
    references
        .iter()
        .filter(|reference| reference.bounds.min[axis] == position && reference.bounds.max[axis] == position)
        .count()
}

/// How many primitives start and end in each bin of each axis.
#[derive(Clone)]
struct Histogram {
    starts: [[u32; BINS]; 3],
    ends: [[u32; BINS]; 3],
}

impl Histogram {
    const EMPTY: Self = Self { starts: [[0; BINS]; 3], ends: [[0; BINS]; 3] };

    fn of(references: &[Reference], span: &Aabb) -> Self {
        let scale: [f32; 3] = std::array::from_fn(|axis| {
            let length = span.max[axis] - span.min[axis];
            if length > 0.0 { BINS as f32 / length } else { 0.0 }
        });
        let mut histogram = Self::EMPTY;
        for reference in references {
            for (axis, scale) in scale.iter().enumerate() {
                // The cast saturates, so a bin below 0 is 0.
                let bin = |x: f32| (((x - span.min[axis]) * scale) as usize).min(BINS - 1);
                histogram.starts[axis][bin(reference.bounds.min[axis])] += 1;
                histogram.ends[axis][bin(reference.bounds.max[axis])] += 1;
            }
        }
        histogram
    }

    fn plus(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.starts[axis][bin] += other.starts[axis][bin];
                self.ends[axis][bin] += other.ends[axis][bin];
            }
        }
        self
    }
}

/// Tries the borders of equal bins between the ends of what the node holds, both ends included.
fn binned(references: &[Reference], costs: &Costs) -> Option<Split> {
    // Counts and boxes do not depend on the order of work, so neither does the split.
    let (span, histogram) = if references.len() >= PARALLEL {
        let span = references.par_iter().map(|reference| reference.bounds).reduce_with(|a, b| a.union(&b))?;
        let histogram = references
            .par_chunks(PARALLEL / 4)
            .map(|chunk| Histogram::of(chunk, &span))
            .reduce(|| Histogram::EMPTY, |a, b| a.plus(&b));
        (span, histogram)
    } else {
        let span = references.iter().map(|reference| reference.bounds).reduce(|a, b| a.union(&b))?;
        (span, Histogram::of(references, &span))
    };
    let mut best = None;
    for axis in 0..3 {
        let length = span.max[axis] - span.min[axis];
        let (mut below, mut above) = (0, references.len());
        for border in 0..=BINS {
            let position = match border {
                0 => span.min[axis],
                BINS => span.max[axis],
                _ => span.min[axis] + length * (border as f32 / BINS as f32),
            };
            best = cheaper(best, costs.split(axis, position, below, above, 0));
            if border < BINS {
                below += histogram.starts[axis][border] as usize;
                above -= histogram.ends[axis][border] as usize;
            }
        }
    }
    best
}
