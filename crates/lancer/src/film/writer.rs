//! Pictures to a film.

use super::FilmDestination;
use super::destination::NumberedName;
use super::ffmpeg::Ffmpeg;
use crate::destination::{Destination, write_file};
use crate::error::Error;
use lancer_core::film::{Image, Tone};
use lancer_core::render::CancelToken;
use lancer_io::image::animation::{AnimationWriter, Film};
use lancer_io::image::{ImageFormat, Metadata};
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// A film on its way.
pub(crate) struct FilmWriter {
    tone: Tone,
    cancel: CancelToken,
    kind: Kind,
}

enum Kind {
    Pictures {
        name: NumberedName,
        format: ImageFormat,
        written: u32,
    },
    Animation {
        path: PathBuf,
        writer: AnimationWriter<BufWriter<File>>,
        /// The same file, which has no name: whatever happens, the system takes it away.
        file: File,
    },
    Video {
        path: PathBuf,
        ffmpeg: Ffmpeg,
    },
}

impl FilmWriter {
    /// Begins a film.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn new(
        destination: &FilmDestination,
        film: Film,
        tone: Tone,
        cancel: &CancelToken,
    ) -> Result<Self, Error> {
        let kind = match destination {
            FilmDestination::Pictures { name, format } => {
                Kind::Pictures { name: name.clone(), format: *format, written: 0 }
            }
            FilmDestination::Animation { path, format } => {
                let begin = || -> io::Result<Kind> {
                    let file = tempfile::tempfile_in(directory_of(path))?;
                    let out = BufWriter::new(file.try_clone()?);
                    let writer = AnimationWriter::new(*format, film, &Metadata::default(), out)?;
                    Ok(Kind::Animation { path: path.clone(), writer, file })
                };
                begin().map_err(|error| Error::output(path.display().to_string(), &error))?
            }
            FilmDestination::Video { path } => {
                let ffmpeg = Ffmpeg::start(&film, directory_of(path))
                    .map_err(|error| Error::output(path.display().to_string(), &error))?;
                Kind::Video { path: path.clone(), ffmpeg }
            }
        };
        Ok(Self { tone, cancel: cancel.clone(), kind })
    }

    /// Adds the next picture; `metadata` is for a file of its own.
    ///
    /// # Errors
    /// It cannot be written, or the user asked to stop.
    pub(crate) fn add(&mut self, image: &Image, metadata: &Metadata) -> Result<(), Error> {
        match &mut self.kind {
            Kind::Pictures { name, format, written } => {
                *written += 1;
                let path = name.numbered(*written);
                let picture = Destination::File { path, encoding: (*format).into(), is_named: true };
                picture.write(image, self.tone, metadata, &self.cancel)
            }
            Kind::Animation { path, writer, .. } => {
                let codes = self.tone.to_codes8(image);
                writer.add(&codes).map_err(|error| Error::output(path.display().to_string(), &error))
            }
            Kind::Video { path, ffmpeg } => {
                let codes = self.tone.to_codes8(image);
                ffmpeg
                    .add(codes.as_flattened())
                    .map_err(|error| Error::output(path.display().to_string(), &error))
            }
        }
    }

    /// Ends the film: only now is there a file, where it is one.
    ///
    /// # Errors
    /// It cannot be written, or the user asked to stop.
    pub(crate) fn finish(self) -> Result<(), Error> {
        let done = |path: &Path, file: io::Result<File>| {
            let mut file = file.map_err(|error| Error::output(path.display().to_string(), &error))?;
            write_file(path, &self.cancel, |out| {
                file.seek(SeekFrom::Start(0))?;
                io::copy(&mut file, out).map(drop)
            })
        };
        match self.kind {
            Kind::Pictures { .. } => Ok(()),
            Kind::Animation { path, writer, file } => done(&path, writer.finish().map(|()| file)),
            Kind::Video { path, ffmpeg } => done(&path, ffmpeg.finish()),
        }
    }
}

/// Where the file will be, so that there is room for it while it is made.
fn directory_of(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}
