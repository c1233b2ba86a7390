//! A camera with its point of interest, and how each gesture moves them. All are pure: the same view and the same
//! way of the cursor give the same view again.

use lancer_core::camera::Camera;
use lancer_core::geometry::{Bounds, DVec2, DVec3, Transform, portable};

/// How far dragging over the height of the viewport turns, in degrees: from one pole to the other.
const TURN: f64 = 180.0;

/// Dragging down over the height of the viewport makes the distance 2 to this power as large. Untuned.
const DOLLY: f64 = 3.0;

/// One step of the wheel outward makes the distance 2 to this power as large: by a fifth, as in other programs.
const WHEEL: f64 = 0.25;

/// How much more than the box is seen when it is framed: 1 has it touch the edges.
const FRAME_MARGIN: f64 = 1.05;

/// How far the eye stays before a framed box, in diagonals. With an angle of view so wide that a corner's edges fit
/// into it, the corner would be the nearest place from which all is seen.
const FRAME_ROOM: f64 = 0.01;

/// The least distance to the point of interest, in parts of the coordinates. Below it the direction of view is
/// made of their rounding: here the picture shakes by less than a thousandth of a pixel.
const NEAREST: f64 = 1e-9;

/// The greatest distance to the point of interest, in world units: far from any overflow.
const FARTHEST: f64 = 1e12;

/// Cosine of the angle to the vertical below which a camera's up is said as the vertical itself, which a scene
/// file's author would write. Nearer to a pole it would be ever less defined by it.
const UPRIGHT: f64 = 0.01;

/// The point of interest is left behind when it is this much nearer than what one moves towards.
const LEFT_BEHIND: f64 = 0.1;

/// Where one looks from, and what at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// Always valid.
    pub(super) camera: Camera,
    /// Always finite.
    pub(super) interest: DVec3,
    /// The unit direction that rotation keeps upright. The camera's right is always at right angles to it.
    vertical: DVec3,
}

/// The place of a cursor in a viewport of some size, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor {
    pub(super) at: DVec2,
    pub(super) viewport: DVec2,
}

impl View {
    /// The view of a camera onto its target; of the default camera where it is not valid.
    pub(super) fn new(camera: Camera) -> Self {
        let camera = if camera.frame().is_ok() { camera } else { Camera::default() };
        Self { camera, interest: camera.target, vertical: DVec3::Y }.with_camera(camera)
    }

    /// The view of another camera onto its target, if that is valid.
    ///
    /// The vertical stays where the new camera's horizon is level with it. Else it is Y where the horizon is
    /// level with that, and for cameras that lean the camera's own up: a picture that leans stays so.
    pub(super) fn with_camera(self, camera: Camera) -> Self {
        let Ok([right, ..]) = camera.frame() else { return self };
        let level = |vertical: &DVec3| right.dot(*vertical).abs() < 1e-9;
        let vertical = [self.vertical, DVec3::Y].into_iter().find(level);
        let vertical = vertical.unwrap_or_else(|| camera.up.normalize());
        Self { camera, interest: camera.target, vertical }
    }

    /// The same view with another point of interest, if that is finite.
    pub(super) fn with_interest(self, interest: DVec3) -> Self {
        if interest.is_finite() { Self { interest, ..self } } else { self }
    }

    fn frame(&self) -> [DVec3; 3] {
        self.camera.frame().expect("a view's camera is valid")
    }

    /// The distance that counts for moving: how far ahead the point of interest is, along the viewing axis. Where
    /// it is not ahead, how far away it is.
    fn reach(&self) -> f64 {
        reach(self.camera.eye, self.frame()[2], self.interest)
    }

    fn nearest(&self) -> f64 {
        nearest(self.camera.eye, self.interest)
    }

    /// A factor for a distance, held back so that the distance stays within what numbers can tell apart.
    fn bounded_factor(&self, factor: f64, distance: f64) -> f64 {
        let least = (self.nearest() / distance).min(1.0);
        let most = (FARTHEST / distance).max(1.0);
        factor.clamp(least, most)
    }

    /// The view from `eye` with the directions of `frame`; the target is as far ahead as the point of interest.
    /// Where numbers end, and no camera can be made of these, nothing moves.
    fn moved(&self, eye: DVec3, [right, up, backward]: [DVec3; 3], interest: DVec3) -> Self {
        let upright = up.dot(self.vertical);
        let up = if upright.abs() > UPRIGHT { self.vertical * upright.signum() } else { up };
        let target = eye - backward * reach(eye, backward, interest);
        let camera = Camera { eye, target, up, ..self.camera };
        let valid =
            interest.is_finite() && camera.frame().is_ok_and(|[as_told, ..]| as_told.dot(right) > 0.5);
        if valid { Self { camera, interest, ..*self } } else { *self }
    }

    /// The length of a pixel on the plane at distance 1.
    fn pixel(&self, viewport: DVec2) -> f64 {
        2.0 * portable::tan(0.5 * self.camera.fov.to_radians()) / viewport.y
    }

    /// Moved in the plane of the picture as the cursor went, so that what was grabbed is still under it. Where
    /// nothing was, the point of interest's distance counts.
    pub(super) fn panned(&self, from: Cursor, to: DVec2, grabbed: Option<DVec3>) -> Self {
        let frame @ [right, up, backward] = self.frame();
        let depth = grabbed.map(|point| (self.camera.eye - point).dot(backward)).filter(|&depth| depth > 0.0);
        let way = (to - from.at) * self.pixel(from.viewport) * depth.unwrap_or_else(|| self.reach());
        let offset = up * way.y - right * way.x;
        self.moved(self.camera.eye + offset, frame, self.interest + offset)
    }

    /// Moved along the viewing axis: upward is forward. The distance to the point of interest changes by a factor,
    /// so one never arrives, and is never too slow.
    pub(super) fn dollied(&self, from: Cursor, to: DVec2) -> Self {
        let frame @ [_, _, backward] = self.frame();
        let reach = self.reach();
        let factor = portable::exp2(DOLLY * (to.y - from.at.y) / from.viewport.y);
        let factor = self.bounded_factor(factor, reach);
        self.moved(self.camera.eye + backward * (reach * (factor - 1.0)), frame, self.interest)
    }

    /// Turned about the point of interest, all as one: it keeps its place in the picture, and its distance.
    ///
    /// Sideways turns about the vertical, so the horizon stays level; up and down about the camera's right, over the
    /// poles too and on, upside down then. Who starts to drag upside down sees sideways turn the other way about:
    /// what is in front follows the hand. Both angles count from the start, so the way back leads back.
    pub(super) fn rotated(&self, from: Cursor, to: DVec2) -> Self {
        let [right, up, backward] = self.frame();
        let degrees = (to - from.at) * (TURN / from.viewport.y);
        let sideways = if up.dot(self.vertical) < 0.0 { degrees.x } else { -degrees.x };
        if !(sideways.is_finite() && degrees.y.is_finite()) {
            return *self;
        }
        let turn = Transform::rotate(right, -degrees.y).then(Transform::rotate(self.vertical, sideways));
        let eye = self.interest + turn.vector(self.camera.eye - self.interest);
        self.moved(eye, [right, up, backward].map(|axis| turn.vector(axis)), self.interest)
    }

    /// Moved towards what is under the cursor, or away from it, by a factor of the distance: it stays under the cursor.
    /// Where nothing is, it is taken to be as far ahead as the point of interest.
    ///
    /// The point of interest stays, until one comes to leave it behind on the way to something farther: then
    /// that takes its place.
    pub(super) fn zoomed(&self, steps: f64, cursor: Cursor, under: Option<DVec3>) -> Self {
        let frame @ [right, up, backward] = self.frame();
        let eye = self.camera.eye;
        let ahead = |point: DVec3| (eye - point).dot(backward);
        let under = under.filter(|&point| ahead(point) > self.nearest()).unwrap_or_else(|| {
            let place = (cursor.at - 0.5 * cursor.viewport) * self.pixel(cursor.viewport);
            eye + (right * place.x - up * place.y - backward) * self.reach()
        });
        let factor = self.bounded_factor(portable::exp2(-WHEEL * steps), ahead(under));
        let moved_eye = under + (eye - under) * factor;
        let left_behind = (moved_eye - self.interest).dot(backward) < LEFT_BEHIND * factor * ahead(under);
        let interest = if factor < 1.0 && left_behind { under } else { self.interest };
        self.moved(moved_eye, frame, interest)
    }

    /// All of a box in the picture and as large as can be, seen in the same direction; its middle is the new point
    /// of interest. A box without size is seen from the old distance. One that is empty or has no end moves nothing.
    pub(super) fn framing(&self, bounds: Bounds, aspect: f64) -> Self {
        if bounds.is_empty() || !bounds.is_finite() || !(aspect.is_finite() && aspect > 0.0) {
            return *self;
        }
        let frame @ [right, up, backward] = self.frame();
        let vertical = portable::tan(0.5 * self.camera.fov.to_radians()) / FRAME_MARGIN;
        let center = bounds.center();
        let corners = bounds.corners().map(|corner| corner - center);
        // Across the picture, a corner at x to the right and z toward the camera is inside where
        // |x - eye_x| <= t (eye_z - z), with t the tangent of half the angle of view. The corners' greatest x + t z
        // and -x + t z thus bound the eye, and the same holds up the picture.
        let fit = |axis: DVec3, tangent: f64| {
            let reach = |axis: DVec3| {
                let reaches = corners.iter().map(|corner| corner.dot(axis) + tangent * corner.dot(backward));
                reaches.fold(f64::NEG_INFINITY, f64::max)
            };
            let (plus, minus) = (reach(axis), reach(-axis));
            ((plus + minus) / (2.0 * tangent), 0.5 * (plus - minus))
        };
        let (distance_across, x) = fit(right, vertical * aspect);
        let (distance_up, y) = fit(up, vertical);
        let nearest_corner = corners.iter().map(|corner| corner.dot(backward)).fold(0.0, f64::max);
        let distance = match bounds.diagonal() {
            0.0 => self.reach(),
            diagonal => distance_across.max(distance_up).max(nearest_corner + FRAME_ROOM * diagonal),
        };
        let eye = center + right * x + up * y + backward * distance;
        self.moved(eye, frame, center)
    }

    /// The point of interest in the middle, seen from a direction and as far away as before.
    ///
    /// The vertical is up. Where one looks along it, what was to the right in the view from the front stays there.
    pub(super) fn looking_from(&self, toward_eye: DVec3) -> Self {
        let distance = (self.camera.eye - self.interest).length().max(self.nearest());
        let across = self.vertical.cross(toward_eye);
        let right = if across.length() > UPRIGHT { across.normalize() } else { self.right_of_front() };
        let frame = [right, toward_eye.cross(right), toward_eye];
        self.moved(self.interest + toward_eye * distance, frame, self.interest)
    }

    fn right_of_front(&self) -> DVec3 {
        let right = DVec3::X - self.vertical * self.vertical.x;
        right.try_normalize().unwrap_or(DVec3::Z)
    }
}

/// See [`View::reach`].
fn reach(eye: DVec3, backward: DVec3, interest: DVec3) -> f64 {
    let (ahead, away) = ((eye - interest).dot(backward), (eye - interest).length());
    let reach = if ahead > NEAREST * away { ahead } else { away };
    reach.max(nearest(eye, interest))
}

/// The least distance that two points with these coordinates may have.
fn nearest(a: DVec3, b: DVec3) -> f64 {
    let size = a.abs().max(b.abs()).max_element();
    (NEAREST * size).max(f64::MIN_POSITIVE / NEAREST)
}
