//! Plots with two logarithmic axes, as SVG.

use std::fmt::Write;

/// A curve with its name.
pub(crate) struct Curve {
    pub(crate) name: &'static str,
    pub(crate) color: &'static str,
    /// Both coordinates above 0.
    pub(crate) points: Vec<(f64, f64)>,
}

/// What stands around the curves.
pub(crate) struct Labels {
    pub(crate) title: &'static str,
    pub(crate) x: &'static str,
    pub(crate) y: &'static str,
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 440.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 50.0;
const BOTTOM: f64 = 60.0;

/// One axis: the decades or octaves that hold all values, and where they lie on the page.
struct Axis {
    base: f64,
    first: i32,
    last: i32,
    start: f64,
    end: f64,
}

impl Axis {
    fn around(values: impl Iterator<Item = f64> + Clone, base: f64, start: f64, end: f64) -> Self {
        let exponent = |x: f64| x.log2() / base.log2();
        let low = values.clone().map(exponent).fold(f64::INFINITY, f64::min);
        let high = values.map(exponent).fold(f64::NEG_INFINITY, f64::max);
        // A value a little above a tick does not deserve a further decade.
        let (first, last) = (low.floor() as i32, (high - 0.05).ceil() as i32);
        Self { base, first, last: last.max(first + 1), start, end }
    }

    fn place(&self, value: f64) -> f64 {
        let exponent = value.log2() / self.base.log2();
        let share = (exponent - f64::from(self.first)) / f64::from(self.last - self.first);
        self.start + share * (self.end - self.start)
    }

    fn ticks(&self) -> impl Iterator<Item = f64> {
        (self.first..=self.last).map(|exponent| (f64::from(exponent) * self.base.log2()).exp2())
    }
}

/// The plot as the text of an SVG file: x in octaves, y in decades.
pub(crate) fn svg(curves: &[Curve], labels: &Labels) -> String {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::around(points.clone().map(|point| point.0), 2.0, LEFT, WIDTH - RIGHT);
    let y = Axis::around(points.map(|point| point.1), 10.0, HEIGHT - BOTTOM, TOP);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' font-family='sans-serif' \
         font-size='13'>\n<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>\n"
    );
    let mut text = |x: f64, y: f64, anchor: &str, more: &str, content: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(svg, "<text x='{x:.1}' y='{y:.1}' text-anchor='{anchor}' {more}>{content}</text>");
    };
    text(WIDTH / 2.0, 28.0, "middle", "font-size='16' font-weight='bold'", labels.title);
    text((LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 16.0, "middle", "", labels.x);
    let middle = (TOP + HEIGHT - BOTTOM) / 2.0;
    text(22.0, middle, "middle", &format!("transform='rotate(-90 22 {middle})'"), labels.y);
    for value in x.ticks() {
        text(x.place(value), HEIGHT - BOTTOM + 20.0, "middle", "", &label(value));
    }
    for value in y.ticks() {
        text(LEFT - 8.0, y.place(value) + 4.0, "end", "", &label(value));
    }
    for (row, curve) in curves.iter().enumerate() {
        let y = TOP + 22.0 + 20.0 * row as f64;
        text(WIDTH - RIGHT - 12.0, y, "end", &format!("fill='{}'", curve.color), curve.name);
    }
    for value in x.ticks() {
        grid(&mut svg, (x.place(value), TOP), (x.place(value), HEIGHT - BOTTOM));
    }
    for value in y.ticks() {
        grid(&mut svg, (LEFT, y.place(value)), (WIDTH - RIGHT, y.place(value)));
    }
    for curve in curves {
        let places = curve.points.iter().map(|&(a, b)| (x.place(a), y.place(b)));
        let path = places.clone().map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ");
        let color = curve.color;
        let _ = writeln!(svg, "<polyline points='{path}' fill='none' stroke='{color}' stroke-width='2'/>");
        for (x, y) in places {
            let _ = writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='3' fill='{color}'/>");
        }
    }
    svg.push_str("</svg>\n");
    svg
}

/// A power of the base as people write it, without the rounding of its computation.
fn label(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}

fn grid(svg: &mut String, from: (f64, f64), to: (f64, f64)) {
    let _ = writeln!(
        svg,
        "<line x1='{:.1}' y1='{:.1}' x2='{:.1}' y2='{:.1}' stroke='#dddddd'/>",
        from.0, from.1, to.0, to.1
    );
}
