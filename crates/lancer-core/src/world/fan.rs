//! Many short rays from one point.

use super::{Intersection, Object, ObjectId, ObjectIndex, World};
use crate::accel::bvh::Child;
use crate::accel::triangles::{Fan, MeshFanScratch, Receiver, visit_fan};
use crate::accel::{Tally, Uncounted, bits};
use crate::geometry::{DMat3, DVec3, DirectionFan, Ray};
use crate::shape::triangle::Canonical;
use fearless_simd::dispatch;

/// An elevation that no rounding makes negative.
const CLEARLY_ABOVE: f64 = 1e-9;

/// So many directions or fewer go through a mesh one by one: a fan costs some time to make ready. Untuned.
const ALONE: u32 = 6;

impl World {
    /// Which of the rays that leave a surface in the directions of a fan meet anything nearer than `reach`: a bit
    /// for each. The fan's normal must be [`Intersection::facing_normal`].
    ///
    /// The answer for each direction is that of [`World::occluded`] for `at.spawn(direction)`; it is only found
    /// faster.
    pub fn occluded_fan(
        &self,
        at: &Intersection,
        fan: &DirectionFan,
        reach: f64,
        scratch: &mut FanScratch,
    ) -> u64 {
        self.occluded_fan_tallied(at, fan, reach, scratch, &Uncounted)
    }

    /// As [`World::occluded_fan`], and tells what it looks at.
    pub(crate) fn occluded_fan_tallied(
        &self,
        at: &Intersection,
        fan: &DirectionFan,
        reach: f64,
        scratch: &mut FanScratch,
        tally: &impl Tally,
    ) -> u64 {
        let wanted = fan.all();
        let mut occluded = 0;
        let mut together = wanted;
        if at.shading_normal != at.geometric_normal || fan.lowest <= CLEARLY_ABOVE {
            // An interpolated normal may have directions above it that go below the surface: their rays start on
            // the other side of it.
            let beneath = dispatch!(self.level, _simd => fan.against(at.geometric_normal));
            together = if at.from_inside { beneath } else { wanted & !beneath };
        }
        let by_objects = match &self.index {
            ObjectIndex::Bvh(_) => true,
            ObjectIndex::Kd(_) | ObjectIndex::None => false,
        };
        if !by_objects {
            together = 0;
        }
        for i in bits(wanted & !together) {
            let ray = Ray { t_max: reach, ..at.spawn(fan.direction(i)) };
            occluded |= u64::from(self.occluded_tallied(&ray, tally)) << i;
        }
        if let Some(first) = bits(together).next() {
            let rays = FanRays { origin: at.spawn(fan.direction(first)).origin, fan, reach, at };
            let mut open = together;
            for &id in &self.unbounded {
                open &= !self.occluded_by(id, &rays, open, &mut scratch.mesh, tally);
            }
            open &= !self.occluded_by_bounded(&rays, open, scratch, tally);
            occluded |= together & !open;
        }
        occluded
    }

    /// Which of the rays `wanted` an object stops.
    fn occluded_by(
        &self,
        id: ObjectId,
        rays: &FanRays,
        wanted: u64,
        scratch: &mut MeshFanScratch,
        tally: &impl Tally,
    ) -> u64 {
        if wanted == 0 {
            return 0;
        }
        let object = self.object(id);
        if wanted.count_ones() > ALONE
            && let Some(tree) = object.geometry.triangle_tree(&self.meshes)
            && let Some(receiver) = rays.receiver(id, object)
        {
            let decide = |i: usize, triangle: &[[f32; 3]; 3]| {
                Canonical::new(&object.placement.ray_to_object(&rays.ray(i))).hits(triangle)
            };
            if let Some(occluded) = tree.occluded_fan(&receiver, rays.fan, wanted, scratch, tally, decide) {
                return occluded;
            }
        }
        let mut occluded = 0;
        for i in bits(wanted) {
            let ray = object.placement.ray_to_object(&rays.ray(i));
            occluded |= u64::from(object.geometry.occluded(&ray, &self.meshes, tally)) << i;
        }
        occluded
    }

    /// Which of the rays `wanted` a bounded object stops.
    fn occluded_by_bounded(
        &self,
        rays: &FanRays,
        wanted: u64,
        scratch: &mut FanScratch,
        tally: &impl Tally,
    ) -> u64 {
        let FanScratch { objects, mesh } = scratch;
        let mut open = wanted;
        let mut found = false;
        if let ObjectIndex::Bvh(tree) = &self.index
            && self.bounded.len() > Self::FEW
        {
            let visit = |leaf: Child, mask: u64| {
                let mut hit = 0;
                for &place in &tree.order()[leaf.first()..leaf.first() + leaf.count()] {
                    hit |= self.occluded_by(self.bounded[place as usize], rays, mask & !hit, mesh, tally);
                }
                open &= !hit;
                hit
            };
            let receiver = rays.in_world();
            found = visit_fan(
                self.level,
                tree.nodes(),
                &self.bounds,
                &receiver,
                rays.fan,
                wanted,
                objects,
                tally,
                visit,
            );
        }
        if !found {
            for &id in &self.bounded {
                open &= !self.occluded_by(id, rays, open, mesh, tally);
            }
        }
        wanted & !open
    }
}

/// Memory that fans leave to the next; what is in it makes no difference.
#[derive(Clone, Debug, Default)]
pub struct FanScratch {
    objects: Fan,
    mesh: MeshFanScratch,
}

/// A fan where it starts.
struct FanRays<'a> {
    origin: DVec3,
    fan: &'a DirectionFan,
    reach: f64,
    at: &'a Intersection,
}

impl FanRays<'_> {
    fn ray(&self, i: usize) -> Ray {
        Ray { origin: self.origin, direction: self.fan.direction(i), t_max: self.reach }
    }

    /// The same in an object's space; none where that is stretched too much for bounds on lengths to be of use.
    fn receiver(&self, id: ObjectId, object: &Object) -> Option<Receiver> {
        let placement = &object.placement;
        let (shortest, longest) = placement.stretch_to_object();
        let stretched = shortest * 100.0 <= longest || !longest.is_finite();
        if stretched {
            return None;
        }
        let scale = 1.0 / longest;
        Some(Receiver {
            point: placement.point_to_object(self.origin),
            normal: placement.covector_to_object(self.at.facing_normal()) * longest,
            from_world: placement.object_from_world() * scale,
            reach: self.reach * longest,
            own: (self.at.object == id).then_some(self.at.primitive),
        })
    }

    fn in_world(&self) -> Receiver {
        Receiver {
            point: self.origin,
            normal: self.at.facing_normal(),
            from_world: DMat3::IDENTITY,
            reach: self.reach,
            own: None,
        }
    }
}
