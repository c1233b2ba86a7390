//! Anti-aliased lines on a transparent picture.

use super::OverlayImage;
use super::lens::End;
use super::surfaces::Surfaces;
use lancer_core::geometry::DVec2;

/// How much of a line is left where a surface hides it.
const HIDDEN: f32 = 0.22;

/// What a line looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    /// sRGB.
    pub(super) color: [u8; 3],
    /// How much it covers, from 0 to 1.
    pub(super) alpha: f32,
    /// In pixels.
    pub(super) width: f64,
}

/// A picture of which nothing is covered at first.
pub(super) struct Canvas {
    image: OverlayImage,
    /// For each pixel the layer that covered it last, and by how much of 255.
    covered: Vec<[u8; 2]>,
    layer: u8,
}

impl Canvas {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        let image = OverlayImage { width, height, pixels: vec![[0; 4]; pixels] };
        Self { image, covered: vec![[0; 2]; pixels], layer: 0 }
    }

    pub(super) fn into_image(self) -> OverlayImage {
        self.image
    }

    /// What is drawn from here on lies above what was drawn before. Lines of one layer do not add up where they
    /// cross or meet: a pixel is covered as by the one that covers it most.
    pub(super) fn begin_layer(&mut self) {
        self.layer += 1;
    }

    /// Draws a line, faint where `surfaces` hide it. `fade` multiplies what it covers, by where on the line and by
    /// the inverse depth.
    pub(super) fn line(
        &mut self,
        [a, b]: [End; 2],
        stroke: &Stroke,
        surfaces: Option<&Surfaces>,
        fade: impl Fn(f64, f64) -> f32,
    ) {
        let way = b.at - a.at;
        let per_length = 1.0 / way.length_squared().max(f64::MIN_POSITIVE);
        // Lines thinner than a pixel are a pixel wide and cover less.
        let thin = stroke.width.min(1.0);
        let reach = 0.5 * stroke.width.max(1.0) + 0.5;
        for_each_pixel_near(a.at, b.at, reach, [self.image.width, self.image.height], |x, y| {
            let center = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let t = ((center - a.at).dot(way) * per_length).clamp(0.0, 1.0);
            let at = a.at + way * t;
            let coverage = (reach - (center - at).length()).min(1.0) * thin;
            if coverage <= 0.0 {
                return;
            }
            let inverse_depth = a.inverse_depth + (b.inverse_depth - a.inverse_depth) * t;
            // Linear in the picture is what is divided by the depth.
            let (from, to) = (a.along * a.inverse_depth, b.along * b.inverse_depth);
            let along = (from + (to - from) * t) / inverse_depth;
            let mut alpha = stroke.alpha * coverage as f32 * fade(along, inverse_depth);
            if alpha * 255.0 < 0.5 {
                return;
            }
            if surfaces.is_some_and(|surfaces| surfaces.hide(x, y, at, inverse_depth)) {
                alpha *= HIDDEN;
            }
            self.cover(x, y, stroke.color, alpha);
        });
    }

    fn cover(&mut self, x: u32, y: u32, color: [u8; 3], alpha: f32) {
        let index = y as usize * self.image.width as usize + x as usize;
        let before = match self.covered[index] {
            [layer, covered] if layer == self.layer => f32::from(covered) / 255.0,
            _ => 0.0,
        };
        // NaN ends here too.
        if !(alpha > before) {
            return;
        }
        self.covered[index] = [self.layer, (alpha * 255.0).round() as u8];
        // As much more as makes the layer cover `alpha` in all.
        let more = if before < 1.0 { ((alpha - before) / (1.0 - before)).min(1.0) } else { 0.0 };
        let [r, g, b] = color;
        let over =
            |below: u8, above: u8| (f32::from(below) * (1.0 - more) + f32::from(above) * more).round() as u8;
        let [below_r, below_g, below_b, below_a] = self.image.pixels[index];
        self.image.pixels[index] = [over(below_r, r), over(below_g, g), over(below_b, b), over(below_a, 255)];
    }
}

/// Calls `visit` with the pixels of an image whose centres are within `reach` of a line, and with some others near it.
fn for_each_pixel_near(
    a: DVec2,
    b: DVec2,
    reach: f64,
    [width, height]: [u32; 2],
    mut visit: impl FnMut(u32, u32),
) {
    let way = b - a;
    let steep = way.y.abs() > way.x.abs();
    // From here on `x` is the axis along which the line is longer.
    let flip = |v: DVec2| if steep { DVec2::new(v.y, v.x) } else { v };
    let (a, b, way) = (flip(a), flip(b), flip(way));
    let (columns, rows) = if steep { (height, width) } else { (width, height) };
    let slope = if way.x == 0.0 { 0.0 } else { way.y / way.x };
    let across = reach * (1.0 + slope * slope).sqrt();
    // What is outside of the image ends up at its edges, as the cast clamps.
    let pixels = |from: f64, to: f64, count: u32| (from.floor() as u32)..(to.ceil() as u32).min(count);
    for column in pixels(a.x.min(b.x) - reach, a.x.max(b.x) + reach, columns) {
        let y = a.y + slope * (f64::from(column) + 0.5 - a.x);
        for row in pixels(y - across, y + across, rows) {
            if steep { visit(row, column) } else { visit(column, row) }
        }
    }
}
