//! Portable float map: linear 32-bit floats after a header of three lines, the last row first.
//!
//! It has no place for metadata. Source: Debevec, "PFM Portable FloatMap Image Format".

use lancer_core::film::Image;
use std::io::{self, Write};

pub(super) fn write(image: &Image, mut out: impl Write) -> io::Result<()> {
    // A negative scale means that the lower byte comes first.
    write!(out, "PF\n{} {}\n-1.0\n", image.width(), image.height())?;
    for row in image.pixels().chunks_exact(image.width() as usize).rev() {
        let bytes = row.as_flattened().iter().flat_map(|channel| channel.to_le_bytes()).collect::<Vec<_>>();
        out.write_all(&bytes)?;
    }
    Ok(())
}
