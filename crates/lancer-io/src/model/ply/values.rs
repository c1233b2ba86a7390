//! The numbers of a PLY file's body, one after another, whatever they are written in.
//!
//! Every type of PLY fits a `f64` exactly, so numbers of all types come out as that.

use super::header::Scalar;
use crate::diagnostics::LoadError;
use crate::model::text::{Cursor, Source, not_a_number};
use std::marker::PhantomData;

/// A source of numbers.
pub(super) trait Values {
    /// Moves to the next element; in text, each begins a line.
    fn begin_element(&mut self) -> Result<(), LoadError>;

    /// The next number, which may be NaN or infinite in binary.
    fn next(&mut self, scalar: Scalar) -> Result<f64, LoadError>;

    /// Where in the file it stands.
    fn offset(&self) -> usize;

    /// How many numbers of a type there can still be at most.
    fn most_left(&self, scalar: Scalar) -> usize;

    /// An error at the number read last.
    fn fault(&self, message: String) -> LoadError;
}

/// Numbers in text. Words of a line beyond those that the header announces are passed over.
pub(super) struct AsciiValues<'a> {
    source: Source<'a>,
    cursor: Cursor<'a>,
    /// Where the number read last begins.
    last: usize,
}

impl<'a> AsciiValues<'a> {
    pub(super) fn new(source: Source<'a>, body: usize) -> Self {
        Self { source, cursor: Cursor::new(source.bytes, body), last: body }
    }

    /// The text after the number read last ends the file.
    fn too_short(&self) -> LoadError {
        LoadError::new(self.source.path, "ends before all that its header promises")
    }
}

impl Values for AsciiValues<'_> {
    fn begin_element(&mut self) -> Result<(), LoadError> {
        if self.cursor.offset() > self.last {
            self.cursor.skip_line();
        }
        let first = self.cursor.clone().first_word().ok_or_else(|| self.too_short())?;
        self.cursor = Cursor::new(self.source.bytes, first.offset);
        Ok(())
    }

    fn next(&mut self, _: Scalar) -> Result<f64, LoadError> {
        let word = self.cursor.word().ok_or_else(|| match self.cursor.clone().first_word() {
            Some(_) => {
                let message = "the line ends before all numbers of its element";
                self.source.diagnostic(self.cursor.offset(), message).into()
            }
            None => self.too_short(),
        })?;
        self.last = word.offset;
        word.number().ok_or_else(|| not_a_number(self.source, word).into())
    }

    fn offset(&self) -> usize {
        self.cursor.offset()
    }

    fn most_left(&self, _: Scalar) -> usize {
        (self.source.bytes.len() - self.cursor.offset()).div_ceil(2)
    }

    fn fault(&self, message: String) -> LoadError {
        self.source.diagnostic(self.last, message).into()
    }
}

/// Which end of a number comes first.
pub(super) trait ByteOrder {
    const BIG: bool;
}

pub(super) struct LittleEndian;
pub(super) struct BigEndian;

impl ByteOrder for LittleEndian {
    const BIG: bool = false;
}

impl ByteOrder for BigEndian {
    const BIG: bool = true;
}

/// Numbers in binary.
pub(super) struct BinaryValues<'a, Order> {
    source: Source<'a>,
    at: usize,
    order: PhantomData<Order>,
}

impl<'a, Order> BinaryValues<'a, Order> {
    pub(super) fn new(source: Source<'a>, body: usize) -> Self {
        Self { source, at: body, order: PhantomData }
    }
}

impl<Order: ByteOrder> BinaryValues<'_, Order> {
    /// The next N bytes, least significant first.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], LoadError> {
        let Some(&bytes) = self.source.bytes[self.at..].first_chunk::<N>() else {
            return Err(LoadError::new(self.source.path, "ends before all that its header promises"));
        };
        self.at += N;
        let mut bytes = bytes;
        if Order::BIG {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<Order: ByteOrder> Values for BinaryValues<'_, Order> {
    fn begin_element(&mut self) -> Result<(), LoadError> {
        Ok(())
    }

    fn next(&mut self, scalar: Scalar) -> Result<f64, LoadError> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    fn offset(&self) -> usize {
        self.at
    }

    fn most_left(&self, scalar: Scalar) -> usize {
        (self.source.bytes.len() - self.at) / scalar.size()
    }

    fn fault(&self, message: String) -> LoadError {
        LoadError::new(self.source.path, format!("before byte {}: {message}", self.at))
    }
}
