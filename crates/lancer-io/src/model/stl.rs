//! STL, the stereolithography format of printers and scanners.
//!
//! In: the bytes of a file, in text or in binary. Which of the two is told by the size that a binary file has
//! for its count of triangles, not by the word `solid`, with which many a binary header begins too. Out: one
//! mesh for each solid, its equal vertices joined, of flat facets unless a crease angle is asked for. Normals are passed over, since they say no
//! more than the order of the vertices, and so are the colours that some programs put into binary files.
//!
//! Source: 3D Systems, "Stereolithography interface specification", 1988.

use super::polygons::{Corner, Excess, NONE, Polygons};
use super::report::{PassedOver, Report};
use super::text::{Cursor, Source, Word, decode, kept_name, not_a_number, quoted};
use super::{Model, ModelOptions, ModelPart, UpAxis, name_of};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::resolver::Resolver;
use lancer_core::geometry::DVec3;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Bytes before the triangles of a binary file: any 80, and the number of triangles.
const HEADER: usize = 84;

/// Bytes of a triangle: its normal, three vertices, and two bytes of attributes.
const RECORD: usize = 50;

/// Reads the STL file at `path`.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    let source = Source { path, bytes: &bytes };
    let mut solids = match encoding_of(source)? {
        Encoding::Text => TextParser::new(source, resolver.limits).parse()?,
        Encoding::Binary { triangles } => read_binary(source, triangles, &resolver.limits)?,
    };
    if solids.polygons.triangles() == 0 {
        return Err(LoadError::new(path, "holds no triangle to draw"));
    }
    // Most files are of parts with sharp edges, and none says which are meant to be round.
    if options.crease.is_some() {
        solids.polygons.smooth(options.crease);
    }
    let meshes = solids.polygons.into_meshes().map_err(|error| LoadError::new(path, error.to_string()))?;
    let part = |(solid, mesh): (u32, _)| {
        let name = solids.names.get(solid as usize).filter(|name| !name.is_empty());
        ModelPart {
            name: name.cloned().unwrap_or_else(|| name_of(path)),
            mesh: Arc::new(mesh),
            material: None,
        }
    };
    Ok(Model {
        name: name_of(path),
        parts: meshes.meshes.into_iter().map(part).collect(),
        origin: meshes.origin,
        up: UpAxis::Z,
        warnings: solids.warnings,
        ..Model::default()
    })
}

/// What an STL file holds.
struct Solids {
    /// A group for each solid.
    polygons: Polygons,
    names: Vec<String>,
    warnings: Vec<Diagnostic>,
}

enum Encoding {
    Text,
    Binary { triangles: usize },
}

/// Text or binary.
///
/// A file of just the size that a binary header announces is binary. Else a file that begins with `solid` is
/// text, and of others those that are longer than announced are binary.
fn encoding_of(source: Source) -> Result<Encoding, LoadError> {
    let bytes = source.bytes;
    let announced = bytes.get(HEADER - 4..).and_then(|rest| rest.first_chunk::<4>());
    let announced = announced.map(|&count| u64::from(u32::from_le_bytes(count)));
    let size_of = |triangles: u64| HEADER as u64 + RECORD as u64 * triangles;
    let is_text = is_text(bytes);
    match announced {
        Some(triangles) if size_of(triangles) == bytes.len() as u64 => {
            Ok(Encoding::Binary { triangles: triangles as usize })
        }
        _ if is_text => Ok(Encoding::Text),
        Some(triangles) if size_of(triangles) < bytes.len() as u64 => {
            Ok(Encoding::Binary { triangles: triangles as usize })
        }
        Some(triangles) => {
            let whole = (bytes.len() - HEADER) / RECORD;
            let message = format!("ends after {whole} of the {triangles} triangles that its header promises");
            Err(LoadError::new(source.path, message))
        }
        None => Err(LoadError::new(source.path, "is neither STL text nor long enough for binary STL")),
    }
}

/// Whether a file's first word is `solid`.
fn is_text(bytes: &[u8]) -> bool {
    let word = Cursor::new(bytes, text_start(bytes)).first_word();
    word.is_some_and(|word| word.bytes.eq_ignore_ascii_case(b"solid"))
}

/// Where the text begins: after a byte order mark, if there is one.
fn text_start(bytes: &[u8]) -> usize {
    const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
    if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 }
}

fn read_binary(source: Source, triangles: usize, limits: &Limits) -> Result<Solids, LoadError> {
    let too_much = |excess: Excess| Diagnostic::new(source.path, excess.to_string()).with_hint(excess.hint());
    if triangles > limits.triangles {
        return Err(too_much(Excess::Triangles(limits.triangles)).into());
    }
    let mut vertices = Vertices::default();
    let records = source.bytes[HEADER..].chunks_exact(RECORD).take(triangles);
    for (triangle, record) in records.enumerate() {
        let first = vertices.polygons.corners.len();
        for (corner, vertex) in record[12..48].as_chunks::<12>().0.iter().enumerate() {
            let coordinate =
                |axis: usize| vertex[4 * axis..].first_chunk().map(|&bytes| f32::from_le_bytes(bytes));
            let coordinates = [0, 1, 2].map(|axis| coordinate(axis).map_or(f64::NAN, f64::from));
            let position = DVec3::from_array(coordinates);
            if !position.is_finite() {
                let place = HEADER + RECORD * triangle + 12 * (corner + 1);
                let message =
                    format!("vertex {} of triangle {triangle} (byte {place}) is not finite", corner + 1);
                return Err(LoadError::new(source.path, message));
            }
            vertices.add(position);
        }
        vertices.polygons.end_face(first, 0);
        if let Some(excess) = vertices.excess(limits) {
            return Err(too_much(excess).into());
        }
    }
    let end = HEADER + RECORD * triangles;
    let beyond = source.bytes.len() - end;
    let warning = (beyond > 0).then(|| {
        let message = format!("holds {beyond} bytes beyond its {triangles} triangles, which are passed over");
        Diagnostic::new(source.path, message)
    });
    Ok(Solids { polygons: vertices.polygons, names: Vec::new(), warnings: warning.into_iter().collect() })
}

/// Polygons whose equal vertices are one.
#[derive(Default)]
struct Vertices {
    polygons: Polygons,
    /// By the bits of the coordinates, of which none is -0. Hashed by the standard library's keyed hash, since a
    /// file's author may choose them.
    index_of: HashMap<[u64; 3], u32>,
}

impl Vertices {
    /// What there is too much of.
    fn excess(&self, limits: &Limits) -> Option<Excess> {
        const FOR_AN_INDEX: usize = 56;
        self.polygons.excess(limits, self.index_of.len() * FOR_AN_INDEX)
    }

    /// Adds a corner at a position.
    fn add(&mut self, position: DVec3) {
        let positions = &mut self.polygons.positions;
        // The sum makes a -0 a 0.
        let key = (position + DVec3::ZERO).to_array().map(f64::to_bits);
        let index = *self.index_of.entry(key).or_insert_with(|| {
            positions.push(position);
            positions.len() as u32 - 1
        });
        self.polygons.corners.push(Corner { position: index, uv: NONE, normal: NONE });
    }
}

/// Reads the words of a text file, whatever lines they stand on.
struct TextParser<'a> {
    source: Source<'a>,
    limits: Limits,
    cursor: Cursor<'a>,
    report: Report,
    vertices: Vertices,
    names: Vec<String>,
    /// Where the facet being read began among the corners.
    first_corner: usize,
    passed_over: PassedOver<'a, SmallFacet>,
}

/// A facet of fewer than three vertices, the one kind of thing that is passed over.
#[derive(Clone, Copy, PartialEq, Eq)]
struct SmallFacet;

impl<'a> TextParser<'a> {
    fn new(source: Source<'a>, limits: Limits) -> Self {
        Self {
            source,
            limits,
            cursor: Cursor::new(source.bytes, text_start(source.bytes)),
            report: Report::new(limits.errors),
            vertices: Vertices::default(),
            names: Vec::new(),
            first_corner: 0,
            passed_over: PassedOver::new(),
        }
    }

    fn parse(mut self) -> Result<Solids, LoadError> {
        // Whether a `solid`, and a `facet` in it, has begun and not ended.
        let (mut in_solid, mut in_facet) = (None, None);
        while let Some(word) = self.cursor.first_word() {
            match word.bytes.to_ascii_lowercase().as_slice() {
                b"solid" => {
                    let name = self.cursor.rest_of_line();
                    self.names.push(kept_name(&decode(name.bytes)));
                    in_solid = Some(word);
                }
                b"endsolid" => {
                    self.cursor.rest_of_line();
                    in_solid = None;
                }
                b"facet" if in_solid.is_some() => {
                    self.facet();
                    in_facet = Some(word);
                }
                b"vertex" if in_facet.is_some() => self.vertex(word),
                b"endfacet" if in_facet.is_some() => {
                    self.end_facet(word);
                    in_facet = None;
                }
                b"outer" | b"loop" | b"endloop" => {}
                b"end" => self.end_two_words(&mut in_facet, &mut in_solid),
                _ => {
                    let message = format!("`{}` is not expected here", quoted(word.bytes));
                    self.error(word, message);
                    self.cursor.skip_line();
                }
            }
            if let Some(excess) = self.vertices.excess(&self.limits) {
                let error = self.source.diagnostic(word.offset, format!("from here on {excess}"));
                self.report.error(|| error.with_hint(excess.hint()));
                break;
            }
        }
        if let Some(open) = in_facet.or(in_solid).filter(|_| self.report.is_clean()) {
            let message = format!("the file ends before this `{}` does", decode(open.bytes));
            self.error(open, message);
        }
        let message = |SmallFacet, _: &str| "a facet of fewer than 3 vertices is not drawn".to_owned();
        let told = self.passed_over.warnings(self.source, message);
        told.into_iter().for_each(|warning| self.report.warn(warning));
        let warnings = self.report.finish(self.source.path)?;
        Ok(Solids { polygons: self.vertices.polygons, names: self.names, warnings })
    }

    /// `normal` and three numbers that nobody needs, on the facet's line.
    fn facet(&mut self) {
        let mut ahead = self.cursor.clone();
        if ahead.first_word().is_some_and(|word| word.bytes.eq_ignore_ascii_case(b"normal")) {
            self.cursor = ahead;
            for _ in 0..3 {
                self.cursor.first_word();
            }
        }
        self.vertices.polygons.corners.truncate(self.first_corner);
    }

    fn vertex(&mut self, keyword: Word<'a>) {
        let mut position = [0.0; 3];
        for slot in &mut position {
            let Some(word) = self.cursor.first_word() else {
                self.error(keyword, "the file ends in this vertex");
                return;
            };
            let Some(number) = word.number().filter(|x| x.abs() <= f64::from(f32::MAX)) else {
                self.report.error(|| not_a_number(self.source, word));
                self.cursor.skip_line();
                return;
            };
            *slot = number;
        }
        self.vertices.add(DVec3::from_array(position));
    }

    fn end_facet(&mut self, word: Word<'a>) {
        let group = self.names.len() as u32 - 1;
        if !self.vertices.polygons.end_face(self.first_corner, group) {
            self.passed_over.add(SmallFacet, word);
        }
        self.first_corner = self.vertices.polygons.corners.len();
    }

    /// What some programs write for `endloop`, `endfacet` and `endsolid`.
    fn end_two_words(&mut self, in_facet: &mut Option<Word<'a>>, in_solid: &mut Option<Word<'a>>) {
        let Some(word) = self.cursor.word() else { return };
        match word.bytes.to_ascii_lowercase().as_slice() {
            b"facet" if in_facet.is_some() => {
                self.end_facet(word);
                *in_facet = None;
            }
            b"solid" => {
                self.cursor.rest_of_line();
                *in_solid = None;
            }
            b"loop" => {}
            _ => self.error(word, format!("`end {}` is not expected here", quoted(word.bytes))),
        }
    }

    fn error(&mut self, place: Word, message: impl Into<String>) {
        self.report.error(|| self.source.diagnostic(place.offset, message));
    }
}
