//! Whitted's recursion, without a stack to overflow.
//!
//! The tree of reflections and refractions is walked breadth first with a queue: each ray carries the product of
//! the coefficients on its path, and adds its local terms times that. Depth costs memory of a queue's length, and
//! where a tree must be cut, what counts most has been traced before.
//!
//! Source: Whitted, "An improved illumination model for shaded display" (CACM 23(6), 1980).

use super::{AmbientOcclusionSampler, Listener, RayCounts, RayId, RayKind, SpawnEvent};
use crate::cancel::CancelToken;
use crate::color::Rgb;
use crate::geometry::{DVec3, Ray};
use crate::sampling::{Branch, Key};
use crate::scene::{Light, Material, Settings};
use crate::shade::{AmbientTerm, LightTerm, ShadingPoint, fresnel_reflectance, reflect, refract};
use crate::world::{Intersection, Media, Touching, World};
use std::collections::VecDeque;

/// Finds the radiance that camera rays see.
#[derive(Clone, Debug)]
pub struct Whitted<'w> {
    world: &'w World,
    depth: u32,
    shadows: bool,
    reflection: bool,
    refraction: bool,
    occlusion: AmbientOcclusionSampler,
    cancel: CancelToken,
}

/// Memory that one camera ray leaves to the next.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pending: VecDeque<PendingRay>,
}

#[derive(Clone, Debug)]
struct PendingRay {
    ray: Ray,
    kind: RayKind,
    throughput: Rgb,
    /// How many reflections and refractions may follow.
    depth: u32,
    key: Key,
    media: Media,
}

/// A path whose throughput is below this in every channel ends: 2^-24, half of the least difference that an
/// `f32` pixel of value 1 can show. A larger bound would be visible under many such paths, a smaller one traces
/// more rays for nothing.
const LEAST_THROUGHPUT: f64 = 1.0 / 16_777_216.0;

impl<'w> Whitted<'w> {
    /// The most rays that one camera ray may become by reflection and refraction; what lies beyond is left out,
    /// and counted. A chain of reflections 10,000 deep fits six times; the trees of glass, which double at each
    /// level, are cut by [`LEAST_THROUGHPUT`] long before, unless their coefficients keep all light.
    pub const MAX_RAYS: u32 = 1 << 16;

    /// An integrator for a world; of the settings, all count that are not the image's size and subpixels.
    pub fn new(world: &'w World, settings: &Settings) -> Self {
        let &Settings { depth, shadows, reflection, refraction, ref ao, .. } = settings;
        let occlusion = AmbientOcclusionSampler::new(ao);
        Self { world, depth, shadows, reflection, refraction, occlusion, cancel: CancelToken::default() }
    }

    /// The same, until it is cancelled: what it returns after that is unfinished, but comes soon, even from the
    /// midst of a large tree of reflections.
    #[must_use]
    pub fn until(mut self, cancel: &CancelToken) -> Self {
        self.occlusion = self.occlusion.until(cancel);
        self.cancel = cancel.clone();
        self
    }

    /// The radiance that arrives along a camera ray.
    ///
    /// `ray.direction` has length 1, and `media` are those around its origin. Finite also as `f32`, or replaced by
    /// black and counted.
    pub fn radiance<L: Listener>(
        &self,
        ray: Ray,
        media: &Media,
        key: Key,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
        listener: &mut L,
    ) -> Rgb {
        let mut walk = Walk { integrator: self, pending: &mut scratch.pending, counts, listener, next_id: 1 };
        let first = PendingRay {
            ray,
            kind: RayKind::Primary,
            throughput: Rgb::WHITE,
            depth: self.depth,
            key,
            media: media.clone(),
        };
        let radiance = walk.run(first);
        // In the precision of a pixel, which holds less than this one does.
        if radiance.map(|channel| f64::from(channel as f32)).is_finite() {
            radiance
        } else {
            counts.replaced += 1;
            Rgb::BLACK
        }
    }

    /// c_a at the surface that a camera ray meets; 1 where it meets none.
    ///
    /// With the key of [`Whitted::radiance`] it is the factor of the ambient term that is found there.
    pub fn occlusion(&self, ray: &Ray, key: Key, counts: &mut RayCounts) -> f64 {
        counts.primary += 1;
        self.world.intersect(ray).map_or(1.0, |hit| {
            let (at, _) = self.world.seen_surface(ray, &hit);
            self.occlusion.factor(self.world, &at, key, counts)
        })
    }
}

/// One camera ray's tree on its way.
struct Walk<'a, 'w, L> {
    integrator: &'a Whitted<'w>,
    pending: &'a mut VecDeque<PendingRay>,
    counts: &'a mut RayCounts,
    listener: &'a mut L,
    next_id: u32,
}

/// A surface that a ray has met, ready for its terms.
struct Arrival<'a> {
    id: RayId,
    pending: &'a PendingRay,
    at: Intersection,
    /// Other dielectrics whose surfaces coincide with this one.
    touching: Vec<Touching>,
    point: ShadingPoint<'a>,
}

impl<L: Listener> Walk<'_, '_, L> {
    fn run(&mut self, first: PendingRay) -> Rgb {
        self.pending.clear();
        let mut radiance = Rgb::BLACK;
        let mut id = 0;
        let mut next = Some(first);
        while let Some(pending) = next {
            if self.integrator.cancel.is_cancelled() {
                break;
            }
            self.count(pending.kind);
            self.listener.begin_ray(RayId(id), pending.kind, pending.throughput, &pending.ray);
            radiance += self.trace(RayId(id), &pending) * pending.throughput;
            id += 1;
            next = self.pending.pop_front();
        }
        radiance
    }

    fn count(&mut self, kind: RayKind) {
        match kind {
            RayKind::Primary => self.counts.primary += 1,
            RayKind::Reflection => self.counts.reflection += 1,
            RayKind::Refraction | RayKind::TotalInternalReflection => self.counts.refraction += 1,
        }
    }

    /// The local terms of one ray; what it reflects and refracts is queued.
    fn trace(&mut self, id: RayId, pending: &PendingRay) -> Rgb {
        let world = self.integrator.world;
        let Some(hit) = world.intersect(&pending.ray) else {
            self.listener.background(world.background());
            return world.background();
        };
        let (at, touching) = world.seen_surface(&pending.ray, &hit);
        let material = world.material(at.material);
        let point = ShadingPoint {
            position: at.point,
            normal: at.facing_normal(),
            to_eye: -pending.ray.direction,
            color: material.color.color_at(at.uv) * at.vertex_color,
            material,
        };
        self.listener.surface(&at, point.color);
        let arrival = Arrival { id, pending, at, touching, point };
        let radiance = self.ambient(&arrival) + self.lights(&arrival);
        if pending.depth > 0 {
            self.continue_paths(&arrival);
        }
        radiance
    }

    /// c_a L_a k_a S.
    fn ambient(&mut self, arrival: &Arrival) -> Rgb {
        let Arrival { point, .. } = arrival;
        let mut term = AmbientTerm {
            occlusion: 1.0,
            light: self.integrator.world.ambient(),
            coefficient: point.material.ambient,
            color: point.color,
        };
        if term.radiance().is_black() {
            return Rgb::BLACK;
        }
        let (world, key) = (self.integrator.world, arrival.pending.key);
        term.occlusion = self.integrator.occlusion.factor(world, &arrival.at, key, self.counts);
        self.listener.ambient(&term);
        term.radiance()
    }

    /// The sum over the lights, in their order.
    fn lights(&mut self, arrival: &Arrival) -> Rgb {
        let world = self.integrator.world;
        let mut radiance = Rgb::BLACK;
        for (index, light) in world.lights().iter().enumerate() {
            let Some(term) = LightTerm::new(&arrival.point, light) else { continue };
            let visible = !self.integrator.shadows || self.reaches(&arrival.at, light);
            self.listener.light(index, light, &term, visible);
            if visible {
                radiance += term.radiance();
            }
        }
        radiance
    }

    /// Whether nothing stands between a surface and a light.
    fn reaches(&mut self, at: &Intersection, light: &Light) -> bool {
        self.counts.shadow += 1;
        !self.integrator.world.occluded(&at.segment_to(light.position))
    }

    /// Queues L_r and L_t where they are wanted and their coefficients are not zero.
    fn continue_paths(&mut self, arrival: &Arrival) {
        let material = arrival.point.material;
        let wants_reflection = self.integrator.reflection && !material.reflect.is_black();
        let wants_refraction = self.integrator.refraction && !material.transmit.is_black();
        if !wants_reflection && !wants_refraction {
            return;
        }
        let bend = Bend::new(self.integrator.world, arrival);
        let (reflect, transmit) = bend.weights(material);
        let mirrored = mirror_direction(&arrival.at, arrival.pending.ray.direction);
        if wants_reflection && !reflect.is_black() {
            let media = arrival.pending.media.clone();
            self.spawn(arrival, &bend, Branch::Reflection, RayKind::Reflection, reflect, mirrored, media);
        }
        if wants_refraction && !transmit.is_black() {
            let (kind, direction, media) = match bend.refracted {
                Some(direction) => (RayKind::Refraction, direction, bend.media_after.clone()),
                None => (RayKind::TotalInternalReflection, mirrored, arrival.pending.media.clone()),
            };
            self.spawn(arrival, &bend, Branch::Transmission, kind, transmit, direction, media);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "each is one property of the new ray, used once")]
    fn spawn(
        &mut self,
        arrival: &Arrival,
        bend: &Bend,
        branch: Branch,
        kind: RayKind,
        coefficient: Rgb,
        direction: DVec3,
        media: Media,
    ) {
        let throughput = arrival.pending.throughput * coefficient;
        if throughput.max_channel() < LEAST_THROUGHPUT {
            return;
        }
        if self.next_id >= Whitted::MAX_RAYS {
            // Counted once for each camera ray.
            self.counts.truncated += u64::from(self.next_id == Whitted::MAX_RAYS);
            self.next_id = Whitted::MAX_RAYS + 1;
            return;
        }
        let ray = arrival.at.spawn(direction);
        self.listener.spawn(&SpawnEvent {
            parent: arrival.id,
            child: RayId(self.next_id),
            kind,
            coefficient,
            ior_before: bend.ior_before,
            ior_after: bend.ior_after,
            ray: &ray,
        });
        self.next_id += 1;
        self.pending.push_back(PendingRay {
            ray,
            kind,
            throughput,
            depth: arrival.pending.depth - 1,
            key: arrival.pending.key.child(branch),
            media,
        });
    }
}

/// What a surface does to a ray that passes it.
struct Bend {
    ior_before: f64,
    ior_after: f64,
    media_after: Media,
    /// None at total internal reflection.
    refracted: Option<DVec3>,
    cosine: f64,
}

impl Bend {
    fn new(world: &World, arrival: &Arrival) -> Self {
        let (at, media) = (&arrival.at, &arrival.pending.media);
        let direction = arrival.pending.ray.direction;
        let cosine = -direction.dot(arrival.point.normal);
        if arrival.point.material.transmit.is_black() {
            let (ior_before, ior_after) = (media.ior(world), arrival.point.material.ior);
            return Self { ior_before, ior_after, media_after: media.clone(), refracted: None, cosine };
        }
        let interface = media.interface(world, at, &arrival.touching);
        let (ior_before, ior_after) = (interface.ior_before, interface.ior_after);
        Self {
            ior_before,
            ior_after,
            media_after: interface.media_after,
            refracted: refracted_direction(at, direction, ior_before, ior_after),
            cosine,
        }
    }

    /// k_r and k_t, weighted by the Fresnel reflectance where the material asks for it.
    fn weights(&self, material: &Material) -> (Rgb, Rgb) {
        if !material.fresnel {
            return (material.reflect, material.transmit);
        }
        let reflectance = fresnel_reflectance(self.cosine, self.ior_before, self.ior_after);
        (material.reflect * reflectance, material.transmit * (1.0 - reflectance))
    }
}

/// The mirror direction about N. Where an interpolated N would send the ray into the surface, the geometric
/// normal takes its place.
fn mirror_direction(at: &Intersection, direction: DVec3) -> DVec3 {
    let mirrored = reflect(direction, at.facing_normal());
    let facing = at.facing_geometric_normal();
    if mirrored.dot(facing) > 0.0 { mirrored } else { reflect(direction, facing) }
}

/// The refracted direction about N. Where an interpolated N would send the ray back out, the geometric normal
/// takes its place.
fn refracted_direction(
    at: &Intersection,
    direction: DVec3,
    ior_before: f64,
    ior_after: f64,
) -> Option<DVec3> {
    let facing = at.facing_geometric_normal();
    let refracted = refract(direction, at.facing_normal(), ior_before, ior_after)?;
    if refracted.dot(facing) < 0.0 {
        Some(refracted)
    } else {
        refract(direction, facing, ior_before, ior_after)
    }
}
