//! Files that are packed: in a zip archive, or compressed one by one.
//!
//! In: the bytes of the archive. Out: the bytes of a file in it, no more than the limits allow, whatever the archive
//! says of their number. Nothing is written to disk, so that no name in an archive can reach anything there.

use crate::limits::Limits;
use crate::resolver::path_below;
use flate2::read::MultiGzDecoder;
use std::fmt;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use zip::ZipArchive;
use zip::result::ZipError;

/// How many times its packed size a file may be. Text compresses to a tenth, and very regular text to a fiftieth; the
/// method itself reaches 1032, which only bombs come near.
const MOST_RATIO: u64 = 200;

/// What any file may be unpacked to, in bytes: small ones may be as regular as they like.
const SMALL: u64 = 64 << 20;

/// Unpacks what `reader` gives of `packed` bytes.
///
/// # Errors
/// A message without a place: the bytes are broken, or unpack to more than they may.
pub(crate) fn unpack(reader: impl Read, packed: u64, limits: &Limits) -> Result<Vec<u8>, String> {
    let most = packed.saturating_mul(MOST_RATIO).max(SMALL).min(limits.file_bytes);
    let mut bytes = Vec::new();
    let read = reader.take(most.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|error| format!("is broken: {}", error.to_string().to_lowercase()))?;
    if bytes.len() as u64 > most {
        return Err(format!("unpacks to more than {most} bytes, from {packed}, which is not read"));
    }
    Ok(bytes)
}

/// What stands in for the disk while a packed file is read.
#[derive(Debug)]
pub(crate) enum Packed {
    /// One gzip file. What it refers to lies beside it.
    File {
        /// The path that its content would have.
        path: PathBuf,
        /// As packed.
        bytes: Vec<u8>,
    },
    /// An archive, which refers to nothing outside.
    Archive(Package),
}

impl Packed {
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
                Some(unpack(MultiGzDecoder::new(&bytes[..]), bytes.len() as u64, limits))
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
    archive: ZipArchive<Cursor<Arc<[u8]>>>,
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
        let archive = ZipArchive::new(Cursor::new(bytes.into())).map_err(|error| message_of(&error))?;
        Ok(Self { path: path.to_owned(), archive, limits, length, unpacked: Arc::default() })
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
        let packed = file.compressed_size();
        let bytes = unpack(file, packed, &self.limits)?;
        // A thousand small files, each unpacked to what small ones may be, are a bomb too.
        let most = self.length.saturating_mul(MOST_RATIO).max(SMALL);
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
        let endless = std::io::repeat(0);
        let message = unpack(endless, 1000, &limits).unwrap_err();
        assert_eq!(message, "unpacks to more than 67108864 bytes, from 1000, which is not read");
        let limits = Limits { file_bytes: 10, ..limits };
        assert!(unpack(&[0; 11][..], 11, &limits).is_err());
        assert_eq!(unpack(&[0; 10][..], 10, &limits).unwrap().len(), 10);
    }
}
