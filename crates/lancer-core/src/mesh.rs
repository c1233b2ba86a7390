//! Validated indexed triangles.
//!
//! In: arrays as a loader or a program makes them. Out: a mesh whose every index and number can be trusted.
//! It knows no accelerator, material or light.

use crate::color::Rgb;
use crate::geometry::{Bounds, DVec2, DVec3};

/// The arrays of a triangle mesh, not yet validated.
///
/// Shape: `positions: [vertices][3]`, `normals: [vertices][3]` or empty, `uvs: [vertices][2]` or empty,
/// `colors: [vertices][3]` or empty, `indices: [triangles][3]`. A triangle is seen from outside where its vertices run counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions in the mesh's canonical space.
    pub positions: Vec<[f32; 3]>,
    /// Vertex normals of any length, facing outward; empty for a mesh of flat facets.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, (0, 0) at the lower left of the image; empty where there are none.
    pub uvs: Vec<[f32; 2]>,
    /// Colours, linear RGB in [0, 1], which multiply the material's S; empty where there are none.
    pub colors: Vec<[f32; 3]>,
    /// Three vertices a triangle.
    pub indices: Vec<[u32; 3]>,
}

/// What is wrong with a [`MeshData`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// There is nothing to draw.
    #[error("the mesh has no triangles")]
    Empty,
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} uses vertex {index}, but there are {vertices} vertices")]
    IndexOutOfRange {
        /// The triangle, counted from 0.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A number is NaN or infinite.
    #[error("the {attribute} of vertex {vertex} is not finite")]
    NotFinite {
        /// `position`, `normal`, `texture coordinate` or `color`.
        attribute: &'static str,
        /// The vertex, counted from 0.
        vertex: usize,
    },
    /// A colour would take light away or give more than there is.
    #[error("the color of vertex {vertex} is not within [0, 1]")]
    ColorOutOfRange {
        /// The vertex, counted from 0.
        vertex: usize,
    },
    /// An attribute array is neither empty nor of one entry a vertex.
    #[error("there are {found} {attribute}s for {vertices} vertices")]
    LengthMismatch {
        /// `normal`, `texture coordinate` or `color`.
        attribute: &'static str,
        /// Entries found.
        found: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// More triangles or vertices than 32-bit indices can name.
    #[error("{triangles} triangles are more than this renderer can index")]
    TooLarge {
        /// The number of triangles.
        triangles: usize,
    },
}

/// A triangle mesh: at least one triangle, indices in range, numbers finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    data: MeshData,
    bounds: Bounds,
}

impl Mesh {
    /// The most triangles that a mesh may have; a k-d tree names a triangle by 32 bits.
    pub const MAX_TRIANGLES: usize = 1 << 30;

    /// Validates the arrays.
    ///
    /// # Errors
    /// The first fault found; see [`MeshError`].
    pub fn new(data: MeshData) -> Result<Self, MeshError> {
        let vertices = data.positions.len();
        if data.indices.is_empty() {
            return Err(MeshError::Empty);
        }
        if data.indices.len() > Self::MAX_TRIANGLES {
            return Err(MeshError::TooLarge { triangles: data.indices.len() });
        }
        let lengths = [
            ("normal", data.normals.len()),
            ("texture coordinate", data.uvs.len()),
            ("color", data.colors.len()),
        ];
        for (attribute, found) in lengths {
            if found != 0 && found != vertices {
                return Err(MeshError::LengthMismatch { attribute, found, vertices });
            }
        }
        all_finite("position", &data.positions)?;
        all_finite("normal", &data.normals)?;
        all_finite("texture coordinate", &data.uvs)?;
        all_finite("color", &data.colors)?;
        let is_color = |color: &[f32; 3]| color.iter().all(|x| (0.0..=1.0).contains(x));
        if let Some(vertex) = data.colors.iter().position(|color| !is_color(color)) {
            return Err(MeshError::ColorOutOfRange { vertex });
        }
        for (triangle, corners) in data.indices.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertices });
            }
        }
        let bounds = Bounds::of_points(
            data.indices.iter().flatten().map(|&index| to_dvec3(data.positions[index as usize])),
        );
        Ok(Self { data, bounds })
    }

    /// The arrays.
    pub fn data(&self) -> &MeshData {
        &self.data
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.data.indices.len()
    }

    /// The box around all vertices in use.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The three corners of a triangle.
    ///
    /// # Panics
    /// Where `triangle` is out of range.
    pub fn vertices(&self, triangle: u32) -> [[f32; 3]; 3] {
        let [a, b, c] = self.data.indices[triangle as usize];
        let position = |index: u32| self.data.positions[index as usize];
        [position(a), position(b), position(c)]
    }

    /// The three corners of a triangle, in `f64`.
    ///
    /// # Panics
    /// Where `triangle` is out of range.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.vertices(triangle).map(to_dvec3)
    }

    /// The vertex normals of a triangle, if the mesh has them.
    pub fn corner_normals(&self, triangle: u32) -> Option<[DVec3; 3]> {
        let corners = self.data.indices[triangle as usize];
        (!self.data.normals.is_empty())
            .then(|| corners.map(|index| to_dvec3(self.data.normals[index as usize])))
    }

    /// The texture coordinates of a triangle's corners, if the mesh has them.
    pub fn corner_uvs(&self, triangle: u32) -> Option<[DVec2; 3]> {
        let corners = self.data.indices[triangle as usize];
        (!self.data.uvs.is_empty()).then(|| {
            corners.map(|index| {
                let [u, v] = self.data.uvs[index as usize];
                DVec2::new(f64::from(u), f64::from(v))
            })
        })
    }

    /// The colours of a triangle's corners, if the mesh has them.
    pub fn corner_colors(&self, triangle: u32) -> Option<[Rgb; 3]> {
        let corners = self.data.indices[triangle as usize];
        (!self.data.colors.is_empty()).then(|| {
            corners.map(|index| {
                let [r, g, b] = self.data.colors[index as usize].map(f64::from);
                Rgb::new(r, g, b)
            })
        })
    }

    /// Bytes held by the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.data.positions[..])
            + size_of_val(&self.data.normals[..])
            + size_of_val(&self.data.uvs[..])
            + size_of_val(&self.data.colors[..])
            + size_of_val(&self.data.indices[..])
    }
}

fn all_finite<const N: usize>(attribute: &'static str, values: &[[f32; N]]) -> Result<(), MeshError> {
    match values.iter().position(|value| value.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(MeshError::NotFinite { attribute, vertex }),
        None => Ok(()),
    }
}

fn to_dvec3([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> MeshData {
        MeshData {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
            indices: vec![[0, 1, 2]],
            ..MeshData::default()
        }
    }

    #[test]
    fn bounds_hold_only_vertices_in_use() {
        let mut data = triangle();
        data.positions.push([100.0, 100.0, 100.0]);
        let mesh = Mesh::new(data).unwrap();
        assert_eq!(mesh.bounds(), Bounds::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0)));
    }

    #[test]
    fn each_fault_is_named() {
        assert_eq!(Mesh::new(MeshData::default()), Err(MeshError::Empty));

        let data = MeshData { indices: vec![[0, 1, 3]], ..triangle() };
        assert_eq!(Mesh::new(data), Err(MeshError::IndexOutOfRange { triangle: 0, index: 3, vertices: 3 }));

        let mut data = triangle();
        data.positions[1][2] = f32::NAN;
        assert_eq!(Mesh::new(data), Err(MeshError::NotFinite { attribute: "position", vertex: 1 }));

        let data = MeshData { normals: vec![[0.0, 0.0, 1.0]], ..triangle() };
        let fault = MeshError::LengthMismatch { attribute: "normal", found: 1, vertices: 3 };
        assert_eq!(Mesh::new(data), Err(fault));

        let data = MeshData { colors: vec![[1.0; 3]; 2], ..triangle() };
        let fault = MeshError::LengthMismatch { attribute: "color", found: 2, vertices: 3 };
        assert_eq!(Mesh::new(data), Err(fault));

        let colored = |color| MeshData { colors: vec![[0.0; 3], color, [1.0; 3]], ..triangle() };
        let not_finite = Err(MeshError::NotFinite { attribute: "color", vertex: 1 });
        assert_eq!(Mesh::new(colored([f32::NAN, 0.0, 0.0])), not_finite);
        for color in [[1.0, 1.5, 0.0], [-0.1, 0.0, 0.0]] {
            assert_eq!(Mesh::new(colored(color)), Err(MeshError::ColorOutOfRange { vertex: 1 }));
        }
    }
}
