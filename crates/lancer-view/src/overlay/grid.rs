//! The plane y = 0 in squares, and the axes of the world.

use super::palette::Palette;
use super::pen::{Pen, Strokes, Style};
use lancer_core::geometry::{DVec2, DVec3};

/// How far the grid reaches from its middle, in distances of the view.
const REACH: f64 = 3.0;

/// The least number of squares to a distance of the view; the most is ten times as many.
const SQUARES: f64 = 2.5;

/// How strong the lines are that bound ten by ten squares, and how strong those of single squares are.
const STRENGTHS: [f64; 2] = [1.0, 0.45];

/// Lines weaker than this are not worth their time.
const UNSEEN: f64 = 0.02;

/// The distance of lines in pixels between which they fade out: nearer, they would be one grey mass.
const CROWDED: [f64; 2] = [3.0, 12.0];

/// The length of an axis, in distances of the eye from the origin: it looks equally long from everywhere.
const AXIS: f64 = 0.3;

/// Squares whose sides are a power of ten, so that both decades of them that are seen have their lines in common.
///
/// From farther away they are ten times as large. On the way there single squares fade out while the tens become as
/// they were: nothing jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The side of a square in world units.
    spacing: f64,
    /// How far it is to where the squares are ten times as large: from 0 to 1.
    toward_next: f64,
    /// Around which it fades out, on the plane.
    middle: DVec2,
    /// The distance from the middle at which nothing is left.
    reach: f64,
}

impl Grid {
    /// The grid of who looks at a point of interest. None where numbers end.
    pub(super) fn for_view(eye: DVec3, interest: DVec3) -> Option<Self> {
        let distance = (eye - interest).length().max(eye.y.abs());
        let (spacing, toward_next) = decade(distance / SQUARES)?;
        let reach = REACH * distance;
        // Farther off, neighbouring lines would be the same numbers.
        let can_count = interest.abs().max_element() < 1e12 * spacing;
        can_count.then_some(Self { spacing, toward_next, middle: DVec2::new(interest.x, interest.z), reach })
    }

    pub(super) fn draw(&self, pen: &mut Pen, palette: &Palette) {
        // Casings would take out of so thin lines what they are to show, and take long.
        let style = Style { color: palette.grid, casing: None, alpha: 0.5, width: 1.0 };
        pen.draw(style, |strokes| {
            self.draw_lines(strokes, self.middle, |across, along| DVec3::new(across, 0.0, along));
            let middle = DVec2::new(self.middle.y, self.middle.x);
            self.draw_lines(strokes, middle, |across, along| DVec3::new(along, 0.0, across));
        });
    }

    /// The lines of one direction. `x` of the middle counts across them, `y` along; `place` makes points of both.
    fn draw_lines(&self, strokes: &mut Strokes, middle: DVec2, place: impl Fn(f64, f64) -> DVec3) {
        let line = |coordinate: f64| (coordinate / self.spacing) as i64;
        for k in line(middle.x - self.reach)..=line(middle.x + self.reach) {
            let (strength, squares) = self.rank(k);
            let across = k as f64 * self.spacing;
            let off = (across - middle.x) / self.reach;
            let most = 1.0 - off * off;
            if strength * most < UNSEEN {
                continue;
            }
            let half = self.reach * most.sqrt();
            let (a, b) = (place(across, middle.y - half), place(across, middle.y + half));
            let (height, pixels) = (strokes.lens().eye().y.abs(), strokes.lens().pixels);
            let apart = squares * self.spacing * pixels;
            strokes.fading_line(a, b, |t, inverse_depth| {
                let inward = most * (4.0 * t * (1.0 - t));
                // Seen at a low angle, the lines across the view are closer by about its sine.
                let sine = (height * inverse_depth).min(1.0);
                let room = (apart * inverse_depth * sine - CROWDED[0]) / (CROWDED[1] - CROWDED[0]);
                (strength * inward * room.clamp(0.0, 1.0)) as f32
            });
        }
    }

    /// How strong the `k`th line from the origin is, and how many squares there are between it and the next like it.
    fn rank(&self, k: i64) -> (f64, f64) {
        let [strong, weak] = STRENGTHS;
        if k % 100 == 0 {
            (strong, 100.0)
        } else if k % 10 == 0 {
            (strong + (weak - strong) * self.toward_next, 10.0)
        } else {
            // Squared, since as many lines as are seen late on the way would fill the picture with grey.
            (weak * (1.0 - self.toward_next) * (1.0 - self.toward_next), 1.0)
        }
    }
}

/// The power of ten at or below `size`, and from 0 to 1 how far `size` is on the way to the next. None where
/// numbers end.
fn decade(size: f64) -> Option<(f64, f64)> {
    if !(1e-30..1e30).contains(&size) {
        return None;
    }
    let mut power = 1.0;
    while power > size {
        power /= 10.0;
    }
    while power * 10.0 <= size {
        power *= 10.0;
    }
    Some((power, (size / power - 1.0) / 9.0))
}

/// The axes at the origin, each with its letter.
pub(super) fn draw_axes(pen: &mut Pen, palette: &Palette) {
    let length = AXIS * pen.lens.eye().length();
    for ((axis, color), letter) in DVec3::AXES.into_iter().zip(palette.axes).zip(LETTERS) {
        let style = Style { color, casing: Some(palette.casing), alpha: 1.0, width: 1.5 };
        let tip = axis * length;
        pen.draw(style, |strokes| {
            strokes.line(DVec3::ZERO, tip);
            for line in letter {
                strokes.mark(tip, line.iter().map(|&place| DVec2::from_array(place) + LETTER_PLACE));
            }
        });
    }
}

/// Where the middle of a letter is, in points from the tip of its axis, right and down.
const LETTER_PLACE: DVec2 = DVec2::new(9.0, -7.0);

/// The letters X, Y and Z as lines, in points about their middle, right and down.
const LETTERS: [&[&[[f64; 2]]]; 3] = [
    &[&[[-3.0, -4.0], [3.0, 4.0]], &[[3.0, -4.0], [-3.0, 4.0]]],
    &[&[[-3.0, -4.0], [0.0, 0.0], [3.0, -4.0]], &[[0.0, 0.0], [0.0, 4.0]]],
    &[&[[-3.0, -4.0], [3.0, -4.0], [-3.0, 4.0], [3.0, 4.0]]],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_powers_of_ten() {
        let close = |size: f64, power: f64| {
            let (found, _) = decade(size).unwrap();
            assert!((found / power - 1.0).abs() < 1e-12, "{found} for {size}");
        };
        close(0.7, 0.1);
        close(1.0, 1.0);
        close(9.99, 1.0);
        close(10.0, 10.0);
        close(0.0013, 0.001);
        assert_eq!([0.0, f64::INFINITY, f64::NAN, -1.0].map(decade), [None; 4]);
    }

    #[test]
    fn where_squares_become_ten_times_as_large_every_line_is_as_strong_before_as_after() {
        let grid = |distance: f64| Grid::for_view(DVec3::Z * distance, DVec3::ZERO).unwrap();
        let [before, after] = [24.9999, 25.0001].map(grid);
        assert!((after.spacing / before.spacing - 10.0).abs() < 1e-9);
        for k in 0..=1000 {
            let (was, _) = before.rank(k);
            let is = if k % 10 == 0 { after.rank(k / 10).0 } else { 0.0 };
            assert!((was - is).abs() < 1e-4, "line {k}: {was}, then {is}");
        }
    }
}
