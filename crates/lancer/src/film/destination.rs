//! Where a film goes.

use super::ffmpeg;
use crate::destination::check_writable;
use crate::error::Error;
use lancer_io::image::ImageFormat;
use lancer_io::image::animation::{AnimationFormat, Film};
use std::fmt;
use std::path::{Path, PathBuf};

/// Where a film goes, and as what.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum FilmDestination {
    /// Numbered pictures.
    Pictures {
        /// Their name.
        name: NumberedName,
        /// Their format.
        format: ImageFormat,
    },
    /// One picture that moves.
    Animation {
        /// Which file.
        path: PathBuf,
        /// Its format.
        format: AnimationFormat,
    },
    /// A video, by ffmpeg.
    Video {
        /// Which file.
        path: PathBuf,
    },
}

/// A file's name with a place for a number, as in `frame_%04d.png`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NumberedName {
    directory: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl FilmDestination {
    /// What the user means by `--output`.
    ///
    /// # Errors
    /// No film of that name is written.
    pub(crate) fn find(output: &Path) -> Result<Self, Error> {
        if let Some(name) = NumberedName::parse(output) {
            let format = ImageFormat::from_path(output).map_err(|error| Error::usage(error.to_string()))?;
            return Ok(Self::Pictures { name, format });
        }
        let path = output.to_owned();
        if let Some(format) = AnimationFormat::from_path(output) {
            return Ok(Self::Animation { path, format });
        }
        if output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mp4")) {
            return Ok(Self::Video { path });
        }
        Err(Error::usage_with_hint(
            format!("films are written as .png, .gif, .webp or .mp4, not as `{}`", output.display()),
            "for one file a picture, number their names, as in frame_%04d.exr",
        ))
    }

    /// The format of the pictures, where each has a file of its own.
    pub(crate) fn picture_format(&self) -> Option<ImageFormat> {
        match self {
            Self::Pictures { format, .. } => Some(*format),
            Self::Animation { .. } | Self::Video { .. } => None,
        }
    }

    /// Finds out before a long render what would make writing fail after it. It changes nothing.
    ///
    /// # Errors
    /// The format cannot hold the film; the files cannot be written; there is no ffmpeg for a video.
    pub(crate) fn check(&self, film: &Film) -> Result<(), Error> {
        let path = match self {
            Self::Pictures { name, .. } => name.numbered(1),
            Self::Animation { path, format } => {
                format.check(film).map_err(|error| {
                    Error::usage_with_hint(error.to_string(), "numbered pictures have no such bounds")
                })?;
                path.clone()
            }
            Self::Video { path } => path.clone(),
        };
        check_writable(&path).map_err(|error| Error::output(path.display().to_string(), &error))?;
        match self {
            Self::Video { path } => ffmpeg::check(path),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for FilmDestination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pictures { name, .. } => name.fmt(f),
            Self::Animation { path, .. } | Self::Video { path } => path.display().fmt(f),
        }
    }
}

impl NumberedName {
    /// The name in which `%d` or, with leading zeros, `%04d` stands; none where there is no such place.
    fn parse(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        name.match_indices('%').find_map(|(place, _)| {
            let rest = &name[place + 1..];
            let end = rest.find(|c: char| !c.is_ascii_digit())?;
            let after = rest[end..].strip_prefix('d')?;
            let digits = match &rest[..end] {
                "" => 1,
                // A width without a zero before it would ask for spaces.
                width => width.strip_prefix('0')?.parse().ok().filter(|digits| (1..=9).contains(digits))?,
            };
            let directory = path.parent().unwrap_or(Path::new("")).to_owned();
            Some(Self { directory, before: name[..place].to_owned(), digits, after: after.to_owned() })
        })
    }

    /// The file of a number.
    pub(crate) fn numbered(&self, number: u32) -> PathBuf {
        let Self { directory, before, digits, after } = self;
        directory.join(format!("{before}{number:0digits$}{after}"))
    }
}

impl fmt::Display for NumberedName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { directory, before, digits, after } = self;
        let place = if *digits == 1 { "%d".to_owned() } else { format!("%0{digits}d") };
        directory.join(format!("{before}{place}{after}")).display().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(name: &str) -> Option<String> {
        NumberedName::parse(Path::new(name)).map(|found| found.numbered(7).display().to_string())
    }

    #[test]
    fn numbers_stand_where_they_are_asked_for() {
        assert_eq!(numbered("a_%04d.png").as_deref(), Some("a_0007.png"));
        assert_eq!(numbered("in/%d.exr").as_deref(), Some("in/7.exr"));
        assert_eq!(numbered("100%_%03d%.png").as_deref(), Some("100%_007%.png"));
        for plain in ["a.png", "a_%.png", "a%4d.png", "a%0xd.png", "%d/a.png", "a%00d.png", "a%"] {
            assert_eq!(numbered(plain), None, "{plain}");
        }
    }

    #[test]
    fn names_are_told_as_they_were_typed() {
        for name in ["a_%04d.png", "in/%d.exr", "b.gif", "c.MP4", "d.apng", "e.webp"] {
            assert_eq!(FilmDestination::find(Path::new(name)).unwrap().to_string(), name);
        }
        assert!(matches!(FilmDestination::find(Path::new("f.avi")), Err(Error::Usage { .. })));
    }
}
