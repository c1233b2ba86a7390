//! PLY, the Stanford polygon file format.
//!
//! In: the bytes of a file, in text or in binary of either byte order, with properties in any order and of
//! any type. Out: one mesh. Read are vertex positions, normals (`nx ny nz`), texture coordinates (`u v`, `s t` or
//! `texture_u texture_v`) and colours (`red green blue`), the polygons of `face`, and the strips of `tristrips`; all else is passed
//! over. What a header promises is held against the file's length before anything is allocated.
//!
//! The reader is our own: `ply-rs-bw`, which we tried, is as fast, but refuses a comment that is not UTF-8,
//! gives no column and several lines for an error, merges properties of one name, and builds elements without
//! properties one by one, as many as the header claims.
//!
//! Source: G. Turk, "The PLY polygon file format", 1994.

mod elements;
mod header;
mod values;
mod write;

pub use write::write_ply;

use self::elements::Reader;
use self::header::{Encoding, Header};
use self::values::{AsciiValues, BigEndian, BinaryValues, LittleEndian};
use super::text::Source;
use super::{Crease, Model, ModelOptions, ModelPart, name_of};
use crate::diagnostics::LoadError;
use crate::resolver::Resolver;
use std::path::Path;
use std::sync::Arc;

/// Reads the PLY file at `path`.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    let source = Source { path, bytes: &bytes };
    let header = Header::parse(source)?;
    header.check_counts(source, &resolver.limits)?;

    let mut reader = Reader::new(source, resolver.limits);
    match header.encoding {
        Encoding::Ascii => reader.read(&header, &mut AsciiValues::new(source, header.body)),
        Encoding::LittleEndian => {
            reader.read(&header, &mut BinaryValues::<LittleEndian>::new(source, header.body))
        }
        Encoding::BigEndian => reader.read(&header, &mut BinaryValues::<BigEndian>::new(source, header.body)),
    }?;
    let (mut polygons, warnings) = reader.finish()?;

    // A mesh that was stored without normals is one of facets.
    let crease = options.crease.or(header.is_as_stored.then_some(Crease::FACETS));
    let is_as_stored = !polygons.smooth(crease) && header.is_as_stored;
    let meshes = if is_as_stored { polygons.into_mesh_as_stored() } else { polygons.into_meshes() };
    let meshes = meshes.map_err(|error| LoadError::new(path, error.to_string()))?;
    let part = |(_, mesh)| ModelPart { name: name_of(path), mesh: Arc::new(mesh), material: None };
    Ok(Model {
        name: name_of(path),
        parts: meshes.meshes.into_iter().map(part).collect(),
        materials: Vec::new(),
        origin: meshes.origin,
        warnings,
        ..Model::default()
    })
}
