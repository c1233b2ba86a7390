//! The coefficients of the illumination model.

use super::Texture;
use crate::color::Rgb;

/// Which material of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub(super) u32);

impl MaterialId {
    pub(crate) fn from_index(index: usize) -> Self {
        Self(u32::try_from(index).expect("fewer than 2^32 materials fit in memory"))
    }

    /// Its place in [`Scene::materials`](super::Scene::materials).
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A material: S, k_a, k_d, k_s, k_r, k_t, m, n and the index of refraction.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What the author calls it; may be empty.
    pub name: String,
    /// S: the colour of the surface.
    pub color: Texture,
    /// k_a: how much of the ambient light is reflected.
    pub ambient: Rgb,
    /// k_d: how much of a light is reflected in all directions.
    pub diffuse: Rgb,
    /// k_s: how much of a light is reflected as a highlight.
    pub specular: Rgb,
    /// m: how far highlights take the surface's colour; 0 plastic, 1 metal.
    pub metallic: Rgb,
    /// n: the exponent of highlights, at least 0; the larger, the smaller they are.
    pub shininess: f64,
    /// k_r: how much of the mirror image is seen.
    pub reflect: Rgb,
    /// k_t: how much of what lies behind is seen, refracted.
    pub transmit: Rgb,
    /// The index of refraction, above 0.
    pub ior: f64,
    /// Whether k_r and k_t are weighted by the Fresnel reflectance, which the model leaves out by default.
    pub fresnel: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            color: Texture::Solid(Rgb::WHITE),
            ambient: Rgb::WHITE,
            diffuse: Rgb::WHITE,
            specular: Rgb::BLACK,
            metallic: Rgb::BLACK,
            shininess: 32.0,
            reflect: Rgb::BLACK,
            transmit: Rgb::BLACK,
            ior: 1.5,
            fresnel: false,
        }
    }
}

impl Material {
    /// The default material under a name.
    pub fn named(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Whether lights add anything to its surfaces.
    pub fn is_lit(&self) -> bool {
        !self.diffuse.is_black() || !self.specular.is_black()
    }
}
