//! A line around what is seen of the selected objects.

use super::palette::Palette;
use super::pen::{Pen, Style};
use lancer_core::geometry::DVec2;
use lancer_core::render::Features;
use lancer_core::world::ObjectId;

/// A line around what is seen of the selected objects together.
pub(super) fn draw(pen: &mut Pen, palette: &Palette, features: &Features, selected: &[ObjectId]) {
    let lines = contour(features, selected);
    let lines = lines.into_iter().map(|line| line.map(|place| pen.surfaces.to_viewport(place)));
    let lines = lines.collect::<Vec<_>>();
    let style = Style { color: palette.selection, casing: Some(palette.casing), alpha: 1.0, width: 2.0 };
    pen.draw(style, |strokes| {
        for &line in &lines {
            strokes.before_all(line);
        }
    });
}

/// The border between the pixels that show one of some objects and the others, as short lines in pixels of the
/// features. It is open at the edges of the picture.
///
/// Marching squares: between each four pixels, a line cuts off the corners that are not like the others. That leaves
/// no stairs.
fn contour(features: &Features, selected: &[ObjectId]) -> Vec<[DVec2; 2]> {
    let mut is_selected = vec![false; selected.iter().map(|id| id.index() + 1).max().unwrap_or(0)];
    for id in selected {
        is_selected[id.index()] = true;
    }
    let row = |y: u32| {
        let shows =
            |x| features.object(x, y).is_some_and(|id| is_selected.get(id.index()).is_some_and(|&is| is));
        (0..features.width()).map(shows).collect::<Vec<bool>>()
    };
    let mut lines = Vec::new();
    if features.height() == 0 {
        return lines;
    }
    let mut above = row(0);
    for y in 1..features.height() {
        let below = row(y);
        for (x, (upper, lower)) in above.windows(2).zip(below.windows(2)).enumerate() {
            if [upper[1], lower[0], lower[1]] != [upper[0]; 3] {
                let middle = DVec2::new(x as f64 + 1.0, f64::from(y));
                cut(middle, [upper[0], upper[1], lower[1], lower[0]], &mut lines);
            }
        }
        above = below;
    }
    lines
}

/// The lines between four pixels that meet at `middle`, given clockwise from the upper left one.
fn cut(middle: DVec2, [a, b, c, d]: [bool; 4], lines: &mut Vec<[DVec2; 2]>) {
    let sides = [(a != b, DVec2::NEG_Y), (b != c, DVec2::X), (c != d, DVec2::Y), (d != a, DVec2::NEG_X)];
    let mut crossed = sides.into_iter().filter(|(crossed, _)| *crossed).map(|(_, side)| middle + 0.5 * side);
    while let (Some(from), Some(to)) = (crossed.next(), crossed.next()) {
        lines.push([from, to]);
    }
}
