//! What the disk says of a path. It may take its time (a network, a sleeping drive): never call it from the window's
//! thread.

use super::Purpose;
use std::cmp::Reverse;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file or directory in a directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) path: PathBuf,
    /// The name, to show.
    pub(super) name: String,
    pub(super) is_directory: bool,
    pub(super) bytes: u64,
}

/// What is at a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// A directory, with what is in it: directories first, then by name.
    Directory { path: PathBuf, entries: Vec<Entry>, is_cut: bool },
    /// A file.
    File(PathBuf),
    /// Nothing, in a directory that is there.
    Nothing(PathBuf),
}

/// Why a path leads nowhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// No path was given.
    NoName,
    /// Nothing of that name, and a file is wanted.
    NoSuchFile(PathBuf),
    /// The directory that should hold it is not there.
    NoSuchDirectory(PathBuf),
    /// It may not be read.
    Denied(PathBuf),
    /// What is written has another extension.
    OtherKind(Purpose),
    /// What the system says.
    Other(PathBuf, String),
}

/// Entries of a directory that are read: more than anyone looks through, few enough to be sorted and drawn at once.
const MOST_ENTRIES: usize = 20_000;

/// Looks what is at a path. A file that is to be written gets an extension where it has none.
pub(super) fn look(path: &Path, purpose: Purpose) -> Result<Found, Fault> {
    let fault = |error: io::Error, path: &Path| match error.kind() {
        io::ErrorKind::PermissionDenied => Fault::Denied(path.to_owned()),
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Fault::NoSuchDirectory(path.to_owned()),
        _ => Fault::Other(path.to_owned(), error.to_string()),
    };
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => return list(path).map_err(|error| fault(error, path)),
        Ok(_) if !purpose.is_save() => return Ok(Found::File(path.to_owned())),
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => return Err(fault(error, path)),
        _ => {}
    }
    let path = if purpose.is_save() { with_extension(path, purpose)? } else { path.to_owned() };
    let directory = path.parent().unwrap_or(&path);
    let ends_in_slash = path.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR);
    match fs::metadata(directory) {
        Ok(metadata) if metadata.is_dir() && !ends_in_slash => {}
        Ok(_) => return Err(Fault::NoSuchDirectory(path)),
        Err(error) => return Err(fault(error, directory)),
    }
    if path.exists() { Ok(Found::File(path)) } else { Ok(Found::Nothing(path)) }
}

/// The path with the purpose's first extension where it has none.
fn with_extension(path: &Path, purpose: Purpose) -> Result<PathBuf, Fault> {
    let extensions = purpose.extensions();
    match path.extension().map(|extension| extension.to_string_lossy().to_lowercase()) {
        Some(found) if extensions.contains(&found.as_str()) => Ok(path.to_owned()),
        Some(_) => Err(Fault::OtherKind(purpose)),
        None => Ok(path.with_extension(extensions[0])),
    }
}

fn list(path: &Path) -> io::Result<Found> {
    let mut read = fs::read_dir(path)?;
    let mut entries = read
        .by_ref()
        .take(MOST_ENTRIES)
        .filter_map(Result::ok)
        .map(|entry| {
            // Follows links; what cannot be looked at is shown as an empty file.
            let metadata = fs::metadata(entry.path()).ok();
            Entry {
                name: entry.file_name().to_string_lossy().into_owned(),
                path: entry.path(),
                is_directory: metadata.as_ref().is_some_and(fs::Metadata::is_dir),
                bytes: metadata.map_or(0, |metadata| metadata.len()),
            }
        })
        .collect::<Vec<_>>();
    let is_cut = read.next().is_some();
    entries.sort_by_cached_key(|entry| (Reverse(entry.is_directory), entry.name.to_lowercase()));
    Ok(Found::Directory { path: path.to_owned(), entries, is_cut })
}
