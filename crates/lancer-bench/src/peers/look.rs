//! What was drawn: how far it is from Lancer's picture, and all side by side.

use super::scene::Picture;
use super::{Entry, Reading};
use crate::Failure;
use lancer_core::color::linear_to_srgb;
use lancer_core::film::{Image, to_srgb8};
use lancer_core::geometry::DVec2;
use lancer_core::scene::Wrap;
use lancer_io::image::Metadata;
use lancer_io::image::encode::write_png;
use lancer_io::image::load_texture;
use lancer_io::limits::Limits;
use lancer_io::resolver::Resolver;
use std::path::Path;

/// The mean difference of each entry's channels from the first entry's, of 255; and a sheet of all, from left to
/// right, into `sheet`.
pub(super) fn compare(picture: &Picture, entries: &[Entry], sheet: &Path) -> Result<Vec<f64>, Failure> {
    let images = entries.iter().map(|entry| read(picture, entry)).collect::<Result<Vec<_>, _>>()?;
    let distances = images.iter().map(|image| apart(image, &images[0])).collect();
    let file = std::io::BufWriter::new(std::fs::File::create(sheet)?);
    write_png(&side_by_side(&images), &Metadata::default(), file)?;
    Ok(distances)
}

/// An image at the picture's size; a larger one by the means of its pixels.
fn read(picture: &Picture, entry: &Entry) -> Result<Image, Failure> {
    let texture = load_texture(&entry.image, &Resolver::for_file(&entry.image, true, Limits::default()))?;
    let (width, height) = (picture.settings.width, picture.settings.height);
    let n = if entry.reading == Reading::Finished { 1 } else { picture.settings.samples };
    let (columns, rows) = (f64::from(width * n), f64::from(height * n));
    let color = |x: u32, y: u32| {
        let uv = DVec2::new((f64::from(x) + 0.5) / columns, 1.0 - (f64::from(y) + 0.5) / rows);
        let color = texture.color_at(uv, [Wrap::Repeat; 2]).to_array();
        // The texture took the bytes for sRGB.
        if entry.reading == Reading::LinearSubpixels { color.map(linear_to_srgb) } else { color }
    };
    let mut image = Image::black(width, height);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let mut sum = [0.0; 3];
        for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
            for (sum, channel) in sum.iter_mut().zip(color(x * n + i, y * n + j)) {
                *sum += channel;
            }
        }
        image.put(x, y, 1, &[sum.map(|sum| (sum / f64::from(n * n)) as f32)]);
    }
    Ok(image)
}

fn apart(image: &Image, reference: &Image) -> f64 {
    let (found, expected) = (to_srgb8(image), to_srgb8(reference));
    let channels = found.as_flattened().iter().zip(expected.as_flattened());
    let sum: u64 = channels.map(|(&a, &b)| u64::from(a.abs_diff(b))).sum();
    sum as f64 / (3 * found.len()) as f64
}

/// All of one size.
fn side_by_side(images: &[Image]) -> Image {
    let (width, height) = (images[0].width(), images[0].height());
    let mut sheet = Image::black(width * images.len() as u32, height);
    for (i, image) in images.iter().enumerate() {
        sheet.put(i as u32 * width, 0, width, image.pixels());
    }
    sheet
}
