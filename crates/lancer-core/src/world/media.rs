//! What a ray travels through: the transmissive objects that it is inside of.
//!
//! Dielectrics may be nested, may overlap and may touch. The medium is that of the object entered last; objects
//! are remembered one by one, so that leaving an outer one while inside an inner one changes nothing.

use super::{Hit, Intersection, ObjectId, World};
use crate::geometry::error::leave_surface;
use crate::geometry::{DVec3, Ray};
use arrayvec::ArrayVec;

/// The transmissive objects around a point, the one entered last at the end.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Media {
    objects: ArrayVec<ObjectId, { Self::MAX_NESTED }>,
}

/// What happens to a ray's media at an interface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Interface {
    /// The index of refraction on the side that the ray comes from.
    pub(crate) ior_before: f64,
    /// The index on the other side.
    pub(crate) ior_after: f64,
    /// The media on the other side.
    pub(crate) media_after: Media,
}

impl Media {
    /// How many objects within one another are told apart; a deeper one is taken for the one around it.
    pub const MAX_NESTED: usize = 12;

    /// The media around a point, such as a camera's eye.
    ///
    /// Follows one ray outward: an object whose surface it first meets from inside is around the point.
    pub fn around(world: &World, point: DVec3) -> Self {
        if !world.objects.iter().any(|object| world.is_transmissive(object)) {
            return Self::default();
        }
        let mut met: Vec<(ObjectId, bool)> = Vec::new();
        let mut ray = Ray::new(point, OUTWARD);
        for _ in 0..MAX_CROSSINGS {
            let Some(hit) = world.intersect(&ray) else { break };
            let intersection = world.intersection(&ray, &hit);
            for (object, from_inside) in [(hit.object, intersection.from_inside)]
                .into_iter()
                .chain(world.also_crossed(&intersection, OUTWARD))
            {
                if met.iter().all(|&(other, _)| other != object) {
                    met.push((object, from_inside));
                }
            }
            ray = intersection.spawn(OUTWARD);
        }
        let mut media = Self::default();
        // What is left first was entered last.
        for &(object, _) in met.iter().rev().filter(|(_, from_inside)| *from_inside) {
            if world.is_transmissive(world.object(object)) {
                media.enter(object);
            }
        }
        media
    }

    /// The index of refraction of the innermost medium; 1 outside of everything.
    pub fn ior(&self, world: &World) -> f64 {
        self.objects.last().map_or(1.0, |&object| world.material(world.object(object).material).ior)
    }

    /// What happens at a transmissive surface to a ray that arrives in `direction` through these media.
    pub(crate) fn interface(&self, world: &World, at: &Intersection, direction: DVec3) -> Interface {
        let mut before = self.clone();
        if at.from_inside && !before.objects.contains(&at.object) {
            before.enter(at.object);
        }
        let mut after = before.clone();
        after.cross(at.object, at.from_inside);
        for (object, from_inside) in world.also_crossed(at, direction) {
            if world.is_transmissive(world.object(object)) {
                after.cross(object, from_inside);
            }
        }
        Interface { ior_before: before.ior(world), ior_after: after.ior(world), media_after: after }
    }

    fn cross(&mut self, object: ObjectId, from_inside: bool) {
        if from_inside {
            self.objects.retain(|other| *other != object);
        } else {
            self.enter(object);
        }
    }

    fn enter(&mut self, object: ObjectId) {
        if !self.objects.contains(&object) && !self.objects.is_full() {
            self.objects.push(object);
        }
    }
}

/// A direction that no scene's edges are likely to follow.
const OUTWARD: DVec3 = DVec3::new(0.437_216_12, 0.829_301_7, 0.348_027_9);

/// Surfaces that a search for the media around a point goes through before it takes the rest for outside.
const MAX_CROSSINGS: usize = 10_000;

impl World {
    /// Whether light passes through an object.
    fn is_transmissive(&self, object: &super::Object) -> bool {
        !self.material(object.material).transmit.is_black()
    }

    /// An opaque surface that coincides, within rounding, with the transmissive one at `at`, as where glass stands
    /// on a table: what a ray in `direction` really sees.
    pub(crate) fn opaque_behind(&self, at: &Intersection, direction: DVec3) -> Option<Hit> {
        let segment = across(at, direction);
        let mut found: Option<Hit> = None;
        self.visit_objects(&segment, |id, object| {
            if id != at.object && !self.is_transmissive(object) {
                let ray = object.placement.ray_to_object(&segment);
                if let Some(local) = object.geometry.intersect(&ray, &self.meshes, self.accelerator) {
                    let hit = Hit { t: at.t, object: id, primitive: local.primitive };
                    found = found.filter(|other| other.object < id).or(Some(hit));
                }
            }
            segment.t_max
        });
        found
    }

    /// The other objects whose surfaces coincide, within rounding, with the one at `at`, and whether a ray in
    /// `direction` leaves them there. In the order of their ids.
    fn also_crossed(&self, at: &Intersection, direction: DVec3) -> Vec<(ObjectId, bool)> {
        let segment = across(at, direction);
        let mut crossed = Vec::new();
        self.visit_objects(&segment, |id, object| {
            if id != at.object && crossed.iter().all(|&(other, _)| other != id) {
                let ray = object.placement.ray_to_object(&segment);
                if let Some(local) = object.geometry.intersect(&ray, &self.meshes, self.accelerator) {
                    let hit = Hit { t: local.t, object: id, primitive: local.primitive };
                    crossed.push((id, self.intersection(&segment, &hit).from_inside));
                }
            }
            segment.t_max
        });
        crossed.sort_unstable();
        crossed
    }
}

/// From just before a surface to just after it, as a ray in `direction` crosses it.
fn across(at: &Intersection, direction: DVec3) -> Ray {
    let leave = |direction| leave_surface(at.point, at.point_error, at.geometric_normal, direction);
    Ray::between(leave(-direction), leave(direction))
}
