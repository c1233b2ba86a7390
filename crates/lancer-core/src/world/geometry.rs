//! What an object is made of, in its canonical space.

use crate::accel::{Aabb, Accelerator, KdTree, Primitives};
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec3, Ray};
use crate::mesh::Mesh;
use crate::shape::triangle::ShearedRay;
use crate::shape::{Hit, SurfacePoint, cube, cylinder, plane, sphere, triangle};
use std::sync::Arc;

/// A canonical shape, or a mesh by its place in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Geometry {
    Sphere,
    Cube,
    Cylinder { capped: bool },
    Plane,
    Mesh(u32),
}

/// A mesh and the tree over its triangles.
#[derive(Clone, Debug)]
pub(super) struct PreparedMesh {
    pub(super) mesh: Arc<Mesh>,
    pub(super) tree: KdTree,
}

impl Geometry {
    pub(super) fn mesh_index(self) -> Option<usize> {
        match self {
            Self::Mesh(index) => Some(index as usize),
            _ => None,
        }
    }

    pub(super) fn bounds(self, meshes: &[PreparedMesh]) -> Bounds {
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
        meshes: &[PreparedMesh],
        accelerator: Accelerator,
    ) -> Option<Hit> {
        match self {
            Self::Sphere => sphere::intersect(ray),
            Self::Cube => cube::intersect(ray),
            Self::Cylinder { capped } => cylinder::intersect(ray, capped),
            Self::Plane => plane::intersect(ray),
            Self::Mesh(index) => meshes[index as usize].intersect(ray, accelerator),
        }
    }

    pub(super) fn occluded(self, ray: &Ray, meshes: &[PreparedMesh], accelerator: Accelerator) -> bool {
        match self {
            Self::Sphere => sphere::occluded(ray),
            Self::Cube => cube::occluded(ray),
            Self::Cylinder { capped } => cylinder::occluded(ray, capped),
            Self::Plane => plane::occluded(ray),
            Self::Mesh(index) => meshes[index as usize].occluded(ray, accelerator),
        }
    }

    pub(super) fn surface(self, ray: &Ray, hit: &Hit, meshes: &[PreparedMesh]) -> SurfacePoint {
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
    fn intersect(&self, ray: &Ray, accelerator: Accelerator) -> Option<Hit> {
        let sheared = ShearedRay::new(ray);
        let mut best = Hit { t: ray.t_max, primitive: u32::MAX };
        let mut test = |primitive: u32| {
            if let Some(hit) = sheared.intersect(&self.mesh.vertices(primitive)) {
                let nearer = hit.t < best.t || (hit.t == best.t && primitive < best.primitive);
                if nearer && hit.t > 0.0 && hit.t < ray.t_max {
                    best = Hit { t: hit.t, primitive };
                }
            }
            best.t
        };
        match accelerator {
            Accelerator::KdTree => self.tree.visit_leaves(ray, |candidates| {
                candidates.iter().fold(ray.t_max, |_, &primitive| test(primitive))
            }),
            Accelerator::BruteForce => (0..self.mesh.triangle_count() as u32).for_each(|primitive| {
                test(primitive);
            }),
        }
        (best.primitive != u32::MAX).then_some(best)
    }

    fn occluded(&self, ray: &Ray, accelerator: Accelerator) -> bool {
        let sheared = ShearedRay::new(ray);
        let hits = |primitive: u32| {
            let hit = sheared.intersect(&self.mesh.vertices(primitive));
            hit.is_some_and(|hit| hit.t > 0.0 && hit.t < ray.t_max)
        };
        match accelerator {
            Accelerator::KdTree => {
                let mut found = false;
                self.tree.visit_leaves(ray, |candidates| {
                    found = candidates.iter().any(|&primitive| hits(primitive));
                    if found { f64::NEG_INFINITY } else { ray.t_max }
                });
                found
            }
            Accelerator::BruteForce => (0..self.mesh.triangle_count() as u32).any(hits),
        }
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
