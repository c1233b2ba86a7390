//! Lancer's side of the comparison by ray kind: the one place to change when Lancer learns to trace many rays at
//! once.

use lancer_core::geometry::Ray;
use lancer_core::world::{Hit, World};

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
