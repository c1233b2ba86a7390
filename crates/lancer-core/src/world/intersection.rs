//! A hit with everything that shading wants to know of it.

use super::{Hit, Hits, Interface, Media, Object, ObjectId, Touching, World};
use crate::accel::bits;
use crate::color::{Colors, Rgb};
use crate::geometry::error::{ray_from_surface, segment_from_surface, stands_off};
use crate::geometry::packet::TOGETHER;
use crate::geometry::{DVec2, DVec3, Placement, Ray, RayPacket, Vectors, packet};
use crate::scene::{Material, MaterialId};
use crate::shape::{self, SurfacePoint, SurfacePoints};
use fearless_simd::dispatch;

const LANES: usize = RayPacket::LANES;

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
    #[inline]
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

/// The surfaces at hits of a packet, lane by lane as vector instructions want them; where there is no hit, nothing of use.
#[derive(Clone, Debug, Default)]
pub(crate) struct Intersections {
    /// In the world.
    pub(crate) surfaces: SurfacePoints,
    /// See [`Intersection::from_inside`].
    pub(crate) from_inside: [bool; LANES],
    /// S, the surfaces' colours, where they have been looked at.
    pub(crate) colors: Colors,
    hits: Hits,
    /// Memory for the rays in an object's space.
    local: RayPacket,
}

impl Intersections {
    /// Finds the surfaces at hits of a packet, each as [`World::intersection`] finds it, in place of those that were
    /// there: they are too large to be handed on. Unless `with_uv`, texture coordinates may be left out where there is no
    /// texture.
    pub(crate) fn find(&mut self, world: &World, rays: &RayPacket, hits: &Hits, with_uv: bool) {
        self.hits.clone_from(hits);
        let all = hits.lanes();
        let mut open = all;
        while let Some(hit) = bits(open).next().and_then(|lane| hits.at(lane)) {
            let lanes = hits.on(hit.object);
            if lanes.count_ones() < TOGETHER {
                for lane in bits(lanes) {
                    if let Some(hit) = hits.at(lane) {
                        self.put(lane, &world.intersection(&rays.ray(lane), &hit));
                    }
                }
            } else if open == all {
                self.find_on(world, hit.object, rays, hits, with_uv);
            } else {
                let mut others = Self::default();
                others.find_on(world, hit.object, rays, hits, with_uv);
                for lane in bits(lanes) {
                    self.surfaces.put(lane, &others.surfaces.at(lane));
                    self.from_inside[lane] = others.from_inside[lane];
                }
            }
            open &= !lanes;
        }
    }

    /// The surfaces at the hits with one object; nothing of use in the other lanes.
    fn find_on(&mut self, world: &World, id: ObjectId, rays: &RayPacket, hits: &Hits, with_uv: bool) {
        let Self { surfaces, from_inside, local, .. } = self;
        let (object, lanes) = (world.object(id), hits.on(id));
        let with_uv = with_uv || world.material(object.material).color.wants_uv();
        dispatch!(world.level, _simd => {
            object.placement.rays_to_object(rays, local);
            // Lanes without a hit get one of the others': what stood there before may become so small as to be slow.
            let hits = hits.on_object(lanes);
            object.geometry.surfaces(local, &hits, lanes, &world.meshes, with_uv, surfaces);
            for (lane, from_inside) in from_inside.iter_mut().enumerate() {
                let surface = surfaces.at(lane);
                *from_inside = is_from_inside(&surface, &local.ray(lane));
                surfaces.put(lane, &to_world(&object.placement, &surface));
            }
        });
    }

    /// Puts another hit of the same ray, and its surface, in the place of that which was there.
    pub(crate) fn put(&mut self, lane: usize, at: &Intersection) {
        let &Intersection { t, object, primitive, from_inside, .. } = at;
        self.hits.put(lane, Some(Hit { t, object, primitive }));
        self.from_inside[lane] = from_inside;
        let surface = SurfacePoint {
            point: at.point,
            point_error: at.point_error,
            geometric_normal: at.geometric_normal,
            shading_normal: at.shading_normal,
            uv: at.uv,
            vertex_color: at.vertex_color,
        };
        self.surfaces.put(lane, &surface);
    }

    /// The rays that hit, a bit for each.
    pub(crate) fn lanes(&self) -> u32 {
        self.hits.lanes()
    }

    /// What a ray hits.
    #[inline]
    pub(crate) fn at(&self, world: &World, lane: usize) -> Option<Intersection> {
        self.hits.at(lane).map(|hit| {
            let object = world.object(hit.object);
            Intersection::at(object, &hit, &self.surfaces.at(lane), self.from_inside[lane])
        })
    }

    /// What happens to a ray that arrives through `media` at what it hits, which touches others. Opaque surfaces are
    /// taken for those of a medium that is not entered.
    pub(crate) fn interface(
        &self,
        world: &World,
        lane: usize,
        media: &Media,
        touching: &[Touching],
    ) -> Interface {
        let (Some(hit), Some(material)) = (self.hits.at(lane), self.material(world, lane)) else {
            return Interface::default();
        };
        if material.transmit.is_black() {
            return Interface { ior_before: media.ior(world), ior_after: material.ior, media_after: *media };
        }
        media.interface(world, hit.object, self.from_inside[lane], touching)
    }

    /// The face that a ray hits.
    pub(crate) fn face(&self, lane: usize) -> Option<Face> {
        self.hits.at(lane).map(|Hit { object, primitive, .. }| Face { object, primitive })
    }

    /// The material of what a ray hits.
    pub(crate) fn material<'w>(&self, world: &'w World, lane: usize) -> Option<&'w Material> {
        self.hits.at(lane).map(|hit| world.material(world.object(hit.object).material))
    }

    /// Looks at what all rays hit: finds the materials, and the colours of the surfaces.
    pub(crate) fn look<'w>(&mut self, world: &'w World) -> [Option<&'w Material>; LANES] {
        let mut materials = [None; LANES];
        for (lane, looked_at) in materials.iter_mut().enumerate() {
            let Some(material) = self.material(world, lane) else { continue };
            let SurfacePoints { uv: [u, v], vertex_color, .. } = &self.surfaces;
            let color = material.color.color_at(DVec2::new(u[lane], v[lane])) * vertex_color.at(lane);
            self.colors.put(lane, color);
            *looked_at = Some(material);
        }
        materials
    }

    /// See [`Intersection::spawn`].
    #[inline(always)]
    pub(crate) fn spawn(&self, lane: usize, direction: DVec3) -> Ray {
        let of = |vectors: &Vectors| packet::at(vectors, lane);
        let SurfacePoints { point, point_error, geometric_normal, .. } = &self.surfaces;
        ray_from_surface(of(point), of(point_error), of(geometric_normal), direction)
    }

    /// See [`Intersection::facing_geometric_normal`].
    #[inline(always)]
    pub(crate) fn facing_geometric_normal(&self, lane: usize) -> DVec3 {
        let normal = packet::at(&self.surfaces.geometric_normal, lane);
        if self.from_inside[lane] { -normal } else { normal }
    }

    /// N of the illumination model; see [`Intersection::facing_normal`].
    #[inline(always)]
    pub(crate) fn facing_normal(&self, lane: usize) -> DVec3 {
        let normal = packet::at(&self.surfaces.shading_normal, lane);
        if self.from_inside[lane] { -normal } else { normal }
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
