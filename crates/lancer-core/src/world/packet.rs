//! Rays that are traced together.

use super::geometry::Geometry;
use super::sheaf::Sheaf;
use super::{Face, Hits, Object, ObjectId, ObjectIndex, World};
use crate::accel::bvh::Child;
use crate::accel::triangles::{Beam, DONE, Lane, NarrowPacket, ReadyRays, Visitor, walk_packet};
use crate::accel::{Uncounted, bits};
use crate::geometry::packet::TOGETHER;
use crate::geometry::{Placement, Ray, RayPacket};
use crate::shape::{self, cube, cylinder, plane, sphere};
use fearless_simd::{Level, dispatch};

const LANES: usize = RayPacket::LANES;

impl World {
    /// The nearest hits of the rays `wanted` of a packet, a bit for each: what [`World::intersect`] finds, found
    /// faster where the rays go much the same way.
    pub fn intersect_packet(&self, rays: &RayPacket, wanted: u32, scratch: &mut PacketScratch) -> Hits {
        let mut best = Hits::NONE;
        // A hit at the same t is looked at too: the lower object is to win.
        let mut up_to = rays.t_max;
        let PacketScratch { narrow, local } = scratch;
        local.frame = None;
        let visited = self.visit_objects_of_packet(rays, wanted, narrow, |id, object, lanes, t_max| {
            let hits = object.intersect_packet(rays, local, &up_to, lanes, self);
            dispatch!(self.level, _simd => best.keep_nearer(id, &hits, lanes, t_max, &mut up_to));
            0
        });
        for lane in bits(wanted & !visited) {
            best.put(lane, self.intersect(&rays.ray(lane)));
        }
        best
    }

    /// Which of the rays `wanted` of a packet meet anything, as [`World::occluded`] tells. `left` are the faces that
    /// rays start from, as [`Intersection::face_left_for`](super::Intersection::face_left_for) knows them: triangles
    /// among them need no test, which would be too close to tell.
    pub fn occluded_packet(
        &self,
        rays: &RayPacket,
        wanted: u32,
        left: &[Option<Face>; LANES],
        scratch: &mut PacketScratch,
    ) -> u32 {
        let mut occluded = 0;
        let PacketScratch { narrow, local } = scratch;
        local.frame = None;
        let visited = self.visit_objects_of_packet(rays, wanted, narrow, |id, object, lanes, _| {
            let own = left.map(|face| face.filter(|face| face.object == id).map(|face| face.primitive));
            let hit = object.occluded_packet(rays, local, lanes, &own, self);
            occluded |= hit;
            hit
        });
        for lane in bits(wanted & !visited) {
            occluded |= u32::from(self.occluded(&rays.ray(lane))) << lane;
        }
        occluded
    }

    /// Which of the rays `wanted` of a packet may meet anything but the objects `excluded`, of which each ray has one.
    pub(super) fn may_meet_others(
        &self,
        rays: &RayPacket,
        wanted: u32,
        excluded: &[ObjectId; LANES],
        scratch: &mut PacketScratch,
    ) -> u32 {
        let mut met = 0;
        let PacketScratch { narrow, local } = scratch;
        local.frame = None;
        let visited = self.visit_objects_of_packet(rays, wanted, narrow, |id, object, lanes, _| {
            let others =
                bits(lanes).filter(|&lane| excluded[lane] != id).fold(0, |set, lane| set | 1 << lane);
            if others != 0 {
                met |= object.occluded_packet(rays, local, others, &[None; LANES], self);
            }
            met
        });
        met | wanted & !visited
    }

    /// Calls `visit` with the objects that some of the rays `wanted` may meet, and with which. It may lower the t up
    /// to which a ray's hits still count, and returns the rays that are done with. Returns the rays that it was called
    /// for: the others are to be traced one by one.
    fn visit_objects_of_packet(
        &self,
        rays: &RayPacket,
        wanted: u32,
        packet: &mut NarrowPacket,
        mut visit: impl FnMut(ObjectId, &Object, u32, &mut [f64; LANES]) -> u32,
    ) -> u32 {
        let ObjectIndex::Bvh(tree) = &self.index else { return 0 };
        let mut t_max = rays.t_max;
        let mut open = wanted;
        let mut visit = |id: ObjectId, lanes: u32, t_max: &mut [f64; LANES]| {
            open &= !visit(id, self.object(id), lanes, t_max);
            open
        };
        let mut left = wanted;
        for &id in &self.unbounded {
            if left != 0 {
                left = visit(id, left, &mut t_max);
            }
        }
        if left == 0 {
            return wanted;
        }
        if self.bounded.len() <= Self::FEW_FOR_PACKETS {
            // What is all there is looks at its own bounds.
            let sheaf = (self.objects.len() > 1)
                .then(|| dispatch!(self.level, simd => Sheaf::around(simd, rays, &t_max, left)));
            for (&id, bounds) in self.bounded.iter().zip(&self.boxes) {
                if left != 0 && sheaf.as_ref().is_none_or(|sheaf| sheaf.may_meet(bounds)) {
                    left = visit(id, left, &mut t_max);
                }
            }
            return wanted;
        }
        let rays = RayPacket { t_max, ..rays.clone() };
        let mut out_of_range = 0;
        dispatch!(self.level, simd => {
            packet.prepare(&rays, &self.bounds);
            out_of_range = packet.out_of_range & left;
            let mut open = packet.ready & left;
            let objects = &self.bounded;
            let packet = &*packet;
            let mut visitor = Leaves { packet, visit: |leaf: Child, mut lanes, t_max: &mut [f64; LANES]| {
                for &candidate in &tree.order()[leaf.first()..leaf.first() + leaf.count()] {
                    lanes &= visit(objects[candidate as usize], lanes, t_max);
                }
                lanes
            }, t_max };
            while let Some((group, backward)) = packet.octant(simd, &mut open) {
                let mut end = packet.ends_of(simd, group);
                walk_packet(simd, tree.nodes(), packet, group, backward, &mut end, &mut visitor);
            }
        });
        wanted & !out_of_range
    }
}

/// Shows the leaves of the tree over the objects to a closure, which returns the rays that still want anything.
struct Leaves<'a, F> {
    packet: &'a NarrowPacket,
    visit: F,
    t_max: [f64; LANES],
}

impl<F: FnMut(Child, u32, &mut [f64; LANES]) -> u32> Visitor for Leaves<'_, F> {
    /// What a ray alone costs is spent in the objects.
    const ALONE: u32 = 0;

    #[inline(always)]
    fn visit(&mut self, leaf: Child, lanes: u32, _beam: &Beam, end: &mut Lane) {
        let open = (self.visit)(leaf, lanes, &mut self.t_max);
        for lane in bits(lanes) {
            let wanted = open >> lane & 1 == 1;
            end[lane] = if wanted { self.packet.up_to(lane, self.t_max[lane]) } else { DONE };
        }
    }
}

/// Memory that packets leave to the next; what is in it makes no difference. To fill it with zeros for each packet would
/// take some hundredths of a picture's time.
#[derive(Clone, Debug, Default)]
pub struct PacketScratch {
    /// The rays in the world, ready for the tree over the objects.
    narrow: NarrowPacket,
    local: Local,
}

/// Rays in the space of the object that was looked at last.
#[derive(Clone, Debug, Default)]
struct Local {
    /// The frame that they are ready for.
    frame: Option<u32>,
    ready: ReadyRays,
}

impl Local {
    /// Carries rays to a mesh, unless they are there, and lets hits count up to `up_to`, which has not grown.
    fn prepare(&mut self, rays: &RayPacket, up_to: &[f64; LANES], object: &Object, world: &World) {
        let known = self.frame == Some(object.frame);
        self.frame = Some(object.frame);
        let ready = &mut self.ready;
        dispatch!(world.level, _simd => {
            if known {
                ready.shorten(up_to);
            } else {
                object.placement.rays_to_object(rays, &mut ready.rays);
                ready.rays.t_max = *up_to;
                ready.prepare(&world.frames[object.frame as usize]);
            }
        });
    }
}

impl Object {
    /// The nearest hits of the rays `wanted`, each with t in (0, `up_to`); nothing of use in the other lanes.
    fn intersect_packet(
        &self,
        rays: &RayPacket,
        local: &mut Local,
        up_to: &[f64; LANES],
        wanted: u32,
        world: &World,
    ) -> shape::Hits {
        if let Some(tree) = self.geometry.triangle_tree(&world.meshes) {
            local.prepare(rays, up_to, self, world);
            return tree.intersect_packet(&local.ready, wanted);
        }
        if wanted.count_ones() >= TOGETHER
            && let Some(nearest) = self.nearest_on_shape(world.level, rays, up_to)
        {
            return nearest;
        }
        let mut hits = shape::Hits::NONE;
        for lane in bits(wanted) {
            let ray = Ray { t_max: up_to[lane], ..self.placement.ray_to_object(&rays.ray(lane)) };
            hits.put_found(lane, self.geometry.intersect(&ray, &world.meshes, &Uncounted));
        }
        hits
    }

    /// Which of the rays `wanted` it stops; none of a mesh's by the ray's own triangle.
    fn occluded_packet(
        &self,
        rays: &RayPacket,
        local: &mut Local,
        wanted: u32,
        own: &[Option<u32>; LANES],
        world: &World,
    ) -> u32 {
        if let Some(tree) = self.geometry.triangle_tree(&world.meshes) {
            local.prepare(rays, &rays.t_max, self, world);
            return tree.occluded_packet(&local.ready, wanted, own);
        }
        if wanted.count_ones() >= TOGETHER
            && let Some(nearest) = self.nearest_on_shape(world.level, rays, &rays.t_max)
        {
            return nearest.lanes() & wanted;
        }
        bits(wanted)
            .filter(|&lane| {
                let ray = self.placement.ray_to_object(&rays.ray(lane));
                self.geometry.occluded(&ray, &world.meshes, &Uncounted)
            })
            .fold(0, |hit, lane| hit | 1 << lane)
    }

    /// Where each ray meets a canonical shape first, infinite where that is not before `up_to`; none of a mesh.
    fn nearest_on_shape(&self, level: Level, rays: &RayPacket, up_to: &[f64; LANES]) -> Option<shape::Hits> {
        let place = &self.placement;
        Some(match self.geometry {
            Geometry::Sphere => dispatch!(level, _simd => nearest(place, rays, up_to, sphere::nearest)),
            Geometry::Cube => dispatch!(level, _simd => nearest(place, rays, up_to, cube::nearest)),
            Geometry::Cylinder { capped } => {
                dispatch!(level, _simd => nearest(place, rays, up_to, |ray| cylinder::nearest(ray, capped)))
            }
            Geometry::Plane => dispatch!(level, _simd => nearest(place, rays, up_to, plane::nearest)),
            Geometry::Mesh(_) => return None,
        })
    }
}

/// What `of_shape` finds for each ray, with t below `up_to`: the scalar function, of which the compiler makes vector code.
#[inline(always)]
fn nearest(
    placement: &Placement,
    rays: &RayPacket,
    up_to: &[f64; LANES],
    of_shape: impl Fn(&Ray) -> shape::Hit,
) -> shape::Hits {
    let mut nearest = shape::Hits::NONE;
    for (lane, &t_max) in up_to.iter().enumerate() {
        nearest.put(lane, of_shape(&Ray { t_max, ..placement.ray_to_object(&rays.ray(lane)) }));
    }
    nearest
}
