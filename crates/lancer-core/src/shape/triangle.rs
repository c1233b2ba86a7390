//! One triangle of a mesh.
//!
//! The test is watertight: each edge function is computed from the same rounded numbers, up to their sign, by
//! the two triangles that share the edge, so that no ray passes between them; a ray through an edge or a
//! vertex meets both. Vertices are `f32`, arithmetic is `f64`: the products under the edge functions are then
//! good to 2^-52 of their size, and no fallback to a wider type is needed.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013). The edge functions'
//! signs can never contradict the exact ones of the sheared vertices, since rounding is monotonic; they can
//! only become zero, which counts as inside.

use super::{Hit, SurfacePoint, SurfacePoints};
use crate::color::Rgb;
use crate::geometry::error::gamma;
use crate::geometry::{DVec2, DVec3, Ray, RayPacket, Vectors, packet};
use crate::mesh::Mesh;

const LANES: usize = RayPacket::LANES;

/// A ray made ready for the triangles of one mesh: the axes permuted and sheared so that it runs along +z.
#[derive(Clone, Copy, Debug)]
pub struct ShearedRay {
    /// The origin, its axes permuted.
    origin: [f64; 3],
    order: Order,
    /// Shear of x, shear of y, scale of z.
    shear: [f64; 3],
}

/// An order of axes: the two that a ray follows less, so that triangles keep their winding, then the other.
#[derive(Clone, Copy, Debug)]
struct Order {
    follows_x: bool,
    follows_y: bool,
    /// Whether it goes down the axis that it follows.
    backward: bool,
}

impl Order {
    #[inline(always)]
    fn along(direction: DVec3) -> Self {
        let size = direction.abs();
        let follows_x = (size.x > size.y) & (size.x > size.z);
        let follows_y = !follows_x & (size.y > size.z);
        let followed = if follows_x {
            direction.x
        } else if follows_y {
            direction.y
        } else {
            direction.z
        };
        Self { follows_x, follows_y, backward: followed < 0.0 }
    }

    /// Without branches, so that vector code can be made of it.
    #[inline(always)]
    fn of(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = if self.follows_x {
            [y, z, x]
        } else if self.follows_y {
            [z, x, y]
        } else {
            [x, y, z]
        };
        if self.backward { [b, a, c] } else { [a, b, c] }
    }
}

/// Where a ray meets a triangle's plane inside of its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// The ray's parameter there.
    pub t: f64,
    /// How far that may be from the true one. A ray that starts on a triangle or behind it may seem to meet it so far
    /// ahead, the further the thinner it is.
    pub t_error: f64,
    /// Weights of the three corners; they add up to 1.
    pub barycentric: [f64; 3],
}

impl TriangleHit {
    /// Whether it is ahead for sure, and nearer than `t_max`. Without branches.
    #[inline(always)]
    fn is_within(&self, t_max: f64) -> bool {
        (self.t > self.t_error) & (self.t < t_max)
    }
}

impl ShearedRay {
    /// Prepares a ray; its direction must not be zero.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let order = Order::along(ray.direction);
        let [x, y, z] = order.of(ray.direction.to_array());
        Self { origin: order.of(ray.origin.to_array()), order, shear: [x / z, y / z, 1.0 / z] }
    }

    /// The hit with the triangle at any t, behind the origin too.
    ///
    /// A triangle seen exactly edge-on is not hit; in a closed mesh its neighbours are.
    #[inline(always)]
    pub fn intersect(&self, corners: &[[f32; 3]; 3]) -> Option<TriangleHit> {
        let hit = self.meet(corners);
        (!hit.t.is_nan()).then_some(hit)
    }

    /// The same without branches: where there is no hit, its t is NaN.
    ///
    /// Source of the bound on the error: Pharr, Jakob, Humphreys, "Physically Based Rendering" (4th ed.), section 6.8.7.
    #[inline(always)]
    fn meet(&self, corners: &[[f32; 3]; 3]) -> TriangleHit {
        let [a, b, c] = corners;
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (self.sheared(a), self.sheared(b), self.sheared(c));
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let some_negative = (u < 0.0) | (v < 0.0) | (w < 0.0);
        let some_positive = (u > 0.0) | (v > 0.0) | (w > 0.0);
        let determinant = u + v + w;
        let t = self.shear[2] * (u * az + v * bz + w * cz) / determinant;
        let misses = (some_negative & some_positive) | (determinant == 0.0);
        let largest = |a: f64, b: f64, c: f64| a.abs().max(b.abs()).max(c.abs());
        let (x, y, z) = (largest(ax, bx, cx), largest(ay, by, cy), largest(az, bz, cz));
        let (x_error, y_error, z_error) = (gamma(5) * (x + z), gamma(5) * (y + z), gamma(3) * z);
        let edge = largest(u, v, w);
        let edge_error = 2.0 * (gamma(2) * x * y + y_error * x + x_error * y);
        let sum_error = 3.0 * (gamma(3) * edge * z + edge_error * z + z_error * edge);
        TriangleHit {
            t: if misses { f64::NAN } else { t },
            t_error: sum_error * (self.shear[2] / determinant).abs(),
            barycentric: [u / determinant, v / determinant, w / determinant],
        }
    }

    #[inline(always)]
    fn sheared(&self, &[x, y, z]: &[f32; 3]) -> [f64; 3] {
        let [x, y, z] = self.order.of([f64::from(x), f64::from(y), f64::from(z)]);
        let along = z - self.origin[2];
        [x - self.origin[0] - self.shear[0] * along, y - self.origin[1] - self.shear[1] * along, along]
    }
}

/// The canonical search for the nearest hit: the least t, and of equal ones the lowest triangle.
pub(crate) struct Nearest<'a> {
    ray: &'a Ray,
    sheared: ShearedRay,
    best: Hit,
}

impl<'a> Nearest<'a> {
    pub(crate) fn new(ray: &'a Ray) -> Self {
        Self { ray, sheared: ShearedRay::new(ray), best: Hit { t: ray.t_max, primitive: u32::MAX } }
    }

    pub(crate) fn consider(&mut self, id: u32, triangle: &[[f32; 3]; 3]) {
        if let Some(hit) = self.sheared.intersect(triangle) {
            let nearer = hit.t < self.best.t || (hit.t == self.best.t && id < self.best.primitive);
            if nearer && hit.is_within(self.ray.t_max) {
                self.best = Hit { t: hit.t, primitive: id };
            }
        }
    }

    /// The t of the nearest hit so far, or the end of the ray.
    pub(crate) fn t(&self) -> f64 {
        self.best.t
    }

    pub(crate) fn found(&self) -> Option<Hit> {
        (self.best.primitive != u32::MAX).then_some(self.best)
    }
}

/// The canonical test of a ray, made ready when it is first needed.
pub(crate) struct Canonical<'a> {
    ray: &'a Ray,
    sheared: Option<ShearedRay>,
}

impl<'a> Canonical<'a> {
    pub(crate) fn new(ray: &'a Ray) -> Self {
        Self { ray, sheared: None }
    }

    /// Whether the ray hits a triangle.
    #[inline(never)]
    pub(crate) fn hits(&mut self, triangle: &[[f32; 3]; 3]) -> bool {
        let sheared = self.sheared.get_or_insert_with(|| ShearedRay::new(self.ray));
        sheared.intersect(triangle).is_some_and(|hit| hit.is_within(self.ray.t_max))
    }
}

/// Where each ray of a packet meets a triangle of its own, with t in (0, `t_max`): the canonical test; infinite where it
/// does not.
#[inline(always)]
pub(crate) fn nearest(rays: &RayPacket, triangles: &Corners<3>) -> [f64; LANES] {
    let mut nearest = [f64::INFINITY; LANES];
    for (lane, nearest) in nearest.iter_mut().enumerate() {
        let ray = rays.ray(lane);
        let hit = ShearedRay::new(&ray).meet(&triangles.lane(lane));
        *nearest = if hit.is_within(ray.t_max) { hit.t } else { f64::INFINITY };
    }
    nearest
}

/// The surface at a hit with triangle `primitive` of `mesh`.
///
/// The shading normal is the interpolated vertex normal, turned to the geometric one's side; the texture
/// coordinates are interpolated, or are the barycentric ones of the last two corners where the mesh has none;
/// vertex colours are interpolated.
pub fn surface(ray: &Ray, mesh: &Mesh, primitive: u32) -> SurfacePoint {
    let (weights, mut surface) = flat(ray, &mesh.vertices(primitive), error_on(mesh));
    if let Some(normals) = mesh.corner_normals(primitive) {
        surface.shading_normal = shading_normal(interpolate(weights, normals), surface.geometric_normal);
    }
    if let Some([a, b, c]) = mesh.corner_uvs(primitive) {
        surface.uv = a * weights.x + b * weights.y + c * weights.z;
    }
    if let Some([a, b, c]) = mesh.corner_colors(primitive) {
        surface.vertex_color = a * weights.x + b * weights.y + c * weights.z;
    }
    surface
}

/// The surfaces at hits of a packet with triangles of a mesh, by lane: each as [`surface`] finds it.
#[inline(always)]
pub(crate) fn surfaces(
    rays: &RayPacket,
    mesh: &Mesh,
    triangles: &[u32; LANES],
    surfaces: &mut SurfacePoints,
) {
    let data = mesh.data();
    let error = error_on(mesh);
    let corners = Corners::gather(mesh, triangles, &data.positions);
    let mut weights = Vectors::default();
    for lane in 0..LANES {
        let (at, surface) = flat(&rays.ray(lane), &corners.lane(lane), error);
        packet::put(&mut weights, lane, at);
        surfaces.put(lane, &surface);
    }
    if !data.normals.is_empty() {
        let normals = Corners::gather(mesh, triangles, &data.normals);
        for lane in 0..LANES {
            let interpolated = interpolate(packet::at(&weights, lane), normals.lane(lane).map(widened));
            let facing = packet::at(&surfaces.geometric_normal, lane);
            packet::put(&mut surfaces.shading_normal, lane, shading_normal(interpolated, facing));
        }
    }
    if !data.uvs.is_empty() {
        let uvs = Corners::gather(mesh, triangles, &data.uvs);
        for lane in 0..LANES {
            let uvs = uvs.lane(lane).map(|[u, v]| DVec3::new(f64::from(u), f64::from(v), 0.0));
            let uv = interpolate(packet::at(&weights, lane), uvs);
            (surfaces.uv[0][lane], surfaces.uv[1][lane]) = (uv.x, uv.y);
        }
    }
    if !data.colors.is_empty() {
        let colors = Corners::gather(mesh, triangles, &data.colors);
        for lane in 0..LANES {
            let color = interpolate(packet::at(&weights, lane), colors.lane(lane).map(widened));
            surfaces.vertex_color.put(lane, color.to_array().into());
        }
    }
}

/// `N` numbers at each corner of a triangle, for each ray of a packet. By corner, number and lane.
pub(crate) struct Corners<const N: usize>([[[f32; LANES]; N]; 3]);

impl<const N: usize> Corners<N> {
    /// Triangles of which all numbers are 0: no ray meets them.
    pub(crate) const ZERO: Self = Self([[[0.0; LANES]; N]; 3]);

    #[inline(always)]
    fn gather(mesh: &Mesh, triangles: &[u32; LANES], of_vertices: &[[f32; N]]) -> Self {
        let mut corners = Self::ZERO;
        for (lane, &triangle) in triangles.iter().enumerate() {
            let [a, b, c] = mesh.data().indices[triangle as usize];
            let of = |vertex: u32| of_vertices[vertex as usize];
            corners.put(lane, &[of(a), of(b), of(c)]);
        }
        corners
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, triangle: &[[f32; N]; 3]) {
        for (corner, numbers) in self.0.iter_mut().zip(triangle) {
            for (lanes, number) in corner.iter_mut().zip(numbers) {
                lanes[lane] = *number;
            }
        }
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> [[f32; N]; 3] {
        let mut corners = [[0.0; N]; 3];
        for (corner, numbers) in corners.iter_mut().zip(&self.0) {
            for (number, lanes) in corner.iter_mut().zip(numbers) {
                *number = lanes[lane];
            }
        }
        corners
    }
}

/// The weights of the corners at a hit, and the surface of a triangle that has nothing but corners. Without branches.
#[inline(always)]
fn flat(ray: &Ray, vertices: &[[f32; 3]; 3], point_error: DVec3) -> (DVec3, SurfacePoint) {
    let hit = ShearedRay::new(ray).meet(vertices);
    let weights = if hit.t.is_nan() { DVec3::X } else { hit.barycentric.into() };
    let [a, b, c] = [widened(vertices[0]), widened(vertices[1]), widened(vertices[2])];
    let across = (b - a).cross(c - a);
    let vanishes = (across.x == 0.0) & (across.y == 0.0) & (across.z == 0.0);
    let geometric_normal = if vanishes { -ray.direction } else { across };
    let surface = SurfacePoint {
        point: interpolate(weights, [a, b, c]),
        point_error,
        geometric_normal,
        shading_normal: geometric_normal,
        uv: DVec2::new(weights.y, weights.z),
        vertex_color: Rgb::WHITE,
    };
    (weights, surface)
}

#[inline(always)]
pub(crate) fn widened([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}

#[inline(always)]
fn interpolate(weights: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * weights.x + b * weights.y + c * weights.z
}

/// The interpolated normal on the geometric one's side, or that one where it vanishes. Without branches.
#[inline(always)]
fn shading_normal(interpolated: DVec3, geometric_normal: DVec3) -> DVec3 {
    let reciprocal = interpolated.length_recip();
    let unit = interpolated * reciprocal;
    let unit = if unit.dot(geometric_normal) < 0.0 { -unit } else { unit };
    if reciprocal.is_finite() & (reciprocal > 0.0) { unit } else { geometric_normal }
}

/// How far a hit may lie from the triangle that it was found on: as far along each axis as along the one on which
/// coordinates are the largest, since the test that the next ray takes mixes them.
fn error_on(mesh: &Mesh) -> DVec3 {
    DVec3::splat(mesh.bounds().magnitude().max_element() * gamma(ON_TRIANGLE))
}

/// Rounded operations between a mesh's vertices and a hit on one of its triangles, there and back: three
/// products and two sums to interpolate, and some twenty to intersect the next ray with the same plane or a
/// neighbour in it. Measured against the mesh's whole size, so that it also holds where a small triangle lies
/// beside a large one.
const ON_TRIANGLE: u32 = 32;
