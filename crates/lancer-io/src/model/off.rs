//! OFF, Geomview's object file format.
//!
//! In: the bytes of a text file, with any of the prefixes `ST`, `C` and `N`, which give vertices texture
//! coordinates, colours and normals. Out: one mesh. Colours of vertices and of faces become colours of the mesh;
//! where a file has both, faces win, as in Geomview. They are sRGB-encoded, whole numbers up to 255 or fractions
//! up to 1, by what the file's largest is. Binary files, and those of other dimensions than three, are refused.
//!
//! Source: Geomview manual, "OFF files".

use super::polygons::{Corner, Excess, NONE, Polygons};
use super::report::{PassedOver, Report};
use super::text::{Cursor, Source, Word, not_a_number, quoted};
use super::{Model, ModelOptions, ModelPart, name_of};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::resolver::Resolver;
use lancer_core::color::srgb_to_linear;
use lancer_core::geometry::DVec3;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Reads the OFF file at `path`.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    let source = Source { path, bytes: &bytes };
    let mut parser = Parser::new(source, resolver.limits);
    let header = parser.header()?;
    parser.vertices(&header)?;
    parser.faces(&header)?;
    let (mut polygons, warnings) = parser.finish()?;
    polygons.smooth(options.crease);
    let meshes = polygons.into_meshes().map_err(|error| LoadError::new(path, error.to_string()))?;
    let part = |(_, mesh)| ModelPart { name: name_of(path), mesh: Arc::new(mesh), material: None };
    Ok(Model {
        name: name_of(path),
        parts: meshes.meshes.into_iter().map(part).collect(),
        origin: meshes.origin,
        warnings,
        ..Model::default()
    })
}

/// What the first words of a file say of the rest.
struct Header<'a> {
    uvs: bool,
    colors: bool,
    normals: bool,
    vertices: usize,
    faces: usize,
    /// Where the counts stand.
    counts: Word<'a>,
}

/// The colour of what has none. No number, since what white is written as depends on the file.
const WHITE: [f64; 3] = [f64::INFINITY; 3];

struct Parser<'a> {
    source: Source<'a>,
    limits: Limits,
    cursor: Cursor<'a>,
    report: Report,
    polygons: Polygons,
    /// For each position its colour as written; white where there is none.
    colors: Vec<[f64; 3]>,
    /// Whether any colour is written.
    has_colors: bool,
    /// The positions of corners whose colour is that of their face, by vertex and by the colour's bits.
    position_of: HashMap<(u32, [u64; 3]), u32>,
    passed_over: PassedOver<'a, SmallFace>,
}

/// A face of fewer than three corners, the one kind of thing that is passed over.
#[derive(Clone, Copy, PartialEq, Eq)]
struct SmallFace;

impl<'a> Parser<'a> {
    fn new(source: Source<'a>, limits: Limits) -> Self {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        let start = if source.bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Self {
            source,
            limits,
            cursor: Cursor::new(source.bytes, start),
            report: Report::new(limits.errors),
            polygons: Polygons::default(),
            colors: Vec::new(),
            has_colors: false,
            position_of: HashMap::new(),
            passed_over: PassedOver::new(),
        }
    }

    /// The keyword, which may be missing, and the counts.
    fn header(&mut self) -> Result<Header<'a>, LoadError> {
        let too_short = || LoadError::new(self.source.path, "holds no numbers of vertices and faces");
        let mut word = self.cursor.first_word().ok_or_else(too_short)?;
        let (mut uvs, mut colors, mut normals) = (false, false, false);
        if let Some(prefixes) = word.bytes.strip_suffix(b"OFF") {
            let mut rest = prefixes;
            uvs = take(&mut rest, b"ST");
            colors = take(&mut rest, b"C");
            normals = take(&mut rest, b"N");
            match rest {
                b"" => {}
                b"4" | b"n" | b"4n" => {
                    let message =
                        format!("`{}` has vertices of other than three dimensions", quoted(word.bytes));
                    return Err(self.fault(word, message));
                }
                _ => {
                    return Err(
                        self.fault(word, format!("`{}` is no keyword of OFF files", quoted(word.bytes)))
                    );
                }
            }
            word = self.cursor.first_word().ok_or_else(too_short)?;
            if word.bytes == b"BINARY" {
                let error = self.source.diagnostic(word.offset, "is a binary OFF file, which is not read");
                return Err(error.with_hint("save it as text").into());
            }
        }
        let counts = word;
        let vertices = self.count(counts, counts)?;
        let faces = self.cursor.first_word().ok_or_else(too_short)?;
        let faces = self.count(faces, counts)?;
        // The number of edges, which nobody needs and some leave out.
        self.cursor.skip_line();
        Ok(Header { uvs, colors, normals, vertices, faces, counts })
    }

    /// A number of elements, each of which takes two bytes at least.
    fn count(&self, word: Word, place: Word) -> Result<usize, LoadError> {
        let digits = std::str::from_utf8(word.bytes).ok();
        let Some(count) = digits.and_then(|digits| digits.parse::<u64>().ok()) else {
            let message = format!("`{}` is not a number of elements", quoted(word.bytes));
            return Err(self.fault(word, message));
        };
        let left = self.source.bytes.len() - place.offset;
        if count > left as u64 / 2 {
            let message = format!("the file is too short for {count} elements");
            return Err(self.fault(word, message));
        }
        Ok(count as usize)
    }

    fn vertices(&mut self, header: &Header<'a>) -> Result<(), LoadError> {
        let bytes = header.vertices * (size_of::<DVec3>() + size_of::<[f64; 3]>());
        if bytes as u64 > self.limits.memory {
            return Err(self.too_much(header.counts, Excess::Memory(self.limits.memory)));
        }
        self.polygons.positions.reserve_exact(header.vertices);
        for done in 0..header.vertices {
            let Some(first) = self.cursor.first_word() else {
                let message = format!("the file ends after {done} of {} vertices", header.vertices);
                return Err(self.fault(header.counts, message));
            };
            self.cursor = Cursor::new(self.source.bytes, first.offset);
            let position = self.numbers::<3>(first)?;
            self.polygons.positions.push(DVec3::from_array(position));
            if header.normals {
                let normal = DVec3::from_array(self.numbers::<3>(first)?).normalize_or_zero();
                self.polygons.normals.push(normal.to_array().map(|x| x as f32));
            }
            let color = if header.colors { self.vertex_color(header, first)? } else { WHITE };
            self.colors.push(color);
            if header.uvs {
                let uv = self.numbers::<2>(first)?;
                self.polygons.uvs.push(uv.map(|x| x as f32));
            }
            self.cursor.skip_line();
        }
        Ok(())
    }

    /// Three numbers of a colour, and a fourth that is passed over, before those of texture coordinates.
    fn vertex_color(&mut self, header: &Header, vertex: Word<'a>) -> Result<[f64; 3], LoadError> {
        let uv_words = if header.uvs { 2 } else { 0 };
        let components = self.words_left().saturating_sub(uv_words).min(4);
        if components < 3 {
            return Err(self.fault(vertex, "this vertex lacks a colour of three or four numbers"));
        }
        let color = self.numbers::<3>(vertex)?;
        if components == 4 {
            self.number(vertex)?;
        }
        self.has_colors = true;
        Ok(color)
    }

    /// How many words the line still has, up to six.
    fn words_left(&self) -> usize {
        let mut ahead = self.cursor.clone();
        std::iter::from_fn(|| ahead.word()).take(6).count()
    }

    fn numbers<const N: usize>(&mut self, element: Word<'a>) -> Result<[f64; N], LoadError> {
        let mut numbers = [0.0; N];
        for slot in &mut numbers {
            *slot = self.number(element)?;
        }
        Ok(numbers)
    }

    /// The next number of the line.
    fn number(&mut self, element: Word<'a>) -> Result<f64, LoadError> {
        let Some(word) = self.cursor.word() else {
            return Err(self.fault(element, "the line ends before all numbers of this vertex"));
        };
        let number = word.number().filter(|x| x.abs() <= f64::from(f32::MAX));
        number.ok_or_else(|| not_a_number(self.source, word).into())
    }

    fn faces(&mut self, header: &Header<'a>) -> Result<(), LoadError> {
        for done in 0..header.faces {
            let Some(count) = self.cursor.first_word() else {
                let message = format!("the file ends after {done} of {} faces", header.faces);
                return Err(self.fault(header.counts, message));
            };
            self.face(header, count);
            self.cursor.skip_line();
            const FOR_A_COLOR: usize = size_of::<[f64; 3]>() + 72;
            if let Some(excess) = self.polygons.excess(&self.limits, self.colors.len() * FOR_A_COLOR) {
                return Err(self.too_much(count, excess));
            }
        }
        Ok(())
    }

    fn face(&mut self, header: &Header, count: Word<'a>) {
        let first = self.polygons.corners.len();
        let Some(corners) = whole(count) else {
            let message = format!("`{}` is not a number of corners", quoted(count.bytes));
            return self.error(count, message);
        };
        for _ in 0..corners {
            let Some(word) = self.cursor.word() else {
                self.polygons.corners.truncate(first);
                return self.error(count, "the line ends before all corners of this face");
            };
            let index = whole(word).filter(|&index| index < header.vertices as u64);
            let Some(index) = index else {
                self.polygons.corners.truncate(first);
                let (written, vertices) = (quoted(word.bytes), header.vertices);
                return self.error(
                    word,
                    format!("`{written}` is no vertex of the {vertices} that there are, from 0"),
                );
            };
            let position = index as u32;
            let used = |present: bool| if present { position } else { NONE };
            self.polygons.corners.push(Corner {
                position,
                uv: used(header.uvs),
                normal: used(header.normals),
            });
        }
        // One number is an entry of a colour map, which the file does not hold.
        if matches!(self.words_left(), 3 | 4) {
            match self.numbers::<3>(count) {
                Ok(color) => self.color_corners(first, color),
                Err(error) => {
                    self.polygons.corners.truncate(first);
                    return error.diagnostics.into_iter().for_each(|told| self.report.error(|| told));
                }
            }
        }
        if !self.polygons.end_face(first, 0) {
            self.passed_over.add(SmallFace, count);
        }
    }

    /// Gives the corners from `first` on positions of a colour.
    fn color_corners(&mut self, first: usize, color: [f64; 3]) {
        self.has_colors = true;
        let positions = &mut self.polygons.positions;
        for corner in &mut self.polygons.corners[first..] {
            let key = (corner.position, color.map(f64::to_bits));
            corner.position = *self.position_of.entry(key).or_insert_with(|| {
                positions.push(positions[corner.position as usize]);
                self.colors.push(color);
                positions.len() as u32 - 1
            });
        }
    }

    fn finish(mut self) -> Result<(Polygons, Vec<Diagnostic>), LoadError> {
        let message = |SmallFace, _: &str| "a face of fewer than 3 corners is not drawn".to_owned();
        self.passed_over
            .warnings(self.source, message)
            .into_iter()
            .for_each(|warning| self.report.warn(warning));
        if self.report.is_clean() && self.polygons.triangles() == 0 {
            self.report.error(|| Diagnostic::new(self.source.path, "holds no face to draw"));
        }
        if self.has_colors {
            let written = self.colors.iter().filter(|color| **color != WHITE).flatten();
            let largest = written.copied().fold(0.0, f64::max);
            let white = if largest > 1.0 { 255.0 } else { 1.0 };
            let channel = |x: f64| srgb_to_linear((x / white).clamp(0.0, 1.0)) as f32;
            let decoded = |color: &[f64; 3]| if *color == WHITE { [1.0; 3] } else { color.map(channel) };
            self.polygons.colors = self.colors.iter().map(decoded).collect();
        }
        let warnings = self.report.finish(self.source.path)?;
        Ok((self.polygons, warnings))
    }

    fn too_much(&self, place: Word, excess: Excess) -> LoadError {
        let error = self.source.diagnostic(place.offset, format!("from here on {excess}"));
        error.with_hint(excess.hint()).into()
    }

    fn fault(&self, place: Word, message: impl Into<String>) -> LoadError {
        self.source.diagnostic(place.offset, message).into()
    }

    fn error(&mut self, place: Word, message: impl Into<String>) {
        self.report.error(|| self.source.diagnostic(place.offset, message));
    }
}

/// Takes a prefix off, if it is there.
fn take(rest: &mut &[u8], prefix: &[u8]) -> bool {
    let stripped = rest.strip_prefix(prefix);
    *rest = stripped.unwrap_or(rest);
    stripped.is_some()
}

/// The whole number that a word is.
fn whole(word: Word) -> Option<u64> {
    std::str::from_utf8(word.bytes).ok()?.parse().ok()
}
