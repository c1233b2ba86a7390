//! What stands before a line.

use super::lens::{End, Lens};
use lancer_core::camera::{Camera, CameraError};
use lancer_core::geometry::DVec2;
use lancer_core::render::Features;

/// By what part of its depth a line may lie behind a surface and still count as on it: the precision of the distances,
/// and lines drawn on surfaces, such as a grid on the floor.
const ON_THE_SURFACE: f64 = 2e-3;

/// By what factor the depth of a surface may change within a pixel of its features. Beyond it is another surface,
/// or one seen edge on.
const WITHIN_A_PIXEL: f64 = 1.25;

/// The surfaces that are seen, of any resolution, over a viewport.
pub(super) struct Surfaces<'a> {
    features: &'a Features,
    /// The same camera for the features' resolution.
    lens: Lens,
    /// Pixels of the features to one of the viewport.
    scale: f64,
    middle: DVec2,
    feature_middle: DVec2,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(
        features: &'a Features,
        camera: &Camera,
        width: u32,
        height: u32,
    ) -> Result<Self, CameraError> {
        let half = |width: u32, height: u32| 0.5 * DVec2::new(f64::from(width), f64::from(height));
        Ok(Self {
            features,
            lens: Lens::new(camera, features.width(), features.height())?,
            scale: f64::from(features.height()) / f64::from(height),
            middle: half(width, height),
            feature_middle: half(features.width(), features.height()),
        })
    }

    /// Whether the surface at a pixel hides a point of a line in or near that pixel.
    ///
    /// The surface is taken for its tangent plane: a line that lies on a floor is on it also where the floor's depth
    /// changes much from pixel to pixel.
    pub(super) fn hide(&self, x: u32, y: u32, point: &End) -> bool {
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let Some((x, y)) = self.feature_at(pixel) else { return false };
        let Some(distance) = self.features.distance(x, y) else { return false };
        let center = self.lens.through(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        let at_center = center.length() / distance;
        let ratio = point.inverse_depth / at_center;
        if ratio > WITHIN_A_PIXEL || ratio * WITHIN_A_PIXEL < 1.0 {
            return ratio < 1.0;
        }
        let normal = self.features.normal(x, y).map(|normal| self.lens.direction(normal));
        let toward = |direction| normal.map_or(0.0, |normal| normal.dot(direction));
        let facing = toward(center);
        let change =
            if facing < 0.0 { toward(self.lens.through(self.to_features(point.at))) / facing } else { 1.0 };
        ratio < change.clamp(1.0 / WITHIN_A_PIXEL, WITHIN_A_PIXEL) * (1.0 - ON_THE_SURFACE)
    }

    /// A place of the viewport among the features. The middles and heights are one; the widths may differ by
    /// what rounding did to a smaller size.
    pub(super) fn to_features(&self, at: DVec2) -> DVec2 {
        (at - self.middle) * self.scale + self.feature_middle
    }

    /// A place among the features in the viewport.
    pub(super) fn to_viewport(&self, at: DVec2) -> DVec2 {
        (at - self.feature_middle) / self.scale + self.middle
    }

    /// The nearest pixel of the features; none where there are none.
    fn feature_at(&self, at: DVec2) -> Option<(u32, u32)> {
        let place = self.to_features(at).max(DVec2::ZERO);
        let (width, height) = (self.features.width(), self.features.height());
        let last = (width.checked_sub(1)?, height.checked_sub(1)?);
        Some(((place.x as u32).min(last.0), (place.y as u32).min(last.1)))
    }
}
