//! What a picture shows, as an image for the eye.
//!
//! The picture itself and ambient occlusion are what the renderer makes. The others are made from what is seen at
//! the centre of each pixel, so their edges are hard however many subpixels there are:
//!
//! - depth: near is bright, far is dark, by the inverse of the distance between the nearest and the farthest of
//!   this picture. The inverse, since a ground may reach to the horizon and leave no shades for the rest.
//!   Nothing is black, and darker than the farthest surface.
//! - normals: (n + 1) / 2 of the world normal on the side of the eye, as 8-bit values that a display shows: the
//!   colours that all tools give them. Nothing is middle grey, the normal 0.
//! - objects: hues a golden section of the circle apart, in three strengths, so that neighbours in the scene differ
//!   most; always the same for the same place in the world. Nothing is dark grey.

use super::Channel;
use lancer_core::camera::Camera;
use lancer_core::color::srgb_to_linear;
use lancer_core::film::Image;
use lancer_core::geometry::DVec3;
use lancer_core::integrator::RayCounts;
use lancer_core::render::{
    Control, Features, Render, RenderError, render, render_features, render_occlusion,
};
use lancer_core::scene::Settings;
use lancer_core::world::World;
use rayon::prelude::*;

/// Makes the image of a channel.
///
/// # Errors
/// See [`RenderError`].
pub(super) fn trace(
    channel: Channel,
    world: &World,
    camera: &Camera,
    settings: &Settings,
    control: &Control,
) -> Result<Render, RenderError> {
    match channel {
        Channel::Picture => render(world, camera, settings, None, control),
        Channel::Occlusion => render_occlusion(world, camera, settings, None, control),
        Channel::Depth | Channel::Normals | Channel::Objects => {
            let Settings { width, height, .. } = *settings;
            Ok(show(channel, &render_features(world, camera, width, height, &control.cancel)?))
        }
    }
}

/// The image of a channel that shows what is seen where: for others the same as that of objects.
pub(super) fn show(channel: Channel, features: &Features) -> Render {
    let image = match channel {
        Channel::Depth => depth(features),
        Channel::Normals => image(features, |x, y| features.normal(x, y).map_or(NO_NORMAL, normal_color)),
        _ => image(features, |x, y| {
            features.object(x, y).map_or(NO_OBJECT, |object| object_color(object.index()))
        }),
    };
    let primary = u64::from(features.width()) * u64::from(features.height());
    Render { image, rays: RayCounts { primary, ..RayCounts::default() } }
}

/// Whether a channel's image is made by [`show`].
pub(super) fn shows_features(channel: Channel) -> bool {
    matches!(channel, Channel::Depth | Channel::Normals | Channel::Objects)
}

/// Of the farthest surface: dark, and not black, which is where there is none.
const FARTHEST: f64 = 0.08;

/// The normal 0: half of the display's range.
const NO_NORMAL: [f32; 3] = [0.214_041_14; 3];

/// Darker than the colour of any object.
const NO_OBJECT: [f32; 3] = [0.015; 3];

fn image(features: &Features, color: impl Fn(u32, u32) -> [f32; 3] + Sync) -> Image {
    let (width, height) = (features.width(), features.height());
    let color = &color;
    let pixels = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| (0..width).map(move |x| color(x, y)))
        .collect::<Vec<_>>();
    let mut image = Image::black(width, height);
    image.put(0, 0, width, &pixels);
    image
}

fn depth(features: &Features) -> Image {
    let inverses = (0..features.height()).into_par_iter().map(|y| {
        (0..features.width())
            .filter_map(|x| features.distance(x, y))
            .map(|distance| (1.0 / distance, 1.0 / distance))
            .fold((f64::INFINITY, f64::NEG_INFINITY), widest)
    });
    let (far, near) = inverses.reduce(|| (f64::INFINITY, f64::NEG_INFINITY), widest);
    image(features, |x, y| {
        features.distance(x, y).map_or([0.0; 3], |distance| {
            let part = if near > far { (1.0 / distance - far) / (near - far) } else { 1.0 };
            [srgb_to_linear(FARTHEST + (1.0 - FARTHEST) * part) as f32; 3]
        })
    })
}

fn widest(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

fn normal_color(normal: DVec3) -> [f32; 3] {
    (0.5 * (normal + 1.0)).to_array().map(|shown| srgb_to_linear(shown.clamp(0.0, 1.0)) as f32)
}

/// The colour of the object of a number.
fn object_color(index: usize) -> [f32; 3] {
    /// The part of the circle that divides it most evenly, however many steps are taken.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let hue = (index as f64 * GOLDEN).fract();
    let (strongest, weakest) = [(0.9, 0.1), (0.6, 0.25), (0.35, 0.02)][index % 3];
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|channel| {
        // 1 at the channel's own hue, 0 from a third of the circle away.
        let away = (hue - channel + 0.5).rem_euclid(1.0) - 0.5;
        let part = (2.0 - 6.0 * away.abs()).clamp(0.0, 1.0);
        (weakest + (strongest - weakest) * part) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worker::tests::scene;
    use lancer_core::film::to_srgb8;
    use lancer_core::render::CancelToken;
    use lancer_core::world::CompileOptions;
    use std::collections::HashSet;

    fn features() -> Features {
        let scene = scene();
        let world = World::compile(&scene, &CompileOptions::default()).unwrap();
        render_features(&world, &scene.camera, 40, 30, &CancelToken::default()).unwrap()
    }

    fn pixels(features: &Features) -> impl Iterator<Item = (u32, u32)> {
        let width = features.width();
        (0..features.height()).flat_map(move |y| (0..width).map(move |x| (x, y)))
    }

    #[test]
    fn depth_is_white_where_it_is_nearest_darker_the_farther_and_black_where_nothing_is() {
        let features = features();
        let image = show(Channel::Depth, &features).image;
        let mut seen = pixels(&features)
            .filter_map(|(x, y)| Some((features.distance(x, y)?, image.pixel(x, y)[0])))
            .collect::<Vec<_>>();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!((seen[0].1 - 1.0).abs() < 1e-6);
        assert!(seen.windows(2).all(|pair| pair[0].1 >= pair[1].1));
        assert!(seen.last().is_some_and(|farthest| farthest.1 > 0.0));
        let nothing = pixels(&features).find(|&(x, y)| features.distance(x, y).is_none()).unwrap();
        assert_eq!(image.pixel(nothing.0, nothing.1), [0.0; 3]);
    }

    #[test]
    fn normals_are_told_by_the_bytes_that_all_tools_give_them() {
        let features = features();
        let bytes = to_srgb8(&show(Channel::Normals, &features).image);
        for ((x, y), found) in pixels(&features).zip(bytes) {
            let normal = features.normal(x, y).unwrap_or(DVec3::ZERO);
            let expected = (127.5 * (normal + 1.0)).to_array();
            let far = (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs()).fold(0.0, f64::max);
            assert!(far <= 0.51, "{x},{y}: {found:?} is not {expected:?}");
        }
    }

    #[test]
    fn each_object_has_one_colour_and_no_two_the_same() {
        let features = features();
        let image = show(Channel::Objects, &features).image;
        let seen = pixels(&features)
            .map(|(x, y)| (features.object(x, y), image.pixel(x, y).map(f32::to_bits)))
            .collect::<HashSet<_>>();
        let colors = seen.iter().map(|(_, color)| color).collect::<HashSet<_>>();
        assert_eq!(seen.len(), 3, "a ball, the ground and nothing");
        assert_eq!(colors.len(), 3);
    }

    #[test]
    fn neighbours_among_the_objects_differ_clearly() {
        let apart = |a: [f32; 3], b: [f32; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
        assert!((0..1000).all(|index| apart(object_color(index), object_color(index + 1)) > 0.2));
    }
}
