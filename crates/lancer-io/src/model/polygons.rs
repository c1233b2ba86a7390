//! Polygons as files hold them, made into meshes.
//!
//! In: positions with their colours, normals and texture coordinates, each with indices of its own, and polygons
//! of them in groups. Out: validated triangle meshes in single precision, relative to one origin. It knows no file
//! format; the loaders have checked every index and number.

use super::normals::{CornerNormals, Faces, JoinedUpTo, NO_NORMAL, corner_normals, places_of};
use super::options::Crease;
use super::triangulate::{MAX_CLIPPED_CORNERS, TooManyCorners, Triangulator};
use crate::limits::Limits;
use lancer_core::color::srgb_to_linear;
use lancer_core::geometry::{Bounds, DVec3};
use lancer_core::mesh::{Mesh, MeshData, MeshError};
use std::collections::HashMap;
use std::ops::Range;

/// The index of an attribute that a corner lacks.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a polygon: indices into the three attribute arrays; all but the position may be [`NONE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// A polygon: its corners run from `first` to the next polygon's.
#[derive(Clone, Copy, Debug)]
struct Face {
    first: u32,
    group: u32,
    smoothing: Smoothing,
}

/// With which neighbours a face is smooth that has no normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Smoothing(u32);

impl Smoothing {
    /// None: it is a facet.
    pub(super) const FACET: Self = Self(0);

    /// Those of its kind that are within the crease angle.
    pub(super) const BY_ANGLE: Self = Self(u32::MAX);

    /// Those of its group that are within [`Crease::IN_GROUP`].
    pub(super) fn group(number: u32) -> Self {
        Self(number.clamp(1, u32::MAX - 1))
    }
}

impl Default for Smoothing {
    fn default() -> Self {
        Self::BY_ANGLE
    }
}

/// Where an image lies on a mesh: the mesh's texture coordinates become the image's by scaling, then by adding an
/// offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvPlacement {
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

impl UvPlacement {
    /// As most lie.
    pub(super) const IDENTITY: Self = Self { scale: [1.0; 2], offset: [0.0; 2] };

    pub(super) fn apply(&self, uv: [f32; 2]) -> [f32; 2] {
        if *self == Self::IDENTITY {
            return uv;
        }
        std::array::from_fn(|axis| {
            let placed = f64::from(uv[axis]) * self.scale[axis] + self.offset[axis];
            // Two large numbers may give more than single precision holds.
            placed.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
        })
    }
}

/// All polygons of one file.
#[derive(Default)]
pub(super) struct Polygons {
    /// In double precision, for models far from the origin.
    pub(super) positions: Vec<DVec3>,
    /// For each position a colour, linear; empty where there are none.
    pub(super) colors: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
    /// Of unit length, or zero where the file's was zero.
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) corners: Vec<Corner>,
    /// For each group where its image lies; those beyond the end lie as most do.
    pub(super) placements: Vec<UvPlacement>,
    /// How faces are smoothed that are ended from now on.
    pub(super) smoothing: Smoothing,
    faces: Vec<Face>,
    triangles: usize,
}

/// What keeps polygons from being meshes.
#[derive(Debug, thiserror::Error)]
pub(super) enum PolygonError {
    #[error(
        "face {face} is concave and has {corners} corners; the most are {MAX_CLIPPED_CORNERS}, and fewer for many such \
         faces"
    )]
    TooManyCorners { face: usize, corners: usize },
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// What a file has too much of, with the most that it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Excess {
    #[error("there are more than {0} triangles")]
    Triangles(usize),
    #[error("more than {0} bytes of memory are needed")]
    Memory(u64),
    #[error("there is more than 32-bit indices can name")]
    Indices,
}

impl Excess {
    /// What the user can do.
    pub(super) fn hint(self) -> &'static str {
        match self {
            Self::Triangles(_) => "--limit triangles=N allows more",
            Self::Memory(_) => {
                "--limit memory=N allows more; a packed file is granted less, so unpack it first"
            }
            Self::Indices => "cut the model into several files",
        }
    }
}

/// The warning that [`Polygons::decode_colors`] asks for.
pub(super) const COLORS_OF_255: &str = "colours of vertices go beyond 1: all are taken as fractions of 255";

/// Meshes with their groups, and the point that their vertices are relative to.
pub(super) struct Meshes {
    pub(super) meshes: Vec<(u32, Mesh)>,
    pub(super) origin: DVec3,
}

impl Polygons {
    /// Ends the polygon whose corners have been pushed since the last one. One of fewer than three corners
    /// is dropped: it covers nothing.
    ///
    /// Returns whether it was kept.
    pub(super) fn end_face(&mut self, first: usize, group: u32) -> bool {
        let corners = self.corners.len() - first;
        if corners < 3 {
            self.corners.truncate(first);
            return false;
        }
        self.triangles += corners - 2;
        self.faces.push(Face { first: first as u32, group, smoothing: self.smoothing });
        true
    }

    /// The number of triangles that the polygons will give.
    pub(super) fn triangles(&self) -> usize {
        self.triangles
    }

    /// Whether 32-bit indices still name every corner and attribute.
    fn is_indexable(&self) -> bool {
        [self.positions.len(), self.uvs.len(), self.normals.len(), self.corners.len()]
            .iter()
            .all(|&length| length < NONE as usize)
    }

    /// Decodes the colours, which are encoded in sRGB so far.
    ///
    /// Returns whether they were fractions of 255 instead of 1, as those of some programs are.
    pub(super) fn decode_colors(&mut self) -> bool {
        let of_255 = self.colors.as_flattened().iter().any(|&channel| channel > 1.0);
        let most = if of_255 { 255.0 } else { 1.0 };
        for channel in self.colors.as_flattened_mut() {
            *channel = srgb_to_linear((f64::from(*channel) / most).clamp(0.0, 1.0)) as f32;
        }
        of_255
    }

    /// What there is too much of, if anything, where a loader holds so many bytes beside the polygons.
    pub(super) fn excess(&self, limits: &Limits, beside: usize) -> Option<Excess> {
        if self.triangles > limits.triangles {
            return Some(Excess::Triangles(limits.triangles));
        }
        if self.peak_bytes().saturating_add(beside as u64) > limits.memory {
            return Some(Excess::Memory(limits.memory));
        }
        (!self.is_indexable()).then_some(Excess::Indices)
    }

    /// About the most bytes that are taken until the meshes are made: what is held, and beside it what smoothing
    /// needs, which is more than the meshes themselves.
    fn peak_bytes(&self) -> u64 {
        const FOR_A_POSITION: usize = size_of::<DVec3>() + 52;
        const FOR_A_CORNER: usize = size_of::<Corner>() + 12;
        const FOR_A_FACE: usize = size_of::<Face>() + size_of::<DVec3>();
        let bytes = self.positions.len() * FOR_A_POSITION
            + self.colors.len() * size_of::<[f32; 3]>()
            + self.uvs.len() * size_of::<[f32; 2]>()
            + self.normals.len() * size_of::<[f32; 3]>()
            + self.corners.len() * FOR_A_CORNER
            + self.faces.len() * FOR_A_FACE;
        bytes as u64
    }

    /// Gives faces without a normal at every corner smooth ones: up to `crease`, or without it as each face's
    /// [`Smoothing`] says. Where all of them are flat, nothing is changed.
    ///
    /// Returns whether any was given.
    ///
    /// # Panics
    /// Where an index is out of range.
    pub(super) fn smooth(&mut self, crease: Option<Crease>) -> bool {
        let surface = Surface::new(self, crease);
        if !(0..surface.count() as u32).any(|face| surface.is_wanted(face)) {
            return false;
        }
        let Some(CornerNormals { normals, of_corner }) = corner_normals(&surface.with_places()) else {
            return false;
        };
        let before = self.normals.len();
        // More than indices can name are left out: the faces stay facets.
        if before + normals.len() >= NONE as usize {
            return false;
        }
        self.normals.extend(normals);
        for (corner, normal) in self.corners.iter_mut().zip(of_corner) {
            if normal != NO_NORMAL {
                corner.normal = before as u32 + normal;
            }
        }
        true
    }

    /// The meshes: for each group in order, first its polygons with a normal at every corner, then those
    /// without, which become flat facets.
    ///
    /// # Errors
    /// See [`PolygonError`].
    ///
    /// # Panics
    /// Where an index is out of range.
    pub(super) fn into_meshes(self) -> Result<Meshes, PolygonError> {
        let used = self.corners.iter().map(|corner| self.positions[corner.position as usize]);
        let origin = origin_for(Bounds::of_points(used));
        let mut builder = MeshBuilder::new(&self, origin);
        let mut meshes = Vec::new();
        let parts = self.parts_of_faces();
        for faces in in_order(&parts).chunk_by(|&a, &b| parts[a as usize] == parts[b as usize]) {
            let Part { group, facets } = parts[faces[0] as usize];
            meshes.push((group, builder.build(group, faces, !facets)?));
        }
        Ok(Meshes { meshes, origin })
    }

    /// The one mesh that was written as these triangles: its vertices are the positions, in their order, each with
    /// the normal and the texture coordinates of the same index. What is no such mesh is read as any other.
    ///
    /// # Errors
    /// See [`PolygonError`].
    pub(super) fn into_mesh_as_stored(self) -> Result<Meshes, PolygonError> {
        if self.corners.len() != 3 * self.faces.len() {
            return self.into_meshes();
        }
        let corners = self.corners.as_chunks::<3>().0;
        let mesh = Mesh::new(MeshData {
            positions: self.positions.iter().map(|position| position.to_array().map(|x| x as f32)).collect(),
            normals: self.normals,
            uvs: self.uvs,
            colors: self.colors,
            indices: corners.iter().map(|corners| corners.map(|corner| corner.position)).collect(),
        })?;
        Ok(Meshes { meshes: vec![(0, mesh)], origin: DVec3::ZERO })
    }

    /// For each face the part that it belongs to.
    fn parts_of_faces(&self) -> Vec<Part> {
        let part = |i: usize| Part { group: self.faces[i].group, facets: !self.has_normals(i) };
        (0..self.faces.len()).map(part).collect()
    }

    /// Whether a face has a normal at every corner.
    fn has_normals(&self, face: usize) -> bool {
        self.corners_of(face)
            .iter()
            .all(|corner| self.normals.get(corner.normal as usize).is_some_and(|&normal| normal != [0.0; 3]))
    }

    fn corners_of(&self, face: usize) -> &[Corner] {
        let Range { start, end } = self.range_of(face);
        &self.corners[start as usize..end as usize]
    }

    /// Where the corners of a face stand.
    fn range_of(&self, face: usize) -> Range<u32> {
        let end = self.faces.get(face + 1).map_or(self.corners.len() as u32, |next| next.first);
        self.faces[face].first..end
    }
}

/// The polygons of a file as their smooth normals depend on them.
struct Surface<'a> {
    polygons: &'a Polygons,
    crease: Option<Crease>,
    joined_up_to: JoinedUpTo,
    joined_in_group: JoinedUpTo,
    origin: DVec3,
    /// For each position its place; positions that are written twice are one place.
    places: Vec<u32>,
    /// For each place a position there.
    positions: Vec<u32>,
}

impl<'a> Surface<'a> {
    /// The surface without its places, which take time to find.
    fn new(polygons: &'a Polygons, crease: Option<Crease>) -> Self {
        let joined_up_to = JoinedUpTo::new(crease.unwrap_or(Crease::DEFAULT));
        let joined_in_group = JoinedUpTo::new(Crease::IN_GROUP);
        let (places, positions) = (Vec::new(), Vec::new());
        Self { polygons, crease, joined_up_to, joined_in_group, origin: DVec3::ZERO, places, positions }
    }

    fn with_places(self) -> Self {
        let used =
            self.polygons.corners.iter().map(|corner| self.polygons.positions[corner.position as usize]);
        let origin = origin_for(Bounds::of_points(used));
        let bits = |position: &DVec3| position.to_array().map(|x| (x + 0.0).to_bits());
        let (places, positions) = places_of(self.polygons.positions.iter().map(bits));
        Self { origin, places, positions, ..self }
    }
}

impl Faces for Surface<'_> {
    fn count(&self) -> usize {
        self.polygons.faces.len()
    }

    fn corners(&self, face: u32) -> Range<u32> {
        self.polygons.range_of(face as usize)
    }

    fn places(&self) -> usize {
        self.positions.len()
    }

    fn place(&self, corner: u32) -> u32 {
        self.places[self.polygons.corners[corner as usize].position as usize]
    }

    fn point(&self, place: u32) -> DVec3 {
        self.polygons.positions[self.positions[place as usize] as usize] - self.origin
    }

    fn is_wanted(&self, face: u32) -> bool {
        let is_smooth = match self.crease {
            Some(crease) => crease != Crease::FACETS,
            None => self.polygons.faces[face as usize].smoothing != Smoothing::FACET,
        };
        is_smooth && !self.polygons.has_normals(face as usize)
    }

    fn joins(&self, a: u32, b: u32, cosine: f64) -> bool {
        let [a, b] = [a, b].map(|face| self.polygons.faces[face as usize].smoothing);
        match self.crease {
            Some(_) => self.joined_up_to.holds(cosine),
            None if a != b => false,
            None if a == Smoothing::BY_ANGLE => self.joined_up_to.holds(cosine),
            None => self.joined_in_group.holds(cosine),
        }
    }
}

/// Which mesh a face goes to, in the order of the meshes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    group: u32,
    /// Without a normal at some corner.
    facets: bool,
}

/// The places of `keys` sorted by key, equal ones in their order.
fn in_order(keys: &[impl Ord]) -> Vec<u32> {
    let mut order = (0..keys.len() as u32).collect::<Vec<_>>();
    order.sort_by(|&a, &b| keys[a as usize].cmp(&keys[b as usize]));
    order
}

/// How many times its size a model may be away from the origin before it is moved there: single precision
/// then leaves 1/2^20 of the size, where the eye sees no step. Less would move models for nothing.
const FAR: f64 = 16.0;

/// The point that vertices are stored relative to: the origin itself, or for a model far from it, a point
/// near its middle whose coordinates are short binary numbers, so that the sum with a vertex is exact.
fn origin_for(bounds: Bounds) -> DVec3 {
    let size = bounds.extent().max_element();
    if bounds.is_empty() || bounds.magnitude().max_element() <= FAR * size {
        return DVec3::ZERO;
    }
    if size == 0.0 {
        return bounds.min;
    }
    let step = power_of_two_below(size);
    (bounds.center() / step).round() * step
}

/// The greatest power of two up to a positive normal number.
fn power_of_two_below(x: f64) -> f64 {
    const EXPONENT_BITS: u64 = 0x7ff << 52;
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & EXPONENT_BITS)
}

/// Builds meshes one after another from the polygons of one file.
struct MeshBuilder<'a> {
    polygons: &'a Polygons,
    origin: DVec3,
    vertices: VertexTable,
    triangulator: Triangulator,
}

impl<'a> MeshBuilder<'a> {
    fn new(polygons: &'a Polygons, origin: DVec3) -> Self {
        let vertices = VertexTable::new(polygons.positions.len());
        Self { polygons, origin, vertices, triangulator: Triangulator::default() }
    }

    /// The mesh of some faces of a group, all with normals or all without.
    fn build(&mut self, group: u32, faces: &[u32], smooth: bool) -> Result<Mesh, PolygonError> {
        let polygons = self.polygons;
        let mut indices = Vec::with_capacity(faces.len());
        let (mut vertices, mut points) = (Vec::new(), Vec::new());
        for &face in faces {
            let corners = polygons.corners_of(face as usize);
            vertices.clear();
            vertices.extend(corners.iter().map(|&corner| {
                let normal = if smooth { corner.normal } else { NONE };
                self.vertices.index_of(Corner { normal, ..corner })
            }));
            points.clear();
            points.extend(corners.iter().map(|corner| polygons.positions[corner.position as usize]));
            let triangles = self.triangulator.triangulate(&points).map_err(|TooManyCorners| {
                PolygonError::TooManyCorners { face: face as usize + 1, corners: points.len() }
            })?;
            indices.extend(triangles.iter().map(|triangle| triangle.map(|i| vertices[i as usize])));
        }
        Ok(Mesh::new(self.mesh_data(group, smooth, indices))?)
    }

    /// The arrays of the vertices collected, which are then forgotten.
    fn mesh_data(&mut self, group: u32, smooth: bool, indices: Vec<[u32; 3]>) -> MeshData {
        let (polygons, origin) = (self.polygons, self.origin);
        let corners = self.vertices.take();
        let position = |corner: &Corner| {
            (polygons.positions[corner.position as usize] - origin).to_array().map(|x| x as f32)
        };
        let normal = |corner: &Corner| polygons.normals[corner.normal as usize];
        let placement = polygons.placements.get(group as usize).unwrap_or(&UvPlacement::IDENTITY);
        let uv = |corner: &Corner| {
            polygons.uvs.get(corner.uv as usize).map_or([0.0; 2], |&uv| placement.apply(uv))
        };
        let color = |corner: &Corner| polygons.colors[corner.position as usize];
        let has_colors = !polygons.colors.is_empty();
        let has_uvs = corners.iter().any(|corner| corner.uv != NONE);
        MeshData {
            positions: corners.iter().map(position).collect(),
            normals: if smooth { corners.iter().map(normal).collect() } else { Vec::new() },
            uvs: if has_uvs { corners.iter().map(uv).collect() } else { Vec::new() },
            colors: if has_colors { corners.iter().map(color).collect() } else { Vec::new() },
            indices,
        }
    }
}

/// Gives each combination of attributes one vertex.
///
/// Most positions occur in a single combination, which a plain array finds; further ones are hashed, by the
/// standard library's keyed hash, since a file's author may choose them.
struct VertexTable {
    corners: Vec<Corner>,
    /// For each position the first vertex there, or [`NONE`].
    first: Vec<u32>,
    others: HashMap<Corner, u32>,
}

impl VertexTable {
    fn new(positions: usize) -> Self {
        Self { corners: Vec::new(), first: vec![NONE; positions], others: HashMap::new() }
    }

    fn index_of(&mut self, corner: Corner) -> u32 {
        let new = self.corners.len() as u32;
        let first = &mut self.first[corner.position as usize];
        let index = if *first == NONE {
            *first = new;
            new
        } else if self.corners[*first as usize] == corner {
            *first
        } else {
            *self.others.entry(corner).or_insert(new)
        };
        if index == new {
            self.corners.push(corner);
        }
        index
    }

    /// The vertices in order. The table is empty then, at a cost of what it held, not of all positions.
    fn take(&mut self) -> Vec<Corner> {
        for corner in &self.corners {
            self.first[corner.position as usize] = NONE;
        }
        self.others = HashMap::new();
        std::mem::take(&mut self.corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(position: u32, normal: u32) -> Corner {
        Corner { position, uv: NONE, normal }
    }

    fn square_at(offset: DVec3) -> Polygons {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mut polygons = Polygons {
            positions: positions.map(|position| position + offset).to_vec(),
            normals: vec![[0.0, 0.0, 1.0]],
            ..Polygons::default()
        };
        polygons.corners.extend([0, 1, 2].map(|i| corner(i, 0)));
        assert!(polygons.end_face(0, 0));
        polygons.corners.extend([2, 3, 0].map(|i| corner(i, NONE)));
        assert!(polygons.end_face(3, 0));
        polygons
    }

    #[test]
    fn faces_without_normals_become_a_part_of_facets() {
        let meshes = square_at(DVec3::ZERO).into_meshes().unwrap().meshes;
        assert_eq!(meshes.len(), 2);
        assert_eq!(meshes[0].1.data().normals.len(), 3);
        assert!(meshes[1].1.data().normals.is_empty());
        assert_eq!(meshes[1].1.triangle_count(), 1);
    }

    #[test]
    fn a_zero_normal_counts_as_none() {
        let mut polygons = square_at(DVec3::ZERO);
        polygons.normals = vec![[0.0; 3]];
        let meshes = polygons.into_meshes().unwrap().meshes;
        assert_eq!(meshes.len(), 1);
        assert_eq!(meshes[0].1.triangle_count(), 2);
        assert_eq!(meshes[0].1.data().positions.len(), 4, "shared corners are one vertex");
    }

    #[test]
    fn far_models_are_stored_exactly_around_a_short_origin() {
        let far = DVec3::new(1e7 + 0.25, -3.0, 2e9);
        let Meshes { meshes, origin } = square_at(far).into_meshes().unwrap();
        let [a, b, c] = meshes[0].1.corners(0);
        assert_eq!(
            [a + origin, b + origin, c + origin],
            [far, far + DVec3::X, far + DVec3::new(1.0, 1.0, 0.0)]
        );
        assert_eq!(origin, origin.round());
    }

    #[test]
    fn near_models_stay_where_they_are() {
        assert_eq!(square_at(DVec3::splat(8.0)).into_meshes().unwrap().origin, DVec3::ZERO);
    }

    #[test]
    fn what_was_no_mesh_is_read_as_any_other_file() {
        let mut polygons = square_at(DVec3::splat(1e6));
        polygons.corners.clear();
        polygons.faces.clear();
        polygons.corners.extend([0, 1, 2, 3].map(|i| corner(i, NONE)));
        assert!(polygons.end_face(0, 0));
        let Meshes { meshes, origin } = polygons.into_mesh_as_stored().unwrap();
        assert_eq!(meshes[0].1.triangle_count(), 2);
        assert_ne!(origin, DVec3::ZERO);
    }

    #[test]
    fn polygons_of_two_corners_are_dropped() {
        let mut polygons = Polygons::default();
        polygons.corners.extend([0, 1].map(|i| corner(i, NONE)));
        assert!(!polygons.end_face(0, 0));
        assert_eq!((polygons.corners.len(), polygons.triangles()), (0, 0));
    }
}
