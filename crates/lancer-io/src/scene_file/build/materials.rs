//! Materials, and the images on them.

use super::{Builder, Source, problems_of_reference};
use crate::scene_file::deserialize::Spanned;
use crate::scene_file::model::{
    ImageFile, ImageReference, MaterialFile, MaterialReference, Named, Pattern, SurfaceColor,
};
use crate::scene_file::syntax::Problem;
use lancer_core::Rgb;
use lancer_core::scene::{ImageTexture, Material, MaterialId, Texture, Wrap};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The images that were asked for, by file; `None` for those that cannot be read.
#[derive(Default)]
pub(super) struct Textures(HashMap<PathBuf, Option<Arc<ImageTexture>>>);

impl Textures {
    fn get(
        &mut self,
        reference: &Spanned<String>,
        source: &mut Source<'_>,
        problems: &mut Vec<Problem>,
    ) -> Option<Arc<ImageTexture>> {
        let path = source.resolve(reference).map_err(|problem| problems.push(problem)).ok()?;
        let read = || match source.assets.texture(&path) {
            Ok(texture) => Some(texture),
            Err(error) => {
                problems.extend(problems_of_reference(reference, &error));
                None
            }
        };
        self.0.entry(path.clone()).or_insert_with(read).clone()
    }
}

impl<'a> Builder<'a> {
    pub(super) fn add_materials(&mut self, materials: &'a Named<MaterialFile>) {
        for (name, file) in &materials.0 {
            let id = self.add_material(&name.value, file);
            self.materials.add(name, id);
        }
    }

    fn add_material(&mut self, name: &str, file: &MaterialFile) -> MaterialId {
        let Self { textures, source, problems, .. } = self;
        let material = material(name, file, |image| textures.get(image, source, problems));
        self.scene.add_material(material)
    }

    /// The material of an object. `None` where it is at fault, which is told.
    pub(super) fn material_of(&mut self, reference: &Spanned<MaterialReference>) -> Option<MaterialId> {
        match &reference.value {
            MaterialReference::InPlace(file) => Some(self.add_material("", file)),
            MaterialReference::Name(name) => match self.materials.find(name, reference.place) {
                Ok(id) => id.copied(),
                Err(problem) => {
                    self.problems.push(problem);
                    None
                }
            },
        }
    }
}

/// The material that a file describes. An image that `fetch` does not find is told by it, and replaced by white.
pub(crate) fn material(
    name: &str,
    file: &MaterialFile,
    fetch: impl FnOnce(&Spanned<String>) -> Option<Arc<ImageTexture>>,
) -> Material {
    let color = match &file.color {
        SurfaceColor::Solid(color) => Texture::Solid(color.0),
        SurfaceColor::Pattern(Pattern::Checker(checker)) => {
            Texture::Checker { even: checker.even.0, odd: checker.odd.0, size: checker.size.get() }
        }
        SurfaceColor::Pattern(Pattern::Image(image)) => {
            let (file, wrap) = file_and_wrap(image);
            fetch(&file).map_or(Texture::Solid(Rgb::WHITE), |image| Texture::Image { image, wrap })
        }
    };
    Material {
        name: name.into(),
        color,
        ambient: file.ambient.get(),
        diffuse: file.diffuse.get(),
        specular: file.specular.get(),
        metallic: file.metallic.get(),
        shininess: file.shininess.get(),
        reflect: file.reflect.get(),
        transmit: file.transmit.get(),
        ior: file.ior.get(),
        fresnel: file.fresnel,
    }
}

/// What a scene file says of an image: its file, and what lies beyond it.
fn file_and_wrap(image: &Spanned<ImageReference>) -> (Spanned<String>, [Wrap; 2]) {
    match &image.value {
        ImageReference::Path(path) => {
            let Spanned { place, is_whole, .. } = *image;
            (Spanned { place, is_whole, value: path.clone() }, [Wrap::Repeat; 2])
        }
        ImageReference::Detailed(ImageFile { file, wrap }) => (file.clone(), wrap.0),
    }
}
