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
use lancer_core::world::{ObjectId, World};
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
        _ => image(features, |x, y| features.object(x, y).map_or(NO_OBJECT, object_color)),
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

fn object_color(object: ObjectId) -> [f32; 3] {
    /// The part of the circle that divides it most evenly, however many steps are taken.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let index = object.index();
    let hue = (index as f64 * GOLDEN).fract();
    let (strongest, weakest) = [(0.9, 0.1), (0.6, 0.25), (0.35, 0.02)][index % 3];
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|channel| {
        // 1 at the channel's own hue, 0 from a third of the circle away.
        let away = (hue - channel + 0.5).rem_euclid(1.0) - 0.5;
        let part = (2.0 - 6.0 * away.abs()).clamp(0.0, 1.0);
        (weakest + (strongest - weakest) * part) as f32
    })
}
