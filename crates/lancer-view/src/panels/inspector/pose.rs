//! A transform as people say it: where, how turned, how large. Plain numbers, without a window.

use lancer_core::geometry::{DMat3, DVec3, Transform, portable};

/// A scaling, then turns about x, y and z, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) translation: DVec3,
    /// Turns about the parent's x, y and z axis, in this order.
    pub(super) degrees: DVec3,
    /// Factors along the node's own axes; a negative one mirrors.
    pub(super) scale: DVec3,
}

/// How far an entry of the matrix may be off, as a share of its column's length: well above what a few roundings
/// do, and well below what can be seen.
const CLOSE: f64 = 1e-9;

impl Pose {
    /// The pose of a transform; none where it shears, flattens or is not finite.
    pub(super) fn of(transform: &Transform) -> Option<Self> {
        let linear = transform.linear();
        let lengths = columns(linear).map(DVec3::length);
        if !lengths.iter().all(|length| length.is_finite() && *length > 0.0) {
            return None;
        }
        let mut scale = DVec3::from_array(lengths);
        if linear.determinant() < 0.0 {
            // Of the three axes along which it may be mirrored, the one that leaves the least turn.
            let diagonal = DVec3::new(linear.x_axis.x, linear.y_axis.y, linear.z_axis.z) / scale;
            let axis = (0..3).min_by(|&a, &b| diagonal[a].total_cmp(&diagonal[b])).unwrap_or(0);
            scale[axis] = -scale[axis];
        }
        let [x, y, z] = columns(linear);
        let rotation = DMat3::from_cols(x / scale.x, y / scale.y, z / scale.z);
        let pose = Self {
            translation: transform.translation(),
            degrees: degrees_of(rotation).map(|degrees| tidy(degrees, 1e-10)),
            scale: scale.map(|factor| tidy(factor, 1e-12 * factor.abs())),
        };
        let again = columns(pose.transform().linear());
        let is_close = columns(linear)
            .iter()
            .zip(&again)
            .zip(lengths)
            .all(|((column, again), length)| (*column - *again).abs().max_element() <= CLOSE * length);
        is_close.then_some(pose)
    }

    /// The transform of the pose.
    pub(super) fn transform(&self) -> Transform {
        Transform::scale(self.scale)
            .then(Transform::rotate(DVec3::X, self.degrees.x))
            .then(Transform::rotate(DVec3::Y, self.degrees.y))
            .then(Transform::rotate(DVec3::Z, self.degrees.z))
            .then(Transform::translate(self.translation))
    }
}

fn columns(m: DMat3) -> [DVec3; 3] {
    [m.x_axis, m.y_axis, m.z_axis]
}

/// The turns about x, y and z that make up a rotation; where only a sum of two is known, the one about z is 0.
fn degrees_of(rotation: DMat3) -> DVec3 {
    let sin_y = -rotation.x_axis.z;
    let cos_y = rotation.x_axis.truncate().length();
    let y = portable::atan2(sin_y, cos_y);
    // Below this the turns about x and z are about one line, and the entries that part them are rounding noise.
    let (x, z) = if cos_y > 1e-9 {
        (
            portable::atan2(rotation.y_axis.z, rotation.z_axis.z),
            portable::atan2(rotation.x_axis.y, rotation.x_axis.x),
        )
    } else {
        (portable::atan2(-rotation.z_axis.y, rotation.y_axis.y), 0.0)
    };
    DVec3::new(x, y, z).map(f64::to_degrees)
}

/// The number that was meant, where one of ten decimals is no further off than `slack`: 30 for 30.000000000000004.
/// Not -0 either.
fn tidy(value: f64, slack: f64) -> f64 {
    let rounded = (value * 1e10).round() / 1e10;
    if (rounded - value).abs() <= slack { rounded + 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_put_in_comes_out() {
        let pose = Pose {
            translation: DVec3::new(1.0, -2.0, 3.5),
            degrees: DVec3::new(30.0, -45.0, 120.0),
            scale: DVec3::new(2.0, 0.5, 1.0),
        };
        assert_eq!(Pose::of(&pose.transform()), Some(pose));
    }

    #[test]
    fn right_angles_and_mirrors_come_out_as_they_are() {
        for degrees in [DVec3::ZERO, DVec3::X * 90.0, DVec3::Y * 90.0, DVec3::Z * -90.0, DVec3::X * 180.0] {
            let pose = Pose { translation: DVec3::ZERO, degrees, scale: DVec3::ONE };
            let again = Pose::of(&pose.transform()).unwrap();
            assert_eq!(again.transform(), pose.transform(), "{degrees}");
        }
        for scale in [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -2.0, 1.0), DVec3::new(3.0, 1.0, -1.0)] {
            let pose = Pose { translation: DVec3::ZERO, degrees: DVec3::ZERO, scale };
            assert_eq!(Pose::of(&pose.transform()), Some(pose));
        }
    }

    #[test]
    fn a_shear_a_flat_and_an_infinite_transform_have_no_pose() {
        let shear = Transform::from_columns(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z, DVec3::ZERO);
        assert_eq!(Pose::of(&shear), None);
        assert_eq!(Pose::of(&Transform::scale(DVec3::new(1.0, 0.0, 1.0))), None);
        assert_eq!(Pose::of(&Transform::scale(DVec3::new(1.0, f64::NAN, 1.0))), None);
    }

    #[test]
    fn tiny_factors_keep_all_of_their_digits() {
        for factor in [1.234_567_890_123e-2, 1.234_567_890_123e-7] {
            let shrink = Transform::scale(DVec3::splat(factor));
            let pose = Pose::of(&shrink).expect("it neither shears nor flattens");
            assert!((pose.scale / factor - DVec3::ONE).abs().max_element() < 1e-12, "{}", pose.scale);
        }
    }

    proptest! {
        #[test]
        fn a_pose_of_any_turns_and_factors_makes_the_same_transform(
            degrees in prop::array::uniform3(-360.0..360.0_f64),
            scale in prop::array::uniform3((1.0..1e3_f64, prop::sample::select(vec![1e-6, 1e-3, 1.0, -1e-3, -1.0]))),
        ) {
            let scale = scale.map(|(digits, unit)| digits * unit);
            let pose = Pose {
                translation: DVec3::new(1.0, 2.0, 3.0),
                degrees: degrees.into(),
                scale: scale.into(),
            };
            let again = Pose::of(&pose.transform()).expect("it neither shears nor flattens");
            for point in [DVec3::X, DVec3::Y, DVec3::Z] {
                let (here, there) = (pose.transform().point(point), again.transform().point(point));
                prop_assert!((here - there).length() < 1e-6, "{} is not {}", here, there);
            }
        }
    }
}
