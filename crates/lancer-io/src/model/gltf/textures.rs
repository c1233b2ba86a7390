//! Images of textures, each read once.

use super::buffers::{Buffers, is_data};
use super::document::Document;
use super::fault::{Fault, Result, Warnings, entry};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::image::{load_texture, texture_of_bytes};
use crate::resolver::Resolver;
use lancer_core::scene::ImageTexture;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// The textures of a document.
pub(super) struct Textures<'a> {
    path: &'a Path,
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    resolver: &'a Resolver,
    /// By image; `None` for one that could not be had and has been told.
    loaded: HashMap<usize, Option<Arc<ImageTexture>>>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(
        path: &'a Path,
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        resolver: &'a Resolver,
    ) -> Self {
        Self { path, document, buffers, resolver, loaded: HashMap::new() }
    }

    /// The image of a texture. One that cannot be had is a warning; an index that leads nowhere is an error.
    pub(super) fn load(
        &mut self,
        texture: usize,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Arc<ImageTexture>>> {
        let written = entry(&self.document.textures, "textures", texture, format!("{at}/index"))?;
        let here = format!("/textures/{texture}");
        let Some(source) = written.source else {
            warnings.add(&here, "has no image of a format that is read");
            return Ok(None);
        };
        entry(&self.document.images, "images", source, format!("{here}/source"))?;
        if let Some(image) = self.loaded.get(&source) {
            return Ok(image.clone());
        }
        let image = match self.read(source) {
            Ok(image) => Some(image),
            Err(fault) => {
                warnings.add(fault.pointer(), format!("{}; the texture is left out", fault.message()));
                None
            }
        };
        self.loaded.insert(source, image.clone());
        Ok(image)
    }

    fn read(&mut self, index: usize) -> Result<Arc<ImageTexture>> {
        let here = format!("/images/{index}");
        let image = &self.document.images[index];
        let broken = |error: LoadError| {
            let told = |Diagnostic { message, hint, .. }: Diagnostic| match hint {
                Some(hint) => format!("{message} ({hint})"),
                None => message,
            };
            Fault::new(&here, error.diagnostics.into_iter().map(told).collect::<Vec<_>>().join("; "))
        };
        // What an image in the file is called in messages, and nothing that is opened.
        let name = image.name.as_deref().unwrap_or("image");
        let named = self.path.with_file_name(name);
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) if is_data(uri) => {
                let bytes = self.buffers.fetch(uri, &format!("{here}/uri"))?;
                texture_of_bytes(&named, &bytes, self.resolver).map_err(broken)
            }
            (Some(uri), _) => {
                let file = self.buffers.file(uri, &format!("{here}/uri"))?;
                load_texture(&file, self.resolver).map_err(broken)
            }
            (None, Some(view)) => {
                let view = self.buffers.view(view, &format!("{here}/bufferView"))?;
                texture_of_bytes(&named, view.bytes, self.resolver).map_err(broken)
            }
            (None, None) => Err(Fault::new(here, "has neither a uri nor a bufferView")),
        }
    }
}
