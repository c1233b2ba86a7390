//! The rays of the comparison by kind, made once and traced by both sides: the same numbers, all exact in `f32`.

use super::directions;
use super::stage::{HEIGHT, Stage, WIDTH};
use crate::Failure;
use lancer_core::geometry::{DVec3, DirectionFan, Ray, RayPacket};
use lancer_core::sampling::HemisphereLattice;
use lancer_core::shade::reflect;
use lancer_core::world::{Intersection, World};
use rayon::prelude::*;

/// Rays of a packet.
pub(super) const LANES: usize = RayPacket::LANES;
/// No ray in this lane.
pub(super) const EMPTY: u32 = u32::MAX;

/// Indices of rays that travel together.
pub(super) type Packet = [u32; LANES];

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Primary,
    Shadow,
    Mirror,
    AmbientOcclusion,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Mirror => "mirror",
            Self::AmbientOcclusion => "AO",
        }
    }

    /// Whether any hit will do.
    pub(super) fn is_occlusion(self) -> bool {
        matches!(self, Self::Shadow | Self::AmbientOcclusion)
    }
}

/// All rays of one kind, with the ways to put them into packets.
pub(super) struct Lot {
    pub(super) kind: Kind,
    /// In the order of tiles of 8 x 8 pixels, each of four blocks of 4 x 4.
    pub(super) rays: Vec<Ray>,
    pub(super) groupings: Vec<(&'static str, Vec<Packet>)>,
    /// The same rays by blocks of pixels, as Lancer takes them, and the lanes that are used; for kinds that have no fans.
    pub(super) packets: Vec<(RayPacket, u32)>,
    /// The same rays by the point that they leave, for kinds that have many of one.
    pub(super) fans: Vec<(Intersection, DirectionFan)>,
    pub(super) reach: f64,
}

/// A point that the camera sees.
#[derive(Clone, Copy)]
struct Seen {
    x: u32,
    y: u32,
    /// Off the surface, so that rays in `f32` do not meet it again.
    point: DVec3,
    normal: DVec3,
    incoming: DVec3,
    at: Intersection,
}

/// How far rays start off the surface, of the scene's diagonal: a hundred steps of `f32`. Nearer, some meet the
/// surface that they leave; further, they miss what touches it.
const OFF_SURFACE: f64 = 1e-5;

/// AO rays at most; more only make the run longer.
const MOST_AO_RAYS: usize = 2_000_000;

/// Directions of ambient occlusion on the whole sphere: 64 above the horizon.
const AO_DIRECTIONS: u32 = 128;

/// The lots of one stage.
pub(super) fn lots(stage: &Stage, world: &World) -> Result<Vec<Lot>, Failure> {
    let projection = stage.scene.camera.project(WIDTH, HEIGHT)?;
    let camera_ray = |&(x, y): &(u32, u32)| {
        let ray = projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        Ray { origin: rounded(ray.origin), direction: rounded(ray.direction), ..ray }
    };
    let pixels: Vec<(u32, u32)> = pixels_in_tiles().collect();
    let primary: Vec<Ray> = pixels.iter().map(camera_ray).collect();
    let seen: Vec<Option<Seen>> = pixels
        .par_iter()
        .zip(&primary)
        .map(|(&(x, y), ray)| {
            let at = world.intersection(ray, &world.intersect(ray)?);
            let normal = at.facing_geometric_normal();
            let point = rounded(at.point + normal * (OFF_SURFACE * stage.diagonal));
            Some(Seen { x, y, point, normal, incoming: ray.direction, at })
        })
        .collect();
    let light = rounded(stage.scene.lights[0].position);
    let shadow = |seen: &Seen| Ray { t_max: 1.0, ..exact(seen.point, light - seen.point) };
    let mirror = |seen: &Seen| exact(seen.point, reflect(seen.incoming, seen.normal));
    let every = |index: usize| index as u32;
    let whole: Vec<Packet> = (0..primary.len())
        .step_by(LANES)
        .map(|first| std::array::from_fn(|lane| every(first + lane)))
        .collect();
    Ok(vec![
        Lot::new(Kind::Primary, primary, whole),
        secondary(Kind::Shadow, &seen, shadow),
        secondary(Kind::Mirror, &seen, mirror),
        ambient_occlusion(&seen, stage.scene.settings.ao.distance),
    ])
}

/// All pixels by tiles of 8 x 8, in each by blocks of 4 x 4, in each row by row.
pub(super) fn pixels_in_tiles() -> impl Iterator<Item = (u32, u32)> {
    let starts = |length: u32| (0..length).step_by(8);
    let in_block = |width: u32, side: u32| (0..side).flat_map(move |y| (0..width).map(move |x| (x, y)));
    starts(HEIGHT).flat_map(move |y| starts(WIDTH).map(move |x| (x, y))).flat_map(move |(x, y)| {
        in_block(2, 2)
            .flat_map(move |(i, j)| in_block(4, 4).map(move |(u, v)| (x + 4 * i + u, y + 4 * j + v)))
    })
}

/// One ray from each point that is seen; lanes of pixels that see nothing stay empty.
fn secondary(kind: Kind, seen: &[Option<Seen>], ray: impl Fn(&Seen) -> Ray) -> Lot {
    let mut rays = Vec::new();
    let mut packets = Vec::new();
    for block in seen.chunks_exact(LANES) {
        let mut packet = [EMPTY; LANES];
        for (lane, seen) in block.iter().enumerate() {
            if let Some(seen) = seen {
                packet[lane] = rays.len() as u32;
                rays.push(ray(seen));
            }
        }
        packets.push(packet);
    }
    packets.retain(is_used);
    Lot::new(kind, rays, packets)
}

impl Lot {
    fn new(kind: Kind, rays: Vec<Ray>, packets: Vec<Packet>) -> Self {
        let filled = packets.iter().map(|packet| filled(&rays, packet)).collect();
        let groupings = vec![("4x4 pixels", packets)];
        Self { kind, rays, groupings, packets: filled, fans: Vec::new(), reach: f64::INFINITY }
    }
}

/// The rays of a packet, and the lanes that are used.
fn filled(rays: &[Ray], packet: &Packet) -> (RayPacket, u32) {
    let first = packet.iter().find(|&&lane| lane != EMPTY).map_or(0, |&ray| ray as usize);
    let mut filled = RayPacket::splat(&rays[first]);
    let mut wanted = 0;
    for (lane, &ray) in packet.iter().enumerate().filter(|&(_, &ray)| ray != EMPTY) {
        filled.set(lane, &rays[ray as usize]);
        wanted |= 1 << lane;
    }
    (filled, wanted)
}

impl Seen {
    /// The point as a place to leave from, without a step further off.
    fn leaving(&self) -> Intersection {
        Intersection {
            point: self.point,
            point_error: DVec3::ZERO,
            geometric_normal: self.normal,
            shading_normal: self.normal,
            from_inside: false,
            ..self.at
        }
    }
}

fn is_used(packet: &Packet) -> bool {
    packet.iter().any(|&lane| lane != EMPTY)
}

/// The directions above the horizon of points in some of the tiles, as many as [`MOST_AO_RAYS`] allow.
fn ambient_occlusion(seen: &[Option<Seen>], reach: f64) -> Lot {
    const TILE: usize = 4 * LANES;
    let lattice = HemisphereLattice::new(AO_DIRECTIONS);
    let points = seen.iter().flatten().count();
    let every = (points * AO_DIRECTIONS as usize / 2).div_ceil(MOST_AO_RAYS).max(1);
    let mut rays = Vec::new();
    let mut fans = Vec::new();
    let mut of_one_point = Vec::new();
    let mut same_index = Vec::new();
    let mut by_direction = Vec::new();
    // Every so many of the tiles that see anything, over the whole image.
    let tiles = seen.chunks_exact(TILE).filter(|tile| tile.iter().any(Option::is_some)).step_by(every);
    for tile in tiles {
        let first_of_tile = rays.len();
        for block in tile.chunks_exact(LANES) {
            // By index of the lattice, one lane a pixel.
            let mut across = vec![[EMPTY; LANES]; AO_DIRECTIONS as usize];
            for (lane, seen) in block.iter().enumerate() {
                let Some(seen) = seen else { continue };
                let first = rays.len();
                let around = directions::around(&lattice, seen.normal, seen.x, seen.y);
                fans.extend(around.iter().map(|fan| (seen.leaving(), fan.clone())));
                let around = around.iter().flat_map(|fan| (0..fan.count).map(|i| fan.direction(i)));
                for (index, direction) in around.enumerate() {
                    across[index][lane] = rays.len() as u32;
                    rays.push(Ray { t_max: reach, ..exact(seen.point, direction) });
                }
                of_one_point.extend(packets_of(&(first..rays.len()).collect::<Vec<_>>()));
            }
            same_index.extend(across.into_iter().filter(is_used));
        }
        let mut all: Vec<usize> = (first_of_tile..rays.len()).collect();
        all.sort_by_key(|&ray| {
            crate::embree::occlusion::direction_bin(rays[ray].direction.as_vec3().to_array())
        });
        by_direction.extend(packets_of(&all));
    }
    let groupings =
        vec![("one point", of_one_point), ("4x4 same index", same_index), ("8x8 by direction", by_direction)];
    Lot { kind: Kind::AmbientOcclusion, rays, groupings, packets: Vec::new(), fans, reach }
}

/// As many full packets as there are, and a last one.
fn packets_of(rays: &[usize]) -> impl Iterator<Item = Packet> {
    rays.chunks(LANES)
        .map(|chunk| std::array::from_fn(|lane| chunk.get(lane).map_or(EMPTY, |&ray| ray as u32)))
}

fn exact(origin: DVec3, direction: DVec3) -> Ray {
    Ray::new(rounded(origin), rounded(direction))
}

fn rounded(vector: DVec3) -> DVec3 {
    vector.as_vec3().as_dvec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_pixels_in_a_row_are_a_block_and_every_pixel_comes_once() {
        let pixels: Vec<_> = pixels_in_tiles().collect();
        for block in pixels.chunks_exact(LANES) {
            assert!(block.iter().all(|&(x, y)| (x / 4, y / 4) == (block[0].0 / 4, block[0].1 / 4)));
        }
        let mut sorted = pixels.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!((pixels.len(), sorted.len()), ((WIDTH * HEIGHT) as usize, (WIDTH * HEIGHT) as usize));
    }
}
