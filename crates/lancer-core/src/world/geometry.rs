//! What an object is made of, in its canonical space.

use crate::accel::triangles::TriangleTree;
use crate::accel::{Aabb, KdTree, Primitives, Tally, bits};
use crate::geometry::error::gamma;
use crate::geometry::{Bounds, DVec2, DVec3, Placement, Ray, RayPacket, packet};
use crate::mesh::Mesh;
use crate::shape::triangle::{Canonical, Nearest, widened};
use crate::shape::{Hit, Hits, SurfacePoint, SurfacePoints, cube, cylinder, plane, sphere, triangle};
use std::sync::{Arc, OnceLock};

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
    /// See [`PreparedMesh::roundness`].
    roundness: OnceLock<f64>,
}

impl PreparedMesh {
    pub(super) fn new(mesh: Arc<Mesh>, index: TriangleIndex) -> Self {
        Self { mesh, index, roundness: OnceLock::new() }
    }

    /// How much the ellipsoid that its box holds has to grow to hold the mesh: 1 of a ball, the root of 3 of a cube.
    fn roundness(&self) -> f64 {
        *self.roundness.get_or_init(|| {
            let bounds = self.mesh.bounds();
            let center = bounds.center();
            let half = (0.5 * bounds.extent()).max(DVec3::splat(f64::MIN_POSITIVE));
            let squared = |&position: &[f32; 3]| ((widened(position) - center) / half).length_squared();
            let largest = self.mesh.data().positions.iter().map(squared).fold(0.0, f64::max);
            largest.sqrt() * (1.0 + 8.0 * f64::EPSILON)
        })
    }
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

    /// A box in the world around its image: closer than that of its own box, where that is turned.
    pub(super) fn bounds_in_world(self, placement: &Placement, meshes: &[Arc<PreparedMesh>]) -> Bounds {
        let bounds = self.bounds(meshes);
        if !bounds.is_finite() {
            return Bounds::UNBOUNDED;
        }
        placement.bounds_within(bounds, |edges| match self {
            Self::Sphere => length_by_axis(&edges),
            Self::Cylinder { .. } => length_by_axis(&[edges[0], edges[2]]) + edges[1].abs(),
            Self::Cube | Self::Plane => sum_by_axis(&edges),
            Self::Mesh(index) => {
                let (of_box, of_ball) = (sum_by_axis(&edges), length_by_axis(&edges));
                // Where they are the same the box is not turned.
                if of_box == of_ball {
                    return of_box;
                }
                of_box.min(of_ball * meshes[index as usize].roundness())
            }
        })
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

/// The sums of the sizes of some vectors' coordinates.
fn sum_by_axis(vectors: &[DVec3]) -> DVec3 {
    vectors.iter().map(|v| v.abs()).sum()
}

/// The roots of the sums of their squares, which may themselves be too small for a number.
fn length_by_axis(vectors: &[DVec3]) -> DVec3 {
    let largest = vectors.iter().fold(DVec3::splat(f64::MIN_POSITIVE), |largest, v| largest.max(v.abs()));
    let squares: DVec3 = vectors.iter().map(|v| (v / largest) * (v / largest)).sum();
    DVec3::new(squares.x.sqrt(), squares.y.sqrt(), squares.z.sqrt()) * largest
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Transform;
    use crate::testing::{Random, ball, soup};

    fn placed(transform: Transform) -> Placement {
        Placement::new(transform).unwrap()
    }

    fn meshes() -> Vec<Arc<PreparedMesh>> {
        let far = Transform::translate(DVec3::new(70.0, -20.0, 5.0));
        let mut aside = ball(8, 12);
        for position in &mut aside.positions {
            let moved = placed(far).point_to_world(widened(*position) * DVec3::new(1.0, 4.0, 0.2));
            *position = moved.as_vec3().to_array();
        }
        let flat = crate::mesh::MeshData {
            positions: vec![[0.0, 2.0, 0.0], [1.0, 2.0, 0.0], [0.0, 2.0, 3.0]],
            indices: vec![[0, 1, 2]],
            ..Default::default()
        };
        [Mesh::new(ball(16, 24)).unwrap(), Mesh::new(aside).unwrap(), Mesh::new(flat).unwrap(), soup(3, 50)]
            .map(|mesh| Arc::new(PreparedMesh::new(Arc::new(mesh), TriangleIndex::None)))
            .into()
    }

    /// A point on a shape, often one that is far out.
    fn point_on(geometry: Geometry, meshes: &[Arc<PreparedMesh>], random: &mut Random) -> DVec3 {
        let sign = |random: &mut Random| if random.below(2) == 0 { 1.0 } else { -1.0 };
        match geometry {
            Geometry::Sphere => random.direction(),
            Geometry::Cube | Geometry::Plane => DVec3::new(sign(random), sign(random), sign(random)),
            Geometry::Cylinder { .. } => {
                let around = random.direction().with_y(0.0).normalize();
                around + DVec3::Y * sign(random)
            }
            Geometry::Mesh(index) => {
                let positions = &meshes[index as usize].mesh.data().positions;
                widened(positions[random.below(positions.len())])
            }
        }
    }

    #[test]
    fn a_box_in_the_world_holds_the_image_and_is_within_that_of_the_box() {
        let meshes = meshes();
        let mut random = Random::new(17);
        let shapes = [Geometry::Sphere, Geometry::Cube, Geometry::Cylinder { capped: true }];
        let geometries = shapes.into_iter().chain((0..meshes.len() as u32).map(Geometry::Mesh));
        for geometry in geometries {
            for _ in 0..200 {
                let size = [1e-3, 1.0, 1e4][random.below(3)];
                let placement = placed(random.transform(size, 100.0));
                let bounds = geometry.bounds_in_world(&placement, &meshes);
                let image = placement.bounds_to_world(geometry.bounds(&meshes));
                let slack = image.magnitude() * 1e-12;
                assert!((bounds.min + slack).cmpge(image.min).all(), "{geometry:?} {bounds:?} {image:?}");
                assert!((bounds.max - slack).cmple(image.max).all(), "{geometry:?} {bounds:?} {image:?}");
                for _ in 0..50 {
                    let point = placement.point_to_world(point_on(geometry, &meshes, &mut random));
                    let is_inside = point.cmpge(bounds.min).all() & point.cmple(bounds.max).all();
                    assert!(is_inside, "{geometry:?}: {point} is not in {bounds:?}");
                }
            }
        }
    }

    #[test]
    fn the_box_holds_what_is_too_small_to_be_squared() {
        let tiny = Transform::scale(DVec3::splat(1e-180));
        let turned = placed(tiny.then(Transform::rotate(DVec3::Z, 30.0)));
        for geometry in [Geometry::Sphere, Geometry::Cylinder { capped: true }] {
            let extent = geometry.bounds_in_world(&turned, &[]).extent();
            assert!(extent.cmpge(DVec3::splat(2e-180)).all(), "{geometry:?} {extent}");
        }
    }

    #[test]
    fn the_box_around_a_turned_ball_is_no_larger() {
        let meshes = meshes();
        let turned = placed(Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 37.0));
        for geometry in [Geometry::Sphere, Geometry::Mesh(0)] {
            let extent = geometry.bounds_in_world(&turned, &meshes).extent();
            assert!((extent - 2.0).abs().max_element() < 1e-6, "{geometry:?} {extent}");
        }
        let about_its_axis = placed(Transform::rotate(DVec3::Y, 45.0));
        let extent = Geometry::Cylinder { capped: false }.bounds_in_world(&about_its_axis, &meshes).extent();
        assert!((extent - 2.0).abs().max_element() < 1e-12, "{extent}");
    }
}
