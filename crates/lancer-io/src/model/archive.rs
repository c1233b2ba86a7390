//! Models that are packed: one gzip file (`.ply.gz`), or the one model of a zip archive.
//!
//! In: a file of these. Out: the model in it, as if it had been unpacked. What a model in an archive refers to is
//! looked for in the archive and nowhere else; beside a gzip file lie the files that its content refers to.

use super::{Model, ModelFormat, ModelOptions, model_extensions, read};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::package::{Package, Packed};
use crate::resolver::Resolver;
use flate2::read::GzDecoder;
use std::path::{Path, PathBuf};

/// The extensions of packed files.
pub(super) const EXTENSIONS: [&str; 2] = ["gz", "zip"];

/// How many models of an archive an error names.
const NAMES_TOLD: usize = 8;

/// Whether a file is packed, by its name.
pub(super) fn is_packed(path: &Path) -> bool {
    EXTENSIONS.iter().any(|known| has_extension(path, known))
}

/// Reads the model in the packed file at `path`.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    if has_extension(path, "gz") {
        load_gzip(path, bytes, resolver, options)
    } else {
        load_zip(path, bytes, resolver, options)
    }
}

fn load_gzip(
    path: &Path,
    bytes: Vec<u8>,
    resolver: &Resolver,
    options: &ModelOptions,
) -> Result<Model, LoadError> {
    let content = content_of(path, &bytes);
    let Some((content, format)) = content else {
        let formats = ModelFormat::ALL.iter().flat_map(|format| format.extensions());
        let names = formats.map(|extension| format!(".{extension}.gz")).collect::<Vec<_>>();
        let message = "does not say which format it holds";
        return Err(Diagnostic::new(path, message).with_hint(format!("name it {}", names.join(", "))).into());
    };
    let within = resolver.within(Packed::File { path: content.clone(), bytes: bytes.into() });
    // Places are told of the file that there is.
    let renamed = |diagnostic: Diagnostic| {
        let file = if diagnostic.file == content { path.to_owned() } else { diagnostic.file };
        Diagnostic { file, ..diagnostic }
    };
    match read(format, &content, &within, options) {
        Ok(model) => Ok(Model { warnings: model.warnings.into_iter().map(renamed).collect(), ..model }),
        Err(error) => Err(LoadError { diagnostics: error.diagnostics.into_iter().map(renamed).collect() }),
    }
}

/// The path of what a gzip file holds, and its format: by the file's own name, or else by the one in its header.
fn content_of(path: &Path, bytes: &[u8]) -> Option<(PathBuf, ModelFormat)> {
    let stripped = path.with_extension("");
    if let Some(format) = ModelFormat::of_path(&stripped) {
        return Some((stripped, format));
    }
    let decoder = GzDecoder::new(bytes);
    let name = std::str::from_utf8(decoder.header()?.filename()?).ok()?;
    // Nothing but the name's end counts.
    let format = ModelFormat::of_path(Path::new(name))?;
    Some((stripped, format))
}

fn load_zip(
    path: &Path,
    bytes: Vec<u8>,
    resolver: &Resolver,
    options: &ModelOptions,
) -> Result<Model, LoadError> {
    let package = Package::new(path, bytes, resolver.limits);
    let package = package.map_err(|message| LoadError::new(path, message))?;
    let models = package.names().into_iter().filter(|name| is_model(name)).collect::<Vec<_>>();
    let [name] = &models[..] else {
        let diagnostic = match models.len() {
            0 => {
                let formats = model_extensions().map(|extension| format!(".{extension}")).collect::<Vec<_>>();
                let hint = format!("models are {}", formats.join(", "));
                Diagnostic::new(path, "is an archive without a model").with_hint(hint)
            }
            count => {
                let told = models.iter().take(NAMES_TOLD).map(|name| format!("`{name}`")).collect::<Vec<_>>();
                let more = if count > NAMES_TOLD { ", ..." } else { "" };
                let message = format!("is an archive of {count} models: {}{more}", told.join(", "));
                Diagnostic::new(path, message).with_hint("unpack it, and name the one that is meant")
            }
        };
        return Err(diagnostic.into());
    };
    let content = package.path_of(name);
    let Some(format) = ModelFormat::of_path(&content) else {
        return Err(LoadError::new(&content, "is packed twice, which is not read"));
    };
    read(format, &content, &resolver.within(Packed::Archive(package)), options)
}

/// Whether an archive's entry is a model: not one of the files that systems add.
fn is_model(name: &str) -> bool {
    let is_hidden = name.split('/').any(|part| part.starts_with('.') || part == "__MACOSX");
    !is_hidden && super::is_model_file(Path::new(name))
}

fn has_extension(path: &Path, known: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(known))
}
