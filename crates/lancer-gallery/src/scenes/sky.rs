//! A sky that pales toward the horizon.
//!
//! The illumination model has no surface that shines, but a surface whose only coefficient is k_a = 1 / L_a shows
//! its own colour. A ball with such a surface, around
//! everything, is a sky. It is for scenes without ambient occlusion, whose noise would show in it.

use lancer_core::Rgb;
use lancer_core::color::linear_to_srgb;
use lancer_core::geometry::{DVec3, Transform, portable};
use lancer_core::scene::{ImageTexture, Material, Node, Scene, Shape};
use std::sync::Arc;

/// The colours of a sky.
pub(super) struct Sky {
    /// Straight above.
    pub(super) zenith: Rgb,
    /// Where it meets the ground, and all that is below.
    pub(super) horizon: Rgb,
    /// How fast it pales: 1 evenly with the angle, larger values nearer to the horizon.
    pub(super) clearness: f64,
}

/// Rows of the sky's picture, half of them above the horizon.
const ROWS: u32 = 512;

impl Sky {
    /// Puts the sky around a scene whose ambient light is set, as a ball about the origin.
    pub(super) fn put_over(&self, scene: &mut Scene, radius: f64) {
        let material = scene.add_material(Material {
            color: Arc::new(self.picture()).into(),
            ambient: scene.ambient.map(|channel| 1.0 / channel),
            diffuse: Rgb::BLACK,
            ..Material::named("sky")
        });
        let around = Transform::scale(DVec3::splat(radius));
        scene.background = self.horizon;
        scene.add(Node::shape("sky", Shape::Sphere).with_material(material).with_transform(around));
    }

    /// One column, from the zenith down.
    fn picture(&self) -> ImageTexture {
        let texels = (0..ROWS).map(|row| {
            let elevation = (1.0 - f64::from(2 * row + 1) / f64::from(ROWS)).max(0.0);
            let haze = portable::pow(1.0 - elevation, self.clearness);
            let color = self.zenith * (1.0 - haze) + self.horizon * haze;
            color.to_array().map(|channel| (linear_to_srgb(channel) * 255.0).round() as u8)
        });
        ImageTexture::new(1, ROWS, texels.collect()).expect("there is a texel for each row")
    }
}
