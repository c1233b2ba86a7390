//! Lancer's side of the comparison by ray kind.

use lancer_core::geometry::{DirectionFan, Ray};
use lancer_core::world::{Hit, Intersection, World};

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

/// Finds whether each ray of each point meets anything. `blocked` is emptied first; its memory is used again.
pub(super) fn occluded_fans(
    world: &World,
    fans: &[(Intersection, DirectionFan)],
    reach: f64,
    blocked: &mut Vec<bool>,
) {
    blocked.clear();
    for (at, fan) in fans {
        let occluded = world.occluded_fan(at, fan, reach);
        blocked.extend((0..fan.count).map(|i| occluded >> i & 1 == 1));
    }
}
