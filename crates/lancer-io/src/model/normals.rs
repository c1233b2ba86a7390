//! Smooth normals for faces that have none.
//!
//! In: faces, with a number for each position so that equal positions have one. Out: a normal for each corner:
//! corners about a position share one as far as the edges between their faces are smooth. An edge is smooth where
//! the normals of its two faces are no more than the crease angle apart. It knows no file format.
//!
//! A normal is the sum of those of its faces, each weighted by its angle there, so that it does not depend on how
//! a surface is cut into triangles. Source: G. Thürmer and C. A. Wüthrich, "Computing vertex normals from
//! polygonal facets" (Journal of Graphics Tools 3(1), 1998). Time is linear, but for the sorting of the edges about
//! each position; memory is some 80 bytes a triangle.

use super::options::Crease;
use lancer_core::geometry::{DVec3, portable};
use lancer_core::mesh::MeshData;
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// Gives the mesh smooth normals if it has none, and splits vertices where they differ. Where no edge is smooth,
/// nothing is changed.
///
/// All indices must be in range. Positions are told apart by their coordinates alone, so that a surface is smooth
/// across vertices that differ in texture coordinates or colours.
pub(super) fn smooth(data: &mut MeshData, crease: Crease) {
    if !data.normals.is_empty() || crease == Crease::FACETS {
        return;
    }
    let (places, points) = places_of(data.positions.iter().map(|&position| key_of(position)));
    let triangles = Triangles { data, places: &places, points: &points, crease: JoinedUpTo::new(crease) };
    if let Some(normals) = corner_normals(&triangles) {
        split(data, &normals);
    }
}

/// Faces as their normals depend on them.
pub(super) trait Faces {
    /// How many faces there are.
    fn count(&self) -> usize;

    /// A face's corners among all corners: those of a face follow those of the face before.
    fn corners(&self, face: u32) -> Range<u32>;

    /// How many places there are.
    fn places(&self) -> usize;

    /// The place of a corner. Corners at equal positions are at one place.
    fn place(&self, corner: u32) -> u32;

    /// Where a place is, about an origin near all of them.
    fn point(&self, place: u32) -> DVec3;

    /// Whether the face is to have normals.
    fn is_wanted(&self, face: u32) -> bool;

    /// Whether the edge between two faces is smooth whose unit normals have this scalar product.
    fn joins(&self, a: u32, b: u32, cosine: f64) -> bool;
}

/// The normals of corners.
pub(super) struct CornerNormals {
    /// Unit vectors.
    pub(super) normals: Vec<[f32; 3]>,
    /// For each corner the index of its normal; [`NO_NORMAL`] for those of faces that are not to have any.
    pub(super) of_corner: Vec<u32>,
}

/// The index of no normal.
pub(super) const NO_NORMAL: u32 = u32::MAX;

/// Whether the angle between two faces is within a crease angle.
#[derive(Clone, Copy)]
pub(super) struct JoinedUpTo {
    least_cosine: f64,
}

impl JoinedUpTo {
    pub(super) fn new(crease: Crease) -> Self {
        // A ten-thousandth of a degree, lest rounding decide about faces that are just the crease angle apart.
        const SLACK: f64 = 1e-4;
        let angle = (crease.degrees() + SLACK).min(180.0).to_radians();
        let is_none = crease == Crease::FACETS;
        // 180 degrees let every pair through, whatever rounding did to its scalar product.
        let least_cosine = if angle >= std::f64::consts::PI { -2.0 } else { portable::sin_cos(angle).1 };
        Self { least_cosine: if is_none { f64::INFINITY } else { least_cosine } }
    }

    pub(super) fn holds(self, cosine: f64) -> bool {
        cosine >= self.least_cosine
    }
}

/// The smooth normals of faces; `None` where all of them are flat.
///
/// A face without a direction gives none and joins none; its corners take whichever normals there are.
pub(super) fn corner_normals(faces: &impl Faces) -> Option<CornerNormals> {
    let face_normals = (0..faces.count() as u32).map(|face| face_normal(faces, face)).collect::<Vec<_>>();
    let around = Around::new(faces);
    let corners = faces.count().checked_sub(1).map_or(0, |last| faces.corners(last as u32).end);
    let mut found = CornerNormals { normals: Vec::new(), of_corner: vec![NO_NORMAL; corners as usize] };
    let mut fan = Fan::default();
    let mut is_flat = true;
    for place in 0..faces.places() as u32 {
        let corners = around.of(place);
        fan.join(faces, corners, place, &face_normals);
        is_flat &= fan.add_normals(faces, corners, place, &face_normals, &mut found);
    }
    (!is_flat).then_some(found)
}

/// A corner and the face that it is of.
#[derive(Clone, Copy, Default)]
struct FaceCorner {
    corner: u32,
    face: u32,
}

/// The corners about each place, in their order.
struct Around {
    corners: Vec<FaceCorner>,
    /// Where those of each place end.
    ends: Vec<u32>,
}

impl Around {
    /// Sorts the corners of the faces that want normals by their places, by counting.
    fn new(faces: &impl Faces) -> Self {
        let wanted = || (0..faces.count() as u32).filter(|&face| faces.is_wanted(face));
        let mut ends = vec![0_u32; faces.places() + 1];
        for corner in wanted().flat_map(|face| faces.corners(face)) {
            ends[faces.place(corner) as usize + 1] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        let mut corners = vec![FaceCorner::default(); sum as usize];
        // Each entry is now where its place begins, and then moves to where it ends.
        for face in wanted() {
            for corner in faces.corners(face) {
                let end = &mut ends[faces.place(corner) as usize];
                corners[*end as usize] = FaceCorner { corner, face };
                *end += 1;
            }
        }
        Self { corners, ends }
    }

    fn of(&self, place: u32) -> &[FaceCorner] {
        let start = place.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        &self.corners[start as usize..self.ends[place as usize] as usize]
    }
}

/// The most faces about one edge that are compared with one another. Two are usual, four lie about the edges of
/// models whose faces are there once for each side; the time grows with the square of this, and beyond it the edge
/// is sharp.
const MOST_FACES_OF_AN_EDGE: usize = 8;

/// The corners about one place, joined across smooth edges. Its memory is used again for each place.
#[derive(Default)]
struct Fan {
    /// For each edge of each corner the place at its other end, and the corner's number in the fan.
    edges: Vec<(u32, u32)>,
    /// For each corner one of those that it is joined with, or itself; never a later one.
    joined: Vec<u32>,
    /// For each first one of joined corners the sum of their normals, and the normal's index.
    sums: Vec<(DVec3, u32)>,
}

impl Fan {
    /// Joins the corners whose faces share a smooth edge that ends at `place`.
    fn join(&mut self, faces: &impl Faces, corners: &[FaceCorner], place: u32, face_normals: &[DVec3]) {
        self.joined.clear();
        self.joined.extend(0..corners.len() as u32);
        self.edges.clear();
        for (number, &corner) in (0..).zip(corners) {
            let ends = neighbours(faces, corner).map(|neighbour| faces.place(neighbour));
            self.edges.extend(ends.into_iter().filter(|&end| end != place).map(|end| (end, number)));
        }
        self.edges.sort_unstable();
        let edges = std::mem::take(&mut self.edges);
        for edge in edges.chunk_by(|a, b| a.0 == b.0).filter(|edge| edge.len() <= MOST_FACES_OF_AN_EDGE) {
            for (i, &(_, a)) in edge.iter().enumerate() {
                for &(_, b) in &edge[i + 1..] {
                    let [face_a, face_b] = [a, b].map(|number| corners[number as usize].face);
                    let [normal_a, normal_b] = [face_a, face_b].map(|face| face_normals[face as usize]);
                    let have_directions = normal_a != DVec3::ZERO && normal_b != DVec3::ZERO;
                    if have_directions && faces.joins(face_a, face_b, normal_a.dot(normal_b)) {
                        self.join_two(a, b);
                    }
                }
            }
        }
        self.edges = edges;
    }

    fn join_two(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first_of(a), self.first_of(b));
        self.joined[a.max(b) as usize] = a.min(b);
    }

    /// The first of the corners that one is joined with. Halves the way there for whoever asks next.
    fn first_of(&mut self, mut number: u32) -> u32 {
        while self.joined[number as usize] != number {
            let next = self.joined[number as usize];
            self.joined[number as usize] = self.joined[next as usize];
            number = next;
        }
        number
    }

    /// Adds a normal for each set of joined corners. Returns whether all are those of their faces.
    fn add_normals(
        &mut self,
        faces: &impl Faces,
        corners: &[FaceCorner],
        place: u32,
        face_normals: &[DVec3],
        found: &mut CornerNormals,
    ) -> bool {
        self.sums.clear();
        self.sums.resize(corners.len(), (DVec3::ZERO, NO_NORMAL));
        let normal_of = |corner: &FaceCorner| face_normals[corner.face as usize];
        for (number, &corner) in corners.iter().enumerate() {
            let normal = normal_of(&corner);
            let angle = angle_at(faces, corner, place, normal);
            let first = self.first_of(number as u32);
            self.sums[first as usize].0 += normal * angle;
        }
        let mut any = NO_NORMAL;
        let mut is_flat = true;
        for (number, corner) in corners.iter().enumerate() {
            let normal = normal_of(corner);
            if normal == DVec3::ZERO {
                continue;
            }
            let first = self.first_of(number as u32) as usize;
            let (sum, index) = &mut self.sums[first];
            if *index == NO_NORMAL {
                *index = found.normals.len() as u32;
                // Normals that cancel out leave that of the first face.
                *sum = sum.try_normalize().unwrap_or(normal);
                found.normals.push(sum.to_array().map(|x| x as f32));
            }
            is_flat &= sum.dot(normal) >= FLAT;
            found.of_corner[corner.corner as usize] = *index;
            any = any.min(*index);
        }
        for corner in corners.iter().filter(|&corner| normal_of(corner) == DVec3::ZERO) {
            if any == NO_NORMAL {
                any = found.normals.len() as u32;
                found.normals.push([0.0, 1.0, 0.0]);
            }
            found.of_corner[corner.corner as usize] = any;
        }
        is_flat
    }
}

/// The least cosine between a face and its normals if it is to be flat: a twelfth of a degree, which nobody sees.
const FLAT: f64 = 1.0 - 1e-6;

/// The corners before and after one in its face.
fn neighbours(faces: &impl Faces, FaceCorner { corner, face }: FaceCorner) -> [u32; 2] {
    let Range { start, end } = faces.corners(face);
    let before = if corner == start { end - 1 } else { corner - 1 };
    let after = if corner + 1 == end { start } else { corner + 1 };
    [before, after]
}

/// The angle of a face, of which `normal` is the unit normal, at one of its corners, in radians.
fn angle_at(faces: &impl Faces, corner: FaceCorner, place: u32, normal: DVec3) -> f64 {
    let at = faces.point(place);
    let [before, after] = neighbours(faces, corner).map(|corner| faces.point(faces.place(corner)) - at);
    let angle = portable::atan2(after.cross(before).dot(normal), after.dot(before));
    // A concave polygon's corner may have more than half a turn.
    if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
}

/// How thin a face may be, against the size of its coordinates, and still have a direction. Thinner ones are made
/// of single precision's rounding, 2^-24, and would turn their neighbours' normals to anywhere.
const THINNEST: f64 = 1.0 / (1_u32 << 22) as f64;

/// The unit normal of a face, or zero where it has no direction. Source: Newell's sum for polygons.
fn face_normal(faces: &impl Faces, face: u32) -> DVec3 {
    let mut points = faces.corners(face).map(|corner| faces.point(faces.place(corner)));
    let Some(origin) = points.next() else { return DVec3::ZERO };
    let (mut sum, mut longest, mut magnitude) = (DVec3::ZERO, 0.0_f64, origin.abs().max_element());
    let mut before = DVec3::ZERO;
    for point in points {
        let edge = point - origin;
        sum += before.cross(edge);
        longest = longest.max(edge.length_squared());
        magnitude = magnitude.max(point.abs().max_element());
        before = edge;
    }
    let length = sum.length();
    if length > longest.sqrt() * magnitude * THINNEST { sum / length } else { DVec3::ZERO }
}

/// For each key the number of its first like, and for each number where its key first stands.
pub(super) fn places_of<K: Hash + Eq>(keys: impl ExactSizeIterator<Item = K>) -> (Vec<u32>, Vec<u32>) {
    let mut firsts = Vec::new();
    // The standard library's hash is keyed: a file's author may choose what is hashed.
    let mut number_of = HashMap::with_capacity(keys.len());
    let number = |(index, key)| {
        *number_of.entry(key).or_insert_with(|| {
            firsts.push(index as u32);
            firsts.len() as u32 - 1
        })
    };
    let numbers = keys.enumerate().map(number).collect();
    (numbers, firsts)
}

/// What is the same for equal coordinates, and no others: their bits, once 0 and -0 are one.
fn key_of(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

/// The triangles of a mesh.
struct Triangles<'a> {
    data: &'a MeshData,
    /// For each vertex its place.
    places: &'a [u32],
    /// For each place a vertex there.
    points: &'a [u32],
    crease: JoinedUpTo,
}

impl Faces for Triangles<'_> {
    fn count(&self) -> usize {
        self.data.indices.len()
    }

    fn corners(&self, face: u32) -> Range<u32> {
        3 * face..3 * face + 3
    }

    fn places(&self) -> usize {
        self.points.len()
    }

    fn place(&self, corner: u32) -> u32 {
        self.places[self.data.indices.as_flattened()[corner as usize] as usize]
    }

    fn point(&self, place: u32) -> DVec3 {
        self.data.positions[self.points[place as usize] as usize].map(f64::from).into()
    }

    fn is_wanted(&self, _: u32) -> bool {
        true
    }

    fn joins(&self, _: u32, _: u32, cosine: f64) -> bool {
        self.crease.holds(cosine)
    }
}

/// Gives each corner its normal: a vertex keeps the first that is asked of it, and is copied for each other.
fn split(data: &mut MeshData, found: &CornerNormals) {
    let vertices = data.positions.len();
    let mut normal_of = vec![NO_NORMAL; vertices];
    let mut copies = HashMap::new();
    for (index, &normal) in data.indices.as_flattened_mut().iter_mut().zip(&found.of_corner) {
        let vertex = *index;
        let first = &mut normal_of[vertex as usize];
        if *first == NO_NORMAL {
            *first = normal;
        } else if *first != normal {
            *index = *copies.entry((vertex, normal)).or_insert_with(|| {
                copy_vertex(&mut data.positions, vertex);
                copy_vertex(&mut data.uvs, vertex);
                copy_vertex(&mut data.colors, vertex);
                normal_of.push(normal);
                normal_of.len() as u32 - 1
            });
        }
    }
    // Vertices of no triangle have no normal.
    let normal = |&index: &u32| found.normals.get(index as usize).copied().unwrap_or_default();
    data.normals = normal_of.iter().map(normal).collect();
}

/// Adds a copy of a vertex to an attribute array, unless that is empty.
fn copy_vertex<T: Copy>(attribute: &mut Vec<T>, vertex: u32) {
    if let Some(&value) = attribute.get(vertex as usize) {
        attribute.push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::mesh::Mesh;
    use proptest::prelude::*;

    fn degrees(degrees: f64) -> Crease {
        Crease::from_degrees(degrees).unwrap()
    }

    /// The cube [-1,1]^3: 8 vertices, 12 triangles.
    fn cube() -> MeshData {
        let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
        let positions = (0..8).map(|i: u32| [sign(i & 1), sign(i & 2), sign(i & 4)]).collect();
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        MeshData { positions, indices, ..MeshData::default() }
    }

    /// A globe without poles: quadrilaterals between `rings` circles of latitude, open at both ends.
    fn belt(rings: u32, segments: u32) -> MeshData {
        let mut data = MeshData::default();
        for ring in 0..rings {
            let (sin, cos) = portable::sin_cos(f64::from(ring) / f64::from(rings - 1) - 0.5);
            for segment in 0..segments {
                let turn = f64::from(segment) / f64::from(segments) * std::f64::consts::TAU;
                let (x, z) = portable::sin_cos(turn);
                data.positions.push([x * cos, sin, z * cos].map(|x| x as f32));
            }
        }
        for ring in 1..rings {
            for segment in 0..segments {
                let [a, b] = [segment, (segment + 1) % segments].map(|s| s + (ring - 1) * segments);
                let [c, d] = [b + segments, a + segments];
                data.indices.extend([[a, b, c], [a, c, d]]);
            }
        }
        data
    }

    fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
        DVec3::from(a.map(f64::from)).dot(b.map(f64::from).into())
    }

    #[test]
    fn a_cube_is_sharp_below_90_degrees_and_round_from_there() {
        let mut sharp = cube();
        smooth(&mut sharp, degrees(89.9));
        assert_eq!(sharp, cube(), "flat faces need no normals");

        for crease in [degrees(90.0), Crease::SMOOTH] {
            let mut round = cube();
            smooth(&mut round, crease);
            assert_eq!((&round.positions, &round.indices), (&cube().positions, &cube().indices));
            for (normal, position) in round.normals.iter().zip(&round.positions) {
                // Each corner's three faces weigh the same, however they are cut into triangles.
                let expected = position.map(|x| x / 3_f32.sqrt());
                assert!(dot(*normal, expected) > 1.0 - 1e-6, "{normal:?} at {position:?}");
            }
        }
    }

    #[test]
    fn no_crease_leaves_facets() {
        let mut facets = belt(5, 12);
        smooth(&mut facets, Crease::FACETS);
        assert_eq!(facets, belt(5, 12));
    }

    #[test]
    fn normals_of_a_fine_globe_point_outward() {
        let mut globe = belt(41, 200);
        smooth(&mut globe, degrees(20.0));
        assert_eq!(globe.positions.len(), globe.normals.len());
        assert_eq!(globe.positions.len(), 41 * 200);
        for ring in 1..40 {
            let vertex = ring * 200 + 17;
            assert!(dot(globe.normals[vertex], globe.positions[vertex]) > 1.0 - 1e-5);
        }
    }

    #[test]
    fn edges_are_judged_one_by_one() {
        // A roof of 60 degrees at its ridge; the walls below bend by 30 from it.
        let data = MeshData {
            positions: vec![
                [0.0, 0.0, 0.0],
                [0.0, 0.0, 1.0],
                [-1.0, -0.57735, 0.0],
                [-1.0, -0.57735, 1.0],
                [1.0, -0.57735, 0.0],
                [1.0, -0.57735, 1.0],
                [1.57735, -1.57735, 0.0],
                [1.57735, -1.57735, 1.0],
            ],
            indices: vec![[0, 2, 3], [0, 3, 1], [0, 1, 5], [0, 5, 4], [4, 5, 7], [4, 7, 6]],
            ..MeshData::default()
        };
        let mut bent = data.clone();
        smooth(&mut bent, degrees(45.0));
        assert_eq!(bent.positions.len(), 10, "the ridge alone is split");
        assert!(dot(bent.normals[2], [-0.5, 0.866_025, 0.0]) > 1.0 - 1e-5);
        let mut round = data;
        smooth(&mut round, degrees(60.1));
        assert_eq!(round.positions.len(), 8);
        assert!(dot(round.normals[0], [0.0, 1.0, 0.0]) > 1.0 - 1e-5);
    }

    #[test]
    fn seams_of_texture_coordinates_are_smooth() {
        let whole = belt(5, 24);
        let mut cut = whole.clone();
        // Every triangle has vertices of its own.
        cut.positions = whole.indices.as_flattened().iter().map(|&i| whole.positions[i as usize]).collect();
        cut.uvs = (0..cut.positions.len()).map(|i| [i as f32, 0.0]).collect();
        cut.colors = vec![[0.5; 3]; cut.positions.len()];
        for (index, corner) in cut.indices.as_flattened_mut().iter_mut().zip(0..) {
            *index = corner;
        }
        let mut whole = whole;
        smooth(&mut whole, degrees(30.0));
        smooth(&mut cut, degrees(30.0));
        for (triangle, corners) in whole.indices.iter().enumerate() {
            for (corner, &vertex) in corners.iter().enumerate() {
                let other = cut.indices[triangle][corner];
                assert_eq!(whole.normals[vertex as usize], cut.normals[other as usize]);
            }
        }
        assert!(Mesh::new(cut).is_ok());
    }

    #[test]
    fn faces_without_area_turn_nothing() {
        let whole = belt(5, 24);
        let mut with = whole.clone();
        let middle = with.positions.len() as u32;
        // A needle along an edge whose third corner lies on it but for rounding, and triangles of fewer corners.
        let [a, b] = [with.positions[0], with.positions[1]];
        with.positions.push([0, 1, 2].map(|i| a[i] * 0.5 + b[i] * 0.5));
        with.indices.extend([[1, 0, middle], [3, 3, 4], [7, 7, 7]]);
        let mut without = whole;
        smooth(&mut without, degrees(40.0));
        smooth(&mut with, degrees(40.0));
        for (triangle, corners) in without.indices.iter().enumerate() {
            for (corner, &vertex) in corners.iter().enumerate() {
                let other = with.indices[triangle][corner];
                assert_eq!(without.normals[vertex as usize], with.normals[other as usize]);
            }
        }
        assert!(with.normals.iter().all(|&normal| (dot(normal, normal) - 1.0).abs() < 1e-6));
    }

    #[test]
    fn both_sides_of_doubled_faces_are_smooth() {
        let mut doubled = belt(5, 24);
        let back = doubled.indices.iter().map(|&[a, b, c]| [a, c, b]).collect::<Vec<_>>();
        let front = doubled.indices.len();
        doubled.indices.extend(back);
        smooth(&mut doubled, degrees(40.0));
        let mut single = belt(5, 24);
        smooth(&mut single, degrees(40.0));
        for (triangle, corners) in single.indices.iter().enumerate() {
            let normal = single.normals[corners[0] as usize];
            assert_eq!(normal, doubled.normals[doubled.indices[triangle][0] as usize]);
            let behind = doubled.normals[doubled.indices[front + triangle][0] as usize];
            assert!(dot(normal, behind) < -1.0 + 1e-6);
        }
    }

    #[test]
    fn a_position_of_very_many_faces_costs_little() {
        // 300,000 triangles about one edge, and about its two ends.
        let mut data = MeshData { positions: vec![[0.0; 3], [0.0, 1.0, 0.0]], ..MeshData::default() };
        for i in 0..300_000_u32 {
            let (sin, cos) = portable::sin_cos(f64::from(i));
            data.positions.push([sin as f32, 0.5, cos as f32]);
            data.indices.push([0, 1, 2 + i]);
        }
        let before = data.clone();
        smooth(&mut data, Crease::SMOOTH);
        assert_eq!(data, before, "an edge of so many faces is sharp");
    }

    proptest! {
        #[test]
        fn any_mesh_stays_the_same_surface(
            positions in prop::collection::vec((-3_i8..3, -3_i8..3, -3_i8..3), 3..20),
            corners in prop::collection::vec(any::<prop::sample::Index>(), 3..90),
            crease in 0.0..180.0,
        ) {
            let positions = positions.iter().map(|&(x, y, z)| [x, y, z].map(f32::from)).collect::<Vec<_>>();
            let indices = corners.as_chunks::<3>().0.iter()
                .map(|corners| corners.map(|corner| corner.index(positions.len()) as u32)).collect();
            let before = MeshData { positions, indices, ..MeshData::default() };
            let mut after = before.clone();
            smooth(&mut after, degrees(crease));
            let after = Mesh::new(after).unwrap();
            let before = Mesh::new(before).unwrap();
            prop_assert_eq!(before.triangle_count(), after.triangle_count());
            for triangle in 0..before.triangle_count() as u32 {
                prop_assert_eq!(before.vertices(triangle), after.vertices(triangle));
                for normal in after.corner_normals(triangle).into_iter().flatten() {
                    prop_assert!((normal.length() - 1.0).abs() < 1e-6);
                }
            }
        }
    }
}
