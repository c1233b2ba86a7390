//! The terms of a pixel, sorted by what they are and by where their light comes from.
//!
//! In: what a [`Listener`] is told of each camera ray. Out: sums over the pixel's camera rays.

use crate::color::Rgb;
use crate::geometry::Ray;
use crate::integrator::{Listener, RayId, RayKind, SpawnEvent};
use crate::scene::Light;
use crate::shade::{AmbientTerm, LightTerm};
use crate::world::Intersection;

/// The places of the terms.
pub(super) const AMBIENT: usize = 0;
pub(super) const DIFFUSE: usize = 1;
pub(super) const SPECULAR: usize = 2;
pub(super) const REFLECTION: usize = 3;
pub(super) const TRANSMISSION: usize = 4;
pub(super) const BACKGROUND: usize = 5;
/// How many terms there are.
pub(super) const TERMS: usize = 6;

/// The places of the sources; each light follows.
pub(super) const ALL_AMBIENT: usize = 0;
pub(super) const ALL_BACKGROUND: usize = 1;
/// How many sources are no light.
pub(super) const SOURCES_BEFORE_LIGHTS: usize = 2;

/// Which way from the surface that the camera ray meets a ray has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// It is the camera ray.
    Direct,
    /// By reflection there.
    Reflected,
    /// By refraction there, or by total internal reflection in its place.
    Transmitted,
}

#[derive(Clone, Debug)]
struct Sums {
    terms: [Rgb; TERMS],
    /// Empty where nobody wants them.
    sources: Vec<Rgb>,
}

impl Sums {
    fn clear(&mut self) {
        self.terms = [Rgb::BLACK; TERMS];
        self.sources.fill(Rgb::BLACK);
    }
}

/// Collects the terms of one pixel after another.
#[derive(Clone, Debug)]
pub(super) struct Gather {
    /// By the number of a ray in its camera ray's tree.
    ways: Vec<Way>,
    way: Way,
    throughput: Rgb,
    /// Of the camera ray in hand.
    ray: Sums,
    /// Of all before it.
    pixel: Sums,
    seen: Option<Intersection>,
    occlusion: Option<f64>,
}

impl Gather {
    /// For so many sources; none where the terms are enough.
    pub(super) fn new(sources: usize) -> Self {
        let none = Sums { terms: [Rgb::BLACK; TERMS], sources: vec![Rgb::BLACK; sources] };
        Self {
            ways: Vec::new(),
            way: Way::Direct,
            throughput: Rgb::BLACK,
            ray: none.clone(),
            pixel: none,
            seen: None,
            occlusion: None,
        }
    }

    /// Before a camera ray.
    pub(super) fn begin(&mut self) {
        self.ways.clear();
        self.ways.push(Way::Direct);
        self.ray.clear();
        self.seen = None;
        self.occlusion = None;
    }

    /// After a camera ray, whose radiance was replaced by black or was not.
    pub(super) fn end(&mut self, replaced: bool) {
        if !replaced {
            self.pixel.terms.iter_mut().zip(&self.ray.terms).for_each(|(sum, &term)| *sum += term);
            self.pixel.sources.iter_mut().zip(&self.ray.sources).for_each(|(sum, &source)| *sum += source);
        }
    }

    /// The sum of each term over the camera rays since it was last cleared.
    pub(super) fn terms(&self) -> &[Rgb] {
        &self.pixel.terms
    }

    /// The sum of each source, likewise.
    pub(super) fn sources(&self) -> &[Rgb] {
        &self.pixel.sources
    }

    /// What the last camera ray met.
    pub(super) fn seen(&self) -> Option<&Intersection> {
        self.seen.as_ref()
    }

    /// c_a there, where the ambient term asked for it.
    pub(super) fn occlusion(&self) -> Option<f64> {
        self.occlusion
    }

    /// After a pixel.
    pub(super) fn clear(&mut self) {
        self.pixel.clear();
    }

    fn add(&mut self, term: usize, source: usize, radiance: Rgb) {
        let radiance = radiance * self.throughput;
        let term = match self.way {
            Way::Direct => term,
            Way::Reflected => REFLECTION,
            Way::Transmitted => TRANSMISSION,
        };
        self.ray.terms[term] += radiance;
        if let Some(sum) = self.ray.sources.get_mut(source) {
            *sum += radiance;
        }
    }
}

impl Listener for Gather {
    fn begin_ray(&mut self, id: RayId, _kind: RayKind, throughput: Rgb, _ray: &Ray) {
        self.way = self.ways[id.0 as usize];
        self.throughput = throughput;
    }

    fn background(&mut self, radiance: Rgb) {
        self.add(BACKGROUND, ALL_BACKGROUND, radiance);
    }

    fn surface(&mut self, intersection: &Intersection, _color: Rgb) {
        if self.way == Way::Direct {
            self.seen = Some(*intersection);
        }
    }

    fn ambient(&mut self, term: &AmbientTerm) {
        if self.way == Way::Direct {
            self.occlusion = Some(term.occlusion);
        }
        self.add(AMBIENT, ALL_AMBIENT, term.radiance());
    }

    fn light(&mut self, index: usize, _light: &Light, term: &LightTerm, visible: bool) {
        if visible {
            self.add(DIFFUSE, SOURCES_BEFORE_LIGHTS + index, term.diffuse);
            self.add(SPECULAR, SOURCES_BEFORE_LIGHTS + index, term.specular);
        }
    }

    fn spawn(&mut self, event: &SpawnEvent) {
        let way = match self.ways[event.parent.0 as usize] {
            Way::Direct if event.kind == RayKind::Reflection => Way::Reflected,
            Way::Direct => Way::Transmitted,
            way => way,
        };
        // Rays are numbered in the order in which they are told of.
        debug_assert_eq!(self.ways.len(), event.child.0 as usize);
        self.ways.push(way);
    }
}
