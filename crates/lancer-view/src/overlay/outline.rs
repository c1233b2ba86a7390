//! A line around what is seen of the selected objects.

use super::palette::Palette;
use super::pen::{Pen, Style};
use lancer_core::geometry::DVec2;
use lancer_core::render::Features;
use lancer_core::world::{ObjectId, World};
use std::collections::HashMap;
use std::ops::Range;

/// A line around what is seen of the selected objects together.
pub(super) fn draw(
    pen: &mut Pen,
    palette: &Palette,
    world: &World,
    features: &Features,
    selected: &[ObjectId],
) {
    let within = extent(pen, world, features, selected);
    let mut contour = Contour::of(&Mask::new(features, selected, within));
    contour.smooth();
    let places = contour.corners.iter().map(|&corner| pen.surfaces.to_viewport(corner)).collect::<Vec<_>>();
    let style = Style { color: palette.selection, casing: Some(palette.casing), alpha: 1.0, width: 2.0 };
    pen.draw(style, |strokes| {
        for &line in &contour.lines {
            strokes.before_all(line.map(|corner| places[corner]));
        }
    });
}

/// The columns and rows of the features in which objects can be seen, and one more on each side: to look through
/// less of a picture is faster.
fn extent(pen: &Pen, world: &World, features: &Features, objects: &[ObjectId]) -> [Range<u32>; 2] {
    let all = [0..features.width(), 0..features.height()];
    // A selection of many may be anywhere.
    if objects.len() > 100 {
        return all;
    }
    let mut least = DVec2::INFINITY;
    let mut most = DVec2::NEG_INFINITY;
    for &id in objects.iter().filter(|id| id.index() < world.objects().len()) {
        for corner in world.object_bounds(id).corners() {
            let Some(place) = pen.lens.pixel_of(corner) else { return all };
            let place = pen.surfaces.to_features(place);
            (least, most) = (least.min(place), most.max(place));
        }
    }
    // What is outside of the picture ends up at its edges, as the casts clamp.
    let [columns, rows] = all;
    [
        (least.x - 2.0) as u32..((most.x + 2.0) as u32).min(columns.end),
        (least.y - 2.0) as u32..((most.y + 2.0) as u32).min(rows.end),
    ]
}

/// Which pixels of the features show one of some objects.
struct Mask<'a> {
    features: &'a Features,
    /// By the objects' ids; those beyond its end are not selected.
    is_selected: Vec<bool>,
    columns: Range<u32>,
    rows: Range<u32>,
}

impl<'a> Mask<'a> {
    fn new(features: &'a Features, selected: &[ObjectId], [columns, rows]: [Range<u32>; 2]) -> Self {
        let mut is_selected = vec![false; selected.iter().map(|id| id.index() + 1).max().unwrap_or(0)];
        for id in selected {
            is_selected[id.index()] = true;
        }
        Self { features, is_selected, columns, rows }
    }

    fn row(&self, y: u32) -> Vec<bool> {
        let is_selected = |id: ObjectId| self.is_selected.get(id.index()).is_some_and(|&is| is);
        self.columns.clone().map(|x| self.features.object(x, y).is_some_and(is_selected)).collect()
    }
}

/// The border of a mask. It is open at the edges of the picture.
#[derive(Default)]
struct Contour {
    /// In pixels of the features.
    corners: Vec<DVec2>,
    /// Each from corner to corner.
    lines: Vec<[usize; 2]>,
    /// The corners by twice their coordinates, which are whole numbers.
    known: HashMap<[u32; 2], usize>,
}

impl Contour {
    /// Marching squares: between each four pixels, a line cuts off the corners that are not like the others.
    fn of(mask: &Mask) -> Self {
        let mut contour = Self::default();
        let mut rows = mask.rows.clone().map(|y| mask.row(y));
        let Some(mut above) = rows.next() else { return contour };
        for (y, below) in (mask.rows.start + 1..).zip(rows) {
            for (x, (upper, lower)) in (mask.columns.start + 1..).zip(above.windows(2).zip(below.windows(2)))
            {
                if [upper[1], lower[0], lower[1]] != [upper[0]; 3] {
                    contour.cut([2 * x, 2 * y], [upper[0], upper[1], lower[1], lower[0]]);
                }
            }
            above = below;
        }
        contour
    }

    /// Adds the lines between four pixels that meet at a place, given clockwise from the upper left one.
    fn cut(&mut self, [x, y]: [u32; 2], [a, b, c, d]: [bool; 4]) {
        let sides = [(a != b, [x, y - 1]), (b != c, [x + 1, y]), (c != d, [x, y + 1]), (d != a, [x - 1, y])];
        let mut crossed = sides.into_iter().filter(|(crossed, _)| *crossed).map(|(_, side)| side);
        while let (Some(from), Some(to)) = (crossed.next(), crossed.next()) {
            let line = [self.corner(from), self.corner(to)];
            self.lines.push(line);
        }
    }

    fn corner(&mut self, doubled: [u32; 2]) -> usize {
        *self.known.entry(doubled).or_insert_with(|| {
            let [x, y] = doubled.map(|coordinate| 0.5 * f64::from(coordinate));
            self.corners.push(DVec2::new(x, y));
            self.corners.len() - 1
        })
    }

    /// Takes the stairs out of it: moves each corner to between its neighbours, some times. Where the line ends,
    /// at the edge of the picture, it stays.
    fn smooth(&mut self) {
        for _ in 0..SMOOTHINGS {
            let mut neighbours = vec![(DVec2::ZERO, 0); self.corners.len()];
            for &[a, b] in &self.lines {
                for (corner, other) in [(a, b), (b, a)] {
                    neighbours[corner].0 += self.corners[other];
                    neighbours[corner].1 += 1;
                }
            }
            for (corner, (sum, count)) in self.corners.iter_mut().zip(neighbours) {
                if count == 2 {
                    *corner = 0.5 * *corner + 0.25 * sum;
                }
            }
        }
    }
}

/// How often the outline is smoothed: less leaves stairs, more rounds corners that are none.
const SMOOTHINGS: u32 = 6;
