//! `lancer thumbnail`: a small picture of a scene or a model, soon.
//!
//! A model is cut out: file managers are light or dark, and show names beneath. A scene keeps its background.

use crate::args::ThumbnailArgs;
use crate::destination::{check_writable, write_file};
use crate::error::Error;
use crate::interrupt;
use crate::source::Source;
use crate::terminal;
use lancer_core::accel::Quality;
use lancer_core::film::Image;
use lancer_core::render::passes::{Layer, Pass, PassRender, Samples, render_passes};
use lancer_core::render::{CancelToken, Control, render};
use lancer_core::scene::{AmbientOcclusion, Scene, Settings};
use lancer_core::world::{CompileOptions, World};
use lancer_io::diagnostics::LoadError;
use lancer_io::image::cutout::{Cutout, write_cutout};
use lancer_io::image::encode::write;
use lancer_io::image::{ImageFormat, Metadata};
use lancer_io::is_scene_file;
use lancer_io::showcase::{framing_camera, hide_ground};
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::Path;

/// The most subpixels along a pixel's side, and what a model gets: its edges are all that is seen of it at first.
const SAMPLES: u32 = 3;
/// The most directions of ambient occlusion at a point: with 3 x 3 subpixels, 72 a pixel.
const OCCLUSION_SAMPLES: u32 = 8;
/// The most reflections that follow one another: enough for a glass ball, and no room of mirrors.
const DEPTH: u32 = 6;

/// Renders and writes.
///
/// # Errors
/// See [`Error`].
pub(crate) fn run(args: &ThumbnailArgs) -> Result<(), Error> {
    let source = Source::find(Some(&args.scene))?;
    check_writable(&args.output).map_err(|error| Error::output(args.output.display().to_string(), &error))?;
    let options = args.files.load_options();
    let loaded = source.load(&options)?;
    loaded.warnings.iter().for_each(terminal::tell_warning);
    let is_model = matches!(&source, Source::File(path) if !is_scene_file(path));
    let cancel = CancelToken::default();
    let _handled = interrupt::cancels(&cancel);
    let control = Control { cancel: cancel.clone(), ..Control::default() };
    let fault = |error: &dyn std::fmt::Display| LoadError::from(source.diagnostic(error));
    let compile = |scene: &Scene| {
        let options = CompileOptions { quality: Quality::Fast, ..CompileOptions::default() };
        World::compile(scene, &options).map_err(|error| fault(&error))
    };
    let mut scene = loaded.scene;
    scene.settings.validate().map_err(|error| fault(&error))?;
    let settings = bounded(&scene.settings, args.size, is_model);

    let metadata = Metadata::default();
    if is_model {
        hide_ground(&mut scene);
        let world = compile(&scene)?;
        let camera = framing_camera(world.bounds(), &settings);
        let picture = render_passes(&world, &camera, &settings, None, &[Pass::Background], 1.0, &control)?;
        let cutout = cut_out(&picture, &scene);
        deliver(&args.output, &cancel, |out| write_cutout(&cutout, &metadata, out))
    } else {
        let world = compile(&scene)?;
        let (Settings { width, height, .. }, camera) = (settings, scene.camera);
        camera.project(width, height).map_err(|error| fault(&error))?;
        let picture = render(&world, &camera, &settings, None, &control)?;
        deliver(&args.output, &cancel, |out| {
            write(ImageFormat::Png, &picture.image, scene.tone, &metadata, out)
        })
    }
}

/// Writes the file, whole or not at all; an empty one that is there is filled.
///
/// File managers make the file first, and some read it through the descriptor by which they did (tumbler, of Thunar and
/// others). That would go on showing the empty file if another took its place.
fn deliver(
    path: &Path,
    cancel: &CancelToken,
    encode: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    if !fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() == 0) {
        return write_file(path, cancel, encode);
    }
    let fill = || {
        let mut bytes = Vec::new();
        encode(&mut bytes)?;
        let mut file = OpenOptions::new().write(true).open(path)?;
        file.write_all(&bytes).inspect_err(|_| {
            // The first error is told.
            let _ = file.set_len(0);
        })
    };
    let _handled = interrupt::only_cancels(cancel);
    if cancel.is_cancelled() {
        return Err(Error::Interrupted);
    }
    fill().map_err(|error| Error::output(path.display().to_string(), &error))
}

/// The scene's settings at the size of a thumbnail, and at a bounded effort.
fn bounded(scene: &Settings, size: u32, is_model: bool) -> Settings {
    let longer = scene.width.max(scene.height);
    let side = |side: u32| {
        let scaled = (u64::from(side) * u64::from(size) + u64::from(longer) / 2) / u64::from(longer);
        (scaled as u32).max(1)
    };
    let (width, height) = if is_model { (size, size) } else { (side(scene.width), side(scene.height)) };
    let ao = AmbientOcclusion { samples: scene.ao.samples.min(OCCLUSION_SAMPLES), ..scene.ao };
    // A scene is rendered smaller than it was meant, with details that want as many subpixels.
    Settings { width, height, samples: SAMPLES, depth: scene.depth.min(DEPTH), ao, ..*scene }
}

/// The picture without its background, which told how much of each pixel it is.
fn cut_out(picture: &PassRender, scene: &Scene) -> Cutout {
    let image = &picture.render.image;
    let [Layer { samples: Samples::Color(behind), .. }] = picture.layers.as_slice() else {
        unreachable!("the background is the one pass, and a colour")
    };
    let mut covering = Image::black(image.width(), image.height());
    let without = image.pixels().iter().zip(behind);
    let without = without.map(|(whole, behind)| std::array::from_fn(|i| whole[i] - behind[i]));
    covering.put(0, 0, image.width(), &without.collect::<Vec<_>>());
    // The brightest channel tells it best.
    let background = scene.background.to_array();
    let brightest = (0..3).max_by(|&a, &b| background[a].total_cmp(&background[b])).unwrap_or_default();
    let bright = background[brightest] as f32;
    let coverage = behind.iter().map(|behind| (1.0 - behind[brightest] / bright).clamp(0.0, 1.0)).collect();
    Cutout { image: covering, coverage }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longer_side_is_the_size_and_the_effort_is_bounded() {
        let scene = Settings {
            width: 1920,
            height: 1080,
            samples: 16,
            depth: 10_000,
            ao: AmbientOcclusion { samples: 4096, distance: 2.0 },
            ..Settings::default()
        };
        let Settings { width, height, samples, depth, ao, .. } = bounded(&scene, 256, false);
        assert_eq!((width, height, samples, depth, ao.samples, ao.distance), (256, 144, 3, 6, 8, 2.0));
        let narrow = Settings { width: 1, height: 60_000, ..scene };
        assert_eq!(bounded(&narrow, 128, false).width, 1);
        let model = bounded(&scene, 100, true);
        assert_eq!((model.width, model.height), (100, 100));
    }
}
