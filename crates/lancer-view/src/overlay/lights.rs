//! Where the lights are.

use super::palette::Palette;
use super::pen::{Pen, Strokes, Style};
use lancer_core::geometry::{DVec2, DVec3, portable};
use lancer_core::scene::Light;
use std::f64::consts::TAU;

/// Radii in points: of the disc, and of the rays' beginnings and ends.
const RADII: [f64; 3] = [3.5, 5.5, 8.5];

/// Rays around a light.
const RAYS: u32 = 8;

/// Corners of what passes for a circle.
const CORNERS: u32 = 16;

/// The radius of the mark below a light, in points.
const FOOT: f64 = 3.0;

/// More lights than these would hide the picture, and take long.
const MOST: usize = 500;

/// A small sun for each light, on a stem that stands on the plane y = 0.
pub(super) fn draw(pen: &mut Pen, palette: &Palette, lights: &[Light], selected: Option<usize>) {
    let position = |(_, light): (usize, &Light)| light.position;
    let others = lights.iter().enumerate().filter(|&(index, _)| selected != Some(index));
    let others = others.map(position).take(MOST).collect::<Vec<_>>();
    let selected = lights.iter().enumerate().filter(|&(index, _)| selected == Some(index));
    let selected = selected.map(position).collect::<Vec<_>>();
    for (positions, color, width) in [(others, palette.light, 1.25), (selected, palette.selection, 2.0)] {
        let style = Style { color, casing: Some(palette.casing), alpha: 0.95, width };
        pen.draw(Style { alpha: 0.5, width: 1.0, ..style }, |strokes| {
            positions.iter().for_each(|&position| draw_stem(strokes, position));
        });
        pen.draw(style, |strokes| positions.iter().for_each(|&position| draw_sun(strokes, position)));
    }
}

fn draw_stem(strokes: &mut Strokes, position: DVec3) {
    let foot = DVec3::new(position.x, 0.0, position.z);
    strokes.line(position, foot);
    for arm in [DVec2::X, DVec2::Y] {
        strokes.mark(foot, [arm * -FOOT, arm * FOOT]);
    }
}

fn draw_sun(strokes: &mut Strokes, position: DVec3) {
    let [disc, from, to] = RADII;
    strokes.mark(position, (0..=CORNERS).map(|corner| around(corner, CORNERS) * disc));
    for ray in 0..RAYS {
        let direction = around(ray, RAYS);
        strokes.mark(position, [direction * from, direction * to]);
    }
}

/// The direction of the `k`th of `count` places around.
fn around(k: u32, count: u32) -> DVec2 {
    let (sin, cos) = portable::sin_cos(TAU * f64::from(k) / f64::from(count));
    DVec2::new(cos, sin)
}
