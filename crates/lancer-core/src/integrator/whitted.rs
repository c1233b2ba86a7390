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
use crate::color::{Colors, Rgb};
use crate::geometry::{Ray, RayPacket};
use crate::sampling::{Branch, Key};
use crate::scene::{Material, Settings};
use crate::shade::{AmbientTerm, LightTerm, ShadingPoint};
use crate::world::{
    Face, Hits, Interface, Intersection, Intersections, Media, PacketScratch, Touching, World,
};
use fearless_simd::dispatch;
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
        self.trace(&rays, media, scratch, counts, listeners, tally).at(0)
    }

    /// The radiances that arrive along camera rays from one place, each as [`Whitted::radiance`] finds it: sooner where
    /// they go much the same way, since they are traced together.
    pub fn radiances(
        &self,
        rays: &CameraRays,
        media: &Media,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
    ) -> Colors {
        self.trace(rays, media, scratch, counts, &mut [Silent; LANES], &Uncounted)
    }

    /// The radiance that arrives along a camera ray that meets nothing; none where no pixel can hold it.
    pub(crate) fn background(&self) -> Option<Rgb> {
        Some(self.world.background()).filter(|background| fits_a_pixel(*background))
    }

    fn trace<L: Listener, T: Tally>(
        &self,
        rays: &CameraRays,
        media: &Media,
        scratch: &mut Scratch,
        counts: &mut RayCounts,
        listeners: &mut [L],
        tally: &T,
    ) -> Colors {
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
        let mut radiances = Colors::default();
        walk.run(rays, media, &mut radiances);
        let fits =
            (0..LANES).fold(0_u32, |set, lane| set | u32::from(fits_a_pixel(radiances.at(lane))) << lane);
        for lane in bits(rays.lanes() & !fits) {
            radiances.put(lane, Rgb::BLACK);
            counts.replaced += 1;
        }
        radiances
    }

    /// c_a at the surfaces that camera rays meet; 1 where one meets none.
    ///
    /// With the keys of [`Whitted::radiances`] they are the factors of the ambient terms that are found there.
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
    ) -> Hits {
        if wanted.count_ones() >= WORTH_A_PACKET {
            return self.world.intersect_packet(rays, wanted, scratch);
        }
        let mut hits = Hits::default();
        for lane in bits(wanted) {
            hits.put(lane, self.world.intersect_tallied(&rays.ray(lane), tally));
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

/// What the rays of a packet have met.
struct Seen<'w> {
    materials: [Option<&'w Material>; LANES],
    /// c_a.
    occlusions: [f64; LANES],
    /// The dielectrics that the surfaces touch, by ray, where any do.
    touching: Vec<(usize, Vec<Touching>)>,
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

impl<'w, L: Listener, T: Tally> Walk<'_, 'w, L, T> {
    fn run(&mut self, first: &CameraRays, media: &Media, radiances: &mut Colors) {
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
        radiances: &mut Colors,
    ) {
        let mut throughput = Colors::default();
        for lane in bits(wanted) {
            throughput.put(lane, paths[lane].throughput);
            self.count(paths[lane].kind);
            if L::HEARS {
                let &Path { kind, throughput, .. } = paths[lane];
                self.listeners[lane].begin_ray(id, kind, throughput, &rays.ray(lane));
            }
        }
        let hits = self.integrator.intersect(rays, wanted, self.packets, self.tally);
        let mut terms = Colors::splat(self.integrator.world.background());
        let seen = (hits.lanes() != 0).then(|| self.shade(rays, &hits, keys, &mut terms));
        for lane in 0..LANES {
            let is_wanted = wanted >> lane & 1 == 1;
            let radiance = if is_wanted { terms.at(lane) * throughput.at(lane) } else { Rgb::BLACK };
            radiances.put(lane, radiances.at(lane) + radiance);
        }
        if L::HEARS {
            for lane in bits(wanted) {
                self.tell(lane, &rays.ray(lane), seen.as_ref());
            }
        }
        if let Some(seen) = seen {
            self.continue_paths(id, rays, &seen, paths, keys);
        }
    }

    fn count(&mut self, kind: RayKind) {
        match kind {
            RayKind::Primary => self.counts.primary += 1,
            RayKind::Reflection => self.counts.reflection += 1,
            RayKind::Refraction | RayKind::TotalInternalReflection => self.counts.refraction += 1,
        }
    }

    /// Puts the local terms where rays have hit.
    fn shade(&mut self, rays: &RayPacket, hits: &Hits, keys: &[Key; LANES], terms: &mut Colors) -> Seen<'w> {
        let world = self.integrator.world;
        let touching = world.seen(rays, hits, L::HEARS, self.met, self.packets, self.tally);
        let materials = self.met.look(world);
        self.find_lighting(rays, &materials);
        let occlusions = self.occlusions(&materials, keys);
        let (met, light) = (self.met.lanes(), world.ambient());
        let mut coefficients = Colors::default();
        for lane in bits(met) {
            coefficients.put(lane, materials[lane].map_or(Rgb::BLACK, |material| material.ambient));
        }
        let mut lights = Colors::default();
        dispatch!(world.level(), _simd => {
            self.lighting.add_to(&mut lights);
            for (lane, &occlusion) in occlusions.iter().enumerate() {
                let (coefficient, color) = (coefficients.at(lane), self.met.colors.at(lane));
                let ambient = AmbientTerm { occlusion, light, coefficient, color };
                let is_met = met >> lane & 1 == 1;
                let term = if is_met { ambient.radiance() + lights.at(lane) } else { terms.at(lane) };
                terms.put(lane, term);
            }
        });
        Seen { materials, occlusions, touching }
    }

    /// c_a at the surfaces, where it makes a difference.
    fn occlusions(&mut self, materials: &[Option<&Material>; LANES], keys: &[Key; LANES]) -> [f64; LANES] {
        let Whitted { world, occlusion, .. } = self.integrator;
        let mut occlusions = [1.0; LANES];
        if !occlusion.is_wanted() {
            return occlusions;
        }
        for (lane, factor) in occlusions.iter_mut().enumerate() {
            let Some(material) = materials[lane] else { continue };
            if self.ambient_term(lane, material, 1.0).radiance().is_black() {
                continue;
            }
            if let Some(at) = self.met.at(world, lane) {
                *factor =
                    occlusion.factor_with(world, &at, keys[lane], self.counts, self.ambient, self.tally);
            }
        }
        occlusions
    }

    /// The ambient term at a surface that has been looked at.
    fn ambient_term(&self, lane: usize, material: &Material, occlusion: f64) -> AmbientTerm {
        let (light, color) = (self.integrator.world.ambient(), self.met.colors.at(lane));
        AmbientTerm { occlusion, light, coefficient: material.ambient, color }
    }

    /// Finds what each light adds to each surface.
    fn find_lighting(&mut self, rays: &RayPacket, materials: &[Option<&Material>; LANES]) {
        let Self { integrator, packets, met, lighting, counts, tally, .. } = self;
        lighting.find(integrator.world, rays, met, materials, |segments, wanted, left| {
            if !integrator.shadows {
                return 0;
            }
            counts.shadow += u64::from(wanted.count_ones());
            integrator.occluded(segments, wanted, left, packets, *tally)
        });
    }

    /// Tells the listener of a ray its terms; `seen` is what the rays of the packet have met, if any has.
    fn tell(&mut self, lane: usize, ray: &Ray, seen: Option<&Seen>) {
        let world = self.integrator.world;
        let surface = seen.and_then(|seen| Some((seen.materials[lane]?, seen.occlusions[lane])));
        let (Some((material, occlusion)), Some(at)) = (surface, self.met.at(world, lane)) else {
            self.listeners[lane].background(world.background());
            return;
        };
        let color = self.met.colors.at(lane);
        self.listeners[lane].surface(&at, color);
        if !self.ambient_term(lane, material, 1.0).radiance().is_black() {
            let term = self.ambient_term(lane, material, occlusion);
            self.listeners[lane].ambient(&term);
        }
        let (normal, to_eye) = (at.facing_normal(), -ray.direction);
        let point = ShadingPoint { position: at.point, normal, to_eye, color, material };
        for (place, (light, visible)) in world.lights().iter().zip(self.lighting.visible(lane)).enumerate() {
            if let Some(term) = LightTerm::new(&point, light) {
                self.listeners[lane].light(place, light, &term, visible);
            }
        }
    }

    /// Queues L_r and L_t where they are wanted and their coefficients are not zero.
    fn continue_paths(
        &mut self,
        id: RayId,
        rays: &RayPacket,
        Seen { materials, touching, .. }: &Seen,
        paths: &[&Path; LANES],
        keys: &[Key; LANES],
    ) {
        let world = self.integrator.world;
        let goes_on = |lane: usize| materials[lane].is_some_and(|it| self.integrator.goes_on(it));
        let going_on = bits(self.met.lanes())
            .filter(|&lane| paths[lane].depth > 0 && goes_on(lane))
            .fold(0_u32, |set, lane| set | 1 << lane);
        if going_on == 0 {
            return;
        }
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
        if bits(going_on).any(|lane| materials[lane].is_some_and(is_asked)) {
            self.bends.refract(world.level(), rays, self.met, &ior);
        }
        for lane in bits(going_on) {
            let Some(material) = materials[lane] else { continue };
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
