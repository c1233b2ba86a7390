//! Which part of an image is seen: zoom and pan, without egui.
//!
//! Lengths are physical pixels of the screen; image positions are pixels from the image's top left corner.

use lancer_core::geometry::DVec2;

/// A view of an image in a rectangle of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageView {
    /// Pixels of the screen to a pixel of the image; none fits the whole image in.
    zoom: Option<f64>,
    /// The image position in the middle of the rectangle, as a share of the image's size; only with a zoom.
    center: DVec2,
}

impl Default for ImageView {
    fn default() -> Self {
        Self { zoom: None, center: DVec2::splat(0.5) }
    }
}

/// A pixel of the image this large still leaves some of its neighbours in view.
const MOST_ZOOM: f64 = 256.0;

/// An image this much smaller than its size is no longer worth looking at.
const LEAST_ZOOM: f64 = 1.0 / 64.0;

impl ImageView {
    /// One pixel of the image to one of the screen, around the image's middle.
    pub fn actual_size() -> Self {
        Self { zoom: Some(1.0), ..Self::default() }
    }

    /// Whether the whole image is fitted in.
    pub fn is_fitted(&self) -> bool {
        self.zoom.is_none()
    }

    /// Pixels of the screen to a pixel of the image.
    pub fn scale(&self, image: DVec2, screen: DVec2) -> f64 {
        self.zoom.unwrap_or_else(|| (screen / image).min_element().clamp(LEAST_ZOOM, MOST_ZOOM))
    }

    /// Where the image's top left corner is, from that of the rectangle.
    ///
    /// On whole pixels of the screen, so that an image at its own size is shown as it is.
    pub fn top_left(&self, image: DVec2, screen: DVec2) -> DVec2 {
        (0.5 * screen - self.center * image * self.scale(image, screen)).round()
    }

    /// The image position under a position of the rectangle.
    pub fn image_at(&self, at: DVec2, image: DVec2, screen: DVec2) -> DVec2 {
        (at - self.top_left(image, screen)) / self.scale(image, screen)
    }

    /// Zooms by a factor; what is at `at` stays there, within half a pixel of the screen.
    pub fn zoom_about(&mut self, factor: f64, at: DVec2, image: DVec2, screen: DVec2) {
        let under = self.image_at(at, image, screen);
        let scale = (self.scale(image, screen) * factor).clamp(LEAST_ZOOM, MOST_ZOOM);
        self.zoom = Some(scale);
        self.center = (under + (0.5 * screen - at) / scale) / image;
        self.keep_in_view();
    }

    /// Moves the image by an offset on the screen.
    pub fn pan(&mut self, offset: DVec2, image: DVec2, screen: DVec2) {
        let scale = self.scale(image, screen);
        self.zoom = Some(scale);
        self.center -= offset / (scale * image);
        self.keep_in_view();
    }

    /// Some of the image stays at the middle of the rectangle, where it can be found again.
    fn keep_in_view(&mut self) {
        self.center = self.center.clamp(DVec2::ZERO, DVec2::ONE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IMAGE: DVec2 = DVec2::new(400.0, 300.0);
    const SCREEN: DVec2 = DVec2::new(1000.0, 600.0);

    #[test]
    fn an_image_that_is_fitted_in_fills_the_shorter_side_and_is_centered() {
        let view = ImageView::default();
        assert_eq!(view.scale(IMAGE, SCREEN), 2.0);
        assert_eq!(view.top_left(IMAGE, SCREEN), DVec2::new(100.0, 0.0));
    }

    #[test]
    fn what_is_under_the_cursor_stays_there_while_zooming() {
        let mut view = ImageView::default();
        let at = DVec2::new(333.0, 222.0);
        for factor in [1.3, 2.0, 5.0, 0.4] {
            let before = view.image_at(at, IMAGE, SCREEN);
            view.zoom_about(factor, at, IMAGE, SCREEN);
            let moved = (view.image_at(at, IMAGE, SCREEN) - before).abs() * view.scale(IMAGE, SCREEN);
            assert!(moved.max_element() <= 0.5 + 1e-9, "by {moved} pixels of the screen");
        }
    }

    #[test]
    fn panning_moves_the_image_with_the_hand() {
        let mut view = ImageView::actual_size();
        let before = view.top_left(IMAGE, SCREEN);
        view.pan(DVec2::new(-35.0, 12.0), IMAGE, SCREEN);
        assert_eq!(view.top_left(IMAGE, SCREEN), before + DVec2::new(-35.0, 12.0));
    }

    #[test]
    fn zooming_ends_at_large_pixels_and_the_image_cannot_be_lost() {
        let mut view = ImageView::default();
        (0..100).for_each(|_| view.zoom_about(2.0, DVec2::ZERO, IMAGE, SCREEN));
        assert_eq!(view.scale(IMAGE, SCREEN), MOST_ZOOM);
        view.pan(DVec2::splat(-1e9), IMAGE, SCREEN);
        assert_eq!(view.image_at(0.5 * SCREEN, IMAGE, SCREEN).round(), IMAGE);
    }
}
