//! Images made larger, to stand in for what is not traced yet.

use lancer_core::film::Image;
use rayon::prelude::*;

/// The image at another size, linearly between the centres of its pixels, as a display stretches it.
pub(super) fn stretched(image: &Image, width: u32, height: u32) -> Image {
    if (image.width(), image.height()) == (width, height) {
        return image.clone();
    }
    let columns = (0..width).map(|x| Between::new(x, width, image.width())).collect::<Vec<_>>();
    let row_of = |y: u32| {
        let start = y as usize * image.width() as usize;
        &image.pixels()[start..start + image.width() as usize]
    };
    let pixels = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| {
            let row = Between::new(y, height, image.height());
            let (upper, lower) = (row_of(row.first), row_of(row.second));
            columns.iter().map(move |column| {
                let along = |pixels: &[[f32; 3]]| {
                    mix(pixels[column.first as usize], pixels[column.second as usize], column.part)
                };
                mix(along(upper), along(lower), row.part)
            })
        })
        .collect::<Vec<_>>();
    let mut stretched = Image::black(width, height);
    stretched.put(0, 0, width, &pixels);
    stretched
}

/// Between which two pixels of `from` a pixel of `to` lies, and how far from the first.
struct Between {
    first: u32,
    second: u32,
    part: f32,
}

impl Between {
    fn new(at: u32, to: u32, from: u32) -> Self {
        let last = from - 1;
        let place = (f64::from(at) + 0.5) * f64::from(from) / f64::from(to) - 0.5;
        let place = place.clamp(0.0, f64::from(last));
        let first = place as u32;
        Self { first, second: (first + 1).min(last), part: (place - f64::from(first)) as f32 }
    }
}

fn mix(a: [f32; 3], b: [f32; 3], part: f32) -> [f32; 3] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Image {
        let mut image = Image::black(width, height);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            image.put(x, y, 1, &[[x as f32 + 0.5, y as f32 + 0.5, 1.0]]);
        }
        image
    }

    #[test]
    fn a_ramp_stays_a_ramp_within_the_centres_of_its_outer_pixels() {
        let large = stretched(&ramp(8, 4), 24, 12);
        for (x, y) in (0..12).flat_map(|y| (0..24).map(move |x| (x, y))) {
            let expected = [(x as f32 + 0.5) / 3.0, (y as f32 + 0.5) / 3.0, 1.0];
            let expected = [expected[0].clamp(0.5, 7.5), expected[1].clamp(0.5, 3.5), 1.0];
            let found = large.pixel(x, y);
            let difference = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f32::max);
            assert!(difference < 1e-5, "{x},{y}: {found:?} is not {expected:?}");
        }
    }

    #[test]
    fn one_pixel_fills_any_image_and_the_same_size_is_the_same_image() {
        assert!(stretched(&ramp(1, 1), 5, 3).pixels().iter().all(|pixel| *pixel == [0.5, 0.5, 1.0]));
        assert_eq!(stretched(&ramp(3, 2), 3, 2), ramp(3, 2));
    }
}
