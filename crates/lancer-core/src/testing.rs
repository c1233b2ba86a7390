//! What the tests of several rooms share: random rays, meshes and transforms, always the same ones.

use crate::geometry::{DVec3, Ray, Transform};
use crate::mesh::{Mesh, MeshData};
use crate::sampling::{Key, Stream};

/// Random numbers for one test.
pub(crate) struct Random(Stream);

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        Self(Key::camera(seed, 0, 0).stream())
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next_unit()
    }

    pub(crate) fn point(&mut self, radius: f64) -> DVec3 {
        DVec3::new(
            self.between(-radius, radius),
            self.between(-radius, radius),
            self.between(-radius, radius),
        )
    }

    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.point(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalize();
            }
        }
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.between(0.0, n as f64) as usize).min(n - 1)
    }

    /// A ray from within `radius`, sometimes along an axis.
    pub(crate) fn ray(&mut self, radius: f64) -> Ray {
        let origin = self.point(radius);
        let mut direction = self.direction();
        if self.below(8) == 0 {
            direction = DVec3::AXES[self.below(3)] * if self.below(2) == 0 { 1.0 } else { -1.0 };
        }
        Ray::new(origin, direction)
    }

    /// A scale, shear, mirror and turn, then a translation by up to `distance`.
    pub(crate) fn transform(&mut self, size: f64, distance: f64) -> Transform {
        let mut factor = || self.between(0.3, 3.0) * if self.below(2) == 0 { size } else { -size };
        let scale = Transform::scale(DVec3::new(factor(), factor(), factor()));
        let (a, b) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
        let shear = Transform::from_columns(DVec3::X, DVec3::new(a, 1.0, b), DVec3::Z, DVec3::ZERO);
        scale
            .then(shear)
            .then(Transform::rotate(self.direction(), self.between(0.0, 360.0)))
            .then(Transform::translate(self.direction() * distance))
    }
}

/// A closed ball of `2 * rings * segments` triangles or so, radius 1, seen from outside.
pub(crate) fn ball(rings: u32, segments: u32) -> MeshData {
    use crate::geometry::portable::sin_cos;
    use std::f64::consts::{PI, TAU};
    let mut data = MeshData::default();
    data.positions.push([0.0, 1.0, 0.0]);
    for ring in 1..rings {
        let (radius, y) = sin_cos(PI * f64::from(ring) / f64::from(rings));
        for segment in 0..segments {
            let (sin, cos) = sin_cos(TAU * f64::from(segment) / f64::from(segments));
            data.positions.push([(radius * sin) as f32, y as f32, (radius * cos) as f32]);
        }
    }
    data.positions.push([0.0, -1.0, 0.0]);
    let south = data.positions.len() as u32 - 1;
    let vertex = |ring: u32, segment: u32| 1 + (ring - 1) * segments + segment % segments;
    for segment in 0..segments {
        data.indices.push([0, vertex(1, segment), vertex(1, segment + 1)]);
        data.indices.push([south, vertex(rings - 1, segment + 1), vertex(rings - 1, segment)]);
        for ring in 1..rings - 1 {
            let (a, b) = (vertex(ring, segment), vertex(ring, segment + 1));
            let (c, d) = (vertex(ring + 1, segment), vertex(ring + 1, segment + 1));
            data.indices.extend([[a, c, d], [a, d, b]]);
        }
    }
    data
}

/// Triangles of all sizes and directions, flat and degenerate ones among them.
pub(crate) fn soup(seed: u32, count: usize) -> Mesh {
    let mut random = Random::new(seed);
    let mut data = MeshData::default();
    for triangle in 0..count as u32 {
        let center = random.point(1.0);
        let size = [0.01, 0.1, 1.0][random.below(3)];
        let mut corners = [(); 3].map(|()| center + random.point(size));
        match random.below(10) {
            0 => corners.iter_mut().for_each(|corner| corner.y = center.y),
            1 => corners[2] = corners[1],
            2 => corners.iter_mut().for_each(|corner| *corner = (*corner * 4.0).round() / 4.0),
            _ => {}
        }
        data.positions.extend(corners.map(|corner| corner.as_vec3().to_array()));
        data.indices.push([3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
    }
    Mesh::new(data).unwrap()
}
