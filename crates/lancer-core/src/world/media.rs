//! What a ray travels through: the transmissive objects that it is inside of.
//!
//! Dielectrics may be nested, may overlap and may touch. The medium is that of the object entered last; objects
//! are remembered one by one, so that leaving an outer one while inside an inner one changes nothing.

use super::{Hit, Hits, Intersection, Intersections, ObjectId, PacketScratch, World};
use crate::accel::{Tally, Uncounted, bits};
use crate::geometry::error::leave_surface;
use crate::geometry::packet::TOGETHER;
use crate::geometry::{DVec3, Ray, RayPacket, Vectors, packet};
use crate::shape::SurfacePoints;
use fearless_simd::dispatch;

/// The transmissive objects around a point, the one entered last at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Media {
    /// The first `count`; the others are the default.
    objects: [ObjectId; Self::MAX_NESTED],
    count: usize,
}

/// What happens to a ray's media at an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Interface {
    /// The index of refraction on the side that the ray comes from.
    pub(crate) ior_before: f64,
    /// The index on the other side.
    pub(crate) ior_after: f64,
    /// The media on the other side.
    pub(crate) media_after: Media,
}

/// A surface that coincides with another, within rounding, as a ray meets the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Touching {
    pub(crate) object: ObjectId,
    pub(crate) primitive: u32,
    /// Whether the ray leaves the object there.
    pub(crate) from_inside: bool,
    pub(crate) is_transmissive: bool,
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
            let here = (hit.object, intersection.from_inside);
            let touching = world.touching(&intersection, OUTWARD, &Uncounted);
            let others = touching.iter().map(|other| (other.object, other.from_inside));
            for (object, from_inside) in std::iter::once(here).chain(others) {
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
        self.objects().last().map_or(1.0, |&object| world.material(world.object(object).material).ior)
    }

    /// What happens to a ray that arrives through these media at the surface of a transmissive object, which touches
    /// others.
    pub(crate) fn interface(
        &self,
        world: &World,
        object: ObjectId,
        from_inside: bool,
        touching: &[Touching],
    ) -> Interface {
        let mut before = *self;
        if from_inside {
            before.enter(object);
        }
        let mut after = before;
        after.cross(object, from_inside);
        for other in touching.iter().filter(|other| other.is_transmissive) {
            after.cross(other.object, other.from_inside);
        }
        Interface { ior_before: before.ior(world), ior_after: after.ior(world), media_after: after }
    }

    fn cross(&mut self, object: ObjectId, from_inside: bool) {
        if from_inside {
            self.leave(object);
        } else {
            self.enter(object);
        }
    }

    fn objects(&self) -> &[ObjectId] {
        &self.objects[..self.count]
    }

    fn enter(&mut self, object: ObjectId) {
        if !self.objects().contains(&object) && self.count < Self::MAX_NESTED {
            self.objects[self.count] = object;
            self.count += 1;
        }
    }

    fn leave(&mut self, object: ObjectId) {
        if let Some(place) = self.objects().iter().position(|&other| other == object) {
            self.objects[place..self.count].rotate_left(1);
            self.count -= 1;
            self.objects[self.count] = ObjectId::default();
        }
    }
}

/// A direction that no scene's edges are likely to follow.
const OUTWARD: DVec3 = DVec3::new(0.437_216_12, 0.829_301_7, 0.348_027_9);

const LANES: usize = RayPacket::LANES;

/// Surfaces that a search for the media around a point goes through before it takes the rest for outside.
const MAX_CROSSINGS: usize = 10_000;

impl World {
    /// Whether light passes through an object.
    fn is_transmissive(&self, object: &super::Object) -> bool {
        !self.material(object.material).transmit.is_black()
    }

    /// Puts the surface that counts in the place of the one that a ray has met, and returns the dielectrics that touch
    /// it there. An opaque surface that touches a transparent one, as where glass stands on a table, is what is seen.
    pub(crate) fn see(&self, ray: &Ray, at: &mut Intersection, tally: &impl Tally) -> Vec<Touching> {
        if self.material(at.material).transmit.is_black() {
            return Vec::new();
        }
        let touching = self.touching(at, ray.direction, tally);
        match touching.iter().find(|other| !other.is_transmissive) {
            Some(&Touching { object, primitive, .. }) => {
                *at = self.intersection(ray, &Hit { t: at.t, object, primitive });
                Vec::new()
            }
            None => touching,
        }
    }

    /// Finds the surfaces that count where rays of a packet hit, as [`Intersections::find`] does, and the dielectrics that
    /// touch them, by ray, where any do.
    pub(crate) fn seen(
        &self,
        rays: &RayPacket,
        hits: &Hits,
        with_uv: bool,
        met: &mut Intersections,
        scratch: &mut PacketScratch,
        tally: &impl Tally,
    ) -> Vec<(usize, Vec<Touching>)> {
        met.find(self, rays, hits, with_uv);
        let mut touching = Vec::new();
        for lane in bits(self.worth_seeing(rays, met, scratch)) {
            let Some(mut at) = met.at(self, lane) else { continue };
            let others = self.see(&rays.ray(lane), &mut at, tally);
            met.put(lane, &at);
            if !others.is_empty() {
                touching.push((lane, others));
            }
        }
        touching
    }

    /// Which of the rays that have met surfaces [`World::see`] has to look at: those that have met dielectrics, without
    /// those that touch nothing for sure, as almost all do.
    fn worth_seeing(&self, rays: &RayPacket, met: &Intersections, scratch: &mut PacketScratch) -> u32 {
        let transmits = |lane: &usize| met.material(self, *lane).is_some_and(|it| !it.transmit.is_black());
        let dielectric = bits(met.lanes()).filter(transmits).fold(0, |set, lane| set | 1_u32 << lane);
        if dielectric.count_ones() < TOGETHER {
            return dielectric;
        }
        let mut segments = RayPacket::default();
        dispatch!(self.level, _simd => {
            let SurfacePoints { point, point_error, geometric_normal, .. } = &met.surfaces;
            for lane in 0..LANES {
                let of = |vectors: &Vectors| packet::at(vectors, lane);
                let segment = across(of(point), of(point_error), of(geometric_normal), of(&rays.direction));
                segments.set(lane, &segment);
            }
        });
        let own = std::array::from_fn(|lane| met.face(lane).map_or(ObjectId(0), |face| face.object));
        self.may_meet_others(&segments, dielectric, &own, scratch)
    }

    /// The surfaces of other objects that coincide, within rounding, with the one at `at`, as a ray in
    /// `direction` meets them. In the order of their objects' ids; almost always none.
    pub(crate) fn touching(&self, at: &Intersection, direction: DVec3, tally: &impl Tally) -> Vec<Touching> {
        let segment = across(at.point, at.point_error, at.geometric_normal, direction);
        let mut touching: Vec<Touching> = Vec::new();
        self.visit_objects(&segment, tally, |id, object| {
            if id != at.object && touching.iter().all(|other| other.object != id) {
                let ray = object.placement.ray_to_object(&segment);
                if let Some(local) = object.geometry.intersect(&ray, &self.meshes, tally) {
                    let hit = Hit { t: local.t, object: id, primitive: local.primitive };
                    touching.push(Touching {
                        object: id,
                        primitive: local.primitive,
                        from_inside: self.intersection(&segment, &hit).from_inside,
                        is_transmissive: self.is_transmissive(object),
                    });
                }
            }
            segment.t_max
        });
        touching.sort_unstable_by_key(|other| other.object);
        touching
    }
}

/// From just before a surface to just after it, as a ray in `direction` crosses it.
#[inline(always)]
fn across(point: DVec3, point_error: DVec3, geometric_normal: DVec3, direction: DVec3) -> Ray {
    let leave = |direction| leave_surface(point, point_error, geometric_normal, direction);
    Ray::between(leave(-direction), leave(direction))
}
