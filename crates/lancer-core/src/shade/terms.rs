//! The local terms.

use super::ShadingPoint;
use crate::color::Rgb;
use crate::geometry::{DVec3, portable};
use crate::scene::Light;
use std::f64::consts::PI;

/// c_a L_a k_a S, and its factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientTerm {
    /// c_a: the ambient occlusion factor.
    pub occlusion: f64,
    /// L_a: the scene's ambient light.
    pub light: Rgb,
    /// k_a.
    pub coefficient: Rgb,
    /// S.
    pub color: Rgb,
}

impl AmbientTerm {
    /// The term's value.
    pub fn radiance(&self) -> Rgb {
        self.light * self.coefficient * self.color * self.occlusion
    }
}

/// What one light adds where nothing is in its way, and the factors of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTerm {
    /// r: the distance to the light.
    pub distance: f64,
    /// L: the unit direction to the light.
    pub direction: DVec3,
    /// L_i / (pi r^2).
    pub irradiance: Rgb,
    /// N.L, above 0.
    pub cosine: f64,
    /// (N.H)+.
    pub half_cosine: f64,
    /// c_s: the normalisation of the specular term.
    pub normalization: f64,
    /// L_i / (pi r^2) k_d S (N.L).
    pub diffuse: Rgb,
    /// L_i / (pi r^2) c_s k_s (m S + (1 - m)) ((N.H)+)^n.
    pub specular: Rgb,
}

impl LightTerm {
    /// The term of a light that nothing hides; none where the surface faces away from it, or where it adds
    /// nothing.
    pub fn new(point: &ShadingPoint, light: &Light) -> Option<Self> {
        Self::find::<true>(point, light)
    }

    /// The value of that term; black where there is none.
    pub fn radiance_at(point: &ShadingPoint, light: &Light) -> Rgb {
        Self::find::<false>(point, light).map_or(Rgb::BLACK, |term| term.radiance())
    }

    /// With `EXPLAIN` all factors are found, else those that the value depends on.
    #[inline(always)]
    fn find<const EXPLAIN: bool>(point: &ShadingPoint, light: &Light) -> Option<Self> {
        let material = point.material;
        let shines = !material.specular.is_black();
        if !shines && material.diffuse.is_black() {
            return None;
        }
        let to_light = light.position - point.position;
        let distance = to_light.length();
        let direction = to_light / distance;
        let cosine = point.normal.dot(direction);
        // Also false for a light in the point itself, whose direction is NaN.
        let faces_the_light = cosine > 0.0;
        if !faces_the_light || light.intensity.is_black() {
            return None;
        }
        let irradiance = light.intensity * (1.0 / (PI * distance * distance));
        let half_cosine = if shines || EXPLAIN {
            let half = (direction + point.to_eye).normalize_or_zero();
            point.normal.dot(half).max(0.0)
        } else {
            0.0
        };
        let normalization = specular_normalization(material.shininess);
        let diffuse = irradiance * material.diffuse * point.color * cosine;
        let specular = if shines {
            let tint = material.metallic * point.color + material.metallic.map(|m| 1.0 - m);
            let lobe = normalization * portable::pow(half_cosine, material.shininess);
            irradiance * material.specular * tint * lobe
        } else {
            Rgb::BLACK
        };
        let term =
            Self { distance, direction, irradiance, cosine, half_cosine, normalization, diffuse, specular };
        (!term.radiance().is_black()).then_some(term)
    }

    /// The term's value.
    pub fn radiance(&self) -> Rgb {
        self.diffuse + self.specular
    }
}

/// c_s = (n + 2) / 2, by which a highlight reflects the same light in all whatever the shininess n is.
pub fn specular_normalization(shininess: f64) -> f64 {
    0.5 * (shininess + 2.0)
}
