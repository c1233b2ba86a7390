//! Cells of equal size over the centres of boxes: a stand-in for the primitives in them, by the thousand.

use super::extent::Extent;
use glam::Vec4;
use rayon::prelude::*;

/// The most cells along an axis, for primitives in a line.
const MAX_CELLS: f32 = 1024.0;

/// Fewer primitives are not worth a table of their own.
const CHUNK: usize = 1 << 16;

/// Where the cells are.
struct Lattice {
    origin: Vec4,
    scale: Vec4,
    cells: [u32; 3],
}

impl Lattice {
    fn new(centers: &Extent, budget: usize) -> Self {
        let sides =
            centers.sides().truncate().to_array().map(|side| if side.is_finite() { side } else { 0.0 });
        let longest = sides.into_iter().fold(0.0, f32::max);
        let budget = budget.max(8) as f32;
        let along = |n: f32| sides.map(|side| (n * (side / longest.max(f32::MIN_POSITIVE))).ceil().max(1.0));
        let mut n = MAX_CELLS;
        while n > 2.0 && along(n).iter().product::<f32>() > budget {
            n *= 0.97;
        }
        let cells = along(n);
        let scale = |axis: usize| if sides[axis] > 1e-30 { cells[axis] / sides[axis] } else { 0.0 };
        let scale = Vec4::new(scale(0), scale(1), scale(2), 0.0);
        Self { origin: centers.low, scale, cells: cells.map(|n| n as u32) }
    }

    fn count(&self) -> usize {
        self.cells.iter().product::<u32>() as usize
    }

    #[inline(always)]
    fn cell(&self, item: &Extent) -> u32 {
        let [x, y, z, _] = ((item.center() - self.origin) * self.scale).to_array();
        let [x, y, z] = [(x, 0), (y, 1), (z, 2)].map(|(x, axis)| (x as u32).min(self.cells[axis] - 1));
        (z * self.cells[1] + y) * self.cells[0] + x
    }
}

/// The primitives in the cells of a lattice.
pub(super) struct Cells {
    /// The cell of each primitive.
    pub(super) of: Vec<u32>,
    /// The cells that are not empty, labelled with their number and that of their primitives.
    pub(super) boxes: Vec<Extent>,
    /// Cells, empty ones included.
    pub(super) count: usize,
}

impl Cells {
    /// Sorts items into at most `budget` cells; the items are not stored.
    pub(super) fn new(items: &(impl Fn(usize) -> Extent + Sync), count: usize, budget: usize) -> Self {
        // Sums of integers and minima: the result does not depend on the number of chunks.
        let chunk = count.div_ceil(rayon::current_num_threads()).max(CHUNK);
        let centers = (0..count.div_ceil(chunk))
            .into_par_iter()
            .map(|i| {
                (i * chunk..count.min((i + 1) * chunk))
                    .fold(Extent::EMPTY, |sum, i| sum.union(&Extent::point(items(i).center())))
            })
            .reduce(|| Extent::EMPTY, |a, b| a.union(&b));
        let lattice = Lattice::new(&centers, budget);
        let mut of = vec![0_u32; count];
        let tables = of
            .par_chunks_mut(chunk)
            .enumerate()
            .map(|(i, of)| {
                let mut table = vec![(Extent::EMPTY, 0_u32); lattice.count()];
                for (of, i) in of.iter_mut().zip(i * chunk..) {
                    let item = items(i);
                    *of = lattice.cell(&item);
                    let (bounds, weight) = &mut table[*of as usize];
                    *bounds = bounds.union(&item);
                    *weight += 1;
                }
                table
            })
            .collect::<Vec<_>>();
        let boxes = (0..lattice.count())
            .filter_map(|cell| {
                let (bounds, weight) =
                    tables.iter().map(|table| table[cell]).reduce(|a, b| (a.0.union(&b.0), a.1 + b.1))?;
                (weight > 0).then(|| bounds.labelled(cell as u32, weight))
            })
            .collect();
        Self { of, boxes, count: lattice.count() }
    }

    /// Writes items ordered by cell, in the order of `boxes`; within a cell they keep theirs.
    pub(super) fn scatter(&self, items: &(impl Fn(usize) -> Extent + Sync), out: &mut [Extent]) {
        let mut starts = vec![0_u32; self.count];
        let mut next = 0;
        for cell in &self.boxes {
            starts[cell.name() as usize] = next;
            next += cell.weight();
        }
        // Each chunk of places reads all cells and writes its own.
        let chunk = out.len().div_ceil(rayon::current_num_threads()).max(CHUNK);
        out.par_chunks_mut(chunk).enumerate().for_each(|(i, out)| {
            let first = (i * chunk) as u32;
            let mut starts = starts.clone();
            for (i, &cell) in self.of.iter().enumerate() {
                let place = &mut starts[cell as usize];
                // Wraps around for the places before the chunk.
                if let Some(out) = out.get_mut(place.wrapping_sub(first) as usize) {
                    *out = items(i);
                }
                *place += 1;
            }
        });
    }
}
