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

use super::{Hit, SurfacePoint};
use crate::color::Rgb;
use crate::geometry::error::gamma;
use crate::geometry::{DVec2, DVec3, Ray};
use crate::mesh::Mesh;

/// A ray made ready for the triangles of one mesh: the axes permuted and sheared so that it runs along +z.
#[derive(Clone, Copy, Debug)]
pub struct ShearedRay {
    /// The origin, its axes permuted.
    origin: [f64; 3],
    /// The two axes that the ray follows less, in an order that keeps triangles' winding, then the other.
    axes: [usize; 3],
    /// Shear of x, shear of y, scale of z.
    shear: [f64; 3],
}

/// Where a ray meets a triangle's plane inside of its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// The ray's parameter there.
    pub t: f64,
    /// Weights of the three corners; they add up to 1.
    pub barycentric: [f64; 3],
}

impl ShearedRay {
    /// Prepares a ray; its direction must not be zero.
    pub fn new(ray: &Ray) -> Self {
        let size = ray.direction.abs();
        let z = if size.x > size.y && size.x > size.z {
            0
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if ray.direction[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        Self { origin: [o[x], o[y], o[z]], axes: [x, y, z], shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]] }
    }

    /// The hit with the triangle at any t, behind the origin too.
    ///
    /// A triangle seen exactly edge-on is not hit; in a closed mesh its neighbours are.
    #[inline(always)]
    pub fn intersect(&self, corners: &[[f32; 3]; 3]) -> Option<TriangleHit> {
        let [a, b, c] = corners;
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (self.sheared(a), self.sheared(b), self.sheared(c));
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = u + v + w;
        if determinant == 0.0 {
            return None;
        }
        let t = self.shear[2] * (u * az + v * bz + w * cz) / determinant;
        Some(TriangleHit { t, barycentric: [u / determinant, v / determinant, w / determinant] })
    }

    #[inline(always)]
    fn sheared(&self, point: &[f32; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes;
        let along = f64::from(point[z]) - self.origin[2];
        [
            f64::from(point[x]) - self.origin[0] - self.shear[0] * along,
            f64::from(point[y]) - self.origin[1] - self.shear[1] * along,
            along,
        ]
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
            if nearer && hit.t > 0.0 && hit.t < self.ray.t_max {
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
        sheared.intersect(triangle).is_some_and(|hit| hit.t > 0.0 && hit.t < self.ray.t_max)
    }
}

/// The surface at a hit with triangle `primitive` of `mesh`.
///
/// The shading normal is the interpolated vertex normal, turned to the geometric one's side; the texture
/// coordinates are interpolated, or are the barycentric ones of the last two corners where the mesh has none;
/// vertex colours are interpolated.
pub fn surface(ray: &Ray, mesh: &Mesh, primitive: u32) -> SurfacePoint {
    let hit = ShearedRay::new(ray).intersect(&mesh.vertices(primitive));
    let [u, v, w] = hit.map_or([1.0, 0.0, 0.0], |hit| hit.barycentric);
    let [a, b, c] = mesh.corners(primitive);
    let across = (b - a).cross(c - a);
    let geometric_normal = if across == DVec3::ZERO { -ray.direction } else { across };
    SurfacePoint {
        point: a * u + b * v + c * w,
        point_error: mesh.bounds().magnitude() * gamma(ON_TRIANGLE),
        geometric_normal,
        shading_normal: mesh
            .corner_normals(primitive)
            .and_then(|[a, b, c]| shading_normal(a * u + b * v + c * w, geometric_normal))
            .unwrap_or(geometric_normal),
        uv: mesh.corner_uvs(primitive).map_or(DVec2::new(v, w), |[a, b, c]| a * u + b * v + c * w),
        vertex_color: mesh.corner_colors(primitive).map_or(Rgb::WHITE, |[a, b, c]| a * u + b * v + c * w),
    }
}

/// The interpolated normal on the geometric one's side, or none where it vanishes.
fn shading_normal(interpolated: DVec3, geometric_normal: DVec3) -> Option<DVec3> {
    let unit = interpolated.try_normalize()?;
    Some(if unit.dot(geometric_normal) < 0.0 { -unit } else { unit })
}

/// Rounded operations between a mesh's vertices and a hit on one of its triangles, there and back: three
/// products and two sums to interpolate, and some twenty to intersect the next ray with the same plane or a
/// neighbour in it. Measured against the mesh's whole size, so that it also holds where a small triangle lies
/// beside a large one.
const ON_TRIANGLE: u32 = 32;
