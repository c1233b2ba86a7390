//! The illumination model, term by term.
//!
//! ```text
//! L = c_a L_a k_a S
//!   + sum_i v_i L_i / (pi r_i^2) [ k_d S (N.L_i)+ + c_s k_s (m S + (1 - m)) ((N.H_i)+)^n ]    where N.L_i > 0
//!   + k_r L_r + k_t L_t
//! ```
//!
//! Each term is a value of its own, with the factors that made it, so that a picture can explain itself. This
//! room knows no accelerator, recursion depth or pixel: whoever calls it finds c_a, v_i, L_r and L_t.
//!
//! Source: the assignment that Lancer began with; Blinn, "Models of light reflection for computer synthesized
//! pictures" (1977), for H; Whitted, "An improved illumination model for shaded display" (1980), for the
//! recursive terms.

mod dielectric;
mod terms;
#[cfg(test)]
mod tests;

pub(crate) use dielectric::refracted;
pub use dielectric::{fresnel_reflectance, reflect, refract};
pub use terms::{AmbientTerm, LightTerm, specular_normalization};
pub(crate) use terms::{Incidence, diffuse, specular};

use crate::color::Rgb;
use crate::geometry::DVec3;
use crate::scene::Material;

/// A point to be lit, and all that the model asks of its surface. Directions are unit vectors of the world.
#[derive(Clone, Copy, Debug)]
pub struct ShadingPoint<'a> {
    /// Where it is.
    pub position: DVec3,
    /// N: the shading normal, on the side that the ray came from.
    pub normal: DVec3,
    /// V: the direction toward the eye.
    pub to_eye: DVec3,
    /// S: the colour of the surface here.
    pub color: Rgb,
    /// The coefficients.
    pub material: &'a Material,
}
