//! What an object is made of, in its canonical space.

use crate::accel::triangles::TriangleTree;
use crate::accel::{Aabb, KdTree, Primitives, Tally, bits};
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec2, DVec3, Ray, RayPacket, packet};
use crate::mesh::Mesh;
use crate::shape::triangle::{Canonical, Nearest};
use crate::shape::{Hit, Hits, SurfacePoint, SurfacePoints, cube, cylinder, plane, sphere, triangle};
use std::sync::Arc;

const LANES: usize = RayPacket::LANES;

/// A canonical shape, or a mesh by its place in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Geometry {
    Sphere,
    Cube,
    Cylinder { capped: bool },
    Plane,
    Mesh(u32),
}

/// A mesh and what finds its triangles.
#[derive(Clone, Debug)]
pub(super) struct PreparedMesh {
    pub(super) mesh: Arc<Mesh>,
    pub(super) index: TriangleIndex,
}

/// What finds the triangles of a mesh.
#[derive(Clone, Debug)]
pub(super) enum TriangleIndex {
    Bvh(TriangleTree),
    Kd(KdTree),
    None,
}

impl TriangleIndex {
    /// Its nodes, its bytes, and the depth of the deepest node.
    pub(super) fn size(&self) -> (u64, u64, u32) {
        match self {
            Self::Bvh(tree) => (tree.node_count() as u64, tree.bytes() as u64, tree.depth()),
            Self::Kd(tree) => (tree.node_count() as u64, tree.bytes() as u64, tree.depth()),
            Self::None => (0, 0, 0),
        }
    }
}

impl Geometry {
    pub(super) fn mesh_index(self) -> Option<usize> {
        match self {
            Self::Mesh(index) => Some(index as usize),
            _ => None,
        }
    }

    /// The tree that packets and fans search, if it is a mesh that has one.
    pub(super) fn triangle_tree(self, meshes: &[Arc<PreparedMesh>]) -> Option<&TriangleTree> {
        match &meshes[self.mesh_index()?].index {
            TriangleIndex::Bvh(tree) => Some(tree),
            TriangleIndex::Kd(_) | TriangleIndex::None => None,
        }
    }

    pub(super) fn bounds(self, meshes: &[Arc<PreparedMesh>]) -> Bounds {
        match self {
            Self::Sphere => sphere::bounds(),
            Self::Cube => cube::bounds(),
            Self::Cylinder { .. } => cylinder::bounds(),
            Self::Plane => plane::bounds(),
            Self::Mesh(index) => meshes[index as usize].mesh.bounds(),
        }
    }

    pub(super) fn intersect(
        self,
        ray: &Ray,
        meshes: &[Arc<PreparedMesh>],
        tally: &impl Tally,
    ) -> Option<Hit> {
        match self {
            Self::Sphere => sphere::intersect(ray),
            Self::Cube => cube::intersect(ray),
            Self::Cylinder { capped } => cylinder::intersect(ray, capped),
            Self::Plane => plane::intersect(ray),
            Self::Mesh(index) => meshes[index as usize].intersect(ray, tally),
        }
    }

    pub(super) fn occluded(self, ray: &Ray, meshes: &[Arc<PreparedMesh>], tally: &impl Tally) -> bool {
        match self {
            Self::Sphere => sphere::occluded(ray),
            Self::Cube => cube::occluded(ray),
            Self::Cylinder { capped } => cylinder::occluded(ray, capped),
            Self::Plane => plane::occluded(ray),
            Self::Mesh(index) => meshes[index as usize].occluded(ray, tally),
        }
    }

    pub(super) fn surface(self, ray: &Ray, hit: &Hit, meshes: &[Arc<PreparedMesh>]) -> SurfacePoint {
        match self {
            Self::Sphere => sphere::surface(ray, hit),
            Self::Cube => cube::surface(ray, hit),
            Self::Cylinder { .. } => cylinder::surface(ray, hit),
            Self::Plane => plane::surface(ray, hit),
            Self::Mesh(index) => triangle::surface(ray, &meshes[index as usize].mesh, hit.primitive),
        }
    }
}

impl PreparedMesh {
    /// The nearest hit; of several at the same t, the lowest triangle's.
    fn intersect(&self, ray: &Ray, tally: &impl Tally) -> Option<Hit> {
        match &self.index {
            TriangleIndex::Bvh(tree) => tree.intersect(ray, tally),
            TriangleIndex::Kd(tree) => {
                let mut nearest = Nearest::new(ray);
                tree.visit_steps_and_leaves(
                    ray,
                    || tally.node(),
                    |candidates| {
                        tally.triangles(candidates.len());
                        for &primitive in candidates {
                            nearest.consider(primitive, &self.mesh.vertices(primitive));
                        }
                        nearest.t()
                    },
                );
                nearest.found()
            }
            TriangleIndex::None => {
                let mut nearest = Nearest::new(ray);
                tally.triangles(self.mesh.triangle_count());
                for primitive in 0..self.mesh.triangle_count() as u32 {
                    nearest.consider(primitive, &self.mesh.vertices(primitive));
                }
                nearest.found()
            }
        }
    }

    fn occluded(&self, ray: &Ray, tally: &impl Tally) -> bool {
        let mut canonical = Canonical::new(ray);
        let mut hits = |primitive: u32| {
            tally.triangles(1);
            canonical.hits(&self.mesh.vertices(primitive))
        };
        match &self.index {
            TriangleIndex::Bvh(tree) => tree.occluded(ray, tally),
            TriangleIndex::Kd(tree) => {
                let mut found = false;
                tree.visit_steps_and_leaves(
                    ray,
                    || tally.node(),
                    |candidates| {
                        found = candidates.iter().any(|&primitive| hits(primitive));
                        if found { f64::NEG_INFINITY } else { ray.t_max }
                    },
                );
                found
            }
            TriangleIndex::None => (0..self.mesh.triangle_count() as u32).any(hits),
        }
    }
}

impl Geometry {
    /// The surfaces at hits of a packet, by lane, each as [`Geometry::surface`] finds it. Texture coordinates that cost much
    /// are left out unless `with_uv`, and where a lane is not among `lanes`.
    #[inline(always)]
    pub(super) fn surfaces(
        self,
        rays: &RayPacket,
        hits: &Hits,
        lanes: u32,
        meshes: &[Arc<PreparedMesh>],
        with_uv: bool,
        surfaces: &mut SurfacePoints,
    ) {
        match self {
            Self::Sphere => plain_surfaces(rays, hits, sphere::plain_surface, surfaces),
            Self::Cube => plain_surfaces(rays, hits, cube::plain_surface, surfaces),
            Self::Cylinder { .. } => plain_surfaces(rays, hits, cylinder::plain_surface, surfaces),
            Self::Plane => plain_surfaces(rays, hits, plane::plain_surface, surfaces),
            Self::Mesh(index) => {
                let mesh = &meshes[index as usize].mesh;
                return triangle::surfaces(rays, mesh, &hits.primitive, surfaces);
            }
        }
        if with_uv {
            for lane in bits(lanes) {
                let uv = self.uv(packet::at(&surfaces.point, lane), hits.primitive[lane]);
                (surfaces.uv[0][lane], surfaces.uv[1][lane]) = (uv.x, uv.y);
            }
        }
    }

    /// The texture coordinates of a point on a face of a shape; 0 of a mesh, which has them at its corners.
    fn uv(self, point: DVec3, face: u32) -> DVec2 {
        match self {
            Self::Sphere => sphere::uv(point),
            Self::Cube => cube::uv(point, face),
            Self::Cylinder { .. } => cylinder::uv(point, face),
            Self::Plane => plane::uv(point),
            Self::Mesh(_) => DVec2::ZERO,
        }
    }
}

/// The surfaces of a shape at hits, without texture coordinates: the scalar function, of which the compiler makes vector
/// code.
#[inline(always)]
fn plain_surfaces(
    rays: &RayPacket,
    hits: &Hits,
    of_shape: impl Fn(&Ray, &Hit) -> SurfacePoint,
    surfaces: &mut SurfacePoints,
) {
    for lane in 0..LANES {
        surfaces.put(lane, &of_shape(&rays.ray(lane), &hits.at(lane)));
    }
}

/// The triangles of a mesh, for a tree.
impl Primitives for Mesh {
    fn count(&self) -> usize {
        self.triangle_count()
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        Aabb::around(&Bounds::of_points(self.corners(primitive)))
    }

    /// Cuts the triangle by the six planes of the cell. Source: Sutherland, Hodgman, "Reentrant polygon
    /// clipping" (1974).
    fn clip(&self, primitive: u32, cell: &Aabb) -> Option<Aabb> {
        let mut polygon = Polygon::new(self.corners(primitive));
        let bounds = cell.to_bounds();
        // Widened by more than the rounding of a cut, so that a triangle that only touches a cell is not lost.
        let slack = bounds.magnitude() * gamma(CUT_OPERATIONS);
        for axis in 0..3 {
            polygon.keep(axis, |x| x - (bounds.min[axis] - slack[axis]));
            polygon.keep(axis, |x| (bounds.max[axis] + slack[axis]) - x);
        }
        let clipped = Bounds::of_points(polygon.corners.iter().copied());
        (!clipped.is_empty()).then(|| Aabb::around(&clipped).clamped(cell))
    }
}

/// Rounded operations in six cuts of an edge, one after another; more only keeps a few more references.
const CUT_OPERATIONS: u32 = 32;

/// A triangle under the knife. Each of six cuts adds a corner at most.
struct Polygon {
    corners: arrayvec::ArrayVec<DVec3, 9>,
}

impl Polygon {
    fn new(triangle: [DVec3; 3]) -> Self {
        Self { corners: triangle.into_iter().collect() }
    }

    /// Keeps the part where `distance` of a coordinate is not negative.
    fn keep(&mut self, axis: usize, distance: impl Fn(f64) -> f64) {
        if self.corners.iter().all(|corner| distance(corner[axis]) >= 0.0) {
            return;
        }
        let old = std::mem::take(&mut self.corners);
        let mut previous = match old.last() {
            Some(&last) => last,
            None => return,
        };
        for &corner in &old {
            let (from, to) = (distance(previous[axis]), distance(corner[axis]));
            if (from < 0.0) != (to < 0.0) {
                let _full = self.corners.try_push(previous + (corner - previous) * (from / (from - to)));
            }
            if to >= 0.0 {
                let _full = self.corners.try_push(corner);
            }
            previous = corner;
        }
    }
}
