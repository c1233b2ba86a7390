//! Where points and lines of the world are in the viewport.

use lancer_core::camera::{Camera, CameraError};
use lancer_core::geometry::{DVec2, DVec3, portable};

/// How far beyond the viewport's edges lines are kept, in pixels: more than half of the widest line.
const MARGIN: f64 = 64.0;

/// A camera with the size of a viewport in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half of the viewport.
    middle: DVec2,
    /// Pixels to a unit on the plane at distance 1.
    pub(super) pixels: f64,
}

/// An end of a line in the viewport, or a point on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// Pixels from the top left corner.
    pub(super) at: DVec2,
    /// 1 over the depth along the direction of view. Along a line it is linear in the picture, as the depth is not.
    pub(super) inverse_depth: f64,
    /// Where on the line that was asked for: from 0 to 1.
    pub(super) along: f64,
}

impl End {
    /// The point of a line at `t` of its length in the picture.
    pub(super) fn between(a: &Self, b: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * t;
        let inverse_depth = mix(a.inverse_depth, b.inverse_depth);
        // What is linear in the world is linear in the picture once divided by the depth.
        let along = mix(a.along * a.inverse_depth, b.along * b.inverse_depth) / inverse_depth;
        Self { at: a.at + (b.at - a.at) * t, inverse_depth, along }
    }
}

impl Lens {
    pub(super) fn new(camera: &Camera, width: u32, height: u32) -> Result<Self, CameraError> {
        let [right, up, backward] = camera.frame()?;
        let middle = 0.5 * DVec2::new(f64::from(width), f64::from(height));
        let pixels = middle.y / portable::tan(0.5 * camera.fov.to_radians());
        Ok(Self { eye: camera.eye, right, up, forward: -backward, middle, pixels })
    }

    pub(super) fn eye(&self) -> DVec3 {
        self.eye
    }

    /// A direction in the camera's frame: right, up, forward.
    pub(super) fn direction(&self, in_world: DVec3) -> DVec3 {
        DVec3::new(in_world.dot(self.right), in_world.dot(self.up), in_world.dot(self.forward))
    }

    /// The direction through a place of the viewport in the camera's frame, 1 long along the view.
    pub(super) fn through(&self, at: DVec2) -> DVec3 {
        let in_plane = (at - self.middle) / self.pixels;
        DVec3::new(in_plane.x, -in_plane.y, 1.0)
    }

    /// Where a point is, also outside of the viewport; none where it is not before the eye.
    pub(super) fn pixel_of(&self, point: DVec3) -> Option<DVec2> {
        let point = self.direction(point - self.eye);
        (point.z > 0.0).then(|| self.middle + DVec2::new(point.x, -point.y) * (self.pixels / point.z))
    }

    /// Where a point is; none where it is not before the eye, or far outside of the viewport.
    pub(super) fn place(&self, point: DVec3) -> Option<End> {
        self.line(point, point).map(|[end, _]| end)
    }

    /// The part of a line that is before the eye and within the viewport, or little outside.
    pub(super) fn line(&self, a: DVec3, b: DVec3) -> Option<[End; 2]> {
        let (a, b) = (self.direction(a - self.eye), self.direction(b - self.eye));
        let reach = (self.middle + MARGIN) / self.pixels;
        // So close to the eye its pixel would be made of rounding.
        let nearest = 1e-9 * a.abs().max(b.abs()).max_element();
        let inside = |p: DVec3| {
            let (x, y) = (reach.x * p.z, reach.y * p.z);
            [p.z - nearest, x - p.x, x + p.x, y - p.y, y + p.y]
        };
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (at_a, at_b) in inside(a).into_iter().zip(inside(b)) {
            match (at_a >= 0.0, at_b >= 0.0) {
                (true, true) => {}
                (true, false) => to = to.min(at_a / (at_a - at_b)),
                (false, true) => from = from.max(at_a / (at_a - at_b)),
                (false, false) => return None,
            }
        }
        let end = |along: f64| {
            let point = a + (b - a) * along;
            let inverse_depth = 1.0 / point.z;
            let at = self.middle + DVec2::new(point.x, -point.y) * (inverse_depth * self.pixels);
            End { at, inverse_depth, along }
        };
        let ends = [end(from), end(to)];
        let sound =
            |end: &End| end.at.is_finite() && end.inverse_depth.is_finite() && end.inverse_depth > 0.0;
        (from <= to && ends.iter().all(sound)).then_some(ends)
    }
}
