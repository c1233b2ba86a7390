//! Files that are written whole or not at all.
//!
//! In: a path and a function that writes. Out: the file with all of it, or else the file as it was. It knows
//! nothing of what is written.

use crate::resolver::reason;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file could not be written. What was there before still is.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {}", path.display(), reason(source))]
pub struct WriteError {
    /// The file, as the caller named it.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

/// Writes a file by `write`, whole or not at all.
///
/// The bytes go to a temporary file beside it, named `.<name>.<random>.tmp`, which takes its place once they
/// are on the disk. A file that exists keeps its permissions, and a symbolic link keeps pointing at what is
/// written. Devices and pipes cannot be replaced and are written directly.
///
/// Not guaranteed: a killed process may leave the temporary file behind.
///
/// # Errors
/// The directory does not exist, the file is read-only or a directory, `write` fails, or the disk does.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    let written = if is_special(path) { write_directly(path, write) } else { replace(path, write) };
    written.map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Whether a path names a device, a pipe or an open descriptor instead of a file.
fn is_special(path: &Path) -> bool {
    // Standard output may be redirected to a file, which must be written through the descriptor all the same.
    let is_descriptor = path.starts_with("/dev") || path.starts_with("/proc");
    is_descriptor || fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

fn write_directly(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(OpenOptions::new().write(true).open(path)?);
    write(&mut out)?;
    out.flush()
}

fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let path = follow_links(path)?;
    let old = old_permissions(&path)?;
    let directory = directory_of(&path)?;
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().ok_or_else(|| invalid("the path names no file"))?);
    name.push(".");

    let mut builder = tempfile::Builder::new();
    builder.prefix(&name).suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(permissions_before_umask());
    let mut file = builder.tempfile_in(directory)?;
    let mut out = BufWriter::new(file.as_file_mut());
    write(&mut out)?;
    out.flush()?;
    drop(out);
    if let Some(old) = old {
        file.as_file().set_permissions(old)?;
    }
    file.as_file().sync_all()?;
    file.persist(&path)?;
    sync_directory(directory);
    Ok(())
}

/// What a program asks for when it creates a file; the system takes the user's mask off.
#[cfg(unix)]
fn permissions_before_umask() -> Permissions {
    use std::os::unix::fs::PermissionsExt;
    Permissions::from_mode(0o666)
}

/// The permissions of the file that will be replaced, if there is one.
///
/// # Errors
/// It must not be replaced: it is read-only or a directory.
fn old_permissions(path: &Path) -> io::Result<Option<Permissions>> {
    match fs::metadata(path) {
        Ok(old) if old.is_dir() => Err(invalid("it is a directory")),
        Ok(old) if old.permissions().readonly() => {
            Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"))
        }
        Ok(old) => Ok(Some(old.permissions())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

fn directory_of(path: &Path) -> io::Result<&Path> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let directory = parent.unwrap_or(Path::new("."));
    match directory.is_dir() {
        true => Ok(directory),
        false => {
            let message = format!("there is no directory `{}`", directory.display());
            Err(io::Error::new(io::ErrorKind::NotFound, message))
        }
    }
}

/// The most symbolic links that are followed, as in Linux: more are taken for a circle.
const MOST_LINKS: usize = 40;

/// The file that a path means, through symbolic links, whether or not it exists yet.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = path.parent().unwrap_or(Path::new("")).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(invalid("too many symbolic links"))
}

/// Makes the new name last through a loss of power, where the system can. The file itself is safe either way.
fn sync_directory(directory: &Path) {
    if let Ok(directory) = File::open(directory) {
        let _ = directory.sync_all();
    }
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}
