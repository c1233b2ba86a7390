//! The elements of a PLY file's body that are drawn: vertices, polygons and strips of triangles.

use super::header::{Element, Header, Property, PropertyType, Scalar};
use super::values::Values;
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::model::polygons::{COLORS_OF_255, Corner, Excess, NONE, Polygons};
use crate::model::text::Source;
use crate::progress::Pace;
use crate::resolver::Resolver;
use lancer_core::color::srgb_to_linear;
use lancer_core::geometry::DVec3;

/// Collects the polygons of a file.
pub(super) struct Reader<'a> {
    source: Source<'a>,
    limits: Limits,
    polygons: Polygons,
    /// How many vertices the header promises, and so the file has: indices are held against it.
    vertices: u64,
    /// Whether normals keep their length.
    is_as_stored: bool,
    has_normals: bool,
    has_uvs: bool,
    /// How the colours of vertices are written, if they have any.
    colors: Option<ColorEncoding>,
    /// How many vertices have an alpha that is less than all.
    translucent: usize,
    small_faces: usize,
    pace: Pace,
    warnings: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: Source<'a>, resolver: &Resolver) -> Self {
        Self {
            source,
            limits: resolver.limits,
            pace: resolver.progress.through(source.bytes.len()),
            polygons: Polygons::default(),
            vertices: 0,
            is_as_stored: false,
            has_normals: false,
            has_uvs: false,
            colors: None,
            translucent: 0,
            small_faces: 0,
            warnings: Vec::new(),
        }
    }

    /// Reads the body.
    ///
    /// # Errors
    /// The first fault.
    pub(super) fn read(&mut self, header: &Header, values: &mut impl Values) -> Result<(), LoadError> {
        self.is_as_stored = header.is_as_stored;
        let mut vertex_elements = header.elements.iter().filter(|element| element.name == "vertex");
        if let Some(vertices) = vertex_elements.next() {
            self.survey_vertices(vertices)?;
        }
        if vertex_elements.next().is_some() {
            return Err(LoadError::new(self.source.path, "the header has two elements `vertex`"));
        }
        for element in &header.elements {
            match element.name.as_str() {
                "vertex" => self.read_vertices(element, values)?,
                "face" => self.read_lists(element, values, Self::end_polygon)?,
                "tristrips" => self.read_lists(element, values, Self::end_strip)?,
                _ => skip_elements(element, values)?,
            }
        }
        Ok(())
    }

    /// The polygons, and what the user should know.
    ///
    /// # Errors
    /// There is nothing to draw.
    pub(super) fn finish(mut self) -> Result<(Polygons, Vec<Diagnostic>), LoadError> {
        if self.polygons.triangles() == 0 {
            let message = format!("has {} vertices, but no face to draw", self.vertices);
            return Err(LoadError::new(self.source.path, message));
        }
        if self.colors == Some(ColorEncoding::Fractions) && self.polygons.decode_colors() {
            self.warn(COLORS_OF_255);
        }
        if self.translucent > 0 {
            let message = format!("alpha is not drawn: {} vertices are not opaque", self.translucent);
            self.warn(message);
        }
        if self.small_faces > 0 {
            let message = format!("faces of fewer than 3 corners are not drawn: {}", self.small_faces);
            self.warn(message);
        }
        Ok((self.polygons, self.warnings))
    }

    fn warn(&mut self, message: impl Into<String>) {
        self.warnings.push(Diagnostic::new(self.source.path, message));
    }

    /// Learns from the header what vertices have.
    fn survey_vertices(&mut self, element: &Element) -> Result<(), LoadError> {
        let has = |role: Role| element.properties.iter().any(|property| Role::of(property) == role);
        if let Some(axis) = (0..3).find(|&axis| !has(Role::Position(axis))) {
            let message = format!("vertices have no number `{}`", ["x", "y", "z"][axis]);
            return Err(LoadError::new(self.source.path, message));
        }
        self.vertices = element.count;
        self.has_normals = (0..3).all(|axis| has(Role::Normal(axis)));
        self.has_uvs = (0..2).all(|axis| has(Role::Uv(axis)));
        let red = element.properties.iter().find(|property| Role::of(property) == Role::Color(0));
        if let Some(red) = red.filter(|_| (1..3).all(|channel| has(Role::Color(channel)))) {
            self.colors = Some(ColorEncoding::of(scalar_of(red.kind), self.is_as_stored));
        }
        Ok(())
    }

    fn read_vertices(&mut self, element: &Element, values: &mut impl Values) -> Result<(), LoadError> {
        let roles = element.properties.iter().map(Role::of).collect::<Vec<_>>();
        // The header has been held against the file's length.
        let bytes = element.count.saturating_mul(size_of::<DVec3>() as u64);
        if bytes > self.limits.memory {
            return Err(self.too_much(Excess::Memory(self.limits.memory)));
        }
        self.polygons.positions.reserve(element.count as usize);
        for _ in 0..element.count {
            values.begin_element()?;
            let mut vertex = Vertex::default();
            for (property, role) in element.properties.iter().zip(&roles) {
                let Some(slot) = vertex.slot(*role) else {
                    skip_property(property.kind, values)?;
                    continue;
                };
                *slot = finite(scalar_of(property.kind), values)?;
                if *role == Role::Alpha && *slot < opaque(scalar_of(property.kind)) {
                    self.translucent += 1;
                }
            }
            self.push(vertex);
            self.pace.at(values.offset());
        }
        Ok(())
    }

    fn push(&mut self, vertex: Vertex) {
        self.polygons.positions.push(vertex.position);
        if self.has_normals {
            let normal = if self.is_as_stored { vertex.normal } else { vertex.normal.normalize_or_zero() };
            self.polygons.normals.push(normal.to_array().map(|x| x as f32));
        }
        if self.has_uvs {
            self.polygons.uvs.push(vertex.uv.map(|x| x as f32));
        }
        if let Some(encoding) = &self.colors {
            self.polygons.colors.push(vertex.color.map(|x| encoding.decode(x)));
        }
    }

    /// Reads elements that are lists of vertices; `end` makes polygons of each, from a place in the corners.
    fn read_lists(
        &mut self,
        element: &Element,
        values: &mut impl Values,
        end: impl Fn(&mut Self, usize, &[i64]),
    ) -> Result<(), LoadError> {
        if element.count > 0 && !element.properties.iter().any(is_index_list) {
            let message = format!("elements `{}` have no list `vertex_indices`", element.name);
            return Err(LoadError::new(self.source.path, message));
        }
        if element.properties.iter().any(|property| property.name == "texcoord") {
            self.warn("texture coordinates of faces are not read, only those of vertices");
        }
        if element.properties.iter().any(|property| property.name == "red") {
            self.warn("colours of faces are not drawn, only those of vertices");
        }
        let mut indices = Vec::new();
        for _ in 0..element.count {
            values.begin_element()?;
            for property in &element.properties {
                if !is_index_list(property) {
                    skip_property(property.kind, values)?;
                    continue;
                }
                self.read_indices(property.kind, values, &mut indices)?;
                end(self, self.polygons.corners.len(), &indices);
                self.check_size()?;
            }
            self.pace.at(values.offset());
        }
        Ok(())
    }

    /// A list of vertices, each in range, or -1.
    fn read_indices(
        &self,
        kind: PropertyType,
        values: &mut impl Values,
        indices: &mut Vec<i64>,
    ) -> Result<(), LoadError> {
        indices.clear();
        let (length, item) = list_length(kind, values)?;
        for _ in 0..length {
            let index = values.next(item)?;
            if index.fract() != 0.0 || index < -1.0 || index >= self.vertices as f64 {
                let count = self.vertices;
                return Err(
                    values.fault(format!("vertex {index} is used, but there are {count}, the first is 0"))
                );
            }
            indices.push(index as i64);
        }
        Ok(())
    }

    /// Ends a polygon. A corner of -1, which only strips may have, takes it with it.
    fn end_polygon(&mut self, first: usize, indices: &[i64]) {
        if !indices.contains(&RESTART) {
            indices.iter().for_each(|&index| self.push_corner(index));
        }
        if !self.polygons.end_face(first, 0) {
            self.small_faces += 1;
        }
    }

    /// Makes triangles of a strip: each corner after the second gives one with the two before it, wound in
    /// turns; -1 begins a new strip. Triangles without area only join strips, and are left out.
    fn end_strip(&mut self, _first: usize, indices: &[i64]) {
        for strip in indices.split(|&index| index == RESTART) {
            for (i, triangle) in strip.windows(3).enumerate() {
                let &[a, b, c] = triangle else { unreachable!("a window of 3 has 3") };
                if a == b || b == c || c == a {
                    continue;
                }
                let wound = if i % 2 == 0 { [a, b, c] } else { [b, a, c] };
                let first = self.polygons.corners.len();
                wound.into_iter().for_each(|index| self.push_corner(index));
                self.polygons.end_face(first, 0);
            }
        }
    }

    /// Adds a corner to the polygon begun: all attributes of PLY have the vertex's index.
    fn push_corner(&mut self, index: i64) {
        let position = index as u32;
        let if_any = |has: bool| if has { position } else { NONE };
        let (uv, normal) = (if_any(self.has_uvs), if_any(self.has_normals));
        self.polygons.corners.push(Corner { position, uv, normal });
    }

    fn check_size(&self) -> Result<(), LoadError> {
        self.polygons.excess(&self.limits, 0).map_or(Ok(()), |excess| Err(self.too_much(excess)))
    }

    fn too_much(&self, excess: Excess) -> LoadError {
        Diagnostic::new(self.source.path, excess.to_string()).with_hint(excess.hint()).into()
    }
}

/// The alpha, written as this type, of what cannot be seen through.
fn opaque(scalar: Scalar) -> f64 {
    match scalar {
        Scalar::F32 | Scalar::F64 => 1.0,
        Scalar::U16 => f64::from(u16::MAX),
        _ => 255.0,
    }
}

/// What ends a strip in a list.
const RESTART: i64 = -1;

/// What a property of a vertex means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Position(usize),
    Normal(usize),
    Uv(usize),
    Color(usize),
    Alpha,
    Other,
}

impl Role {
    fn of(property: &Property) -> Self {
        if matches!(property.kind, PropertyType::List { .. }) {
            return Self::Other;
        }
        match property.name.as_str() {
            "x" => Self::Position(0),
            "y" => Self::Position(1),
            "z" => Self::Position(2),
            "nx" => Self::Normal(0),
            "ny" => Self::Normal(1),
            "nz" => Self::Normal(2),
            "u" | "s" | "texture_u" | "texture_s" => Self::Uv(0),
            "v" | "t" | "texture_v" | "texture_t" => Self::Uv(1),
            "red" | "r" | "diffuse_red" => Self::Color(0),
            "green" | "g" | "diffuse_green" => Self::Color(1),
            "blue" | "b" | "diffuse_blue" => Self::Color(2),
            "alpha" | "a" => Self::Alpha,
            _ => Self::Other,
        }
    }
}

/// A vertex being read.
#[derive(Clone, Copy, Default)]
struct Vertex {
    position: DVec3,
    normal: DVec3,
    uv: [f64; 2],
    color: [f64; 3],
    alpha: f64,
}

impl Vertex {
    /// Where the number of a property goes.
    fn slot(&mut self, role: Role) -> Option<&mut f64> {
        match role {
            Role::Position(axis) => Some(&mut self.position[axis]),
            Role::Normal(axis) => Some(&mut self.normal[axis]),
            Role::Uv(axis) => Some(&mut self.uv[axis]),
            Role::Color(channel) => Some(&mut self.color[channel]),
            Role::Alpha => Some(&mut self.alpha),
            Role::Other => None,
        }
    }
}

/// How a file writes the channels of its colours.
#[derive(Clone, Debug, PartialEq)]
enum ColorEncoding {
    /// Whole numbers up to 255, encoded in sRGB; what they decode to.
    Bytes(Box<[f32; 256]>),
    /// Whole numbers up to this, encoded in sRGB.
    Whole { most: f64 },
    /// Fractions, encoded in sRGB, to be decoded when all are known.
    Fractions,
    /// Numbers of a mesh, as they are.
    AsStored,
}

impl ColorEncoding {
    /// The encoding of channels of this type. Whole numbers are up to 255 but for the type that must mean more.
    fn of(scalar: Scalar, is_as_stored: bool) -> Self {
        match scalar {
            _ if is_as_stored => Self::AsStored,
            Scalar::F32 | Scalar::F64 => Self::Fractions,
            Scalar::U16 => Self::Whole { most: f64::from(u16::MAX) },
            _ => {
                Self::Bytes(Box::new(std::array::from_fn(|byte| srgb_to_linear(byte as f64 / 255.0) as f32)))
            }
        }
    }

    fn decode(&self, channel: f64) -> f32 {
        match self {
            // Numbers out of range go to its ends.
            Self::Bytes(decoded) => decoded[usize::from(channel as u8)],
            Self::Whole { most } => srgb_to_linear((channel / most).clamp(0.0, 1.0)) as f32,
            Self::Fractions | Self::AsStored => channel as f32,
        }
    }
}

fn is_index_list(property: &Property) -> bool {
    matches!(property.kind, PropertyType::List { .. })
        && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
}

/// The type of a property that [`Role::of`] found to be one number.
fn scalar_of(kind: PropertyType) -> Scalar {
    match kind {
        PropertyType::Scalar(scalar) | PropertyType::List { count: scalar, .. } => scalar,
    }
}

/// The next number, which must be one that single precision can hold.
fn finite(scalar: Scalar, values: &mut impl Values) -> Result<f64, LoadError> {
    let number = values.next(scalar)?;
    if number.abs() <= f64::from(f32::MAX) {
        return Ok(number);
    }
    Err(values.fault(format!("{number} is not a finite number")))
}

/// The length of the list that comes next, and the type of its numbers.
fn list_length(kind: PropertyType, values: &mut impl Values) -> Result<(usize, Scalar), LoadError> {
    let PropertyType::List { count, item } = kind else { return Ok((1, scalar_of(kind))) };
    let length = values.next(count)?;
    if length.fract() == 0.0 && length >= 0.0 && length <= values.most_left(item) as f64 {
        return Ok((length as usize, item));
    }
    Err(values.fault(format!("a list cannot have {length} numbers here")))
}

fn skip_property(kind: PropertyType, values: &mut impl Values) -> Result<(), LoadError> {
    let (length, item) = list_length(kind, values)?;
    for _ in 0..length {
        values.next(item)?;
    }
    Ok(())
}

fn skip_elements(element: &Element, values: &mut impl Values) -> Result<(), LoadError> {
    if element.properties.is_empty() {
        return Ok(()); // They take no bytes, however many there are.
    }
    for _ in 0..element.count {
        values.begin_element()?;
        for property in &element.properties {
            skip_property(property.kind, values)?;
        }
    }
    Ok(())
}
