//! Files that are packed: in a zip archive, or compressed one by one.
//!
//! In: the bytes of the archive. Out: the bytes of a file in it, no more than the limits allow, whatever the archive
//! says of their number. Nothing is written to disk, so that no name in an archive can reach anything there.

use crate::limits::Limits;
use crate::resolver::path_below;
use flate2::read::MultiGzDecoder;
use std::fmt;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use zip::ZipArchive;
use zip::result::ZipError;

/// Unpacks what `reader` gives, which has taken `consumed` packed bytes so far.
///
/// That is asked again and again: a bomb is left where it begins to be one.
///
/// # Errors
/// A message without a place: the bytes are broken, or unpack to more than they may.
fn unpack(mut reader: impl Read, consumed: impl Fn() -> u64, limits: &Limits) -> Result<Vec<u8>, String> {
    const AT_ONCE: u64 = 1 << 20;
    let mut bytes = Vec::new();
    loop {
        let read = reader.by_ref().take(AT_ONCE).read_to_end(&mut bytes);
        if read.map_err(|error| format!("is broken: {}", error.to_string().to_lowercase()))? == 0 {
            return Ok(bytes);
        }
        let consumed = consumed();
        let most = limits.of_packed(consumed).file_bytes;
        if bytes.len() as u64 > most {
            return Err(format!("unpacks to more than {most} bytes, from {consumed}, which is not read"));
        }
    }
}

/// Bytes that tell how far they have been read.
#[derive(Clone)]
struct Counted {
    bytes: Cursor<Arc<[u8]>>,
    read: Arc<AtomicU64>,
}

impl Counted {
    fn new(bytes: Arc<[u8]>) -> Self {
        Self { bytes: Cursor::new(bytes), read: Arc::default() }
    }
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.bytes.read(buffer)?;
        self.read.fetch_add(read as u64, Ordering::Relaxed);
        Ok(read)
    }
}

impl Seek for Counted {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        self.bytes.seek(place)
    }
}

/// What stands in for the disk while a packed file is read.
#[derive(Debug)]
pub(crate) enum Packed {
    /// One gzip file. What it refers to lies beside it.
    File {
        /// The path that its content would have.
        path: PathBuf,
        /// As packed.
        bytes: Arc<[u8]>,
    },
    /// An archive, which refers to nothing outside.
    Archive(Package),
}

impl Packed {
    /// The length of the packed file itself, in bytes.
    pub(crate) fn length(&self) -> u64 {
        match self {
            Self::File { bytes, .. } => bytes.len() as u64,
            Self::Archive(package) => package.length,
        }
    }

    /// As [`Resolver::resolve`](crate::resolver::Resolver::resolve); `None` where the disk is asked.
    pub(crate) fn resolve(&self, from: &Path, reference: &str) -> Option<Result<PathBuf, String>> {
        match self {
            Self::File { .. } => None,
            Self::Archive(package) => Some(package.resolve(from, reference)),
        }
    }

    /// The bytes of a file, or what is wrong with it; `None` where the disk is asked.
    pub(crate) fn read(&self, path: &Path, limits: &Limits) -> Option<Result<Vec<u8>, String>> {
        match self {
            Self::File { path: content, bytes } if content == path => {
                let packed = Counted::new(Arc::clone(bytes));
                let read = Arc::clone(&packed.read);
                Some(unpack(MultiGzDecoder::new(packed), || read.load(Ordering::Relaxed), limits))
            }
            Self::File { .. } => None,
            Self::Archive(package) => Some(package.read(path)),
        }
    }
}

/// A zip archive in memory.
#[derive(Clone)]
pub(crate) struct Package {
    /// The archive's own path: what is in it is called by paths below.
    path: PathBuf,
    archive: ZipArchive<Counted>,
    /// How much of it has been read.
    read: Arc<AtomicU64>,
    limits: Limits,
    /// The archive's own length, in bytes.
    length: u64,
    /// What has been unpacked of it.
    unpacked: Arc<AtomicU64>,
}

impl fmt::Debug for Package {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Package({}, {} files)", self.path.display(), self.archive.len())
    }
}

impl Package {
    /// The archive in `bytes`, which were read from `path`.
    ///
    /// # Errors
    /// A message without a place.
    pub(crate) fn new(path: &Path, bytes: Vec<u8>, limits: Limits) -> Result<Self, String> {
        let length = bytes.len() as u64;
        let packed = Counted::new(bytes.into());
        let read = Arc::clone(&packed.read);
        let archive = ZipArchive::new(packed).map_err(|error| message_of(&error))?;
        Ok(Self { path: path.to_owned(), archive, read, limits, length, unpacked: Arc::default() })
    }

    /// The limits for what is in it.
    pub(crate) fn limits(&self) -> Limits {
        self.limits.of_packed(self.length)
    }

    /// The names of the files in it, with `/` between folders, in the archive's order.
    pub(crate) fn names(&self) -> Vec<String> {
        let names = self.archive.file_names().filter_map(Result::ok);
        names.filter(|name| !name.ends_with('/')).map(|name| name.replace('\\', "/")).collect()
    }

    /// What a file in it is called in messages.
    pub(crate) fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The file that `reference`, written in the file `from`, names.
    ///
    /// # Errors
    /// A message without a place: it leads out of the archive, or to no file.
    pub(crate) fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String> {
        let inside = from.strip_prefix(&self.path).unwrap_or(Path::new(""));
        let folder = inside.parent().unwrap_or(Path::new(""));
        let found = path_below(folder, reference)
            .ok_or_else(|| format!("`{reference}` lies outside of the archive"))?;
        let path = self.path.join(&found);
        match self.index_of(&path) {
            Some(_) => Ok(path),
            None => Err(format!("cannot open `{reference}`: no such file in the archive")),
        }
    }

    /// The bytes of the file that is called `path`.
    ///
    /// # Errors
    /// A message without a place.
    pub(crate) fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        let index = self.index_of(path).ok_or("cannot be read: no such file in the archive")?;
        // A copy shares the bytes; reading moves a place in them.
        let mut archive = self.archive.clone();
        let file = archive.by_index(index).map_err(|error| message_of(&error))?;
        let before = self.read.load(Ordering::Relaxed);
        let bytes = unpack(file, || self.read.load(Ordering::Relaxed) - before, &self.limits)?;
        // A thousand small files, each unpacked to what small ones may be, are a bomb too.
        let most = self.limits().file_bytes;
        let unpacked = self.unpacked.fetch_add(bytes.len() as u64, Ordering::Relaxed) + bytes.len() as u64;
        if unpacked > most {
            return Err(format!(
                "unpacks, with the files before it, to more than {most} bytes, from {}",
                self.length
            ));
        }
        Ok(bytes)
    }

    fn index_of(&self, path: &Path) -> Option<usize> {
        let inside = path.strip_prefix(&self.path).ok()?;
        let name = inside.iter().map(|part| part.to_str()).collect::<Option<Vec<_>>>()?.join("/");
        // Some programs write `\`.
        let written = self.archive.index_for_name(&name);
        written.or_else(|| self.archive.index_for_name(&name.replace('/', "\\")))
    }
}

fn message_of(error: &ZipError) -> String {
    let words = error.to_string().to_lowercase();
    format!("is no zip archive that can be read: {words}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bombs_are_not_unpacked_to_their_end() {
        let limits = Limits::default();
        let message = unpack(std::io::repeat(0), || 1000, &limits).unwrap_err();
        assert_eq!(message, "unpacks to more than 16777216 bytes, from 1000, which is not read");
        let limits = Limits { file_bytes: 10, ..limits };
        assert!(unpack(&[0; 11][..], || 11, &limits).is_err());
        assert_eq!(unpack(&[0; 10][..], || 10, &limits).unwrap().len(), 10);
    }

    #[test]
    fn a_bomb_is_left_where_it_begins_to_be_one() {
        let consumed = std::cell::Cell::new(0);
        // From 1 MiB on nothing more is consumed.
        let read = || {
            consumed.set((consumed.get() + (1 << 18)).min(1 << 20));
            consumed.get()
        };
        let message = unpack(std::io::repeat(0), read, &Limits::default()).unwrap_err();
        assert_eq!(message, "unpacks to more than 104857600 bytes, from 1048576, which is not read");
    }
}
