//! Wavefront OBJ.
//!
//! In: the bytes of a file. Out: one mesh for each material, in the order in which the file first uses them;
//! where only some faces of a material have normals at all corners, those without are a second mesh of flat
//! facets. Faces without normals are smooth within their smoothing group (`s`), and where the file names none, up
//! to an angle. Objects and groups (`o`, `g`) only name parts; display attributes and weights of vertices are passed
//! over. Free-form geometry, points and lines are told once and left out. Names run to the end of the line and may
//! hold blanks and `#`. Three numbers after a position are a colour, encoded in sRGB: an extension by scanners.
//!
//! The parser is our own since readers that exist give no line for an error, let NaN pass, open any file that
//! `mtllib` names, and refuse text that is not UTF-8.
//!
//! Source: Alias Wavefront, "Advanced Visualizer" manual, appendix B1.

use super::mtl::MaterialLibrary;
use super::polygons::{COLORS_OF_255, Corner, NONE, Polygons, Smoothing, UvPlacement};
use super::report::{PassedOver, Report};
use super::text::{Cursor, Reference, Source, Word, decode, not_a_number, quoted};
use super::{Model, ModelOptions, ModelPart, name_of};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::progress::Pace;
use crate::resolver::Resolver;
use lancer_core::geometry::DVec3;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Reads the OBJ file at `path` and the material libraries that it names.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        let error = Diagnostic::new(path, "is written in UTF-16, which OBJ files are not");
        return Err(error.with_hint("save it as UTF-8").into());
    }
    let source = Source { path, bytes: &bytes };
    let mut parser = Parser::new(source, resolver);
    parser.parse();
    let Obj { mut polygons, groups, libraries, object, mut warnings } = parser.finish()?;

    let names = groups.iter().map(|group| group.as_deref());
    let library = MaterialLibrary::load(&libraries, source, names, resolver, &mut warnings);
    // The file is no longer needed, and what follows needs the memory.
    drop(bytes);
    polygons.smooth(options.crease);
    let material_of = |group: &Option<String>| group.as_deref().and_then(|name| library.index_of(name));
    let placement = |material: Option<usize>| {
        material.map_or(UvPlacement::IDENTITY, |material| library.placements[material])
    };
    polygons.placements = groups.iter().map(|group| placement(material_of(group))).collect();
    let meshes = polygons.into_meshes().map_err(|error| LoadError::new(path, error.to_string()))?;
    let fallback = object.unwrap_or_else(|| name_of(path));
    let part = |(group, mesh): (u32, _)| {
        let name = groups[group as usize].as_deref();
        let material = material_of(&groups[group as usize]);
        ModelPart { name: name.unwrap_or(&fallback).to_owned(), mesh: Arc::new(mesh), material }
    };
    Ok(Model {
        name: name_of(path),
        parts: meshes.meshes.into_iter().map(part).collect(),
        materials: library.materials,
        origin: meshes.origin,
        warnings,
        ..Model::default()
    })
}

/// What an OBJ file holds.
struct Obj {
    polygons: Polygons,
    /// The material of each group of polygons.
    groups: Vec<Option<String>>,
    /// What `mtllib` names.
    libraries: Vec<Reference>,
    /// The first object's or group's name.
    object: Option<String>,
    warnings: Vec<Diagnostic>,
}

/// What is left out, told once each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LeftOut {
    FreeForm,
    PointsAndLines,
    SmallFaces,
    Commands,
    Unknown,
}

impl LeftOut {
    fn message(self, keyword: &str) -> String {
        match self {
            Self::FreeForm => format!("free-form geometry is not drawn: `{keyword}`"),
            Self::PointsAndLines => format!("points and lines are not drawn: `{keyword}`"),
            Self::SmallFaces => "a face of fewer than 3 corners is not drawn".to_owned(),
            Self::Commands => {
                format!("`{keyword}` is not done: a model runs nothing and reads no other model")
            }
            Self::Unknown => format!("`{keyword}` is no statement of OBJ files and is passed over"),
        }
    }
}

/// The three arrays that a face's indices point into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Attribute {
    Position,
    Uv,
    Normal,
}

impl Attribute {
    fn noun(self) -> &'static str {
        match self {
            Self::Position => "vertex",
            Self::Uv => "texture vertex",
            Self::Normal => "normal",
        }
    }
}

/// An index beyond the attributes read so far, to be looked at again when all are.
struct ForwardIndex {
    attribute: Attribute,
    index: u32,
    offset: usize,
}

struct Parser<'a> {
    source: Source<'a>,
    limits: Limits,
    pace: Pace,
    cursor: Cursor<'a>,
    report: Report,
    polygons: Polygons,
    groups: Vec<Option<String>>,
    group_of_material: HashMap<&'a [u8], u32>,
    /// The group that faces are put in.
    group: u32,
    libraries: Vec<Reference>,
    object: Option<String>,
    forward: Vec<ForwardIndex>,
    left_out: PassedOver<'a, LeftOut>,
}

impl<'a> Parser<'a> {
    fn new(source: Source<'a>, resolver: &Resolver) -> Self {
        let limits = resolver.limits;
        Self {
            source,
            limits,
            pace: resolver.progress.through(source.bytes.len()),
            cursor: Cursor::new(source.bytes, 0),
            report: Report::new(limits.errors),
            polygons: Polygons::default(),
            groups: vec![None],
            group_of_material: HashMap::new(),
            group: 0,
            libraries: Vec::new(),
            object: None,
            forward: Vec::new(),
            left_out: PassedOver::new(),
        }
    }

    /// Reads every statement, up to a fault that makes the rest meaningless.
    fn parse(&mut self) {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        if self.source.bytes.starts_with(BYTE_ORDER_MARK) {
            self.cursor = Cursor::new(self.source.bytes, BYTE_ORDER_MARK.len());
        }
        while let Some(keyword) = self.cursor.first_word() {
            self.statement(keyword);
            self.cursor.skip_line();
            self.pace.at(self.cursor.offset());
            if let Some(excess) = self.polygons.excess(&self.limits, self.bytes_beside()) {
                let error = self.source.diagnostic(keyword.offset, format!("from here on {excess}"));
                self.report.error(|| error.with_hint(excess.hint()));
                return;
            }
        }
    }

    /// About what is held beside the polygons.
    fn bytes_beside(&self) -> usize {
        const FOR_A_NAME: usize = 160;
        (self.groups.len() - 1 + self.libraries.len()) * FOR_A_NAME
            + self.forward.len() * size_of::<ForwardIndex>()
    }

    fn statement(&mut self, keyword: Word<'a>) {
        match keyword.bytes {
            b"v" => self.position(keyword),
            b"vt" => self.uv(keyword),
            b"vn" => self.normal(keyword),
            // `fo` is what the manual's earlier versions wrote.
            b"f" | b"fo" => self.face(keyword),
            b"usemtl" => self.use_material(),
            b"mtllib" => self.libraries(),
            b"o" | b"g" => self.name(),
            b"s" => self.smoothing_group(),
            b"mg" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" | b"shadow_obj" | b"trace_obj"
            | b"usemap" | b"maplib" => {}
            b"call" | b"csh" => self.left_out.add(LeftOut::Commands, keyword),
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm"
            | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech" | b"stech" | b"bsp"
            | b"bzp" | b"cdc" | b"cdp" | b"res" => self.left_out.add(LeftOut::FreeForm, keyword),
            b"p" | b"l" => self.left_out.add(LeftOut::PointsAndLines, keyword),
            _ => self.left_out.add(LeftOut::Unknown, keyword),
        }
    }

    fn error(&mut self, place: Word, message: impl Into<String>) {
        self.report.error(|| self.source.diagnostic(place.offset, message));
    }

    fn position(&mut self, keyword: Word<'a>) {
        // A vertex at fault still counts, lest every later index be at fault too.
        let position = self.numbers::<3>(keyword, 3).unwrap_or_default();
        let before = self.polygons.positions.len();
        self.polygons.positions.push(DVec3::from_array(position));
        if let Some(color) = self.color() {
            // Vertices without one among others that have one are white.
            self.polygons.colors.resize(before, WHITE);
            self.polygons.colors.push(color);
        }
    }

    /// The colour after a position, `r g b`, perhaps with a weight before it. Anything else there is passed over.
    fn color(&mut self) -> Option<[f32; 3]> {
        let mut numbers = [0.0; 4];
        let mut count = 0;
        while let Some(word) = self.cursor.word() {
            *numbers.get_mut(count)? = word.number()?;
            count += 1;
        }
        let [a, b, c, d] = numbers.map(|x| x as f32);
        match count {
            3 => Some([a, b, c]),
            4 => Some([b, c, d]),
            _ => None,
        }
    }

    fn uv(&mut self, keyword: Word<'a>) {
        let uv = self.numbers::<2>(keyword, 1).unwrap_or_default();
        self.polygons.uvs.push(uv.map(|x| x as f32));
    }

    fn normal(&mut self, keyword: Word<'a>) {
        let normal = self.numbers::<3>(keyword, 3).unwrap_or_default();
        let unit = DVec3::from_array(normal).normalize_or_zero();
        self.polygons.normals.push(unit.to_array().map(|x| x as f32));
    }

    /// The next N numbers of the line, of which those beyond the first `required` may be absent and are 0.
    fn numbers<const N: usize>(&mut self, keyword: Word<'a>, required: usize) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (i, slot) in numbers.iter_mut().enumerate() {
            let Some(word) = self.cursor.word() else {
                if i < required {
                    let keyword_name = quoted(keyword.bytes);
                    self.error(keyword, format!("`{keyword_name}` needs {required} numbers, there are {i}"));
                    return None;
                }
                break;
            };
            let Some(number) = word.number().filter(|x| x.abs() <= f64::from(f32::MAX)) else {
                self.report.error(|| not_a_number(self.source, word));
                return None;
            };
            *slot = number;
        }
        Some(numbers)
    }

    fn face(&mut self, keyword: Word<'a>) {
        let first = self.polygons.corners.len();
        while let Some(word) = self.cursor.word() {
            match self.corner(word) {
                Ok(corner) => self.polygons.corners.push(corner),
                Err(message) => {
                    self.error(word, message);
                    self.polygons.corners.truncate(first);
                    return;
                }
            }
        }
        if !self.polygons.end_face(first, self.group) {
            self.left_out.add(LeftOut::SmallFaces, keyword);
        }
    }

    /// A corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: Word<'a>) -> Result<Corner, String> {
        let mut fields = word.bytes.split(|&byte| byte == b'/');
        let mut index = |parser: &mut Self, attribute| match fields.next() {
            None | Some(b"") => Ok(NONE),
            Some(digits) => parser.index(digits, attribute, word),
        };
        let position = index(self, Attribute::Position)?;
        let uv = index(self, Attribute::Uv)?;
        let normal = index(self, Attribute::Normal)?;
        if position == NONE || fields.next().is_some() {
            return Err(format!("`{}` is not a corner as v, v/vt, v//vn or v/vt/vn", quoted(word.bytes)));
        }
        Ok(Corner { position, uv, normal })
    }

    /// The place in its array that an index means: 1 is the first, -1 the last one read so far.
    fn index(&mut self, digits: &[u8], attribute: Attribute, word: Word) -> Result<u32, String> {
        let written = integer(digits).ok_or_else(|| format!("`{}` is not a whole number", quoted(digits)))?;
        let count = self.count_of(attribute);
        let noun = attribute.noun();
        if written == 0 {
            return Err(format!("there is no {noun} 0: the first is 1"));
        }
        let from_start = if written > 0 { written - 1 } else { count as i64 + written };
        let index = u32::try_from(from_start).ok().filter(|&index| index != NONE);
        let index = index.ok_or_else(|| out_of_range(attribute, written, count))?;
        if index as usize >= count {
            self.forward.push(ForwardIndex { attribute, index, offset: word.offset });
        }
        Ok(index)
    }

    fn count_of(&self, attribute: Attribute) -> usize {
        match attribute {
            Attribute::Position => self.polygons.positions.len(),
            Attribute::Uv => self.polygons.uvs.len(),
            Attribute::Normal => self.polygons.normals.len(),
        }
    }

    fn use_material(&mut self) {
        let name = self.cursor.rest_of_line();
        if name.bytes.is_empty() {
            self.group = 0;
            return;
        }
        self.group = *self.group_of_material.entry(name.bytes).or_insert_with(|| {
            self.groups.push(Some(decode(name.bytes).into_owned()));
            self.groups.len() as u32 - 1
        });
    }

    /// `s 3`, or `s off`, which `s 0` means too.
    fn smoothing_group(&mut self) {
        let word = self.cursor.word().map_or(&b"off"[..], |word| word.bytes);
        self.polygons.smoothing = match integer(word) {
            Some(number) if number > 0 => Smoothing::group(u32::try_from(number).unwrap_or(u32::MAX)),
            None if word == b"on" => Smoothing::group(1),
            _ => Smoothing::FACET,
        };
    }

    fn libraries(&mut self) {
        let rest = self.cursor.rest_of_line();
        let name = |name: &str| Reference { name: name.to_owned(), offset: rest.offset };
        self.libraries.extend(split_file_names(&decode(rest.bytes)).into_iter().map(name));
    }

    fn name(&mut self) {
        let name = self.cursor.rest_of_line();
        if self.object.is_none() && !name.bytes.is_empty() {
            self.object = Some(decode(name.bytes).into_owned());
        }
    }

    /// Checks what can be checked only at the end.
    fn finish(mut self) -> Result<Obj, LoadError> {
        for forward in std::mem::take(&mut self.forward) {
            let count = self.count_of(forward.attribute);
            if forward.index as usize >= count {
                let written = i64::from(forward.index) + 1;
                let message = out_of_range(forward.attribute, written, count);
                self.report.error(|| self.source.diagnostic(forward.offset, message));
            }
        }
        if !self.polygons.colors.is_empty() {
            self.polygons.colors.resize(self.polygons.positions.len(), WHITE);
            if self.polygons.decode_colors() {
                self.report.warn(Diagnostic::new(self.source.path, COLORS_OF_255));
            }
        }
        let left_out = self.left_out.warnings(self.source, LeftOut::message);
        if self.report.is_clean() && self.polygons.triangles() == 0 {
            let error = Diagnostic::new(self.source.path, "holds no face to draw");
            let hint = left_out.first().map(|diagnostic| diagnostic.message.clone());
            self.report.error(|| match hint {
                Some(hint) => error.with_hint(hint),
                None => error,
            });
        }
        left_out.into_iter().for_each(|warning| self.report.warn(warning));
        Ok(Obj {
            polygons: self.polygons,
            groups: self.groups,
            libraries: self.libraries,
            object: self.object,
            warnings: self.report.finish(self.source.path)?,
        })
    }
}

const WHITE: [f32; 3] = [1.0; 3];

fn out_of_range(attribute: Attribute, written: i64, count: usize) -> String {
    let noun = attribute.noun();
    match count {
        0 => format!("{noun} {written} is used, but there are none"),
        _ => format!("{noun} {written} is used, but there are only {count}"),
    }
}

/// A whole number with an optional sign, of at most 18 digits.
fn integer(text: &[u8]) -> Option<i64> {
    const MOST_DIGITS: usize = 18;
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > MOST_DIGITS {
        return None;
    }
    let mut value = 0_i64;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = 10 * value + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}

/// The file names of a `mtllib` statement: each may hold blanks and ends in `.mtl`; a last one need not.
fn split_file_names(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut start = 0;
    let lower = text.to_ascii_lowercase();
    for (at, extension) in lower.match_indices(".mtl") {
        let end = at + extension.len();
        if lower[end..].is_empty() || lower[end..].starts_with([' ', '\t', '"']) {
            names.push(&text[start..end]);
            start = end;
        }
    }
    names.push(&text[start..]);
    let bare = names.into_iter().map(|name| name.trim_matches(|c: char| c == '"' || c.is_whitespace()));
    bare.filter(|name| !name.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_may_hold_blanks() {
        assert_eq!(split_file_names("a.mtl"), ["a.mtl"]);
        assert_eq!(split_file_names("my lib.mtl other.MTL"), ["my lib.mtl", "other.MTL"]);
        assert_eq!(
            split_file_names("\"my lib.mtl\" b.mtl.mtl materials.txt"),
            ["my lib.mtl", "b.mtl.mtl", "materials.txt"]
        );
        assert!(split_file_names("").is_empty());
    }

    #[test]
    fn integers_are_whole_and_short() {
        assert_eq!(integer(b"-12"), Some(-12));
        assert_eq!(integer(b"+7"), Some(7));
        assert_eq!(integer(b"999999999999999999"), Some(999_999_999_999_999_999));
        for junk in [&b""[..], b"-", b"1.0", b"1e3", b"0x1", b"9999999999999999999", b"--1"] {
            assert_eq!(integer(junk), None);
        }
    }
}
