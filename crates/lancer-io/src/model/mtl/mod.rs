//! Wavefront MTL: the materials of OBJ files.
//!
//! In: the libraries that an OBJ file names and the materials that it uses. Out: those materials in the
//! renderer's terms ([`convert`] says how) with their textures. Nothing here is an error: what is missing or
//! cannot be read is a warning, and the part is then drawn with the material of its node.
//!
//! Source: Alias Wavefront, "MTL material format", 1995.

mod convert;
mod parse;

use self::convert::material;
use self::parse::Definition;
use super::polygons::UvPlacement;
use super::text::{Reference, Source, quoted};
use crate::diagnostics::Diagnostic;
use crate::image::load_texture;
use crate::resolver::Resolver;
use lancer_core::scene::{ImageTexture, Material, Texture};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most libraries that one OBJ file may name: far more than any does, and few enough to open.
const MAX_LIBRARIES: usize = 100;

/// How many undefined materials a warning names.
const NAMES_TOLD: usize = 5;

/// The materials that a model uses and that were found.
pub(super) struct MaterialLibrary {
    pub(super) materials: Vec<Material>,
    /// For each material where its image lies.
    pub(super) placements: Vec<UvPlacement>,
    index_by_name: HashMap<String, usize>,
}

impl MaterialLibrary {
    /// Reads the libraries that the OBJ file `source` refers to, and makes the materials in `names`.
    pub(super) fn load<'n>(
        references: &[Reference],
        source: Source,
        names: impl Iterator<Item = Option<&'n str>>,
        resolver: &Resolver,
        warnings: &mut Vec<Diagnostic>,
    ) -> Self {
        let libraries = Libraries::read(references, source, resolver, warnings);
        let mut textures = Textures::new(resolver);
        let mut library =
            Self { materials: Vec::new(), placements: Vec::new(), index_by_name: HashMap::new() };
        let mut undefined = Vec::new();
        for name in names.flatten() {
            let Some((path, definition)) = libraries.definitions.get(name) else {
                undefined.push(name);
                continue;
            };
            let map = definition.map_kd.as_ref();
            let image = map.and_then(|map| textures.load(path, &map.file, warnings));
            library.index_by_name.insert(name.to_owned(), library.materials.len());
            let texture = image.zip(map).map(|(image, map)| Texture::Image { image, wrap: [map.wrap; 2] });
            library.materials.push(material(definition, texture));
            library.placements.push(map.map_or(UvPlacement::IDENTITY, |map| map.placement));
        }
        // Where a library is missing, that has been told, and its materials need not be.
        if !undefined.is_empty() && libraries.all_found {
            warnings.push(Diagnostic::new(source.path, undefined_message(&undefined)));
        }
        library
    }

    /// The place of a material by its name.
    pub(super) fn index_of(&self, name: &str) -> Option<usize> {
        self.index_by_name.get(name).copied()
    }
}

fn undefined_message(names: &[&str]) -> String {
    let told = names
        .iter()
        .take(NAMES_TOLD)
        .map(|name| format!("`{}`", quoted(name.as_bytes())))
        .collect::<Vec<_>>()
        .join(", ");
    let more = match names.len().saturating_sub(NAMES_TOLD) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("no material library defines {told}{more}; the default material is used")
}

/// The definitions of all libraries of a file.
struct Libraries {
    /// By name, with the library's path; the first definition counts.
    definitions: HashMap<String, (PathBuf, Definition)>,
    all_found: bool,
}

impl Libraries {
    fn read(
        references: &[Reference],
        source: Source,
        resolver: &Resolver,
        warnings: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut libraries = Self { definitions: HashMap::new(), all_found: true };
        let mut seen = HashSet::new();
        for reference in references {
            if !seen.insert(reference.name.as_str()) {
                continue;
            }
            if seen.len() > MAX_LIBRARIES {
                let message =
                    format!("only {MAX_LIBRARIES} material libraries are read, not this and further ones");
                warnings.push(source.diagnostic(reference.offset, message));
                break;
            }
            if let Err(message) = libraries.add(source.path, &reference.name, resolver, warnings) {
                libraries.all_found = false;
                let message = format!("material library: {message}; the default material is used");
                warnings.push(source.diagnostic(reference.offset, message));
            }
        }
        libraries
    }

    /// Reads one library.
    fn add(
        &mut self,
        from: &Path,
        name: &str,
        resolver: &Resolver,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(), String> {
        let path = resolver.resolve(from, name)?;
        let bytes = resolver.read(&path).map_err(|error| error.to_string())?;
        let (definitions, told) = parse::definitions(Source { path: &path, bytes: &bytes });
        warnings.extend(told);
        for definition in definitions {
            let entry = self.definitions.entry(definition.name.clone());
            entry.or_insert_with(|| (path.clone(), definition));
        }
        Ok(())
    }
}

/// The textures of one model.
struct Textures<'a> {
    resolver: &'a Resolver,
    /// Files that could not be had, which is told once, however many materials name them.
    refused: HashSet<PathBuf>,
}

impl<'a> Textures<'a> {
    fn new(resolver: &'a Resolver) -> Self {
        Self { resolver, refused: HashSet::new() }
    }

    /// The image that the library at `library` names.
    fn load(
        &mut self,
        library: &Path,
        name: &str,
        warnings: &mut Vec<Diagnostic>,
    ) -> Option<Arc<ImageTexture>> {
        let path = match self.resolve(library, name) {
            Ok(path) => path,
            Err(message) => {
                if self.refused.insert(library.join(name)) {
                    warnings.push(Diagnostic::new(library, format!("texture: {message}")));
                }
                return None;
            }
        };
        let file = self.resolver.identity(&path);
        if self.refused.contains(&file) {
            return None;
        }
        load_texture(&path, self.resolver)
            .map_err(|error| {
                warnings.extend(error.diagnostics);
                self.refused.insert(file);
            })
            .ok()
    }

    /// The file that a library means. A full path was right on its author's machine only, so if it cannot be
    /// had, the file of that name beside the library is taken.
    fn resolve(&self, library: &Path, name: &str) -> Result<PathBuf, String> {
        self.resolver.resolve(library, name).or_else(|message| {
            let file = name.rsplit(['/', '\\']).next().filter(|_| is_full_path(name));
            file.and_then(|file| self.resolver.resolve(library, file).ok()).ok_or(message)
        })
    }
}

/// Whether a path begins at a root: `/`, `\` or a drive's letter.
fn is_full_path(path: &str) -> bool {
    let drive = |bytes: &[u8]| matches!(bytes, [letter, b':', ..] if letter.is_ascii_alphabetic());
    path.starts_with(['/', '\\']) || drive(path.as_bytes())
}
