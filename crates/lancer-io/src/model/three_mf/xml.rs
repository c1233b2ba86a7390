//! The XML of 3MF parts, element by element.
//!
//! A stream, since parts are large: nothing is kept but the element at hand. Entities that a document defines are not
//! expanded, so that no document grows. Every fault is told by line.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::model::text::{Source, quoted};
use lancer_core::color::srgb_to_linear;
use lancer_core::geometry::DVec3;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Which specification an element is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Namespace {
    Core,
    Materials,
    Production,
    Other,
}

impl Namespace {
    fn of_uri(uri: &[u8]) -> Self {
        match uri {
            b"http://schemas.microsoft.com/3dmanufacturing/core/2015/02" => Self::Core,
            b"http://schemas.microsoft.com/3dmanufacturing/material/2015/02" => Self::Materials,
            b"http://schemas.microsoft.com/3dmanufacturing/production/2015/06" => Self::Production,
            _ => Self::Other,
        }
    }
}

/// What prefixes stand for, as the root element says; the empty one is the default.
type Prefixes = Rc<HashMap<Vec<u8>, Vec<u8>>>;

/// Reads the elements of a part.
pub(super) struct Reader<'a> {
    source: Source<'a>,
    reader: quick_xml::Reader<&'a [u8]>,
    prefixes: Option<Prefixes>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Start,
    Empty,
    End,
}

/// An element's start or end.
pub(super) struct Element<'a> {
    source: Source<'a>,
    offset: usize,
    tag: Tag,
    start: BytesStart<'a>,
    prefixes: Prefixes,
}

impl<'a> Reader<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        Self { source: Source { path, bytes }, reader: quick_xml::Reader::from_reader(bytes), prefixes: None }
    }

    pub(super) fn path(&self) -> PathBuf {
        self.source.path.to_owned()
    }

    /// What is wrong at an [offset](Element::offset).
    pub(super) fn fault_at(&self, offset: usize, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic(offset, message)
    }

    /// The next start or end of an element; `None` at the end of the part.
    pub(super) fn next(&mut self) -> Result<Option<Element<'a>>, LoadError> {
        loop {
            let offset = self.reader.buffer_position() as usize;
            let (tag, start) = match self.reader.read_event() {
                Ok(Event::Start(start)) => (Tag::Start, start),
                Ok(Event::Empty(start)) => (Tag::Empty, start),
                Ok(Event::End(end)) => {
                    let name = String::from_utf8_lossy(end.name().as_ref()).into_owned();
                    (Tag::End, BytesStart::new(name))
                }
                Ok(Event::Eof) => return Ok(None),
                Ok(_) => continue,
                Err(error) => {
                    let place = self.reader.error_position() as usize;
                    let words = error.to_string().to_lowercase();
                    let message = format!("is no XML: {}", quoted(words.as_bytes()));
                    return Err(self.source.diagnostic(place.max(offset), message).into());
                }
            };
            let prefixes = Rc::clone(self.prefixes.get_or_insert_with(|| Rc::new(prefixes_of(&start))));
            return Ok(Some(Element { source: self.source, offset, tag, start, prefixes }));
        }
    }

    /// The next start or end of an element within `outer`, whose start was read last; `None` at its end.
    pub(super) fn next_within(&mut self, outer: &Element) -> Result<Option<Element<'a>>, LoadError> {
        if outer.tag != Tag::Start {
            return Ok(None);
        }
        let Some(element) = self.next()? else {
            return Err(outer.fault("the file ends before this element does").into());
        };
        let is_end = element.tag == Tag::End && element.full_name() == outer.full_name();
        Ok((!is_end).then_some(element))
    }
}

/// The `xmlns` attributes of the root element.
fn prefixes_of(root: &BytesStart) -> HashMap<Vec<u8>, Vec<u8>> {
    let mut prefixes = HashMap::new();
    for attribute in root.attributes().with_checks(false).flatten() {
        let key = attribute.key.as_ref();
        if let Some(prefix) = key.strip_prefix(b"xmlns:") {
            prefixes.insert(prefix.to_vec(), attribute.value.to_vec());
        } else if key == b"xmlns" {
            prefixes.insert(Vec::new(), attribute.value.to_vec());
        }
    }
    prefixes
}

impl Element<'_> {
    /// Where it begins in the part.
    pub(super) fn offset(&self) -> usize {
        self.offset
    }

    pub(super) fn is_start(&self) -> bool {
        self.tag != Tag::End
    }

    /// The name without its prefix.
    pub(super) fn name(&self) -> &[u8] {
        self.start.local_name().into_inner()
    }

    /// The name as written.
    pub(super) fn full_name(&self) -> &[u8] {
        self.start.name().into_inner()
    }

    pub(super) fn namespace(&self) -> Namespace {
        let prefix = self.start.name().prefix();
        self.namespace_of(prefix.map_or(&[][..], |prefix| prefix.into_inner()))
    }

    /// What a prefix stands for.
    pub(super) fn namespace_of(&self, prefix: &[u8]) -> Namespace {
        self.prefixes.get(prefix).map_or(Namespace::Other, |uri| Namespace::of_uri(uri))
    }

    pub(super) fn uri_of(&self, prefix: &[u8]) -> Option<String> {
        self.prefixes.get(prefix).map(|uri| String::from_utf8_lossy(uri).into_owned())
    }

    /// The value of an attribute without a prefix, as written.
    pub(super) fn attribute(&self, name: &str) -> Option<&[u8]> {
        let mut attributes = self.start.attributes();
        let found =
            attributes.with_checks(false).flatten().find(|found| found.key.as_ref() == name.as_bytes())?;
        match found.value {
            std::borrow::Cow::Borrowed(value) => Some(value),
            std::borrow::Cow::Owned(_) => None,
        }
    }

    /// The text of an attribute without a prefix.
    pub(super) fn text(&self, name: &str) -> Option<String> {
        let mut attributes = self.start.attributes();
        let found =
            attributes.with_checks(false).flatten().find(|found| found.key.as_ref() == name.as_bytes())?;
        text_of(&found)
    }

    /// The text of an attribute of a namespace.
    pub(super) fn text_of(&self, namespace: Namespace, name: &str) -> Option<String> {
        let mut attributes = self.start.attributes();
        let found = attributes.with_checks(false).flatten().find(|found| {
            let prefix = found.key.prefix().map(|prefix| self.namespace_of(prefix.into_inner()));
            prefix == Some(namespace) && found.key.local_name().as_ref() == name.as_bytes()
        })?;
        text_of(&found)
    }

    /// An attribute that is a whole number.
    pub(super) fn number(&self, name: &str) -> Result<u32, LoadError> {
        self.parsed(name, |text| text.trim().parse().ok(), "a whole number")
    }

    /// An attribute that is a finite number, in single precision too.
    pub(super) fn coordinate(&self, name: &str) -> Result<f64, LoadError> {
        self.parsed(name, finite, "a finite number")
    }

    /// An attribute that is twelve numbers: the images of the three axes, and of the origin.
    pub(super) fn columns(&self, name: &str) -> Result<[DVec3; 4], LoadError> {
        let columns = |text: &str| {
            let numbers = text.split_whitespace().map(finite).collect::<Option<Vec<_>>>()?;
            let (columns, []) = numbers.as_chunks::<3>() else { return None };
            columns.iter().map(|&column| DVec3::from_array(column)).collect::<Vec<_>>().try_into().ok()
        };
        self.parsed(name, columns, "twelve finite numbers")
    }

    /// An attribute that is `#rrggbb` or `#rrggbbaa`, encoded in sRGB: the linear colour, and the opacity.
    pub(super) fn color(&self, name: &str) -> Result<[f64; 4], LoadError> {
        let color = |text: &str| {
            let digits = text.trim().strip_prefix('#')?;
            let whole = match digits.len() {
                6 => format!("{digits}ff"),
                8 => digits.to_owned(),
                _ => return None,
            };
            let is_hex = whole.bytes().all(|byte| byte.is_ascii_hexdigit());
            let bits = u32::from_str_radix(&whole, 16).ok().filter(|_| is_hex)?;
            let [r, g, b, a] = bits.to_be_bytes().map(|byte| f64::from(byte) / 255.0);
            Some([srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b), a])
        };
        self.parsed(name, color, "a color as #rrggbb or #rrggbbaa")
    }

    fn parsed<T>(&self, name: &str, parse: impl Fn(&str) -> Option<T>, what: &str) -> Result<T, LoadError> {
        let Some(value) = self.attribute(name) else {
            let element = quoted(self.full_name());
            return Err(self.fault(format!("`{element}` lacks `{name}`")).into());
        };
        std::str::from_utf8(value)
            .ok()
            .and_then(parse)
            .ok_or_else(|| self.fault(format!("{name} is `{}`, must be {what}", quoted(value))).into())
    }

    /// What is wrong with this element.
    pub(super) fn fault(&self, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic(self.offset, message)
    }
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|x| x.abs() <= f64::from(f32::MAX))
}

fn text_of(attribute: &quick_xml::events::attributes::Attribute) -> Option<String> {
    attribute.normalized_value(XmlVersion::Implicit1_0).ok().map(std::borrow::Cow::into_owned)
}
