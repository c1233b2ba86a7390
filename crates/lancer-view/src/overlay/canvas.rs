//! Anti-aliased lines on a transparent picture.

use super::OverlayImage;
use super::lens::End;
use super::surfaces::Surfaces;
use lancer_core::geometry::DVec2;
use std::ops::Range;

/// How much of a line is left where a surface hides it.
const HIDDEN: f32 = 0.22;

/// What covers a pixel less than this is not worth the time that it takes to find what hides it.
const UNSEEN: f32 = 1.5 / 255.0;

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
        let thin = stroke.width.min(1.0) as f32;
        let reach = 0.5 * stroke.width.max(1.0) + 0.5;
        let (width, height) = (self.image.width, self.image.height);
        // The axis along which the line is longer is walked pixel by pixel.
        let steep = way.y.abs() > way.x.abs();
        let (columns, rows) = if steep { (height, width) } else { (width, height) };
        let flip = |v: DVec2| if steep { DVec2::new(v.y, v.x) } else { v };
        let (from, flipped_way) = (flip(a.at), flip(way));
        let slope = if flipped_way.x == 0.0 { 0.0 } else { flipped_way.y / flipped_way.x };
        let across = reach * (1.0 + slope * slope).sqrt();
        let ends = [from.x, from.x + flipped_way.x];
        for column in pixels(ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach, columns) {
            let x = f64::from(column) + 0.5;
            let y = from.y + slope * (x - from.x);
            let t = ((flip(DVec2::new(x, y)) - a.at).dot(way) * per_length).clamp(0.0, 1.0);
            let point = End::between(&a, &b, t);
            let alpha = stroke.alpha * thin * fade(point.along, point.inverse_depth);
            if alpha < UNSEEN {
                continue;
            }
            for row in pixels(y - across, y + across, rows) {
                let center = flip(DVec2::new(x, f64::from(row) + 0.5));
                let t = ((center - a.at).dot(way) * per_length).clamp(0.0, 1.0);
                let coverage = (reach - (center - a.at - way * t).length()).min(1.0) as f32;
                if alpha * coverage < UNSEEN {
                    continue;
                }
                let (column, row) = if steep { (row, column) } else { (column, row) };
                let hidden = surfaces.is_some_and(|surfaces| surfaces.hide(column, row, &point));
                self.cover(column, row, stroke.color, alpha * coverage * if hidden { HIDDEN } else { 1.0 });
            }
        }
    }

    fn cover(&mut self, x: u32, y: u32, color: [u8; 3], alpha: f32) {
        let index = y as usize * self.image.width as usize + x as usize;
        let before = match self.covered[index] {
            [layer, covered] if layer == self.layer => f32::from(covered) / 255.0,
            _ => 0.0,
        };
        if alpha <= before {
            return;
        }
        self.covered[index] = [self.layer, (alpha * 255.0 + 0.5) as u8];
        // As much more as makes the layer cover `alpha` in all.
        let more = if before < 1.0 { ((alpha - before) / (1.0 - before)).min(1.0) } else { 0.0 };
        let [r, g, b] = color;
        let over = |below: u8, above: u8| {
            (f32::from(below) + (f32::from(above) - f32::from(below)) * more + 0.5) as u8
        };
        let [below_r, below_g, below_b, below_a] = self.image.pixels[index];
        self.image.pixels[index] = [over(below_r, r), over(below_g, g), over(below_b, b), over(below_a, 255)];
    }
}

/// The pixels of a row, `count` long, that have a part between two places. Places outside of the row end up at its
/// ends, as the cast clamps.
fn pixels(from: f64, to: f64, count: u32) -> Range<u32> {
    from.floor() as u32..(to.ceil() as u32).min(count)
}
