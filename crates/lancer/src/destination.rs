//! Where a picture goes.

use crate::args::EncodingArgs;
use crate::error::Error;
use crate::interrupt;
use crate::source::Source;
use crate::terminal::{self, STDOUT};
use lancer_core::film::{Image, Tone};
use lancer_core::render::CancelToken;
use lancer_io::image::{Encoding, EncodingChoice, ImageFormat, Metadata, encode};
use lancer_io::output::write_atomically;
use std::fmt;
use std::fs;
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

/// Where a picture goes, and in which format.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// Standard output.
    Stdout(Encoding),
    /// A file.
    File {
        /// Which.
        path: PathBuf,
        /// How it is written.
        encoding: Encoding,
        /// Whether the user named it.
        is_named: bool,
    },
}

impl Destination {
    /// What the user means by `--output` and the flags of its format; without them, a PNG with the scene's name in
    /// the current directory.
    ///
    /// # Errors
    /// No format of that name is written, or it has not what was chosen of it.
    pub(crate) fn find(output: Option<&Path>, args: &EncodingArgs, source: &Source) -> Result<Self, Error> {
        let EncodingArgs { format, bits, compression, quality, dpi: _ } = *args;
        let encoding = |usual: ImageFormat| {
            Encoding::new(format.unwrap_or(usual), EncodingChoice { bits, compression, quality })
                .map_err(|error| Error::usage(error.to_string()))
        };
        match output {
            None => {
                let mut name = source.stem().to_owned();
                name.push(".png");
                Ok(Self::File { path: name.into(), encoding: encoding(ImageFormat::Png)?, is_named: false })
            }
            Some(output) if output == Path::new("-") => Ok(Self::Stdout(encoding(ImageFormat::Png)?)),
            Some(output) => {
                let usual = match format {
                    Some(format) => Ok(format),
                    None => ImageFormat::from_path(output),
                };
                let usual = usual.map_err(|error| Error::usage(error.to_string()))?;
                Ok(Self::File { path: output.to_owned(), encoding: encoding(usual)?, is_named: true })
            }
        }
    }

    /// Whether it is standard output.
    pub(crate) fn is_stdout(&self) -> bool {
        matches!(self, Self::Stdout(_))
    }

    /// How the picture is written.
    pub(crate) fn encoding(&self) -> Encoding {
        match self {
            Self::Stdout(encoding) | Self::File { encoding, .. } => *encoding,
        }
    }

    /// Finds out before a long render what would make writing fail after it. It changes nothing.
    ///
    /// # Errors
    /// Standard output is a terminal; the file or its directory cannot be written.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self::Stdout(_) if io::stdout().is_terminal() => Err(Error::usage_with_hint(
                "a terminal cannot show a picture",
                "redirect standard output, or give a file: --output picture.png",
            )),
            Self::Stdout(_) => Ok(()),
            Self::File { path, is_named, .. } => {
                let checked =
                    check_writable(path).and_then(|()| if *is_named { Ok(()) } else { check_ours(path) });
                checked.map_err(|error| Error::output(path.display().to_string(), &error))
            }
        }
    }

    /// Writes the picture, whole or not at all.
    ///
    /// # Errors
    /// It cannot be written, or the user asked to stop before it was.
    pub(crate) fn write(
        &self,
        image: &Image,
        tone: Tone,
        metadata: &Metadata,
        cancel: &CancelToken,
    ) -> Result<(), Error> {
        let written = match self {
            Self::Stdout(encoding) => {
                write_to_stdout(|out| encode::write(*encoding, image, tone, metadata, out))
            }
            Self::File { path, encoding, .. } => {
                write_to_file(path, cancel, |out| encode::write(*encoding, image, tone, metadata, out))
            }
        };
        // Whatever the error then says, it is not the file's fault.
        written.map_err(|error| if cancel.is_cancelled() { Error::Interrupted } else { error })
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stdout(_) => f.write_str(STDOUT),
            Self::File { path, .. } => path.display().fmt(f),
        }
    }
}

fn write_to_stdout(encode: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Error> {
    let mut bytes = Vec::new();
    encode(&mut bytes).map_err(|error| Error::output(STDOUT, &error))?;
    terminal::print(bytes).map_err(|error| match error {
        // Unlike the end of a list, a picture that nobody took is news.
        Error::ReaderGone => Error::output(STDOUT, &io::ErrorKind::BrokenPipe.into()),
        error => error,
    })
}

fn write_to_file(
    path: &Path,
    cancel: &CancelToken,
    encode: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    // A pipe, in which nothing can be unwound, may wait for its reader for ever.
    let is_replaced = fs::metadata(path).map_or(true, |found| found.is_file());
    let _handled = is_replaced.then(|| interrupt::only_cancels(cancel));
    let written = write_atomically(path, |out| {
        let mut out = UntilCancelled { out, cancel };
        encode(&mut out)?;
        out.flush()
    });
    written.map_err(|error| Error::output(path.display().to_string(), &error.source))
}

/// A writer that fails once the user asked to stop, so that what was written so far is dropped.
struct UntilCancelled<'a, W> {
    out: W,
    cancel: &'a CancelToken,
}

impl<W> UntilCancelled<'_, W> {
    fn go_on(&self) -> io::Result<()> {
        // Not `ErrorKind::Interrupted`, at which callers try again.
        if self.cancel.is_cancelled() { Err(io::Error::other("cancelled")) } else { Ok(()) }
    }
}

impl<W: Write> Write for UntilCancelled<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.go_on()?;
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.go_on()?;
        self.out.flush()
    }
}

/// Whether a file can be made or replaced.
///
/// Permissions do not tell: read-only file systems, quotas and access lists have their say. So a nameless file is
/// made in the directory, which the system takes away again whatever happens.
fn check_writable(path: &Path) -> io::Result<()> {
    // What is written is what a symbolic link leads to.
    let path = &path.canonicalize().unwrap_or_else(|_| path.to_owned());
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(io::Error::other("it is a directory")),
        Ok(found) if found.permissions().readonly() => return Err(io::Error::other("it is read-only")),
        // A pipe or a device, which is written as it is.
        Ok(found) if !found.is_file() => return Ok(()),
        _ => {}
    }
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let directory = directory.unwrap_or(Path::new("."));
    if !directory.is_dir() {
        return Err(io::Error::other(format!("there is no directory `{}`", directory.display())));
    }
    tempfile::tempfile_in(directory).map(drop)
}

/// Whether a file that the user did not name may be replaced: it is not there, or is a picture by this program.
///
/// `model.obj` often has its texture beside it in `model.png`.
fn check_ours(path: &Path) -> io::Result<()> {
    /// More than the chunks of a PNG before its pixels, where it names its maker.
    const HEAD: u64 = 1024;
    const MAKER: &[u8] = b"Software\0Lancer ";
    let Ok(file) = fs::File::open(path) else { return Ok(()) };
    let mut head = Vec::new();
    file.take(HEAD).read_to_end(&mut head)?;
    if head.windows(MAKER.len()).any(|window| window == MAKER) {
        return Ok(());
    }
    Err(io::Error::other("it was not made by lancer; to replace it, name it with --output"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cancelled_write_leaves_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("old.png");
        fs::write(&path, "old").unwrap();
        let encoding = ImageFormat::Png.into();
        let destination = Destination::File { path: path.clone(), encoding, is_named: true };
        let cancel = CancelToken::default();
        cancel.cancel();

        let written = destination.write(&Image::black(2, 2), Tone::default(), &Metadata::default(), &cancel);

        assert!(matches!(written, Err(Error::Interrupted)));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_check_changes_nothing() {
        let directory = tempfile::tempdir().unwrap();
        check_writable(&directory.path().join("new.png")).unwrap();
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    }
}
