//! Who is told of the terms.

use crate::color::Rgb;
use crate::geometry::Ray;
use crate::scene::Light;
use crate::shade::{AmbientTerm, LightTerm};
use crate::world::Intersection;

/// Which ray of a camera ray's tree, in the order in which they are traced; the camera ray is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RayId(pub u32);

/// What a ray is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// It comes from the camera.
    Primary,
    /// It follows a mirror direction: L_r.
    Reflection,
    /// It follows a refracted direction: L_t.
    Refraction,
    /// It was to be refracted and was reflected totally: also L_t.
    TotalInternalReflection,
}

/// A ray that continues another.
#[derive(Clone, Copy, Debug)]
pub struct SpawnEvent<'a> {
    /// The ray that it continues.
    pub parent: RayId,
    /// The number under which it is traced, unless the tree is cut before.
    pub child: RayId,
    /// What it is.
    pub kind: RayKind,
    /// k_r or k_t, with the Fresnel weight where the material asks for one.
    pub coefficient: Rgb,
    /// The index of refraction where the ray is.
    pub ior_before: f64,
    /// The index of refraction beyond the surface.
    pub ior_after: f64,
    /// The ray.
    pub ray: &'a Ray,
}

/// Is told every term of every ray of a pixel while the picture is made.
///
/// All methods do nothing unless they are written: a listener takes what it wants, and what it leaves costs
/// nothing. Calls for one ray come together, [`begin_ray`](Self::begin_ray) first; rays come breadth first. A
/// ray's terms times its throughput add up, over all rays, to the radiance.
pub trait Listener {
    /// Whether it is to be told anything: what nobody hears of is not made.
    const HEARS: bool = true;

    /// A ray is about to be traced; `throughput` is the product of the coefficients on its path.
    fn begin_ray(&mut self, _id: RayId, _kind: RayKind, _throughput: Rgb, _ray: &Ray) {}
    /// It met nothing.
    fn background(&mut self, _radiance: Rgb) {}
    /// It met a surface, of colour S.
    fn surface(&mut self, _intersection: &Intersection, _color: Rgb) {}
    /// The ambient term.
    fn ambient(&mut self, _term: &AmbientTerm) {}
    /// The term of a light, which counts only where it is visible. Lights that the surface faces away from have
    /// none.
    fn light(&mut self, _index: usize, _light: &Light, _term: &LightTerm, _visible: bool) {}
    /// L_r or L_t will be traced.
    fn spawn(&mut self, _event: &SpawnEvent) {}
}

/// Listens to nothing: a plain render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Silent;

impl Listener for Silent {
    const HEARS: bool = false;
}
