//! A hit with everything that shading wants to know of it.

use super::{Hit, Object, ObjectId, World};
use crate::color::Rgb;
use crate::geometry::error::{ray_from_surface, segment_from_surface, stands_off};
use crate::geometry::{DVec2, DVec3, Placement, Ray, RayPacket};
use crate::scene::MaterialId;
use crate::shape::{self, SurfacePoint, SurfacePoints};
use fearless_simd::dispatch;

const LANES: usize = RayPacket::LANES;

/// So many hits with an object are worth vector code. Untuned.
const TOGETHER: usize = 3;

/// A triangle or another face of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Which object's.
    pub object: ObjectId,
    /// Which of its faces or triangles.
    pub primitive: u32,
}

/// Where a ray meets a surface, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection {
    /// The ray's parameter.
    pub t: f64,
    /// The point, as near to the surface as rounding allows.
    pub point: DVec3,
    /// How far from the surface it may lie, by axis; see [`crate::geometry::error::leave_surface`].
    pub point_error: DVec3,
    /// The outward unit normal of the surface.
    pub geometric_normal: DVec3,
    /// The outward unit normal for shading.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
    /// The interpolated vertex colour of a mesh that has them, else white: S is the material's colour times this.
    pub vertex_color: Rgb,
    /// What was hit.
    pub object: ObjectId,
    /// Which face or triangle of it.
    pub primitive: u32,
    /// Its material.
    pub material: MaterialId,
    /// Whether the ray came from the inner side, against the outward normal.
    pub from_inside: bool,
}

impl Intersection {
    pub(super) fn new(world: &World, ray: &Ray, hit: &Hit) -> Self {
        let object = world.object(hit.object);
        let ray = object.placement.ray_to_object(ray);
        let local_hit = shape::Hit { t: hit.t, primitive: hit.primitive };
        let local = object.geometry.surface(&ray, &local_hit, &world.meshes);
        let surface = to_world(&object.placement, &local);
        Self::at(object, hit, &surface, is_from_inside(&local, &ray))
    }

    fn at(object: &Object, hit: &Hit, surface: &SurfacePoint, from_inside: bool) -> Self {
        Self {
            t: hit.t,
            point: surface.point,
            point_error: surface.point_error,
            geometric_normal: surface.geometric_normal,
            shading_normal: surface.shading_normal,
            uv: surface.uv,
            vertex_color: surface.vertex_color,
            object: hit.object,
            primitive: hit.primitive,
            material: object.material,
            from_inside,
        }
    }

    /// The geometric normal on the side that the ray came from.
    pub fn facing_geometric_normal(&self) -> DVec3 {
        if self.from_inside { -self.geometric_normal } else { self.geometric_normal }
    }

    /// N of the illumination model: the shading normal on the side that the ray came from.
    pub fn facing_normal(&self) -> DVec3 {
        if self.from_inside { -self.shading_normal } else { self.shading_normal }
    }

    /// The ray that leaves this surface in `direction`, to whichever side that is.
    pub fn spawn(&self, direction: DVec3) -> Ray {
        ray_from_surface(self.point, self.point_error, self.geometric_normal, direction)
    }

    /// The segment that leaves this surface and ends at `target`; t runs from 0 to 1.
    pub fn segment_to(&self, target: DVec3) -> Ray {
        segment_from_surface(self.point, self.point_error, self.geometric_normal, target)
    }

    /// The face that the point lies on, if the target stands clearly off the plane that touches it there: a flat face, as
    /// a triangle is, cannot then be met by [`Intersection::segment_to`] that target, which starts off the face and rises.
    /// None where rounding could hide on which side of the plane the target is.
    pub fn face_left_for(&self, target: DVec3) -> Option<Face> {
        stands_off(self.point, self.point_error, self.geometric_normal, target).then_some(self.face())
    }

    /// The face that the point lies on.
    pub fn face(&self) -> Face {
        Face { object: self.object, primitive: self.primitive }
    }
}

impl World {
    /// Puts the surfaces at hits of a packet into `found`, which is empty: each as [`World::intersection`] finds it.
    pub(crate) fn intersections(
        &self,
        rays: &RayPacket,
        hits: &[Option<Hit>; LANES],
        found: &mut [Option<Intersection>; LANES],
    ) {
        for lane in 0..LANES {
            let Some(hit) = hits[lane].filter(|_| found[lane].is_none()) else { continue };
            let alike = |other: &Option<Hit>| other.filter(|other| other.object == hit.object);
            let hits = hits.each_ref().map(alike);
            if hits.iter().flatten().count() >= TOGETHER {
                self.intersections_with(self.object(hit.object), rays, &hits, found);
            } else {
                found[lane] = Some(self.intersection(&rays.ray(lane), &hit));
            }
        }
    }

    /// Adds the surfaces at hits with one object.
    fn intersections_with(
        &self,
        object: &Object,
        rays: &RayPacket,
        hits: &[Option<Hit>; LANES],
        found: &mut [Option<Intersection>; LANES],
    ) {
        let mut from_inside = [false; LANES];
        let mut surfaces = SurfacePoints::default();
        dispatch!(self.level, _simd => {
            let rays = object.placement.rays_to_object(rays);
            object.geometry.surfaces(&rays, hits, &self.meshes, &mut surfaces);
            for (lane, from_inside) in from_inside.iter_mut().enumerate() {
                let surface = surfaces.at(lane);
                *from_inside = is_from_inside(&surface, &rays.ray(lane));
                surfaces.put(lane, &to_world(&object.placement, &surface));
            }
        });
        for lane in 0..LANES {
            if let Some(hit) = &hits[lane] {
                found[lane] = Some(Intersection::at(object, hit, &surfaces.at(lane), from_inside[lane]));
            }
        }
    }
}

/// A surface of an object in the world, its normals of length 1.
#[inline(always)]
fn to_world(placement: &Placement, surface: &SurfacePoint) -> SurfacePoint {
    let geometric_normal = placement.normal_to_world(surface.geometric_normal);
    // Most often they are one.
    let shading_normal = match surface.shading_normal == surface.geometric_normal {
        true => geometric_normal,
        false => placement.normal_to_world(surface.shading_normal),
    };
    SurfacePoint {
        point: placement.point_to_world(surface.point),
        point_error: placement.error_in_world(surface.point, surface.point_error),
        geometric_normal,
        shading_normal,
        ..*surface
    }
}

/// Whether a ray meets a surface from its inner side, both in the object's space: the inverse transpose keeps the sign
/// of this product, so it is taken where it is most exact.
#[inline(always)]
fn is_from_inside(surface: &SurfacePoint, ray: &Ray) -> bool {
    surface.geometric_normal.dot(ray.direction) > 0.0
}
