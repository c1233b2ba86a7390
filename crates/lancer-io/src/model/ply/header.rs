//! The header of a PLY file: what its body holds, and how it is written.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::model::text::{Cursor, Source, Word, decode, quoted};

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number in binary.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One number, or a list with its length before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyType {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyType,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The fewest bytes that one such element takes.
    fn least_bytes(&self, encoding: Encoding) -> u64 {
        let bytes = |property: &Property| match (encoding, property.kind) {
            // A digit and what parts it from the next; only the file's last number may lack that.
            (Encoding::Ascii, _) => 2,
            (_, PropertyType::Scalar(scalar) | PropertyType::List { count: scalar, .. }) => {
                scalar.size() as u64
            }
        };
        self.properties.iter().map(bytes).sum()
    }
}

/// How many lines that are not understood are told: some programs forget the word `comment`.
const MOST_WARNINGS: usize = 3;

/// The information by which a file says that its numbers are those of a mesh, to be taken as they are.
pub(super) const AS_STORED: &str = "lancer: numbers as stored";

/// What a PLY file says about itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Whether [`AS_STORED`] stands in it.
    pub(super) is_as_stored: bool,
    /// Where the body begins.
    pub(super) body: usize,
    /// What is odd about it.
    pub(super) warnings: Vec<Diagnostic>,
}

impl Header {
    /// Reads the header.
    ///
    /// # Errors
    /// The first fault, with its place.
    pub(super) fn parse(source: Source) -> Result<Self, LoadError> {
        let mut parser = Parser { source, cursor: Cursor::new(source.bytes, 0) };
        let first = parser.cursor.first_word().filter(|word| word.bytes == b"ply" && word.offset == 0);
        let Some(first) = first else {
            return Err(source.diagnostic(0, "does not begin with `ply`").into());
        };
        parser.cursor.skip_line();
        parser.parse(first)
    }

    /// Holds the numbers of elements against the file's length and the limits.
    ///
    /// # Errors
    /// The file is too short for what it promises, or promises too much.
    pub(super) fn check_counts(&self, source: Source, limits: &Limits) -> Result<(), LoadError> {
        // The last number of a text may end with the file instead of a blank.
        let available = (source.bytes.len() - self.body) as u64 + 1;
        let mut needed = 0_u64;
        for element in &self.elements {
            let bytes = element.count.saturating_mul(element.least_bytes(self.encoding));
            needed = needed.saturating_add(bytes);
            if needed > available {
                let (count, name) = (element.count, &element.name);
                let message =
                    format!("is too short for the {count} elements `{name}` that its header promises");
                return Err(LoadError::new(source.path, message));
            }
        }
        let faces = self.elements.iter().find(|element| element.name == "face").map_or(0, |face| face.count);
        if faces > limits.triangles as u64 {
            let message = format!("has {faces} faces; the most are {}", limits.triangles);
            let hint = "--limit triangles=N allows more";
            return Err(Diagnostic::new(source.path, message).with_hint(hint).into());
        }
        Ok(())
    }
}

struct Parser<'a> {
    source: Source<'a>,
    cursor: Cursor<'a>,
}

impl<'a> Parser<'a> {
    fn parse(&mut self, first: Word<'a>) -> Result<Header, LoadError> {
        let mut encoding = None;
        let mut elements = Vec::<Element>::new();
        let mut is_as_stored = false;
        let mut warnings = Vec::new();
        while let Some(keyword) = self.cursor.first_word() {
            match keyword.bytes {
                b"comment" => {
                    self.cursor.rest_of_line();
                }
                b"obj_info" => is_as_stored |= self.cursor.rest_of_line().bytes == AS_STORED.as_bytes(),
                b"format" => encoding = Some(self.encoding(keyword)?),
                b"element" => elements.push(self.element(keyword)?),
                b"property" => {
                    let property = self.property(keyword)?;
                    let Some(element) = elements.last_mut() else {
                        return Err(self.fault(keyword, "a property stands before the first element"));
                    };
                    element.properties.push(property);
                }
                b"end_header" => {
                    let Some(encoding) = encoding else {
                        return Err(self.fault(keyword, "the header has no `format` line"));
                    };
                    let body = keyword.offset + keyword.bytes.len();
                    let body = self.after_newline(first, body);
                    return Ok(Header { encoding, elements, is_as_stored, body, warnings });
                }
                other => {
                    let message = format!("`{}` is not known in a PLY header", quoted(other));
                    // Where the body is described, what is not understood may change it.
                    if !elements.is_empty() {
                        return Err(self.fault(keyword, message));
                    }
                    if warnings.len() < MOST_WARNINGS {
                        warnings
                            .push(self.source.diagnostic(keyword.offset, message + " and is passed over"));
                    }
                    self.cursor.rest_of_line();
                }
            }
            self.cursor.skip_line();
        }
        Err(Diagnostic::new(self.source.path, "the header does not end: `end_header` is missing").into())
    }

    /// Where the body begins: after a newline as the first line has, since the byte after a lone `\r` may be
    /// the body's.
    fn after_newline(&self, first: Word, line_end: usize) -> usize {
        let bytes = self.source.bytes;
        let mut at = line_end;
        while matches!(bytes.get(at), Some(b' ' | b'\t')) {
            at += 1;
        }
        let newline = match bytes.get(first.bytes.len()..) {
            Some([b'\r', b'\n', ..]) => &b"\r\n"[..],
            Some([b'\r', ..]) => b"\r",
            _ => b"\n",
        };
        if bytes[at..].starts_with(newline) { at + newline.len() } else { (at + 1).min(bytes.len()) }
    }

    fn encoding(&mut self, keyword: Word<'a>) -> Result<Encoding, LoadError> {
        let word = self.argument(keyword, "an encoding")?;
        match word.bytes {
            b"ascii" => Ok(Encoding::Ascii),
            b"binary_little_endian" => Ok(Encoding::LittleEndian),
            b"binary_big_endian" => Ok(Encoding::BigEndian),
            other => Err(self.fault(word, format!("`{}` is not an encoding of PLY files", quoted(other)))),
        }
    }

    fn element(&mut self, keyword: Word<'a>) -> Result<Element, LoadError> {
        let name = self.argument(keyword, "a name")?;
        let count = self.argument(keyword, "a number of elements")?;
        let parsed = std::str::from_utf8(count.bytes).ok().and_then(|digits| digits.parse().ok());
        let Some(parsed) = parsed else {
            let message = format!("`{}` is not a number of elements", quoted(count.bytes));
            return Err(self.fault(count, message));
        };
        Ok(Element { name: decode(name.bytes).into_owned(), count: parsed, properties: Vec::new() })
    }

    fn property(&mut self, keyword: Word<'a>) -> Result<Property, LoadError> {
        let word = self.argument(keyword, "a type")?;
        let kind = if word.bytes == b"list" {
            let count = self.scalar(keyword)?;
            PropertyType::List { count, item: self.scalar(keyword)? }
        } else {
            PropertyType::Scalar(self.scalar_of(word)?)
        };
        let name = self.argument(keyword, "a name")?;
        Ok(Property { name: decode(name.bytes).into_owned(), kind })
    }

    fn scalar(&mut self, keyword: Word<'a>) -> Result<Scalar, LoadError> {
        let word = self.argument(keyword, "a type")?;
        self.scalar_of(word)
    }

    fn scalar_of(&self, word: Word) -> Result<Scalar, LoadError> {
        Scalar::named(word.bytes)
            .ok_or_else(|| self.fault(word, format!("`{}` is not a type of PLY files", quoted(word.bytes))))
    }

    fn argument(&mut self, keyword: Word<'a>, what: &str) -> Result<Word<'a>, LoadError> {
        let word = self.cursor.word();
        word.ok_or_else(|| self.fault(keyword, format!("`{}` lacks {what}", quoted(keyword.bytes))))
    }

    fn fault(&self, place: Word, message: impl Into<String>) -> LoadError {
        self.source.diagnostic(place.offset, message).into()
    }
}
