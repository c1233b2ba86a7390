//! Whitted's recursion, without a stack to overflow.
//!
//! The tree of reflections and refractions is walked breadth first with a queue: each ray carries the product of
//! the coefficients on its path, and adds its local terms times that. Depth costs memory of a queue's length, and
//! where a tree must be cut, what counts most has been traced before.
//!
//! Source: Whitted, "An improved illumination model for shaded display" (CACM 23(6), 1980).

use super::ambient_occlusion::OcclusionScratch;
use super::bends::{Bends, Indices};
use super::lighting::Lighting;
use super::{AmbientOcclusionSampler, CameraRays, Listener, RayCounts, RayId, RayKind, Silent, SpawnEvent};
use crate::accel::{Tally, Uncounted, bits};
use crate::cancel::CancelToken;
use crate::color::Rgb;
use crate::geometry::{Ray, RayPacket};
use crate::sampling::{Branch, Key};
use crate::scene::{Material, Settings};
use crate::shade::{AmbientTerm, LightTerm, ShadingPoint};
use crate::world::{
    Face, Hit, Interface, Intersection, Intersections, Look, Media, PacketScratch, Touching, World,
};
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

/// Memory that camera rays leave to the next.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// For each camera ray of a packet.
    pending: [VecDeque<PendingRay>; LANES],
    packets: PacketScratch,
    met: Intersections,
    lighting: Lighting,
    bends: Bends,
    ambient: OcclusionScratch,
}

const LANES: usize = RayPacket::LANES;

#[derive(Clone, Debug)]
struct PendingRay {
    ray: Ray,
    path: Path,
    key: Key,
}

/// What a ray brings along.
#[derive(Clone, Debug)]
struct Path {
    kind: RayKind,
    throughput: Rgb,
    /// How many reflections and refractions may follow.
    depth: u32,
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
        self.radiance_tallied(ray, media, key, scratch, counts, listener, &Uncounted)
    }

    /// As [`Whitted::radiance`], and tells what the searches for all of its rays look at.
    #[expect(clippy::too_many_arguments, reason = "the tally is one more who listens")]
    pub fn radiance_tallied<L: Listener, T: Tally>(
        &self,
        ray: Ray,
        media: &Media,
        key: Key,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
        listener: &mut L,
        tally: &T,
    ) -> Rgb {
        let rays = CameraRays::one(&ray, key);
        let listeners = std::slice::from_mut(listener);
        let mut sums = [Rgb::BLACK; LANES];
        self.trace(&rays, media, scratch, counts, listeners, tally, &mut sums);
        sums[0]
    }

    /// Adds to `sums` the radiances that arrive along camera rays from one place, each as [`Whitted::radiance`] finds
    /// it: sooner where they go much the same way, since they are traced together.
    pub fn add_radiances(
        &self,
        rays: &CameraRays,
        media: &Media,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
        sums: &mut [Rgb; RayPacket::LANES],
    ) {
        self.trace(rays, media, scratch, counts, &mut [Silent; LANES], &Uncounted, sums);
    }

    /// The radiance that arrives along a camera ray that meets nothing; none where no pixel can hold it.
    pub(crate) fn background(&self) -> Option<Rgb> {
        Some(self.world.background()).filter(|background| fits_a_pixel(*background))
    }

    #[expect(clippy::too_many_arguments, reason = "as above")]
    fn trace<L: Listener, T: Tally>(
        &self,
        rays: &CameraRays,
        media: &Media,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
        listeners: &mut [L],
        tally: &T,
        sums: &mut [Rgb; LANES],
    ) {
        let Scratch { pending, packets, met, lighting, bends, ambient } = scratch;
        let next_id = [1; LANES];
        let mut walk = Walk {
            integrator: self,
            pending,
            packets,
            met,
            lighting,
            bends,
            ambient,
            counts,
            listeners,
            tally,
            next_id,
        };
        let mut radiances = [Rgb::BLACK; LANES];
        walk.run(rays, media, &mut radiances);
        for (sum, radiance) in sums.iter_mut().zip(radiances) {
            if fits_a_pixel(radiance) {
                *sum += radiance;
            } else {
                counts.replaced += 1;
            }
        }
    }

    /// c_a at the surfaces that camera rays meet; 1 where one meets none.
    ///
    /// With the keys of [`Whitted::add_radiances`] they are the factors of the ambient terms that are found there.
    pub fn occlusions(
        &self,
        rays: &CameraRays,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
    ) -> [f64; RayPacket::LANES] {
        counts.primary += rays.count() as u64;
        let Scratch { packets, met, ambient, .. } = scratch;
        let hits = self.intersect(rays.packet(), rays.lanes(), packets, &Uncounted);
        self.world.seen(rays.packet(), &hits, false, met, packets, &Uncounted);
        let mut occlusions = [1.0; LANES];
        for (lane, occlusion) in occlusions.iter_mut().enumerate() {
            if let Some(at) = met.at(self.world, lane) {
                let key = rays.keys()[lane];
                *occlusion = self.occlusion.factor_with(self.world, &at, key, counts, ambient, &Uncounted);
            }
        }
        occlusions
    }

    /// What each of the rays `wanted` hits.
    fn intersect(
        &self,
        rays: &RayPacket,
        wanted: u32,
        scratch: &mut PacketScratch,
        tally: &impl Tally,
    ) -> [Option<Hit>; LANES] {
        if wanted.count_ones() >= WORTH_A_PACKET {
            return self.world.intersect_packet(rays, wanted, scratch);
        }
        let mut hits = [None; LANES];
        for lane in bits(wanted) {
            hits[lane] = self.world.intersect_tallied(&rays.ray(lane), tally);
        }
        hits
    }

    /// Which of the rays `wanted` meet anything; see [`World::occluded_packet`].
    fn occluded(
        &self,
        rays: &RayPacket,
        wanted: u32,
        left: &[Option<Face>; LANES],
        scratch: &mut PacketScratch,
        tally: &impl Tally,
    ) -> u32 {
        if wanted.count_ones() >= WORTH_A_PACKET {
            return self.world.occluded_packet(rays, wanted, left, scratch);
        }
        bits(wanted)
            .filter(|&lane| self.world.occluded_tallied(&rays.ray(lane), tally))
            .fold(0, |occluded, lane| occluded | 1 << lane)
    }

    fn wants_reflection(&self, material: &Material) -> bool {
        self.reflection && !material.reflect.is_black()
    }

    fn wants_refraction(&self, material: &Material) -> bool {
        self.refraction && !material.transmit.is_black()
    }

    /// Whether rays go on from surfaces of a material.
    fn goes_on(&self, material: &Material) -> bool {
        self.wants_reflection(material) || self.wants_refraction(material)
    }

    /// c_a at a surface, by the key of the ray that met it.
    pub fn occlusion_at(&self, at: &Intersection, key: Key, counts: &mut RayCounts) -> f64 {
        self.occlusion.factor(self.world, at, key, counts)
    }
}

/// Whether it is finite in the precision of a pixel, which holds less than this one does.
fn fits_a_pixel(radiance: Rgb) -> bool {
    radiance.map(|channel| f64::from(channel as f32)).is_finite()
}

/// So many rays are traced together; fewer go one by one.
const WORTH_A_PACKET: u32 = 4;

/// The trees of camera rays on their way, in step: the next ray of each is traced together.
struct Walk<'a, 'w, L, T> {
    integrator: &'a Whitted<'w>,
    pending: &'a mut [VecDeque<PendingRay>; LANES],
    packets: &'a mut PacketScratch,
    met: &'a mut Intersections,
    lighting: &'a mut Lighting,
    bends: &'a mut Bends,
    ambient: &'a mut OcclusionScratch,
    counts: &'a mut RayCounts,
    listeners: &'a mut [L],
    tally: &'a T,
    /// By camera ray; all ids below it are given.
    next_id: [u32; LANES],
}

/// A ray that goes on from where it met a surface.
struct Arrival<'a> {
    /// Which camera ray it comes from.
    lane: usize,
    id: RayId,
    path: &'a Path,
    key: Key,
    interface: Interface,
}

/// A ray that continues another.
struct Continuation {
    kind: RayKind,
    coefficient: Rgb,
    ray: Ray,
    media: Media,
}

impl<L: Listener, T: Tally> Walk<'_, '_, L, T> {
    fn run(&mut self, first: &CameraRays, media: &Media, radiances: &mut [Rgb; LANES]) {
        let camera = &Path {
            kind: RayKind::Primary,
            throughput: Rgb::WHITE,
            depth: self.integrator.depth,
            media: *media,
        };
        self.step(RayId(0), first.packet(), first.lanes(), &[camera; LANES], first.keys(), radiances);
        if self.pending.iter().all(VecDeque::is_empty) {
            return;
        }
        let mut rays = first.packet().clone();
        let mut keys = *first.keys();
        let mut paths = [const { None }; LANES];
        for id in 1.. {
            let mut wanted = 0;
            for (lane, pending) in self.pending.iter_mut().enumerate() {
                if let Some(PendingRay { ray, path, key }) = pending.pop_front() {
                    rays.set(lane, &ray);
                    keys[lane] = key;
                    paths[lane] = Some(path);
                    wanted |= 1 << lane;
                }
            }
            if wanted == 0 {
                break;
            }
            if self.integrator.cancel.is_cancelled() {
                self.pending.iter_mut().for_each(VecDeque::clear);
                break;
            }
            let paths = paths.each_ref().map(|path| path.as_ref().unwrap_or(camera));
            self.step(RayId(id), &rays, wanted, &paths, &keys, radiances);
        }
    }

    /// Traces one ray of each tree, and adds what is seen there.
    fn step(
        &mut self,
        id: RayId,
        rays: &RayPacket,
        wanted: u32,
        paths: &[&Path; LANES],
        keys: &[Key; LANES],
        radiances: &mut [Rgb; LANES],
    ) {
        let hits = self.integrator.intersect(rays, wanted, self.packets, self.tally);
        let background = self.integrator.world.background();
        let mut met = 0;
        for lane in bits(wanted) {
            let &Path { kind, throughput, .. } = paths[lane];
            self.count(kind);
            if hits[lane].is_some() {
                met |= 1 << lane;
            } else {
                self.listeners[lane].begin_ray(id, kind, throughput, &rays.ray(lane));
                self.listeners[lane].background(background);
                radiances[lane] += background * throughput;
            }
        }
        if met != 0 {
            self.shade(id, rays, &hits, paths, keys, radiances);
        }
    }

    fn count(&mut self, kind: RayKind) {
        match kind {
            RayKind::Primary => self.counts.primary += 1,
            RayKind::Reflection => self.counts.reflection += 1,
            RayKind::Refraction | RayKind::TotalInternalReflection => self.counts.refraction += 1,
        }
    }

    /// The local terms where rays have hit; what they reflect and refract is queued.
    fn shade(
        &mut self,
        id: RayId,
        rays: &RayPacket,
        hits: &[Option<Hit>; LANES],
        paths: &[&Path; LANES],
        keys: &[Key; LANES],
        radiances: &mut [Rgb; LANES],
    ) {
        let world = self.integrator.world;
        let touching = world.seen(rays, hits, L::HEARS, self.met, self.packets, self.tally);
        let mut looks = [None; LANES];
        for (lane, look) in looks.iter_mut().enumerate() {
            *look = self.met.look(world, lane);
        }
        self.find_lighting(rays, &looks);
        // Light alone needs no more of a surface than has been looked at.
        let wants_surfaces = L::HEARS || self.integrator.occlusion.is_wanted();
        let mut going_on = 0;
        for (lane, look) in looks.into_iter().enumerate() {
            let Some(Look { material, color }) = look else { continue };
            let (path, key, ray) = (paths[lane], keys[lane], rays.ray(lane));
            going_on |= u32::from(path.depth > 0 && self.integrator.goes_on(material)) << lane;
            let at = wants_surfaces.then(|| self.met.at(world, lane)).flatten();
            let listener = &mut self.listeners[lane];
            listener.begin_ray(id, path.kind, path.throughput, &ray);
            let mut point = None;
            if L::HEARS
                && let Some(at) = &at
            {
                listener.surface(at, color);
                let (normal, to_eye) = (at.facing_normal(), -ray.direction);
                point = Some(ShadingPoint { position: at.point, normal, to_eye, color, material });
            }
            let ambient = self.ambient(lane, at.as_ref(), key, material.ambient, color);
            let radiance = ambient + self.lights(lane, point.as_ref());
            radiances[lane] += radiance * path.throughput;
        }
        if going_on != 0 {
            self.continue_paths(id, rays, going_on, &touching, paths, keys);
        }
    }

    /// c_a L_a k_a S. Where nothing is known of the surface c_a is 1.
    fn ambient(
        &mut self,
        lane: usize,
        at: Option<&Intersection>,
        key: Key,
        coefficient: Rgb,
        color: Rgb,
    ) -> Rgb {
        let light = self.integrator.world.ambient();
        let mut term = AmbientTerm { occlusion: 1.0, light, coefficient, color };
        if term.radiance().is_black() {
            return Rgb::BLACK;
        }
        if let Some(at) = at {
            let Whitted { world, occlusion, .. } = self.integrator;
            term.occlusion = occlusion.factor_with(world, at, key, self.counts, self.ambient, self.tally);
        }
        self.listeners[lane].ambient(&term);
        term.radiance()
    }

    /// Finds what each light adds to each surface.
    fn find_lighting(&mut self, rays: &RayPacket, looks: &[Option<Look>; LANES]) {
        let Self { integrator, packets, met, lighting, counts, tally, .. } = self;
        lighting.find(integrator.world, rays, met, looks, |segments, wanted, left| {
            if !integrator.shadows {
                return 0;
            }
            counts.shadow += u64::from(wanted.count_ones());
            integrator.occluded(segments, wanted, left, packets, *tally)
        });
    }

    /// The sum over the lights, in their order; `point` is for whoever listens.
    fn lights(&mut self, lane: usize, point: Option<&ShadingPoint>) -> Rgb {
        let lights = self.integrator.world.lights();
        let mut sum = Rgb::BLACK;
        for (place, (light, (radiance, visible))) in lights.iter().zip(self.lighting.at(lane)).enumerate() {
            if let Some(term) = point.and_then(|point| LightTerm::new(point, light)) {
                self.listeners[lane].light(place, light, &term, visible);
            }
            if visible {
                sum += radiance;
            }
        }
        sum
    }

    /// Queues L_r and L_t of the rays `going_on` where they are wanted and their coefficients are not zero.
    fn continue_paths(
        &mut self,
        id: RayId,
        rays: &RayPacket,
        going_on: u32,
        touching: &[(usize, Vec<Touching>)],
        paths: &[&Path; LANES],
        keys: &[Key; LANES],
    ) {
        let world = self.integrator.world;
        let mut interfaces = [Interface::default(); LANES];
        let mut ior = Indices { before: [1.0; LANES], after: [1.0; LANES] };
        for lane in bits(going_on) {
            let touching = touching.iter().find(|(other, _)| *other == lane);
            let touching = touching.map_or(&[][..], |(_, touching)| touching);
            interfaces[lane] = self.met.interface(world, lane, &paths[lane].media, touching);
            (ior.before[lane], ior.after[lane]) = (interfaces[lane].ior_before, interfaces[lane].ior_after);
        }
        self.bends.mirror(world.level(), rays, self.met);
        let is_asked = |material: &Material| material.fresnel || self.integrator.wants_refraction(material);
        if bits(going_on).any(|lane| self.met.material(world, lane).is_some_and(is_asked)) {
            self.bends.refract(world.level(), rays, self.met, &ior);
        }
        for lane in bits(going_on) {
            let Some(material) = self.met.material(world, lane) else { continue };
            let (path, interface) = (paths[lane], interfaces[lane]);
            let arrival = Arrival { lane, id, path, key: keys[lane], interface };
            let (reflect, transmit) = weights(material, self.bends.reflectance(lane));
            if self.integrator.wants_reflection(material) && !reflect.is_black() {
                let (kind, ray, media) = (RayKind::Reflection, self.bends.mirrored(lane), path.media);
                self.spawn(&arrival, &Continuation { kind, coefficient: reflect, ray, media });
            }
            if self.integrator.wants_refraction(material) && !transmit.is_black() {
                let (kind, ray, media) = match self.bends.refracted(lane) {
                    Some(ray) => (RayKind::Refraction, ray, interface.media_after),
                    None => (RayKind::TotalInternalReflection, self.bends.mirrored(lane), path.media),
                };
                self.spawn(&arrival, &Continuation { kind, coefficient: transmit, ray, media });
            }
        }
    }

    fn spawn(&mut self, arrival: &Arrival, continuation: &Continuation) {
        let &Arrival { lane, id, path, key, interface } = arrival;
        let &Continuation { kind, coefficient, ray, media } = continuation;
        let throughput = path.throughput * coefficient;
        if throughput.max_channel() < LEAST_THROUGHPUT {
            return;
        }
        let next_id = &mut self.next_id[lane];
        if *next_id >= Whitted::MAX_RAYS {
            // Counted once for each camera ray.
            self.counts.truncated += u64::from(*next_id == Whitted::MAX_RAYS);
            *next_id = Whitted::MAX_RAYS + 1;
            return;
        }
        self.listeners[lane].spawn(&SpawnEvent {
            parent: id,
            child: RayId(*next_id),
            kind,
            coefficient,
            ior_before: interface.ior_before,
            ior_after: interface.ior_after,
            ray: &ray,
        });
        *next_id += 1;
        let branch = if kind == RayKind::Reflection { Branch::Reflection } else { Branch::Transmission };
        let path = Path { kind, throughput, depth: path.depth - 1, media };
        self.pending[lane].push_back(PendingRay { ray, path, key: key.child(branch) });
    }
}

/// k_r and k_t, weighted by the Fresnel reflectance where the material asks for it.
fn weights(material: &Material, reflectance: f64) -> (Rgb, Rgb) {
    if !material.fresnel {
        return (material.reflect, material.transmit);
    }
    (material.reflect * reflectance, material.transmit * (1.0 - reflectance))
}
