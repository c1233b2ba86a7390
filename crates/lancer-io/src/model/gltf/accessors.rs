//! Accessors: arrays of numbers in buffers.
//!
//! In: an index. Out: a reader of one element at a time, whatever its type, stride and sparse replacements. All
//! ranges are checked when it is made, so that no count is believed that no bytes stand for.

use super::buffers::{Buffers, View};
use super::document::{self, Document};
use super::fault::{Fault, Result, entry};

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32, at: &str) -> Result<Self> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => {
                return Err(Fault::new(
                    format!("{at}/componentType"),
                    format!("{code} is no type of numbers"),
                ));
            }
        })
    }

    fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number at the start of `bytes`; a normalised integer is a fraction of its type's largest.
    fn read(self, bytes: &[u8], normalized: bool) -> f64 {
        let fraction = |value: f64, largest: f64| {
            if normalized { (value / largest).max(-1.0) } else { value }
        };
        match self {
            Self::I8 => fraction(f64::from(bytes[0] as i8), 127.0),
            Self::U8 => fraction(f64::from(bytes[0]), 255.0),
            Self::I16 => fraction(f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
            Self::U16 => fraction(f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
            Self::U32 => f64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
            Self::F32 => f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
        }
    }
}

/// An array whose every element is there.
pub(super) struct Accessor<'a> {
    /// `None`: all are zero, but for sparse ones.
    view: Option<&'a [u8]>,
    stride: u64,
    component: Component,
    /// Numbers in an element.
    components: usize,
    normalized: bool,
    count: u64,
    sparse: Option<Sparse<'a>>,
    /// Where it is in the document.
    pub(super) pointer: String,
}

/// Elements in place of others.
struct Sparse<'a> {
    /// In growing order.
    indices: Vec<u32>,
    values: &'a [u8],
}

impl<'a> Accessor<'a> {
    /// The accessor that the place `at` names.
    pub(super) fn new(document: &Document, buffers: &'a Buffers, index: usize, at: &str) -> Result<Self> {
        let written = entry(&document.accessors, "accessors", index, at)?;
        let here = format!("/accessors/{index}");
        let component = Component::of(written.component_type, &here)?;
        let components = match written.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            other => return Err(Fault::new(format!("{here}/type"), format!("`{other}` is not read here"))),
        };
        let element = component.size() * components as u64;
        let mut stride = element;
        let view = match written.buffer_view {
            None => None,
            Some(view) => {
                let View { bytes, stride: given } = buffers.view(view, &format!("{here}/bufferView"))?;
                stride = given.unwrap_or(element);
                Some(range(bytes, written.byte_offset, stride, element, written.count, &here)?)
            }
        };
        let sparse = match &written.sparse {
            None => None,
            Some(sparse) => Some(Sparse::new(sparse, buffers, element, written.count, &here)?),
        };
        if written.count > u64::from(u32::MAX) {
            return Err(Fault::new(
                format!("{here}/count"),
                format!("{} is more than indices reach", written.count),
            ));
        }
        let (normalized, count) = (written.normalized, written.count);
        Ok(Self { view, stride, component, components, normalized, count, sparse, pointer: here })
    }

    pub(super) fn count(&self) -> u64 {
        self.count
    }

    pub(super) fn component(&self) -> Component {
        self.component
    }

    pub(super) fn components(&self) -> usize {
        self.components
    }

    /// The first N numbers of an element, or those that it has and then ones.
    pub(super) fn get<const N: usize>(&self, index: u32) -> [f64; N] {
        let element = self.components * self.component.size() as usize;
        let replaced = self.sparse.as_ref().and_then(|sparse| {
            let at = sparse.indices.binary_search(&index).ok()?;
            Some(&sparse.values[at * element..])
        });
        let stored = || self.view.map(|bytes| &bytes[(self.stride * u64::from(index)) as usize..]);
        let bytes = replaced.or_else(stored);
        std::array::from_fn(|i| match bytes {
            _ if i >= self.components => 1.0,
            None => 0.0,
            Some(bytes) => self.component.read(&bytes[i * self.component.size() as usize..], self.normalized),
        })
    }

    /// The whole number that an element of one number is.
    pub(super) fn index(&self, index: u32) -> u32 {
        let [number] = self.get::<1>(index);
        number as u32
    }
}

impl<'a> Sparse<'a> {
    fn new(
        written: &document::Sparse,
        buffers: &'a Buffers,
        element: u64,
        count: u64,
        accessor: &str,
    ) -> Result<Self> {
        let here = format!("{accessor}/sparse");
        if written.count > count {
            let message = format!("replaces {} of {count} elements", written.count);
            return Err(Fault::new(here, message));
        }
        let at = format!("{here}/indices");
        let component = Component::of(written.indices.component_type, &at)?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            return Err(Fault::new(format!("{at}/componentType"), "indices are unsigned whole numbers"));
        }
        let view = buffers.view(written.indices.buffer_view, &format!("{at}/bufferView"))?;
        let size = component.size();
        let bytes = range(view.bytes, written.indices.byte_offset, size, size, written.count, &at)?;
        let numbers = bytes.chunks_exact(size as usize).take(written.count as usize);
        let indices = numbers.map(|bytes| component.read(bytes, false) as u32).collect::<Vec<_>>();
        if !indices.is_sorted_by(|a, b| a < b) || indices.last().is_some_and(|&last| u64::from(last) >= count)
        {
            return Err(Fault::new(at, format!("they do not grow from 0 to less than {count}")));
        }
        let at = format!("{here}/values");
        let view = buffers.view(written.values.buffer_view, &format!("{at}/bufferView"))?;
        let values = range(view.bytes, written.values.byte_offset, element, element, written.count, &at)?;
        Ok(Self { indices, values })
    }
}

/// The bytes of `count` elements, `stride` apart, from an offset on.
fn range<'a>(
    bytes: &'a [u8],
    offset: u64,
    stride: u64,
    element: u64,
    count: u64,
    at: &str,
) -> Result<&'a [u8]> {
    if stride < element {
        return Err(Fault::new(at, format!("elements of {element} bytes are only {stride} bytes apart")));
    }
    let before_last = count.checked_sub(1).map_or(Some(0), |before| before.checked_mul(stride));
    let last = if count == 0 { 0 } else { element };
    let end = before_last.and_then(|before| before.checked_add(offset)?.checked_add(last));
    let range = end.filter(|&end| end <= bytes.len() as u64).map(|end| &bytes[offset as usize..end as usize]);
    range.ok_or_else(|| {
        let message =
            format!("{count} elements from byte {offset} on are not within the view's {} bytes", bytes.len());
        Fault::new(at, message)
    })
}
