//! Mirror and refracted directions, and how light divides between them.

use crate::geometry::DVec3;

/// The mirror image of `direction` in a surface with the unit `normal`, which may face either side.
#[inline(always)]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// The direction by Snell's law of a ray that passes from index `ior_before` to `ior_after`; none at total
/// internal reflection.
///
/// `direction` is a unit vector, and `normal` the unit normal on the side that it comes from; the result has
/// length 1. Where the indices are equal it is `direction` itself.
pub fn refract(direction: DVec3, normal: DVec3, ior_before: f64, ior_after: f64) -> Option<DVec3> {
    let refracted = refracted(direction, normal, ior_before, ior_after);
    (!refracted.x.is_nan()).then_some(refracted)
}

/// The same without branches: NaN at total internal reflection.
#[inline(always)]
pub(crate) fn refracted(direction: DVec3, normal: DVec3, ior_before: f64, ior_after: f64) -> DVec3 {
    let ratio = ior_before / ior_after;
    let cos_before = -direction.dot(normal);
    let sin_after_squared = ratio * ratio * (1.0 - cos_before * cos_before).max(0.0);
    // A sine above 1 has no cosine.
    let cos_after = (1.0 - sin_after_squared).sqrt();
    let bent = (direction * ratio + normal * (ratio * cos_before - cos_after)).normalize();
    if ior_before == ior_after { direction } else { bent }
}

/// The share of unpolarised light that a smooth dielectric surface reflects, in [0, 1]; 1 at total internal
/// reflection. `cos_before` is the cosine between the ray and the normal on its side, in [0, 1].
///
/// Source: Fresnel's equations, in Born, Wolf, "Principles of Optics", section 1.5.2.
#[inline(always)]
pub fn fresnel_reflectance(cos_before: f64, ior_before: f64, ior_after: f64) -> f64 {
    let cos_before = cos_before.clamp(0.0, 1.0);
    let ratio = ior_before / ior_after;
    let sin_after_squared = ratio * ratio * (1.0 - cos_before * cos_before);
    let cos_after = (1.0 - sin_after_squared).sqrt();
    let amplitude = |a: f64, b: f64| (a - b) / (a + b);
    let across = amplitude(ior_before * cos_before, ior_after * cos_after);
    let along = amplitude(ior_after * cos_before, ior_before * cos_after);
    let reflectance = 0.5 * (across * across + along * along);
    if sin_after_squared >= 1.0 { 1.0 } else { reflectance }
}
