//! The local terms.

use super::ShadingPoint;
use crate::color::Rgb;
use crate::geometry::{DVec3, portable};
use crate::scene::{Light, Material};
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
        let &ShadingPoint { position, normal, to_eye, color, material } = point;
        if !material.is_lit() || light.intensity.is_black() {
            return None;
        }
        let Incidence { distance, direction, falloff, cosine, half_cosine } =
            Incidence::new(position, normal, to_eye, light.position);
        // Also false for a light in the point itself, whose direction is NaN.
        let faces_the_light = cosine > 0.0;
        if !faces_the_light {
            return None;
        }
        let irradiance = light.intensity * falloff;
        let normalization = specular_normalization(material.shininess);
        let diffuse = diffuse(irradiance, material.diffuse, color, cosine);
        let specular = specular(irradiance, material, color, half_cosine);
        let term =
            Self { distance, direction, irradiance, cosine, half_cosine, normalization, diffuse, specular };
        (!term.radiance().is_black()).then_some(term)
    }

    /// The term's value.
    pub fn radiance(&self) -> Rgb {
        self.diffuse + self.specular
    }
}

/// How a light stands to a point, whatever the material there is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incidence {
    /// r: the distance to the light.
    pub(crate) distance: f64,
    /// L: the unit direction to the light.
    pub(crate) direction: DVec3,
    /// 1 / (pi r^2).
    pub(crate) falloff: f64,
    /// N.L.
    pub(crate) cosine: f64,
    /// (N.H)+.
    pub(crate) half_cosine: f64,
}

impl Incidence {
    /// For N and V of a point. Without branches, so that vector code can be made of it.
    #[inline(always)]
    pub(crate) fn new(position: DVec3, normal: DVec3, to_eye: DVec3, light_position: DVec3) -> Self {
        let to_light = light_position - position;
        let distance = to_light.length();
        let direction = to_light / distance;
        let half = (direction + to_eye).normalize_or_zero();
        Self {
            distance,
            direction,
            falloff: 1.0 / (PI * distance * distance),
            cosine: normal.dot(direction),
            half_cosine: normal.dot(half).max(0.0),
        }
    }
}

/// L_i / (pi r^2) k_d S (N.L).
#[inline(always)]
pub(crate) fn diffuse(irradiance: Rgb, coefficient: Rgb, color: Rgb, cosine: f64) -> Rgb {
    irradiance * coefficient * color * cosine
}

/// L_i / (pi r^2) c_s k_s (m S + (1 - m)) ((N.H)+)^n.
pub(crate) fn specular(irradiance: Rgb, material: &Material, color: Rgb, half_cosine: f64) -> Rgb {
    if material.specular.is_black() {
        return Rgb::BLACK;
    }
    let tint = material.metallic * color + material.metallic.map(|m| 1.0 - m);
    let lobe = specular_normalization(material.shininess) * portable::pow(half_cosine, material.shininess);
    irradiance * material.specular * tint * lobe
}

/// c_s = (n + 2) / 2, by which a highlight reflects the same light in all whatever the shininess n is.
pub fn specular_normalization(shininess: f64) -> f64 {
    0.5 * (shininess + 2.0)
}
