//! Cameras on their way: around what they look at, and from one to the next.
//!
//! In: cameras and a time. Out: a camera. It knows neither frames nor scenes.

use super::Camera;
use crate::geometry::{DVec3, Transform};
use std::ops::{Add, Mul, Sub};

impl Camera {
    /// The camera after an orbit by `degrees` about the line through its target along `axis`: counter-clockwise as
    /// seen from the axis's tip, its up turned along. By 0 degrees it is the very same.
    pub fn orbited(&self, axis: DVec3, degrees: f64) -> Self {
        if degrees.rem_euclid(360.0) == 0.0 {
            return *self;
        }
        let turn = Transform::rotate(axis, degrees);
        let eye = self.target + turn.vector(self.eye - self.target);
        Self { eye, up: turn.vector(self.up), ..*self }
    }
}

/// A smooth way past cameras.
///
/// Eye, target, up and field of view each follow a centripetal Catmull-Rom spline, which passes its points without
/// loops and cusps, however unevenly they lie; from camera to camera takes one unit of time. A way whose ends are
/// the same camera is closed, and as smooth there as elsewhere; others come to their ends as if they went straight
/// on.
///
/// Source: Yuksel, Schaefer, Keyser, "Parameterization and applications of Catmull-Rom curves" (2011).
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    cameras: Vec<Camera>,
}

impl CameraPath {
    /// A way past these cameras; none where there are fewer than two.
    pub fn new(cameras: Vec<Camera>) -> Option<Self> {
        (cameras.len() >= 2).then_some(Self { cameras })
    }

    /// The time at which its last camera is passed; the first is passed at 0.
    pub fn duration(&self) -> f64 {
        (self.cameras.len() - 1) as f64
    }

    /// Whether it ends where it began.
    pub fn is_closed(&self) -> bool {
        self.cameras.first() == self.cameras.last()
    }

    /// The camera at a time from 0 to [`CameraPath::duration`], to which others are clamped. At whole times it is the
    /// very camera that is passed.
    pub fn at(&self, time: f64) -> Camera {
        let time = time.clamp(0.0, self.duration());
        let segment = (time.floor() as usize).min(self.cameras.len() - 2);
        let u = time - segment as f64;
        if u == 0.0 || u == 1.0 {
            return self.cameras[segment + usize::from(u == 1.0)];
        }
        let around = |of: fn(&Camera) -> DVec3| {
            let [before, from, to, after] = self.around(segment).map(|camera| camera.map(of));
            // The ends, where there is no camera beyond.
            let (from, to) = (from.unwrap_or_default(), to.unwrap_or_default());
            along([before.unwrap_or(from + (from - to)), from, to, after.unwrap_or(to + (to - from))], u)
        };
        Camera {
            eye: around(|camera| camera.eye),
            target: around(|camera| camera.target),
            up: around(|camera| camera.up.normalize_or_zero()),
            // Like a scale, so that it cannot leave its range by much; the range itself is kept by clamping.
            fov: around(|camera| DVec3::splat(camera.fov)).x.clamp(LEAST_FOV, MOST_FOV),
        }
    }

    /// The ends of a segment and their neighbours, where there are any.
    fn around(&self, segment: usize) -> [Option<&Camera>; 4] {
        let last = self.cameras.len() - 1;
        let before = match segment.checked_sub(1) {
            // Once around: the first and the last camera are one.
            None if self.is_closed() => Some(&self.cameras[last - 1]),
            before => before.map(|before| &self.cameras[before]),
        };
        let after = match segment + 2 {
            after if after <= last => Some(&self.cameras[after]),
            _ if self.is_closed() => Some(&self.cameras[1]),
            _ => None,
        };
        [before, self.cameras.get(segment), self.cameras.get(segment + 1), after]
    }
}

/// The range of the field of view of cameras between others, in degrees.
const LEAST_FOV: f64 = 0.01;
const MOST_FOV: f64 = 179.0;

/// The point at `u` in [0, 1] between the middle two of four.
fn along([before, from, to, after]: [DVec3; 4], u: f64) -> DVec3 {
    let step = to - from;
    let (t0, t1, t2) = (knot(from - before), knot(step), knot(after - to));
    if t1 == 0.0 {
        return from;
    }
    // The slopes at both ends, times the length of the segment. Where neighbours coincide, the curve leaves straight.
    let slope = |near: DVec3, t_near: f64, far: DVec3| match t_near {
        0.0 => far,
        t_near => near * (t1 / t_near) - (near + far) * (t1 / (t_near + t1)) + far,
    };
    let leave = slope(from - before, t0, step);
    let arrive = slope(after - to, t2, step);
    hermite(from, leave, to, arrive, u)
}

/// The distance of two knots: the square root of that of their points.
fn knot(step: DVec3) -> f64 {
    step.length().sqrt()
}

fn hermite<T>(from: T, leave: T, to: T, arrive: T, u: f64) -> T
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    let step = to - from;
    from + (leave + ((step * 3.0 - leave * 2.0 - arrive) + (leave + arrive - step * 2.0) * u) * u) * u
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looking_from(x: f64, y: f64, z: f64) -> Camera {
        Camera { eye: DVec3::new(x, y, z), ..Camera::default() }
    }

    fn assert_close(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn an_orbit_keeps_the_distance_and_comes_home() {
        let camera = Camera { target: DVec3::new(1.0, 2.0, 3.0), ..looking_from(4.0, 3.0, 7.0) };
        assert_eq!(camera.orbited(DVec3::Y, 0.0), camera);
        assert_eq!(camera.orbited(DVec3::Y, 360.0), camera);
        for degrees in [1.0, 45.0, 90.0, 200.0] {
            let orbited = camera.orbited(DVec3::Y, degrees);
            assert!((orbited.eye.distance(camera.target) - camera.eye.distance(camera.target)).abs() < 1e-12);
            assert!((orbited.eye.y - camera.eye.y).abs() < 1e-12);
            assert_eq!((orbited.target, orbited.fov), (camera.target, camera.fov));
        }
    }

    #[test]
    fn a_quarter_about_y_takes_front_to_right() {
        let orbited = looking_from(0.0, 1.0, 5.0).orbited(DVec3::Y, 90.0);
        assert_close(orbited.eye, DVec3::new(5.0, 1.0, 0.0));
        assert_close(orbited.up, DVec3::Y);
    }

    #[test]
    fn an_orbit_over_the_top_turns_up_along() {
        let orbited = looking_from(0.0, 0.0, 5.0).orbited(DVec3::X, 180.0);
        assert_close(orbited.eye, DVec3::new(0.0, 0.0, -5.0));
        assert_close(orbited.up, -DVec3::Y);
        for degrees in 0..360 {
            looking_from(0.0, 0.0, 5.0).orbited(DVec3::X, f64::from(degrees)).frame().unwrap();
        }
    }

    #[test]
    fn a_path_passes_its_cameras_at_whole_times() {
        let cameras =
            [(0.0, 0.0, 5.0), (5.0, 1.0, 0.0), (0.0, 9.0, 0.1)].map(|(x, y, z)| looking_from(x, y, z));
        let path = CameraPath::new(cameras.to_vec()).unwrap();
        assert_eq!(path.duration(), 2.0);
        for (time, camera) in cameras.iter().enumerate() {
            assert_eq!(path.at(time as f64), *camera);
        }
        assert_eq!(path.at(-1.0), cameras[0]);
        assert_eq!(path.at(7.0), cameras[2]);
        assert!(CameraPath::new(cameras[..1].to_vec()).is_none());
    }

    #[test]
    fn two_cameras_are_joined_by_a_straight_line_at_even_pace() {
        let (a, b) = (looking_from(0.0, 0.0, 5.0), Camera { fov: 60.0, ..looking_from(4.0, 2.0, 5.0) });
        let path = CameraPath::new(vec![a, b]).unwrap();
        for time in [0.25, 0.5, 0.75] {
            let found = path.at(time);
            assert_close(found.eye, a.eye + (b.eye - a.eye) * time);
            assert!((found.fov - (40.0 + 20.0 * time)).abs() < 1e-12);
            assert_close(found.up, DVec3::Y);
        }
    }

    /// No step is much longer or turns much more than the one before.
    fn assert_smooth(path: &CameraPath) {
        let eyes = (0..=1000).map(|i| path.at(path.duration() * f64::from(i) / 1000.0).eye);
        let steps = eyes.collect::<Vec<_>>().windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
        for pair in steps.windows(2) {
            assert!((pair[1] - pair[0]).length() < 0.1 * pair[0].length().max(1e-3), "{pair:?}");
        }
        if path.is_closed() {
            let (first, last) = (steps[0], steps[steps.len() - 1]);
            assert!((first - last).length() < 0.1 * last.length(), "{last} then {first}");
        }
    }

    #[test]
    fn paths_are_smooth_however_unevenly_their_cameras_lie() {
        let uneven = [(0.0, 0.0, 5.0), (0.3, 0.0, 5.0), (9.0, 2.0, 0.0), (9.0, 2.5, -0.5)];
        let cameras = uneven.map(|(x, y, z)| looking_from(x, y, z));
        // Knots follow distances, time does not: pace changes at cameras, direction does not.
        let path = CameraPath::new(cameras.to_vec()).unwrap();
        for time in [1.0, 2.0] {
            let before = path.at(time).eye - path.at(time - 1e-6).eye;
            let after = path.at(time + 1e-6).eye - path.at(time).eye;
            assert!(before.normalize().dot(after.normalize()) > 0.999_99, "{before} then {after}");
        }
        let around = [(0.0, 0.0, 5.0), (5.0, 1.0, 0.0), (0.0, 0.0, -5.0), (-5.0, 1.0, 0.0), (0.0, 0.0, 5.0)];
        assert_smooth(&CameraPath::new(around.map(|(x, y, z)| looking_from(x, y, z)).to_vec()).unwrap());
    }

    #[test]
    fn cameras_that_stand_still_stay() {
        let camera = looking_from(1.0, 2.0, 3.0);
        let path = CameraPath::new(vec![camera, camera, looking_from(5.0, 2.0, 3.0)]).unwrap();
        assert_eq!(path.at(0.5), camera);
        assert!(path.at(1.5).eye.is_finite());
    }
}
