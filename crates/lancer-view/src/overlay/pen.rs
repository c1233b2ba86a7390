//! Draws lines of the world, and marks of a fixed size at points of it.

use super::canvas::{Canvas, Stroke};
use super::lens::{End, Lens};
use super::palette::Color;
use super::surfaces::Surfaces;
use lancer_core::geometry::{DVec2, DVec3};

/// How much wider than its line a casing is, in points.
const CASING_WIDTH: f64 = 2.0;

/// How much a casing covers, in parts of its line.
const CASING_ALPHA: f32 = 0.3;

/// An inverse depth nearer than all surfaces: what is drawn there is never hidden.
const BEFORE_ALL: f64 = 1e30;

/// What lines look like on every screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) color: Color,
    /// Of the wider line below; none draws none.
    pub(super) casing: Option<Color>,
    pub(super) alpha: f32,
    /// In points.
    pub(super) width: f64,
}

/// Draws on a canvas what a lens sees.
pub(super) struct Pen<'a> {
    pub(super) canvas: Canvas,
    pub(super) lens: Lens,
    pub(super) surfaces: Surfaces<'a>,
    /// Pixels to a point.
    pub(super) scale: f64,
}

/// A pen that draws in one style.
pub(super) struct Strokes<'p, 'a> {
    pen: &'p mut Pen<'a>,
    stroke: Stroke,
}

impl<'a> Pen<'a> {
    /// Calls `draw`, which is to draw the same lines each time, for the casings and then for the lines.
    pub(super) fn draw(&mut self, style: Style, draw: impl Fn(&mut Strokes)) {
        let Style { color, casing, alpha, width } = style;
        let casing = casing.map(|color| (color, alpha * CASING_ALPHA, width + CASING_WIDTH));
        for (color, alpha, width) in casing.into_iter().chain([(color, alpha, width)]) {
            self.canvas.begin_layer();
            let stroke = Stroke { color, alpha, width: width * self.scale };
            draw(&mut Strokes { pen: self, stroke });
        }
    }
}

impl Strokes<'_, '_> {
    pub(super) fn lens(&self) -> &Lens {
        &self.pen.lens
    }

    /// A line between two points of the world.
    pub(super) fn line(&mut self, a: DVec3, b: DVec3) {
        self.fading_line(a, b, |_, _| 1.0);
    }

    /// A line that covers less by a factor of where on it one is, from 0 to 1, and of the inverse depth there.
    pub(super) fn fading_line(&mut self, a: DVec3, b: DVec3, fade: impl Fn(f64, f64) -> f32) {
        if let Some(ends) = self.pen.lens.line(a, b) {
            self.pen.canvas.line(ends, &self.stroke, Some(&self.pen.surfaces), fade);
        }
    }

    /// Lines through places given in points from where a point of the world is seen, right and down, hidden where
    /// that point would be.
    pub(super) fn mark(&mut self, point: DVec3, places: impl IntoIterator<Item = DVec2>) {
        if let Some(end) = self.pen.lens.place(point) {
            let scale = self.pen.scale;
            self.polyline(places.into_iter().map(|place| End { at: end.at + place * scale, ..end }));
        }
    }

    /// A line of the viewport, which nothing hides.
    pub(super) fn before_all(&mut self, places: [DVec2; 2]) {
        self.polyline(places.map(|at| End { at, inverse_depth: BEFORE_ALL, along: 0.0 }));
    }

    fn polyline(&mut self, ends: impl IntoIterator<Item = End>) {
        let mut ends = ends.into_iter();
        let Some(mut last) = ends.next() else { return };
        for end in ends {
            self.pen.canvas.line([last, end], &self.stroke, Some(&self.pen.surfaces), |_, _| 1.0);
            last = end;
        }
    }
}
