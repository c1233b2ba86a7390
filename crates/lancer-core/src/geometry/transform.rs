//! Affine transforms, as authored and as prepared for tracing.

use super::error::gamma;
use super::{Bounds, DAffine3, DMat3, DVec3, Ray, RayPacket, portable};

/// An affine map from an object's space to its parent's.
///
/// Steps are chained in the order in which they apply to the object:
///
/// ```
/// use lancer_core::geometry::{DVec3, Transform};
/// let stretched_then_lifted = Transform::scale(DVec3::new(1.0, 2.0, 1.0)).then(Transform::translate(DVec3::Y));
/// assert_eq!(stretched_then_lifted.point(DVec3::Y), DVec3::new(0.0, 3.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform(DAffine3);

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that moves nothing.
    pub const IDENTITY: Self = Self(DAffine3::IDENTITY);

    /// Moves by `offset`.
    pub fn translate(offset: DVec3) -> Self {
        Self(DAffine3::from_translation(offset))
    }

    /// Scales by one factor an axis; negative factors mirror, and one of 0 makes the transform singular.
    pub fn scale(factors: DVec3) -> Self {
        Self(DAffine3::from_scale(factors))
    }

    /// Turns about an axis through the origin, counter-clockwise seen from the axis's tip.
    ///
    /// `axis` has any length but zero; `degrees` as in scene files. Multiples of 90 degrees about a coordinate
    /// axis are exact. Source: Rodrigues' formula.
    pub fn rotate(axis: DVec3, degrees: f64) -> Self {
        let (sin, cos) = match degrees.rem_euclid(360.0) {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            angle => portable::sin_cos(angle.to_radians()),
        };
        let a = axis / axis.length();
        let along = DMat3::from_cols(a * a.x, a * a.y, a * a.z);
        let across = DMat3::from_cols(
            DVec3::new(0.0, a.z, -a.y),
            DVec3::new(-a.z, 0.0, a.x),
            DVec3::new(a.y, -a.x, 0.0),
        );
        Self(DAffine3::from_mat3(along * (1.0 - cos) + DMat3::IDENTITY * cos + across * sin))
    }

    /// A linear map given by the images of the three axes, then a translation.
    pub fn from_columns(x: DVec3, y: DVec3, z: DVec3, translation: DVec3) -> Self {
        Self(DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation })
    }

    /// This transform, then `next`: the order in which they apply to the object.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self(next.0 * self.0)
    }

    /// The image of a point.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.0.transform_point3(point)
    }

    /// The image of a direction, not renormalised.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.0.transform_vector3(vector)
    }

    /// The linear part: its columns are the images of the axes.
    pub fn linear(&self) -> DMat3 {
        self.0.matrix3
    }

    /// The image of the origin.
    pub fn translation(&self) -> DVec3 {
        self.0.translation
    }
}

/// A transform that flattens space, or holds a number that is not finite, and so has no inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the transform is singular: it flattens the object or has entries that are not finite")]
pub struct SingularTransform;

/// An object's place in the world: its global transform, the inverse, and what rounding does on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    world_from_object: DMat3,
    object_from_world: DMat3,
    translation: DVec3,
    /// See [`Placement::stretch_to_object`].
    stretch: (f64, f64),
}

impl Placement {
    /// Prepares the product of the transforms on the path from the root.
    ///
    /// # Errors
    /// [`SingularTransform`] where no inverse exists in `f64`.
    pub fn new(world_from_object: Transform) -> Result<Self, SingularTransform> {
        let linear = world_from_object.linear();
        // Scaled to entries near 1 first, so that a uniform scale of 1e-120 is no reason to refuse.
        let size = max_entry(linear);
        if !size.is_finite() || size == 0.0 || !world_from_object.translation().is_finite() {
            return Err(SingularTransform);
        }
        let scaled = linear * (1.0 / size);
        let determinant = scaled.determinant();
        let volume = scaled.x_axis.length() * scaled.y_axis.length() * scaled.z_axis.length();
        // Below this share of the columns' volume the determinant is rounding noise.
        if determinant.is_nan() || determinant.abs() <= gamma(16) * volume {
            return Err(SingularTransform);
        }
        let object_from_world = scaled.inverse() * (1.0 / size);
        if !max_entry(object_from_world).is_finite() {
            return Err(SingularTransform);
        }
        Ok(Self {
            world_from_object: linear,
            object_from_world,
            translation: world_from_object.translation(),
            stretch: (1.0 / largest_stretch(linear), largest_stretch(object_from_world)),
        })
    }

    /// The inverse, for directions.
    pub fn object_from_world(&self) -> DMat3 {
        self.object_from_world
    }

    /// Bounds on the length in the object's space of a unit vector of the world: not more than the least, and not
    /// less than the greatest. They are exact, but for rounding, where the transform keeps angles.
    pub fn stretch_to_object(&self) -> (f64, f64) {
        self.stretch
    }

    /// The image in the object's space of a point of the world.
    pub fn point_to_object(&self, point_in_world: DVec3) -> DVec3 {
        self.object_from_world * (point_in_world - self.translation)
    }

    /// What gives with the image of a vector the same product as `covector_in_world` with the vector.
    pub fn covector_to_object(&self, covector_in_world: DVec3) -> DVec3 {
        self.world_from_object.transpose() * covector_in_world
    }

    /// The ray in the object's space. Its direction keeps its length, so t means the same in both spaces.
    #[inline(always)]
    pub fn ray_to_object(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.object_from_world * (ray.origin - self.translation),
            direction: self.object_from_world * ray.direction,
            t_max: ray.t_max,
        }
    }

    /// Puts the rays in the object's space into `local`, each as [`Placement::ray_to_object`] would carry it there.
    #[inline(always)]
    pub fn rays_to_object(&self, rays: &RayPacket, local: &mut RayPacket) {
        for lane in 0..RayPacket::LANES {
            local.set(lane, &self.ray_to_object(&rays.ray(lane)));
        }
    }

    /// The image in the world of a point of the object.
    #[inline(always)]
    pub fn point_to_world(&self, point_in_object: DVec3) -> DVec3 {
        self.world_from_object * point_in_object + self.translation
    }

    /// The image in the world of a direction of the object, not renormalised.
    #[inline(always)]
    pub fn vector_to_world(&self, vector_in_object: DVec3) -> DVec3 {
        self.world_from_object * vector_in_object
    }

    /// The unit normal in the world of a normal of the object, by the inverse transpose.
    ///
    /// It keeps its side: what is outside of the object stays outside, mirrored or not.
    #[inline(always)]
    pub fn normal_to_world(&self, normal_in_object: DVec3) -> DVec3 {
        normalize(self.object_from_world.transpose() * normal_in_object)
    }

    /// How far, by axis, a point of the world may lie from the surface that it was computed on.
    ///
    /// `error_in_object` bounds the point's distance from the surface in the object's space. Added to it are
    /// the rounding of the way out into the world and of the way back that the next ray takes, in which the
    /// inverse is itself inexact; both grow with the transform's condition.
    #[inline(always)]
    pub fn error_in_world(&self, point_in_object: DVec3, error_in_object: DVec3) -> DVec3 {
        let out = absolute(self.world_from_object);
        let back = absolute(self.object_from_world);
        let magnitude = out * point_in_object.abs() + self.translation.abs();
        out * error_in_object + out * (back * magnitude) * gamma(ROUND_TRIP_OPERATIONS)
    }

    /// A box in the world around the image of a box of the object; unbounded where that is.
    pub fn bounds_to_world(&self, bounds_in_object: Bounds) -> Bounds {
        if !bounds_in_object.is_finite() {
            return Bounds::UNBOUNDED;
        }
        let image = Bounds::of_points(bounds_in_object.corners().map(|corner| self.point_to_world(corner)));
        let slack = self.error_in_world(bounds_in_object.magnitude(), DVec3::ZERO);
        Bounds::new(image.min - slack, image.max + slack)
    }

    /// The same around the image of what fills only a part of its box, which is bounded: how far that goes from the box's
    /// centre in the world, by axis, `reach` tells from the images of half the box's edges.
    pub(crate) fn bounds_within(
        &self,
        bounds_in_object: Bounds,
        reach: impl FnOnce([DVec3; 3]) -> DVec3,
    ) -> Bounds {
        let half = 0.5 * bounds_in_object.extent();
        let DMat3 { x_axis, y_axis, z_axis } = self.world_from_object;
        let center = self.point_to_world(bounds_in_object.center());
        let reach = reach([x_axis * half.x, y_axis * half.y, z_axis * half.z])
            + self.error_in_world(bounds_in_object.magnitude(), DVec3::ZERO);
        Bounds::new(center - reach, center + reach)
    }
}

/// Rounded operations on a coordinate's way to the world and back: two products of a matrix and a vector, two
/// sums with the translation, and an inverse computed by cofactors, which counts for a dozen. An upper bound;
/// fewer would let rays meet the surface that they left, more would only move them a little further off.
const ROUND_TRIP_OPERATIONS: u32 = 24;

/// Not less than the length of the image of any unit vector.
///
/// The square root of the greatest eigenvalue of M^T M, bounded by Gershgorin's circles: exact where the columns
/// are orthogonal.
fn largest_stretch(m: DMat3) -> f64 {
    let size = max_entry(m);
    let scaled = m * (1.0 / size);
    let rows = absolute(scaled.transpose() * scaled) * DVec3::ONE;
    rows.max_element().sqrt() * size * (1.0 + gamma(32))
}

/// `v` divided by its length, safe for lengths whose square would overflow or vanish.
#[inline(always)]
pub(crate) fn normalize(v: DVec3) -> DVec3 {
    let scaled = v / v.abs().max_element();
    scaled / scaled.length()
}

#[inline(always)]
fn absolute(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

fn max_entry(m: DMat3) -> f64 {
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    if columns.iter().all(|column| column.is_finite()) {
        columns.iter().map(|column| column.abs().max_element()).fold(0.0, f64::max)
    } else {
        f64::NAN
    }
}
