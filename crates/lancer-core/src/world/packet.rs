//! Rays that are traced together.

use super::geometry::{Geometry, TriangleIndex};
use super::{Hit, Object, ObjectId, ObjectIndex, World};
use crate::accel::bvh::Child;
use crate::accel::triangles::{DONE, Lane, NarrowPacket, Visitor, walk_packet};
use crate::accel::{Uncounted, bits};
use crate::geometry::RayPacket;
use crate::shape::{self, sphere};
use fearless_simd::dispatch;
use std::hint::black_box;

const LANES: usize = RayPacket::LANES;

impl World {
    /// The nearest hits of the rays `wanted` of a packet, a bit for each: what [`World::intersect`] finds, found
    /// faster where the rays go much the same way.
    pub fn intersect_packet(&self, rays: &RayPacket, wanted: u32) -> [Option<Hit>; LANES] {
        let mut best: [Option<Hit>; LANES] = [None; LANES];
        let visited = self.visit_objects_of_packet(rays, wanted, |id, object, lanes, t_max| {
            let mut local = object.placement.rays_to_object(rays);
            for (t_max, best) in local.t_max.iter_mut().zip(&best) {
                // A hit at the same t is looked at too: the lower object is to win.
                *t_max = best.map_or(*t_max, |hit| hit.t.next_up());
            }
            let hits = object.geometry.intersect_packet(&local, lanes, self);
            for lane in bits(lanes) {
                let Some(shape::Hit { t, primitive }) = hits[lane] else { continue };
                if best[lane].is_none_or(|best| (t, id) < (best.t, best.object)) {
                    best[lane] = Some(Hit { t, object: id, primitive });
                    t_max[lane] = t;
                }
            }
        });
        for lane in bits(wanted & !visited) {
            best[lane] = self.intersect(&rays.ray(lane));
        }
        best
    }

    /// Reads the corners of the triangles that were hit: memory then answers for all of them together, where surfaces
    /// that are found one by one would wait for each.
    pub(crate) fn fetch(&self, hits: &[Option<Hit>; LANES]) {
        for hit in hits.iter().flatten() {
            if let Geometry::Mesh(mesh) = self.object(hit.object).geometry {
                black_box(self.meshes[mesh as usize].mesh.vertices(hit.primitive));
            }
        }
    }

    /// Which of the rays `wanted` of a packet meet anything, as [`World::occluded`] tells.
    pub fn occluded_packet(&self, rays: &RayPacket, wanted: u32) -> u32 {
        let mut occluded = 0;
        let visited = self.visit_objects_of_packet(rays, wanted, |_, object, lanes, t_max| {
            let local = object.placement.rays_to_object(rays);
            let hit = object.geometry.occluded_packet(&local, lanes, self);
            occluded |= hit;
            for lane in bits(hit) {
                t_max[lane] = f64::NEG_INFINITY;
            }
        });
        for lane in bits(wanted & !visited) {
            occluded |= u32::from(self.occluded(&rays.ray(lane))) << lane;
        }
        occluded
    }

    /// Calls `visit` with the objects that some of the rays `wanted` may meet, and with which. It may lower the t up
    /// to which a ray's hits still count, to `f64::NEG_INFINITY` to end it. Returns the rays that it was done for:
    /// the others are to be traced one by one.
    fn visit_objects_of_packet(
        &self,
        rays: &RayPacket,
        wanted: u32,
        mut visit: impl FnMut(ObjectId, &Object, u32, &mut [f64; LANES]),
    ) -> u32 {
        let ObjectIndex::Bvh { tree, level } = &self.index else { return 0 };
        let mut t_max = rays.t_max;
        let mut open = wanted;
        let mut visit = |id: ObjectId, lanes: u32, t_max: &mut [f64; LANES]| {
            visit(id, self.object(id), lanes, t_max);
            for lane in bits(lanes) {
                open &= !(u32::from(t_max[lane] == f64::NEG_INFINITY) << lane);
            }
            open
        };
        let mut left = wanted;
        let one_by_one: &[ObjectId] = if self.bounded.len() <= Self::FEW { &self.bounded } else { &[] };
        for &id in self.unbounded.iter().chain(one_by_one) {
            if left != 0 {
                left = visit(id, left, &mut t_max);
            }
        }
        if !one_by_one.is_empty() || self.bounded.is_empty() || left == 0 {
            return wanted;
        }
        let rays = RayPacket { t_max, ..rays.clone() };
        let mut out_of_range = 0;
        dispatch!(*level, simd => {
            let packet = NarrowPacket::new(&rays, left, &self.bounds);
            out_of_range = packet.out_of_range;
            let mut open = packet.ready;
            let objects = &self.bounded;
            let mut visitor = Leaves { packet: &packet, visit: |leaf: Child, mut lanes, t_max: &mut [f64; LANES]| {
                for &candidate in &tree.order()[leaf.first()..leaf.first() + leaf.count()] {
                    lanes &= visit(objects[candidate as usize], lanes, t_max);
                }
            }, t_max };
            while let Some((group, backward)) = packet.octant(&mut open) {
                let mut end = packet.ends_of(group);
                walk_packet(simd, tree.nodes(), &packet, group, backward, &mut end, &mut visitor);
            }
        });
        wanted & !out_of_range
    }
}

/// Shows the leaves of the tree over the objects to a closure.
struct Leaves<'a, F> {
    packet: &'a NarrowPacket,
    visit: F,
    t_max: [f64; LANES],
}

impl<F: FnMut(Child, u32, &mut [f64; LANES])> Visitor for Leaves<'_, F> {
    /// What a ray alone costs is spent in the objects.
    const ALONE: u32 = 0;

    #[inline(always)]
    fn visit(&mut self, leaf: Child, lanes: u32, end: &mut Lane) {
        (self.visit)(leaf, lanes, &mut self.t_max);
        for lane in bits(lanes) {
            let over = self.t_max[lane] == f64::NEG_INFINITY;
            end[lane] = if over { DONE } else { self.packet.up_to(lane, self.t_max[lane]) };
        }
    }
}

impl Geometry {
    fn intersect_packet(self, rays: &RayPacket, wanted: u32, world: &World) -> [Option<shape::Hit>; LANES] {
        if let Self::Mesh(mesh) = self
            && let TriangleIndex::Bvh(tree) = &world.meshes[mesh as usize].index
        {
            return tree.intersect_packet(rays, wanted);
        }
        let mut hits = [None; LANES];
        for lane in bits(wanted & self.may_meet(rays)) {
            hits[lane] = self.intersect(&rays.ray(lane), &world.meshes, &Uncounted);
        }
        hits
    }

    /// The rays that a quick look at all of them together does not rule out.
    fn may_meet(self, rays: &RayPacket) -> u32 {
        match self {
            Self::Sphere => sphere::may_meet(rays),
            _ => u32::MAX,
        }
    }

    fn occluded_packet(self, rays: &RayPacket, wanted: u32, world: &World) -> u32 {
        if let Self::Mesh(mesh) = self
            && let TriangleIndex::Bvh(tree) = &world.meshes[mesh as usize].index
        {
            return tree.occluded_packet(rays, wanted);
        }
        bits(wanted & self.may_meet(rays))
            .filter(|&lane| self.occluded(&rays.ray(lane), &world.meshes, &Uncounted))
            .fold(0, |hit, lane| hit | 1 << lane)
    }
}
