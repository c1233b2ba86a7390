//! Which passes are written, and into which files.

use crate::args::PassArgs;
use crate::destination::{Destination, check_writable, write_file};
use crate::error::Error;
use lancer_core::film::Image;
use lancer_core::render::CancelToken;
use lancer_core::render::passes::{Layer, Pass, light_names, select};
use lancer_core::scene::Scene;
use lancer_core::world::World;
use lancer_io::image::layers::{channel_names, write_layer, write_layers};
use lancer_io::image::{ImageFormat, encode};
use lancer_io::provenance::Provenance;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Bits of a float in a layer.
const LAYER_BITS: u8 = 32;

/// The passes as typed, and where they go.
pub(crate) struct PassFiles {
    words: Vec<String>,
    separate: bool,
    path: PathBuf,
}

/// The passes of a scene that is known.
pub(crate) struct PassPlan {
    pub(crate) passes: Vec<Pass>,
    /// What lights are called in the names of passes.
    lights: Vec<String>,
    separate: bool,
    path: PathBuf,
}

impl PassFiles {
    /// What the words mean; none where no passes are asked for.
    ///
    /// # Errors
    /// The picture does not go to an OpenEXR file.
    pub(crate) fn new(args: PassArgs, destination: &Destination) -> Result<Option<Self>, Error> {
        let PassArgs { passes: words, separate_passes: separate } = args;
        if words.is_empty() {
            return Ok(None);
        }
        match destination {
            Destination::File { path, encoding, .. } if encoding.format() == ImageFormat::Exr => {
                if encoding.bits() != LAYER_BITS {
                    return Err(Error::usage_with_hint(
                        format!("layers of {} bits do not add up to their picture", encoding.bits()),
                        "leave out --bits: layers have 32",
                    ));
                }
                Ok(Some(Self { words, separate, path: path.clone() }))
            }
            _ => Err(Error::usage_with_hint(
                "passes are written to OpenEXR files alone",
                "give one: --output picture.exr",
            )),
        }
    }

    /// The passes of `scene`.
    ///
    /// # Errors
    /// A word means none of them; a file of a pass could not be written.
    pub(crate) fn plan(&self, scene: &Scene) -> Result<PassPlan, Error> {
        let words = self.words.iter().map(|word| word.trim());
        let passes = select(words, &scene.lights).map_err(|error| {
            Error::usage_with_hint(error.to_string(), format!("the passes of this scene are {}", error.known))
        })?;
        let plan = PassPlan {
            passes,
            lights: light_names(&scene.lights),
            separate: self.separate,
            path: self.path.clone(),
        };
        if self.separate {
            for &pass in &plan.passes {
                let path = plan.path_of(pass);
                check_writable(&path).map_err(|error| Error::output(path.display().to_string(), &error))?;
            }
        }
        Ok(plan)
    }
}

impl PassPlan {
    /// The file of a pass that has one of its own: NAME.exr becomes NAME.PASS.exr.
    fn path_of(&self, pass: Pass) -> PathBuf {
        let mut name = self.path.file_stem().unwrap_or_default().to_owned();
        name.push(format!(".{}.", pass.name(&self.lights)));
        name.push(self.path.extension().unwrap_or_default());
        self.path.with_file_name(name)
    }

    /// Writes the picture and its layers, each file whole or not at all, and says in each how it was made, by the
    /// record of the picture.
    ///
    /// # Errors
    /// One cannot be written, or the user asked to stop before it was.
    pub(crate) fn write(
        &self,
        image: &Image,
        layers: &[Layer],
        record: &Provenance,
        cancel: &CancelToken,
    ) -> Result<(), Error> {
        let name = |layer: &Layer| layer.pass.name(&self.lights);
        let encoded = |layers: &[Layer], record: &Provenance, path: &Path| {
            write_file(path, cancel, |out| encode_as_recorded(image, layers, &self.lights, record, out))
        };
        if !self.separate {
            let record = Provenance { passes: layers.iter().map(name).collect(), ..record.clone() };
            return encoded(layers, &record, &self.path);
        }
        encoded(&[], record, &self.path)?;
        layers.iter().try_for_each(|layer| {
            let record = Provenance { pass: Some(name(layer)), ..record.clone() };
            encoded(std::slice::from_ref(layer), &record, &self.path_of(layer.pass))
        })
    }

    /// What was written, for programs.
    pub(crate) fn table(&self, scene: &Scene, world: &World) -> LayersJson {
        let has = |pass: Pass| self.passes.contains(&pass);
        let name_of = |pass: Pass| LayerJson {
            name: pass.name(&self.lights),
            channels: channel_names(pass, &self.lights),
            file: self.separate.then(|| lossy(&self.path_of(pass))),
        };
        let objects = world.objects().iter().map(|object| scene.node(object.node()).name.clone());
        let materials = scene.materials().iter().map(|material| material.name.clone());
        LayersJson {
            layers: self.passes.iter().map(|&pass| name_of(pass)).collect(),
            objects: has(Pass::ObjectId).then(|| objects.collect()),
            materials: has(Pass::MaterialId).then(|| materials.collect()),
        }
    }
}

/// Writes what a record says that a file holds: a picture, a picture and its layers, or a layer.
///
/// # Errors
/// `out` fails.
pub(crate) fn encode_as_recorded(
    image: &Image,
    layers: &[Layer],
    lights: &[String],
    record: &Provenance,
    out: &mut dyn Write,
) -> io::Result<()> {
    let (&Provenance { tone, encoding, .. }, metadata) = (record, record.metadata());
    match (&record.pass, layers) {
        (Some(_), [layer]) => write_layer(image, layer, encoding, &metadata, out),
        (None, []) => encode::write(encoding, image, tone, &metadata, out),
        _ => write_layers(&tone.expose(image), layers, lights, encoding, &metadata, out),
    }
}

fn lossy(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The layers of a picture, for programs.
#[derive(Serialize)]
pub(crate) struct LayersJson {
    layers: Vec<LayerJson>,
    /// The names of the objects, of which the first has the id 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    objects: Option<Vec<String>>,
    /// The names of the materials, of which the first has the id 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    materials: Option<Vec<String>>,
}

#[derive(Serialize)]
struct LayerJson {
    name: String,
    channels: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
}
