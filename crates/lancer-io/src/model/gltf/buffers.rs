//! The bytes that a document refers to.
//!
//! A buffer is in the GLB file, in a `data:` URI, or in a file of its own, which only the resolver opens. Each is
//! read when it is first asked for. Ranges are computed in 64 bits and checked before anything is read.

use super::document::Document;
use super::fault::{Fault, Result, entry};
use crate::resolver::Resolver;
use base64::Engine;
use base64::engine::general_purpose::{STANDARD, URL_SAFE};
use percent_encoding::percent_decode_str;
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The buffers of a document.
pub(super) struct Buffers<'a> {
    path: &'a Path,
    resolver: &'a Resolver,
    document: &'a Document,
    binary: Option<&'a [u8]>,
    loaded: Vec<OnceCell<Rc<Vec<u8>>>>,
    /// Files that several buffers may name.
    files: RefCell<HashMap<PathBuf, Rc<Vec<u8>>>>,
    /// What further files may hold, in bytes: one file may be named in many ways.
    left: Cell<u64>,
}

/// A part of a buffer.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) stride: Option<u64>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        path: &'a Path,
        resolver: &'a Resolver,
        document: &'a Document,
        binary: Option<&'a [u8]>,
    ) -> Self {
        let loaded = document.buffers.iter().map(|_| OnceCell::new()).collect();
        let left = Cell::new(resolver.limits.file_bytes);
        Self { path, resolver, document, binary, loaded, files: RefCell::default(), left }
    }

    /// The bytes of all buffers that can be had, each file counted once.
    pub(super) fn total_bytes(&self) -> u64 {
        let binary = self.binary.map_or(0, <[u8]>::len) as u64;
        let mut seen = HashSet::new();
        let mut total = binary;
        for index in 0..self.document.buffers.len() {
            // One that cannot be had is told where it is used.
            let had = self.buffer(index, "").is_ok();
            let loaded = self.loaded[index].get().filter(|bytes| had && seen.insert(Rc::as_ptr(bytes)));
            total += loaded.map_or(0, |bytes| bytes.len() as u64);
        }
        total
    }

    /// A buffer view; `at` is the place that names it.
    pub(super) fn view(&self, index: usize, at: &str) -> Result<View<'_>> {
        let view = entry(&self.document.buffer_views, "bufferViews", index, at)?;
        let here = format!("/bufferViews/{index}");
        if view.extensions.meshopt.is_some() {
            let message = "is compressed with EXT_meshopt_compression, which is not read";
            return Err(Fault::new(here, message));
        }
        let buffer = self.buffer(view.buffer, &format!("{here}/buffer"))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end
            .filter(|&end| end <= buffer.len() as u64)
            .map(|end| &buffer[view.byte_offset as usize..end as usize]);
        let bytes = bytes.ok_or_else(|| {
            let (length, offset) = (view.byte_length, view.byte_offset);
            Fault::new(
                &here,
                format!("{length} bytes from {offset} on are not within the buffer's {}", buffer.len()),
            )
        })?;
        Ok(View { bytes, stride: view.byte_stride })
    }

    fn buffer(&self, index: usize, at: &str) -> Result<&[u8]> {
        let buffer = entry(&self.document.buffers, "buffers", index, at)?;
        let here = format!("/buffers/{index}");
        let bytes = match (&buffer.uri, self.binary) {
            (None, Some(binary)) if index == 0 => binary,
            (None, _) => return Err(Fault::new(here, "has no uri, and the file has no binary chunk for it")),
            (Some(uri), _) => {
                if self.loaded[index].get().is_none() {
                    let bytes = self.fetch(uri, &format!("{here}/uri"))?;
                    let _ = self.loaded[index].set(bytes);
                }
                self.loaded[index].get().map_or(&[][..], |bytes| bytes)
            }
        };
        if (bytes.len() as u64) < buffer.byte_length {
            let message = format!("is {} long, but there are {} bytes", buffer.byte_length, bytes.len());
            return Err(Fault::new(format!("{here}/byteLength"), message));
        }
        // GLB files pad the chunk.
        Ok(&bytes[..buffer.byte_length as usize])
    }

    /// The bytes that a URI means: those in it, or those of a file.
    pub(super) fn fetch(&self, uri: &str, at: &str) -> Result<Rc<Vec<u8>>> {
        if is_data(uri) {
            return decode_data(uri).map(Rc::new).map_err(|message| Fault::new(at, message));
        }
        let path = self.file(uri, at)?;
        let identity = self.resolver.identity(&path);
        if let Some(bytes) = self.files.borrow().get(&identity) {
            return Ok(Rc::clone(bytes));
        }
        let bytes = self.resolver.read(&path).map_err(|error| Fault::new(at, error.to_string()))?;
        let Some(left) = self.left.get().checked_sub(bytes.len() as u64) else {
            let most = self.resolver.limits.file_bytes;
            return Err(Fault::new(at, format!("the buffers are longer than {most} bytes in all")));
        };
        self.left.set(left);
        let bytes = Rc::new(bytes);
        self.files.borrow_mut().insert(identity, Rc::clone(&bytes));
        Ok(bytes)
    }

    /// The file that a URI names.
    pub(super) fn file(&self, uri: &str, at: &str) -> Result<PathBuf> {
        if let Some(scheme) = scheme_of(uri) {
            return Err(Fault::new(at, format!("`{scheme}:` URIs are not opened")));
        }
        let name = percent_decode_str(uri).decode_utf8();
        let name = name.map_err(|_| Fault::new(at, "is not UTF-8 when its escapes are decoded"))?;
        self.resolver.resolve(self.path, &name).map_err(|message| Fault::new(at, message))
    }
}

/// Whether a URI holds its data.
pub(super) fn is_data(uri: &str) -> bool {
    uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

/// The scheme of a URI that has one. One letter is a drive, which the resolver judges.
fn scheme_of(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let is_scheme =
        scheme.len() > 1 && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    is_scheme.then_some(scheme)
}

fn decode_data(uri: &str) -> std::result::Result<Vec<u8>, String> {
    let (header, data) = uri.split_once(',').ok_or("is a data URI without a comma")?;
    if !header.to_ascii_lowercase().ends_with(";base64") {
        return Ok(percent_decode_str(data).collect());
    }
    let decoded = STANDARD.decode(data).or_else(|first| URL_SAFE.decode(data).map_err(|_| first));
    decoded.map_err(|error| format!("is no base64: {}", error.to_string().to_lowercase()))
}
