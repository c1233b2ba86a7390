//! FLIP: how different two pictures look to somebody who flips between them.
//!
//! In: two pictures as displays are sent them. Out: a number for each pixel, from 0 where nothing is to be seen to 1.
//! Colours are compared after the blur of the eye, edges and points as they are, and a difference of colour counts
//! more where there is one of edges.
//!
//! Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020: the metric for displays (LDR-FLIP), with
//! the authors' constants. All of its filters are products of one for rows and one for columns, and are applied so.
//!
//! No filter reaches further than some rows. A picture is therefore gone through in bands, each with as many rows more
//! above and below as filters reach: on all threads, in memory for a few bands, and with the same numbers as in one go.

use super::filter::Plane;
use lancer_core::color::srgb_to_linear;
use lancer_core::film::Image;
use lancer_core::geometry::portable;
use rayon::prelude::*;
use std::f64::consts::{LOG2_E, PI};
use std::ops::Range;

/// How many pixels an eye sees in a degree, on a display of 3840 pixels over 0.7 m, from 0.7 m away: the default of
/// the authors.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * PI / 180.0;

/// The exponent that spreads small differences of colour (q_c).
const COLOR_EXPONENT: f64 = 0.7;
/// Differences below this part of the greatest one (p_c) ...
const COLOR_KNEE: f64 = 0.4;
/// ... take this part of the range (p_t).
const COLOR_KNEE_VALUE: f64 = 0.95;
/// The width of an edge in degrees (w).
const FEATURE_WIDTH: f64 = 0.082;
/// The exponent that spreads small differences of edges and points (q_f).
const FEATURE_EXPONENT: f64 = 0.5;

/// FLIP of each pixel, top row first, found on the threads of the current rayon pool. Shape: `[height * width]`.
///
/// `pixels_per_degree` says from how far the pictures are looked at: [`PIXELS_PER_DEGREE`] where it does not matter.
/// Pictures are of one size, and hold sRGB from 0 to 1.
///
/// # Panics
/// Where the pictures are not of one size, or `pixels_per_degree` is not from 1 to 1000.
pub fn flip(reference: &Image, test: &Image, pixels_per_degree: f64) -> Vec<f32> {
    assert_eq!((reference.width(), reference.height()), (test.width(), test.height()), "sizes");
    assert!((1.0..=1000.0).contains(&pixels_per_degree), "{pixels_per_degree} pixels a degree");
    let reach = color_radius(pixels_per_degree).max(feature_radius(pixels_per_degree));
    let (width, height) = (reference.width() as usize, reference.height() as usize);
    let mut values = vec![0.0; width * height];
    if values.is_empty() {
        return values;
    }
    let rows_of_band = LEAST_ROWS.max(reach * ROWS_FOR_REACH);
    let bands = values.par_chunks_mut(rows_of_band * width).enumerate();
    bands.for_each(|(index, band)| {
        let first = index * rows_of_band;
        let end = first + band.len() / width;
        let seen = first.saturating_sub(reach)..(end + reach).min(height);
        let found = flip_of_rows(reference, test, seen.clone(), pixels_per_degree);
        for (value, found) in band.iter_mut().zip(found.skip((first - seen.start) * width)) {
            *value = found;
        }
    });
    values
}

/// The least rows of a band: fewer would leave threads more to share out than to do.
const LEAST_ROWS: usize = 16;
/// How many times as high a band is as filters reach to each side. Where it is 1, two of three rows are filtered for a
/// neighbour; where it is 100, a small picture is one band, for one thread. Untuned.
const ROWS_FOR_REACH: usize = 6;

/// FLIP of some rows of a picture, as if there were no others.
fn flip_of_rows(
    reference: &Image,
    test: &Image,
    rows: Range<usize>,
    pixels_per_degree: f64,
) -> impl Iterator<Item = f32> {
    let (reference, test) = (Opponent::of(reference, rows.clone()), Opponent::of(test, rows));
    let features = feature_differences(&reference.lightness(), &test.lightness(), pixels_per_degree);
    let colors = color_differences(&reference, &test, pixels_per_degree);
    let combined = colors.into_iter().zip(features);
    combined.map(|(color, feature)| portable::pow(color, 1.0 - f64::from(feature)) as f32)
}

/// Linear RGB to CIE XYZ, for sRGB's primaries.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// Its inverse.
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.241_003_232_976_358, -1.537_398_969_488_785, -0.498_615_881_996_363],
    [-0.969_224_252_202_516, 1.875_929_983_695_176, 0.041_554_226_340_085],
    [0.055_639_419_851_975, -0.204_011_206_123_910, 1.057_148_977_187_533],
];

fn times(matrix: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

/// XYZ of white.
fn white() -> [f64; 3] {
    times(&XYZ_FROM_RGB, [1.0; 3])
}

/// A picture in Y C_x C_z, which is CIE L*a*b* without its cube roots: light, red against green, blue against yellow.
struct Opponent {
    planes: [Plane; 3],
}

impl Opponent {
    /// Some rows of a picture.
    fn of(srgb: &Image, rows: Range<usize>) -> Self {
        let (width, height) = (srgb.width() as usize, rows.len());
        let mut planes = [(); 3].map(|()| Plane { width, height, values: Vec::new() });
        let white = white();
        for pixel in &srgb.pixels()[rows.start * width..rows.end * width] {
            let rgb = pixel.map(|value| srgb_to_linear(f64::from(value.clamp(0.0, 1.0).max(0.0))));
            let xyz = times(&XYZ_FROM_RGB, rgb);
            let [x, y, z] = std::array::from_fn(|i| xyz[i] / white[i]);
            let opponent = [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)];
            for (plane, value) in planes.iter_mut().zip(opponent) {
                plane.values.push(value as f32);
            }
        }
        Self { planes }
    }

    /// The light of each pixel, from 0 to 1.
    fn lightness(&self) -> Plane {
        let [light, ..] = &self.planes;
        let values = light.values.iter().map(|&y| ((f64::from(y) + 16.0) / 116.0) as f32).collect();
        Plane { values, ..*light }
    }

    /// The picture as the eye resolves it, in CIE L*a*b*, its colours weaker where it is dark (the Hunt effect).
    fn seen(&self, pixels_per_degree: f64) -> Vec<[f64; 3]> {
        let white = white();
        let [light, red_green, blue_yellow] =
            std::array::from_fn(|i| SENSITIVITIES[i].filtered(&self.planes[i], pixels_per_degree).values);
        let planes = light.into_iter().zip(red_green).zip(blue_yellow);
        planes
            .map(|((light, red_green), blue_yellow)| {
                let y = (f64::from(light) + 16.0) / 116.0;
                let (x, z) = (y + f64::from(red_green) / 500.0, y - f64::from(blue_yellow) / 200.0);
                let rgb = times(&RGB_FROM_XYZ, [x * white[0], y * white[1], z * white[2]]);
                hunt_lab(rgb.map(|value| value.clamp(0.0, 1.0)))
            })
            .collect()
    }
}

/// How well the eye resolves one of the channels: a sum of one or two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
/// degrees. Table 1 of the source.
struct Sensitivity {
    gaussians: &'static [(f64, f64)],
}

const SENSITIVITIES: [Sensitivity; 3] = [
    Sensitivity { gaussians: &[(1.0, 0.0047)] },
    Sensitivity { gaussians: &[(1.0, 0.0053)] },
    Sensitivity { gaussians: &[(34.1, 0.04), (13.5, 0.025)] },
];

/// The widest b, by which all kernels are cut at three deviations.
const WIDEST: f64 = 0.04;

impl Sensitivity {
    fn filtered(&self, plane: &Plane, pixels_per_degree: f64) -> Plane {
        let radius = color_radius(pixels_per_degree);
        let mut values = vec![0.0_f32; plane.values.len()];
        let kernels = self.gaussians.iter().map(|&(a, b)| {
            let kernel =
                sampled(radius, |x| exp(-PI * PI / b * (x / pixels_per_degree) * (x / pixels_per_degree)));
            let sum = kernel.iter().sum::<f64>();
            (a * (PI / b).sqrt() * sum * sum, kernel.into_iter().map(|value| value / sum).collect::<Vec<_>>())
        });
        let kernels = kernels.collect::<Vec<_>>();
        let total = kernels.iter().map(|(weight, _)| weight).sum::<f64>();
        for (weight, kernel) in &kernels {
            let filtered = plane.filtered(kernel, kernel);
            for (value, more) in values.iter_mut().zip(filtered.values) {
                *value += (f64::from(more) * weight / total) as f32;
            }
        }
        Plane { values, ..*plane }
    }
}

/// How many pixels the filters of colours reach to each side.
fn color_radius(pixels_per_degree: f64) -> usize {
    (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize
}

/// How wide an edge is that the filters of edges and points see, in pixels.
fn feature_deviation(pixels_per_degree: f64) -> f64 {
    0.5 * FEATURE_WIDTH * pixels_per_degree
}

/// How many pixels these reach to each side.
fn feature_radius(pixels_per_degree: f64) -> usize {
    (3.0 * feature_deviation(pixels_per_degree)).ceil() as usize
}

/// A function at the pixels from `-radius` to `radius`.
fn sampled(radius: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * radius).map(|i| f(i as f64 - radius as f64)).collect()
}

fn exp(x: f64) -> f64 {
    portable::exp2(x * LOG2_E)
}

/// CIE L*a*b* of linear RGB, a* and b* in proportion to L*.
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    /// 6 / 29: where the curve turns into a line.
    const DELTA: f64 = 6.0 / 29.0;
    let (xyz, white) = (times(&XYZ_FROM_RGB, rgb), white());
    let [x, y, z] = std::array::from_fn(|i| {
        let t = xyz[i] / white[i];
        if t > DELTA * DELTA * DELTA {
            portable::pow(t, 1.0 / 3.0)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    });
    let light = 116.0 * y - 16.0;
    [light, 0.01 * light * 500.0 * (x - y), 0.01 * light * 200.0 * (y - z)]
}

/// The distance HyAB: of lightness, plus that of the rest.
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [light, x, y] = std::array::from_fn(|i| a[i] - b[i]);
    light.abs() + (x * x + y * y).sqrt()
}

/// Differences of colour from 0 to 1.
fn color_differences(reference: &Opponent, test: &Opponent, pixels_per_degree: f64) -> Vec<f64> {
    let spread = |difference: f64| portable::pow(difference, COLOR_EXPONENT);
    // No two colours are further apart than pure green and pure blue.
    let greatest = spread(hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])));
    let knee = COLOR_KNEE * greatest;
    let pairs = reference.seen(pixels_per_degree).into_iter().zip(test.seen(pixels_per_degree));
    pairs
        .map(|(reference, test)| {
            let difference = spread(hyab(reference, test));
            if difference < knee {
                COLOR_KNEE_VALUE / knee * difference
            } else {
                let beyond = (difference - knee) / (greatest - knee);
                (COLOR_KNEE_VALUE + beyond * (1.0 - COLOR_KNEE_VALUE)).min(1.0)
            }
        })
        .collect()
}

/// Differences of edges and points from 0 to 1.
fn feature_differences(reference: &Plane, test: &Plane, pixels_per_degree: f64) -> Vec<f32> {
    let (deviation, radius) = (feature_deviation(pixels_per_degree), feature_radius(pixels_per_degree));
    let gaussian = |x: f64| exp(-x * x / (2.0 * deviation * deviation));
    let smooth = sampled(radius, gaussian);
    let total = smooth.iter().sum::<f64>();
    let smooth = smooth.into_iter().map(|value| value / total).collect::<Vec<_>>();
    let edge = balanced(sampled(radius, |x| -x * gaussian(x)));
    let point = balanced(sampled(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x)));

    let strength = |plane: &Plane, kernel: &[f64]| -> Vec<f64> {
        let (across, down) = (plane.filtered(kernel, &smooth), plane.filtered(&smooth, kernel));
        let both = across.values.into_iter().zip(down.values);
        both.map(|(x, y)| (f64::from(x) * f64::from(x) + f64::from(y) * f64::from(y)).sqrt()).collect()
    };
    let [edges, points] = [edge, point].map(|kernel| {
        let pairs = strength(reference, &kernel).into_iter().zip(strength(test, &kernel));
        pairs.map(|(reference, test)| (reference - test).abs()).collect::<Vec<_>>()
    });
    let greater = edges.into_iter().zip(points).map(|(edge, point)| edge.max(point));
    greater
        .map(|difference| {
            portable::pow(difference / std::f64::consts::SQRT_2, FEATURE_EXPONENT).min(1.0) as f32
        })
        .collect()
}

/// A kernel whose positive weights are 1 together, and whose negative ones are -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let positive = kernel.iter().filter(|&&weight| weight > 0.0).sum::<f64>();
    let negative = -kernel.iter().filter(|&&weight| weight < 0.0).sum::<f64>();
    kernel.into_iter().map(|weight| weight / if weight < 0.0 { negative } else { positive }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::render::with_threads;

    fn picture(width: u32, height: u32, color: impl Fn(u32, u32) -> [f32; 3]) -> Image {
        let mut image = Image::black(width, height);
        for y in 0..height {
            for x in 0..width {
                image.put(x, y, 1, &[color(x, y)]);
            }
        }
        image
    }

    fn noise(seed: u32) -> impl Fn(u32, u32) -> [f32; 3] {
        move |x, y| {
            std::array::from_fn(|channel| {
                let mut h = seed ^ x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b) ^ channel as u32;
                h = (h ^ h >> 16).wrapping_mul(0x045d_9f3b);
                ((h ^ h >> 15) & 0xff) as f32 / 255.0
            })
        }
    }

    #[test]
    fn equal_pictures_differ_nowhere() {
        let image = picture(20, 15, noise(1));
        assert!(flip(&image, &image, PIXELS_PER_DEGREE).iter().all(|&value| value == 0.0));
    }

    #[test]
    fn bands_and_threads_change_no_bit() {
        let (a, b) = (picture(23, 301, noise(1)), picture(23, 301, noise(2)));
        for pixels_per_degree in [1.0, PIXELS_PER_DEGREE] {
            let in_one_go =
                flip_of_rows(&a, &b, 0..301, pixels_per_degree).map(f32::to_bits).collect::<Vec<_>>();
            for threads in [1, 3] {
                let found = with_threads(threads, || flip(&a, &b, pixels_per_degree)).unwrap();
                assert_eq!(found.into_iter().map(f32::to_bits).collect::<Vec<_>>(), in_one_go);
            }
        }
    }

    #[test]
    fn which_picture_is_the_reference_makes_no_difference() {
        let (a, b) = (picture(20, 15, noise(1)), picture(20, 15, noise(2)));
        assert_eq!(flip(&a, &b, PIXELS_PER_DEGREE), flip(&b, &a, PIXELS_PER_DEGREE));
    }

    #[test]
    fn green_and_blue_are_as_far_apart_as_can_be() {
        let (green, blue) = (picture(4, 4, |_, _| [0.0, 1.0, 0.0]), picture(4, 4, |_, _| [0.0, 0.0, 1.0]));
        assert!(flip(&green, &blue, PIXELS_PER_DEGREE).iter().all(|value| (value - 1.0).abs() < 1e-6));
    }

    #[test]
    fn white_and_black_differ_by_their_lightness_alone() {
        // 100^0.7 against the knee at 0.4 of 203.47^0.7, the distance of green and blue.
        let (white, black) = (picture(4, 4, |_, _| [1.0; 3]), picture(4, 4, |_, _| [0.0; 3]));
        let greatest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0]));
        let (c, m) = (portable::pow(100.0, 0.7), portable::pow(greatest, 0.7));
        let expected = 0.95 + (c - 0.4 * m) / (0.6 * m) * 0.05;
        for value in flip(&white, &black, PIXELS_PER_DEGREE) {
            assert!((f64::from(value) - expected).abs() < 1e-6, "{value} is not {expected}");
        }
    }

    #[test]
    fn the_matrices_are_inverses() {
        for i in 0..3 {
            let unit = std::array::from_fn(|j| f64::from(u8::from(i == j)));
            let back = times(&RGB_FROM_XYZ, times(&XYZ_FROM_RGB, unit));
            assert!(
                back.iter().zip(unit).all(|(found, expected)| (found - expected).abs() < 1e-9),
                "{back:?}"
            );
        }
    }

    #[test]
    fn values_are_from_0_to_1_at_every_distance() {
        let (a, b) = (picture(20, 15, noise(1)), picture(20, 15, noise(2)));
        for pixels_per_degree in [1.0, 10.0, PIXELS_PER_DEGREE, 300.0] {
            let values = flip(&a, &b, pixels_per_degree);
            assert!(values.iter().all(|value| (0.0..=1.0).contains(value)), "{pixels_per_degree}");
            assert!(values.iter().any(|&value| value > 0.1));
        }
    }
}
