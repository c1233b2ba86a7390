//! Lancer's side of the comparison by ray kind.

use lancer_core::geometry::{DirectionFan, Ray, RayPacket};
use lancer_core::world::{FanScratch, Hit, Intersection, PacketScratch, World};

/// Finds the nearest hit of each ray. `hits` is emptied first; its memory is used again.
pub(super) fn intersect(world: &World, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
    hits.clear();
    hits.extend(rays.iter().map(|ray| world.intersect(ray)));
}

/// Finds whether each ray meets anything. `blocked` is emptied first; its memory is used again.
pub(super) fn occluded(world: &World, rays: &[Ray], blocked: &mut Vec<bool>) {
    blocked.clear();
    blocked.extend(rays.iter().map(|ray| world.occluded(ray)));
}

/// Finds the nearest hit of each ray of each packet; see [`intersect`].
pub(super) fn intersect_packets(world: &World, packets: &[(RayPacket, u32)], hits: &mut Vec<Option<Hit>>) {
    hits.clear();
    let mut scratch = PacketScratch::default();
    for (rays, wanted) in packets {
        let found = world.intersect_packet(rays, *wanted, &mut scratch);
        let lanes = (0..RayPacket::LANES).filter(|lane| wanted >> lane & 1 == 1);
        hits.extend(lanes.map(|lane| found.at(lane)));
    }
}

/// Finds whether each ray of each packet meets anything; see [`occluded`].
pub(super) fn occluded_packets(world: &World, packets: &[(RayPacket, u32)], blocked: &mut Vec<bool>) {
    blocked.clear();
    let mut scratch = PacketScratch::default();
    for (rays, wanted) in packets {
        let occluded = world.occluded_packet(rays, *wanted, &[None; RayPacket::LANES], &mut scratch);
        let lanes = (0..RayPacket::LANES).filter(|lane| wanted >> lane & 1 == 1);
        blocked.extend(lanes.map(|lane| occluded >> lane & 1 == 1));
    }
}

/// Finds whether each ray of each point meets anything. `blocked` is emptied first; its memory is used again.
pub(super) fn occluded_fans(
    world: &World,
    fans: &[(Intersection, DirectionFan)],
    reach: f64,
    blocked: &mut Vec<bool>,
) {
    blocked.clear();
    let mut scratch = FanScratch::default();
    for (at, fan) in fans {
        let occluded = world.occluded_fan(at, fan, reach, &mut scratch);
        blocked.extend((0..fan.count).map(|i| occluded >> i & 1 == 1));
    }
}
