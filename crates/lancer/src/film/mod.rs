//! Films: many pictures in one file, or one after another.
//!
//! In: pictures in their order. Out: numbered files, each whole or not at all; or one file, whole or not at all,
//! which is kept nameless until it is done.

mod destination;
mod ffmpeg;
mod writer;

pub(crate) use destination::FilmDestination;
pub(crate) use writer::FilmWriter;
