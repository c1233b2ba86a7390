//! From pixels to rays.
//!
//! The camera looks along -Z of its own frame with +Y up, as in glTF; pixel (0, 0) is the top left one.

mod motion;

pub use motion::CameraPath;

use crate::geometry::{DVec3, Ray, RayPacket, portable};

/// A perspective camera as its author says it. Lengths in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
    pub eye: DVec3,
    /// What it looks at: the centre of the image.
    pub target: DVec3,
    /// The direction that is up in the image; need not be at right angles to the view.
    pub up: DVec3,
    /// The whole vertical angle of view in degrees, in (0, 180).
    pub fov: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: DVec3::new(0.0, 0.0, 5.0), target: DVec3::ZERO, up: DVec3::Y, fov: 40.0 }
    }
}

/// Why a camera makes no picture; its words can be shown to a user.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is NaN or infinite.
    #[error("the camera has a number that is not finite")]
    NotFinite,
    /// `eye` and `target` are one point.
    #[error("the camera's eye and target are the same point, so it looks nowhere")]
    NoDirection,
    /// `up` is zero or along the view.
    #[error("the camera's up is zero or along its line of sight")]
    NoUp,
    /// `fov` is outside (0, 180).
    #[error("the camera's fov must be between 0 and 180 degrees, without the ends")]
    FieldOfView,
}

/// A camera for an image of a known size: its frame, scaled so that a ray costs two products.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    eye: DVec3,
    /// From the eye to the top left corner of the image plane at distance 1.
    top_left: DVec3,
    /// One pixel to the right on that plane.
    right: DVec3,
    /// One pixel down on that plane.
    down: DVec3,
    /// The direction of view, of length 1.
    forward: DVec3,
}

impl Camera {
    /// The frame of the camera: right, up and backward, each of length 1.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn frame(&self) -> Result<[DVec3; 3], CameraError> {
        let finite = self.eye.is_finite() && self.target.is_finite() && self.up.is_finite();
        if !finite || !self.fov.is_finite() {
            return Err(CameraError::NotFinite);
        }
        if !(self.fov > 0.0 && self.fov < 180.0) {
            return Err(CameraError::FieldOfView);
        }
        let backward = (self.eye - self.target).try_normalize().ok_or(CameraError::NoDirection)?;
        let up = self.up.try_normalize().ok_or(CameraError::NoUp)?;
        let across = up.cross(backward);
        if across.length() < ALONG_THE_VIEW {
            return Err(CameraError::NoUp);
        }
        let right = across.normalize();
        Ok([right, backward.cross(right), backward])
    }

    /// The camera made ready for an image of `width` by `height` square pixels.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn project(&self, width: u32, height: u32) -> Result<Projection, CameraError> {
        let [right, up, backward] = self.frame()?;
        let (width, height) = (f64::from(width), f64::from(height));
        let pixel = 2.0 * portable::tan(0.5 * self.fov.to_radians()) / height;
        Ok(Projection {
            eye: self.eye,
            top_left: up * (0.5 * height * pixel) - right * (0.5 * width * pixel) - backward,
            right: right * pixel,
            down: up * -pixel,
            forward: -backward,
        })
    }
}

/// Sine of the angle between `up` and the view below which they count as one line: there the image's
/// orientation is rounding noise.
const ALONG_THE_VIEW: f64 = 1e-12;

impl Projection {
    /// The ray through the point (`x`, `y`) of the image, in pixels from its top left corner; unit direction.
    #[inline(always)]
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        Ray::new(self.eye, (self.top_left + self.right * x + self.down * y).normalize())
    }

    /// The rays through points (`x`, `y`) of the image, each as [`Projection::ray`] finds it.
    pub fn rays(&self, x: &[f64; RayPacket::LANES], y: &[f64; RayPacket::LANES], rays: &mut RayPacket) {
        for lane in 0..RayPacket::LANES {
            rays.set(lane, &self.ray(x[lane], y[lane]));
        }
    }

    /// Where a point of the world is in the image: x and y in pixels from its top left corner, and its depth along
    /// the direction of view, in world units. None where the point is not before the eye.
    ///
    /// [`Projection::ray`] through (x, y) meets the point.
    pub fn pixel_of(&self, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        let to_point = point_in_world - self.eye;
        let depth = to_point.dot(self.forward);
        (depth > 0.0).then(|| {
            let in_plane = to_point / depth - self.top_left;
            let along = |pixel: DVec3| in_plane.dot(pixel) / pixel.length_squared();
            (along(self.right), along(self.down), depth)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-14, "{a} is not {b}");
    }

    #[test]
    fn center_of_the_image_looks_at_the_target() {
        let camera = Camera {
            eye: DVec3::new(1.0, 2.0, 3.0),
            target: DVec3::new(-4.0, 0.5, 9.0),
            ..Camera::default()
        };
        let ray = camera.project(640, 480).unwrap().ray(320.0, 240.0);
        assert_close(ray.direction, (camera.target - camera.eye).normalize());
    }

    #[test]
    fn top_of_the_image_is_half_the_field_of_view_up_and_left_is_left() {
        let camera = Camera { fov: 90.0, ..Camera::default() };
        let projection = camera.project(200, 100).unwrap();
        assert_close(projection.ray(100.0, 0.0).direction, DVec3::new(0.0, 1.0, -1.0).normalize());
        assert_close(projection.ray(0.0, 50.0).direction, DVec3::new(-2.0, 0.0, -1.0).normalize());
    }

    #[test]
    fn rays_of_a_packet_are_those_of_their_points_bit_for_bit() {
        let camera = Camera { eye: DVec3::new(3.0, -2.0, 5.0), fov: 70.0, ..Camera::default() };
        let projection = camera.project(640, 480).unwrap();
        let x = std::array::from_fn(|lane| 39.7 * lane as f64 - 100.3);
        let y = std::array::from_fn(|lane| 480.0 - 31.1 * lane as f64);
        let mut rays = RayPacket::default();
        projection.rays(&x, &y, &mut rays);
        for lane in 0..RayPacket::LANES {
            assert_eq!(rays.ray(lane), projection.ray(x[lane], y[lane]));
        }
    }

    #[test]
    fn pixel_of_finds_the_pixel_whose_ray_meets_the_point() {
        let camera = Camera { eye: DVec3::new(3.0, -2.0, 5.0), fov: 70.0, ..Camera::default() };
        let projection = camera.project(640, 480).unwrap();
        let [_, _, backward] = camera.frame().unwrap();
        for (x, y) in [(0.0, 0.0), (320.0, 240.0), (17.5, 400.25), (640.0, 480.0), (-300.0, 900.0)] {
            for t in [1e-3, 1.0, 1e4] {
                let point = projection.ray(x, y).at(t);
                let (found_x, found_y, depth) = projection.pixel_of(point).unwrap();
                assert!((found_x - x).abs() < 1e-9 / t.min(1.0) && (found_y - y).abs() < 1e-9 / t.min(1.0));
                assert!((depth - (camera.eye - point).dot(backward)).abs() < 1e-12 * t);
            }
        }
    }

    #[test]
    fn points_at_and_behind_the_eye_are_in_no_pixel() {
        let projection = Camera::default().project(100, 100).unwrap();
        for point in [DVec3::Z * 5.0, DVec3::Z * 6.0, DVec3::new(1.0, 2.0, 5.0), DVec3::NAN] {
            assert_eq!(projection.pixel_of(point), None, "{point}");
        }
    }

    #[test]
    fn cameras_that_make_no_picture_are_refused() {
        let good = Camera::default();
        let refused = |camera: Camera| camera.project(1, 1).unwrap_err();
        assert_eq!(refused(Camera { target: good.eye, ..good }), CameraError::NoDirection);
        assert_eq!(refused(Camera { up: DVec3::Z, ..good }), CameraError::NoUp);
        assert_eq!(refused(Camera { up: DVec3::ZERO, ..good }), CameraError::NoUp);
        assert_eq!(refused(Camera { fov: 180.0, ..good }), CameraError::FieldOfView);
        assert_eq!(refused(Camera { fov: 0.0, ..good }), CameraError::FieldOfView);
        assert_eq!(refused(Camera { eye: DVec3::NAN, ..good }), CameraError::NotFinite);
    }
}
