//! Primitives to meshes.
//!
//! In: the attributes, indices and mode of a primitive. Out: a mesh of the vertices that it uses, and only those,
//! for exporters let thousands of primitives share one array. Without normals it is of flat facets, as the
//! specification asks. Primitives that are alike share their mesh.

use super::accessors::{Accessor, Component};
use super::buffers::Buffers;
use super::document::{Document, Primitive};
use super::fault::{Fault, Result, Warnings};
use super::materials::UvMapping;
use crate::limits::Limits;
use crate::model::polygons::Excess;
use lancer_core::geometry::DVec3;
use lancer_core::mesh::{Mesh, MeshData, MeshError};
use std::collections::HashMap;
use std::sync::Arc;

/// How many corners of triangles there may be for each byte of the buffers. In an honest file an index takes a
/// byte or more, and few primitives share theirs; what draws its bytes more often than this is made to fill the
/// memory.
const CORNERS_PER_BYTE: u64 = 4;

/// Corners that any file may have.
const CORNERS_AT_LEAST: u64 = 1 << 20;

/// What a mesh is made from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Recipe {
    mode: u32,
    indices: Option<usize>,
    position: usize,
    normal: Option<usize>,
    color: Option<usize>,
    uv: Option<(usize, UvMapping)>,
}

/// Makes meshes, each once.
pub(super) struct MeshMaker<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    made: HashMap<Recipe, Arc<Mesh>>,
    /// Corners that may still be made.
    corners_left: u64,
    triangles_left: u64,
    bytes_left: u64,
    limits: Limits,
}

impl<'a> MeshMaker<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'a>, limits: &Limits) -> Self {
        let corners_left = buffers.total_bytes().saturating_mul(CORNERS_PER_BYTE).max(CORNERS_AT_LEAST);
        Self {
            document,
            buffers,
            made: HashMap::new(),
            corners_left,
            triangles_left: limits.triangles as u64,
            bytes_left: limits.memory,
            limits: *limits,
        }
    }

    /// The mesh of a primitive whose texture takes its coordinates as `mapping` says; `None`, and a warning, where
    /// it has nothing to draw.
    pub(super) fn mesh(
        &mut self,
        primitive: &Primitive,
        mapping: Option<&UvMapping>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Arc<Mesh>>> {
        match primitive.mode {
            0..=3 => {
                warnings.add(at, "points and lines are not drawn");
                return Ok(None);
            }
            4..=6 => {}
            mode => return Err(Fault::new(format!("{at}/mode"), format!("{mode} is no mode of primitives"))),
        }
        if !primitive.targets.is_empty() {
            warnings.add(format!("{at}/targets"), "morph targets are not applied");
        }
        let attribute = |name: &str| primitive.attributes.get(name).copied();
        let Some(position) = attribute("POSITION") else {
            warnings.add(at, "a primitive without POSITION is not drawn");
            return Ok(None);
        };
        let uv = mapping.and_then(|mapping| {
            let name = format!("TEXCOORD_{}", mapping.set);
            let found = attribute(&name);
            if found.is_none() {
                warnings.add(at, format!("has a texture and no {name}; one texel is drawn"));
            }
            Some((found?, mapping.clone()))
        });
        let recipe = Recipe {
            mode: primitive.mode,
            indices: primitive.indices,
            position,
            normal: attribute("NORMAL"),
            color: attribute("COLOR_0"),
            uv,
        };
        if let Some(mesh) = self.made.get(&recipe) {
            return Ok(Some(Arc::clone(mesh)));
        }
        let Some(data) = self.data(&recipe, at, warnings)? else { return Ok(None) };
        let mesh = Mesh::new(data).map_err(|error| fault_of_mesh(&error, at))?;
        let mesh = Arc::new(mesh);
        self.made.insert(recipe, Arc::clone(&mesh));
        Ok(Some(mesh))
    }

    fn data(&mut self, recipe: &Recipe, at: &str, warnings: &mut Warnings) -> Result<Option<MeshData>> {
        let positions = self.attribute(recipe.position, at, "POSITION", &[3], None)?;
        let count = positions.count();
        let attribute = |index, name: &str, components: &[usize]| {
            self.attribute(index, at, name, components, Some(count))
        };
        let normals = recipe.normal.map(|index| attribute(index, "NORMAL", &[3])).transpose()?;
        let colors = recipe.color.map(|index| attribute(index, "COLOR_0", &[3, 4])).transpose()?;
        let uvs = recipe.uv.as_ref().map(|(index, mapping)| {
            Ok((attribute(*index, &format!("TEXCOORD_{}", mapping.set), &[2])?, mapping))
        });
        let uvs = uvs.transpose()?;
        let indices = recipe.indices.map(|index| self.indices(index, at)).transpose()?;
        let corners = indices.as_ref().map_or(count, Accessor::count);
        let triangles = if recipe.mode == TRIANGLES { corners / 3 } else { corners.saturating_sub(2) };
        if recipe.mode == TRIANGLES && corners % 3 != 0 {
            warnings.add(at, "the last corners are fewer than a triangle's three");
        }
        if triangles == 0 {
            warnings.add(at, "a primitive without a triangle is not drawn");
            return Ok(None);
        }
        self.charge(corners, triangles, at)?;

        let mut vertices = Vertices::new(count, corners);
        let corner = |place: u64| match &indices {
            None => Ok(place as u32),
            Some(indices) => {
                let index = indices.index(place as u32);
                if u64::from(index) < count {
                    return Ok(index);
                }
                let message = format!("entry {place} is {index}, but there are only {count} vertices");
                Err(Fault::new(format!("{at}/indices"), message))
            }
        };
        let mut data = MeshData::default();
        data.indices.reserve_exact(triangles as usize);
        for triangle in 0..triangles {
            let places = match recipe.mode {
                TRIANGLES => [3 * triangle, 3 * triangle + 1, 3 * triangle + 2],
                STRIP => [triangle, triangle + 1 + triangle % 2, triangle + 2 - triangle % 2],
                _ => [triangle + 1, triangle + 2, 0],
            };
            let mut vertex = [0; 3];
            for (vertex, place) in vertex.iter_mut().zip(places) {
                *vertex = vertices.number_of(corner(place)?);
            }
            data.indices.push(vertex);
        }
        let used = vertices.used;
        for &vertex in &used {
            let position = positions.get::<3>(vertex).map(|x| x as f32);
            if position.iter().any(|x| !x.is_finite()) {
                let message = format!("the position of vertex {vertex} is not finite");
                return Err(Fault::new(&positions.pointer, message));
            }
            data.positions.push(position);
        }
        if let Some(normals) = normals {
            let unit = |&vertex: &u32| DVec3::from_array(normals.get(vertex)).try_normalize();
            match used.iter().map(unit).collect::<Option<Vec<_>>>() {
                Some(units) => {
                    data.normals = units.iter().map(|unit| unit.to_array().map(|x| x as f32)).collect();
                }
                None => warnings
                    .add(&normals.pointer, "has a normal that is zero or not finite; facets are drawn"),
            }
        }
        if let Some((uvs, mapping)) = uvs {
            let mapped = used.iter().map(|&vertex| mapping.apply(uvs.get(vertex)));
            data.uvs = mapped.map(|uv| uv.map(|x| x as f32)).collect();
        }
        if let Some(colors) = colors {
            data.colors = used.iter().map(|&vertex| colors.get(vertex).map(|x| clamped(x) as f32)).collect();
        }
        Ok(Some(data))
    }

    fn attribute(
        &self,
        index: usize,
        at: &str,
        name: &str,
        components: &[usize],
        count: Option<u64>,
    ) -> Result<Accessor<'a>> {
        let at = format!("{at}/attributes/{name}");
        let accessor = Accessor::new(self.document, self.buffers, index, &at)?;
        if !components.contains(&accessor.components()) {
            let message = format!("has {} numbers for a vertex", accessor.components());
            return Err(Fault::new(at, message));
        }
        if let Some(count) = count.filter(|&count| count != accessor.count()) {
            let message = format!("has {} entries for {count} vertices", accessor.count());
            return Err(Fault::new(at, message));
        }
        Ok(accessor)
    }

    fn indices(&self, index: usize, at: &str) -> Result<Accessor<'a>> {
        let at = format!("{at}/indices");
        let accessor = Accessor::new(self.document, self.buffers, index, &at)?;
        let is_index = matches!(accessor.component(), Component::U8 | Component::U16 | Component::U32);
        if !is_index || accessor.components() != 1 {
            return Err(Fault::new(at, "indices are unsigned whole numbers, one by one"));
        }
        Ok(accessor)
    }

    /// Takes what a primitive needs off what there may still be.
    fn charge(&mut self, corners: u64, triangles: u64, at: &str) -> Result<()> {
        /// What a triangle takes with its vertices, and a tree over it.
        const FOR_A_TRIANGLE: u64 = 100;
        let too_much =
            |excess: Excess| Fault::new(at, format!("from here on {excess}")).with_hint(excess.hint());
        let triangles_left = self.triangles_left.checked_sub(triangles);
        let triangles_left =
            triangles_left.ok_or_else(|| too_much(Excess::Triangles(self.limits.triangles)))?;
        let bytes_left = self.bytes_left.checked_sub(triangles.saturating_mul(FOR_A_TRIANGLE));
        let bytes_left = bytes_left.ok_or_else(|| too_much(Excess::Memory(self.limits.memory)))?;
        let corners_left = self.corners_left.checked_sub(corners).ok_or_else(|| {
            let message = "from here on more triangles are drawn than the file has bytes for";
            Fault::new(at, message)
        })?;
        (self.triangles_left, self.corners_left, self.bytes_left) =
            (triangles_left, corners_left, bytes_left);
        Ok(())
    }
}

const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;

fn clamped(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) }
}

fn fault_of_mesh(error: &MeshError, at: &str) -> Fault {
    Fault::new(at, error.to_string())
}

/// Numbers the vertices that are used, in the order of their first use.
struct Vertices {
    used: Vec<u32>,
    numbers: Numbers,
}

/// For each vertex of the file its number.
enum Numbers {
    /// `u32::MAX` for those without.
    Dense(Vec<u32>),
    Sparse(HashMap<u32, u32>),
}

impl Vertices {
    fn new(vertices: u64, corners: u64) -> Self {
        /// How many vertices for each corner are still numbered in a plain array.
        const DENSE: u64 = 4;
        let numbers = if vertices <= corners.saturating_mul(DENSE) {
            Numbers::Dense(vec![u32::MAX; vertices as usize])
        } else {
            Numbers::Sparse(HashMap::new())
        };
        Self { used: Vec::new(), numbers }
    }

    fn number_of(&mut self, vertex: u32) -> u32 {
        let new = self.used.len() as u32;
        let number = match &mut self.numbers {
            Numbers::Dense(numbers) => {
                let number = &mut numbers[vertex as usize];
                if *number == u32::MAX {
                    *number = new;
                }
                *number
            }
            Numbers::Sparse(numbers) => *numbers.entry(vertex).or_insert(new),
        };
        if number == new {
            self.used.push(vertex);
        }
        number
    }
}
