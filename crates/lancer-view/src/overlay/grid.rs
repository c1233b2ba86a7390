//! The plane y = 0 in squares, and the axes of the world.

use super::palette::Palette;
use super::pen::{Pen, Strokes, Style};
use lancer_core::geometry::{Bounds, DVec2, DVec3};

/// Squares across the scene's diagonal, at most.
const SQUARES: f64 = 10.0;

/// How far the grid reaches from its middle, in squares.
const REACH: i32 = 30;

/// Every how many lines one is stronger.
const MAJOR: i64 = 10;

/// The distance of lines in pixels between which they fade out: nearer, they would be one grey mass.
const CROWDED: (f64, f64) = (3.0, 12.0);

/// How far the axes reach from the origin, in squares.
const AXIS: f64 = 10.0;

/// How large the squares are, and where their middle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The side of a square: 1, 2 or 5 times a power of ten, in world units.
    pub(super) spacing: f64,
    /// The number of the lines that cross in the middle, along x and along z.
    middle: [i64; 2],
}

impl Grid {
    /// A grid for a scene within some bounds; around `interest` for one without. None where there is no good size.
    pub(super) fn for_scene(bounds: Bounds, eye: DVec3, interest: DVec3) -> Option<Self> {
        let bounded = !bounds.is_empty() && bounds.is_finite() && bounds.diagonal() > 0.0;
        let size = if bounded { bounds.diagonal() } else { (eye - interest).length() };
        let spacing = round_up(size / SQUARES)?;
        let center = if bounded { bounds.center() } else { interest };
        let line = |coordinate: f64| {
            let majors = (coordinate / (spacing * MAJOR as f64)).round();
            // Farther off, neighbouring lines would be the same numbers.
            (majors.abs() < 1e12).then_some(majors as i64 * MAJOR)
        };
        Some(Self { spacing, middle: [line(center.x)?, line(center.z)?] })
    }

    pub(super) fn draw(&self, pen: &mut Pen, palette: &Palette) {
        let style = Style { color: palette.grid, casing: Some(palette.casing), alpha: 0.55, width: 1.0 };
        pen.draw(style, |strokes| {
            for k in -i64::from(REACH)..=i64::from(REACH) {
                self.draw_line(strokes, k, |across, along| DVec3::new(across, 0.0, along), self.middle);
                let [x, z] = self.middle;
                self.draw_line(strokes, k, |across, along| DVec3::new(along, 0.0, across), [z, x]);
            }
        });
    }

    /// The `k`th line from the middle, whose number counts across it; `place` makes points of the two coordinates.
    fn draw_line(&self, strokes: &mut Strokes, k: i64, place: impl Fn(f64, f64) -> DVec3, middle: [i64; 2]) {
        let [across, along] = middle.map(|line| line as f64 * self.spacing);
        let across = across + k as f64 * self.spacing;
        let reach = f64::from(REACH) * self.spacing;
        let (a, b) = (place(across, along - reach), place(across, along + reach));
        let major = (middle[0] + k) % MAJOR == 0;
        let (strength, lines) = if major { (1.0, MAJOR as f64) } else { (0.45, 1.0) };
        let (height, pixels) = (strokes.lens().eye().y.abs(), strokes.lens().pixels);
        let off_middle = k as f64 / f64::from(REACH);
        strokes.fading_line(a, b, |t, inverse_depth| {
            let along = 2.0 * t - 1.0;
            let inward = (1.0 - off_middle * off_middle - along * along).max(0.0);
            // Seen at a low angle, the lines across the view are closer by about its sine.
            let sine = (height * inverse_depth).min(1.0);
            let apart = lines * self.spacing * pixels * inverse_depth * sine;
            let room = ((apart - CROWDED.0) / (CROWDED.1 - CROWDED.0)).clamp(0.0, 1.0);
            (strength * inward * room) as f32
        });
    }

    /// The axes: each full on its positive side, which ends with its letter, and thin on the other.
    pub(super) fn draw_axes(&self, pen: &mut Pen, palette: &Palette) {
        let reach = AXIS * self.spacing;
        for ((axis, color), letter) in DVec3::AXES.into_iter().zip(palette.axes).zip(LETTERS) {
            let style = Style { color, casing: Some(palette.casing), alpha: 0.95, width: 1.5 };
            let tip = axis * reach;
            pen.draw(style, |strokes| {
                strokes.fading_line(-tip, DVec3::ZERO, |t, _| 0.45 * t as f32);
                strokes.line(DVec3::ZERO, tip);
                for line in letter {
                    let places = line.iter().map(|&[x, y]| DVec2::new(x, y) + DVec2::new(9.0, -7.0));
                    strokes.mark(tip, places);
                }
            });
        }
    }
}

/// The letters X, Y and Z as lines, in points about their middle, right and down.
const LETTERS: [&[&[[f64; 2]]]; 3] = [
    &[&[[-3.0, -4.0], [3.0, 4.0]], &[[3.0, -4.0], [-3.0, 4.0]]],
    &[&[[-3.0, -4.0], [0.0, 0.0], [3.0, -4.0]], &[[0.0, 0.0], [0.0, 4.0]]],
    &[&[[-3.0, -4.0], [3.0, -4.0], [-3.0, 4.0], [3.0, 4.0]]],
];

/// The least of 1, 2 and 5 times powers of ten that is not below `size`; none where numbers end.
fn round_up(size: f64) -> Option<f64> {
    if !(1e-30..1e30).contains(&size) {
        return None;
    }
    let mut power = 1.0;
    while power > size {
        power /= 10.0;
    }
    while power * 10.0 < size {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|&rounded| rounded >= size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_1_2_or_5_times_a_power_of_ten() {
        let close =
            |a: Option<f64>, b: f64| assert!((a.unwrap() / b - 1.0).abs() < 1e-12, "{a:?} is not {b}");
        close(round_up(0.7), 1.0);
        close(round_up(1.0), 1.0);
        close(round_up(1.1), 2.0);
        close(round_up(3.0), 5.0);
        close(round_up(51.0), 100.0);
        close(round_up(0.0013), 0.002);
        assert_eq!([0.0, f64::INFINITY, f64::NAN, -1.0].map(round_up), [None; 4]);
    }

    #[test]
    fn a_scene_is_five_to_ten_squares_across_whatever_its_size() {
        for size in [1e-6, 0.03, 1.0, 7.0, 99.0, 1e9] {
            let bounds = Bounds::new(DVec3::ZERO, DVec3::X * size);
            let grid = Grid::for_scene(bounds, DVec3::ZERO, DVec3::ZERO).unwrap();
            let squares = size / grid.spacing;
            assert!((4.0..=10.0 + 1e-9).contains(&squares), "{squares} squares across {size}");
        }
    }
}
