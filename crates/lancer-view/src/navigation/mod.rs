//! The camera, moved by gestures.
//!
//! In come places of the cursor in pixels from the viewport's top left corner and, where something is under it, the
//! point of the world; out comes a camera, which is always valid. The room knows neither windows nor pictures.
//!
//! Every gesture is computed from where it began, so nothing drifts: back where it began, the view is what it was.

mod scheme;
#[cfg(test)]
mod tests;
mod view;

pub use scheme::{Button, Gesture, Modifiers, Scheme};

use lancer_core::camera::Camera;
use lancer_core::geometry::{Bounds, DVec2, DVec3};
use view::{Cursor, View};

/// An axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// To the right, seen from the front.
    X,
    /// Up.
    Y,
    /// Toward who looks from the front.
    Z,
}

/// Holds the camera and its point of interest, and moves them.
///
/// ```
/// use lancer_core::camera::Camera;
/// use lancer_core::geometry::{DVec2, DVec3};
/// use lancer_view::navigation::{Gesture, Navigator};
///
/// let mut navigator = Navigator::new(Camera::default());
/// let viewport = DVec2::new(1300.0, 900.0);
/// navigator.begin(Gesture::Rotate, DVec2::new(650.0, 450.0), viewport, None);
/// navigator.drag_to(DVec2::new(200.0, 450.0)); // by half the height: a quarter turn
/// navigator.end();
/// assert!((navigator.camera().eye - DVec3::new(5.0, 0.0, 0.0)).length() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct Navigator {
    view: View,
    home: View,
    drag: Option<Drag>,
}

#[derive(Clone, Copy, Debug)]
struct Drag {
    gesture: Gesture,
    start: View,
    from: Cursor,
    to: DVec2,
    grabbed: Option<DVec3>,
}

impl Drag {
    fn view(&self) -> View {
        match self.gesture {
            Gesture::Pan => self.start.panned(self.from, self.to, self.grabbed),
            Gesture::Dolly => self.start.dollied(self.from, self.to),
            Gesture::Rotate => self.start.rotated(self.from, self.to),
        }
    }
}

impl Navigator {
    /// Starts at `home`, with its target as the point of interest. In place of a camera that is not valid, the
    /// default one is taken.
    pub fn new(home: Camera) -> Self {
        let home = View::new(home);
        Self { view: home, home, drag: None }
    }

    /// The camera; always valid.
    pub fn camera(&self) -> Camera {
        self.view.camera
    }

    /// Looks through another camera, at its target. One that is not valid changes nothing.
    pub fn set_camera(&mut self, camera: Camera) {
        self.change(|view| view.with_camera(camera));
    }

    /// Back to where it started.
    pub fn home(&mut self) {
        let home = self.home;
        self.change(|_| home);
    }

    /// From now on [`Navigator::home`] leads here; the view stays. A camera that is not valid changes nothing.
    pub fn set_home(&mut self, home: Camera) {
        self.home = self.home.with_camera(home);
    }

    /// What rotation is about.
    pub fn point_of_interest(&self) -> DVec3 {
        self.view.interest
    }

    /// Rotates about another point from now on; the camera does not move. A point that is not finite changes nothing.
    pub fn set_point_of_interest(&mut self, point: DVec3) {
        self.change(|view| view.with_interest(point));
    }

    /// A button goes down. `grabbed` is the point of the world under the cursor, if there is one.
    pub fn begin(&mut self, gesture: Gesture, at: DVec2, viewport: DVec2, grabbed: Option<DVec3>) {
        let from = Cursor { at, viewport: viewport.max(DVec2::ONE) };
        self.drag = Some(Drag { gesture, start: self.view, from, to: at, grabbed });
    }

    /// The cursor is elsewhere. Without a gesture, nothing happens.
    pub fn drag_to(&mut self, at: DVec2) {
        if let Some(drag) = &mut self.drag
            && at.is_finite()
        {
            drag.to = at;
            self.view = drag.view();
        }
    }

    /// The button goes up.
    pub fn end(&mut self) {
        self.drag = None;
    }

    /// Whether a gesture has begun and not ended.
    pub fn is_active(&self) -> bool {
        self.drag.is_some()
    }

    /// The wheel turns, by whole steps or parts of them; forward is positive. `under` is the point of the world under
    /// the cursor, if there is one; it stays there.
    pub fn wheel(&mut self, steps: f64, at: DVec2, viewport: DVec2, under: Option<DVec3>) {
        let cursor = Cursor { at, viewport: viewport.max(DVec2::ONE) };
        self.change(|view| view.zoomed(steps, cursor, under));
    }

    /// Two fingers scroll by some pixels: the same as dragging by that much, but for [`Gesture::Dolly`], which
    /// holds what is under the cursor as the wheel does.
    pub fn scroll(&mut self, gesture: Gesture, by: DVec2, at: DVec2, viewport: DVec2, under: Option<DVec3>) {
        if gesture == Gesture::Dolly {
            self.wheel(by.y / PIXELS_A_STEP, at, viewport, under);
        } else {
            self.move_by(gesture, Cursor { at, viewport: viewport.max(DVec2::ONE) }, by, under);
        }
    }

    /// Moves as a drag by `dx`, `dy` would, in heights of the viewport, right and down: for the keyboard.
    pub fn nudge(&mut self, gesture: Gesture, dx: f64, dy: f64) {
        self.move_by(gesture, Cursor { at: DVec2::ZERO, viewport: DVec2::ONE }, DVec2::new(dx, dy), None);
    }

    /// All of a box in a picture of this width over height, in the same direction. An empty or endless one changes
    /// nothing.
    pub fn frame(&mut self, bounds: Bounds, aspect: f64) {
        self.change(|view| view.framing(bounds, aspect));
    }

    /// Looks at the point of interest from the positive side of an axis, or from the negative one, from as far away
    /// as before: Z from the front, X from the right, Y from the top.
    pub fn look_along(&mut self, axis: Axis, negative: bool) {
        let axis = match axis {
            Axis::X => DVec3::X,
            Axis::Y => DVec3::Y,
            Axis::Z => DVec3::Z,
        };
        self.change(|view| view.looking_from(if negative { -axis } else { axis }));
    }

    fn move_by(&mut self, gesture: Gesture, from: Cursor, by: DVec2, grabbed: Option<DVec3>) {
        if by.is_finite() {
            self.change(|view| Drag { gesture, start: view, from, to: from.at + by, grabbed }.view());
        }
    }

    /// Changes the view, also amid a drag, which then goes on from here.
    fn change(&mut self, change: impl FnOnce(View) -> View) {
        self.view = change(self.view);
        if let Some(drag) = &mut self.drag {
            drag.start = self.view;
            drag.from.at = drag.to;
        }
    }
}

/// How many pixels of scrolling count as one step of a wheel. Systems say 30 to 120; untuned.
const PIXELS_A_STEP: f64 = 50.0;
