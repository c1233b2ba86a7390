//! `lancer verify`: a picture rendered again from what it says of itself, and compared.

use super::render::{trace, trace_passes};
use crate::args::VerifyArgs;
use crate::error::Error;
use crate::job::{Shot, compile_options, load_options, on_threads, thread_count};
use crate::passes::encode_as_recorded;
use crate::progress::Progress;
use crate::source::Source;
use crate::{json, terminal};
use lancer_core::camera::Camera;
use lancer_core::render::passes::{Pass, light_names, select};
use lancer_core::render::{CancelToken, Control, Region};
use lancer_core::scene::Scene;
use lancer_core::world::World;
use lancer_io::Loaded;
use lancer_io::compare::{Comparison, PIXELS_PER_DEGREE};
use lancer_io::diagnostics::{Diagnostic, LoadError};
use lancer_io::image::layers::differing_channels;
use lancer_io::image::{ImageFormat, decode_picture, provenance_of};
use lancer_io::limits::Limits;
use lancer_io::provenance::{Provenance, SceneHash, SceneSource};
use lancer_io::resolver::Resolver;
use lancer_io::scene_file::Override;
use serde::Serialize;
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

/// Renders the picture again and prints whether its bytes agree.
///
/// # Errors
/// They do not; or the picture does not say how it was made, or the scene cannot be had or rendered.
pub(crate) fn run(args: VerifyArgs) -> Result<(), Error> {
    on_threads(thread_count(args.work.threads), || verify(args))
}

fn verify(args: VerifyArgs) -> Result<(), Error> {
    let VerifyArgs { image, scene, work, reading, json, quiet } = args;
    let progress = Progress::new(quiet);
    let limits = Limits::default();
    let bytes = Resolver::for_file(&image, true, limits).read(&image)?;
    let record = record_of(&image, &bytes)?;
    check_version(&image, &record);

    let source = source_of(&image, &record, scene.as_deref())?;
    let mut options = load_options(reading);
    options.overrides.splice(0..0, overrides_of(&image, &record, &options.overrides)?);
    let Loaded { scene, warnings, .. } = progress.during("reading", || source.load(&options))?;
    warnings.iter().for_each(terminal::tell_warning);

    let shot = shot_of(&image, &record, &scene)?;
    let hash = SceneHash::of(&scene, &shot.camera);
    if hash != record.hash {
        terminal::tell_warning(source.diagnostic(format!(
            "the scene is not what it was: its hash is {hash}, where the picture says {}",
            record.hash
        )));
    }
    let world = progress
        .during("building", || World::compile(&scene, &compile_options(&work)))
        .map_err(|error| LoadError::from(source.diagnostic(error)))?;
    let passes = passes_of(&image, &record, &scene)?;
    let lights = light_names(&scene.lights);
    drop(scene);

    let tile_size = work.tile_size.unwrap_or(Control::DEFAULT_TILE_SIZE);
    let cancel = CancelToken::default();
    let (picture, layers) = match passes.as_slice() {
        [] => (trace(&shot, tile_size, &world, &cancel, &progress)?, Vec::new()),
        passes => trace_passes(&shot, tile_size, &world, passes, &cancel, &progress)?,
    };
    // As it was recorded, so that a file of another version, or of a scene that has changed unseen, still agrees where
    // its pixels do.
    let mut again = Vec::new();
    encode_as_recorded(&picture.image, &layers, &lights, &record, &mut again)
        .map_err(|error| at_fault(&image, error))?;

    let verdict = match layers.is_empty() {
        true => Verdict::of(&image, &bytes, &again, limits)?,
        false => Verdict::of_layers(&image, &bytes, &again, limits)?,
    };
    let told = Told { image: &image, source: &source, record: &record, hash, verdict };
    terminal::print(if json { told.json() } else { told.text() })?;
    if told.verdict == Verdict::Same { Ok(()) } else { Err(Error::Different) }
}

fn at_fault(image: &Path, message: impl fmt::Display) -> Error {
    Error::Scene(Diagnostic::new(image, message.to_string()).into())
}

/// What the picture says of how it was made.
fn record_of(image: &Path, bytes: &[u8]) -> Result<Provenance, Error> {
    let Some(text) = provenance_of(bytes) else {
        let fault = Diagnostic::new(image, "does not say how it was made");
        let hint = "what `lancer render`, numbered pictures of `lancer turntable` and the window's renders write does, in any \
                    format but PFM, unless a program has taken that out; films in one file and thumbnails do not";
        return Err(Error::Scene(fault.with_hint(hint).into()));
    };
    Provenance::from_text(&text).map_err(|error| at_fault(image, error))
}

fn check_version(image: &Path, record: &Provenance) {
    if record.lancer != Provenance::VERSION {
        terminal::tell_warning(Diagnostic::new(
            image,
            format!(
                "was made by lancer {}, and this is {}: pixels may differ",
                record.lancer,
                Provenance::VERSION
            ),
        ));
    }
}

/// The scene that the user names, or else the one that the picture does: a file beside it, or in the current
/// directory.
fn source_of(image: &Path, record: &Provenance, named: Option<&OsStr>) -> Result<Source, Error> {
    if named.is_some() {
        return Source::find(named);
    }
    let name = match &record.scene {
        SceneSource::Builtin(name) => {
            let builtin = lancer_gallery::find(name).map(Source::Builtin);
            return builtin.ok_or_else(|| at_fault(image, format!("there is no built-in scene `{name}`")));
        }
        SceneSource::File(name) => Path::new(name),
    };
    // A name leads nowhere else.
    let is_name = name.file_name() == Some(name.as_os_str());
    let places = [image.with_file_name(name), PathBuf::from(name)];
    places.into_iter().find(|path| is_name && path.is_file()).map(Source::File).ok_or_else(|| {
        let fault = Diagnostic::new(image, format!("its scene `{}` is not here", name.display()));
        Error::Scene(fault.with_hint("say where it is: --scene FILE").into())
    })
}

/// The recorded overrides. Those that could not be recorded must be `given` again.
fn overrides_of(image: &Path, record: &Provenance, given: &[Override]) -> Result<Vec<Override>, Error> {
    let is_given =
        |path: &String| given.iter().any(|edit| edit.to_string().starts_with(&format!("--set {path}=")));
    if let Some(path) = record.unrecorded.iter().find(|path| !is_given(path)) {
        let message = format!("was made with --set {path}=..., which named a file by its whole path");
        let fault = Diagnostic::new(image, message);
        return Err(Error::Scene(fault.with_hint(format!("give it again: --set {path}=FILE")).into()));
    }
    let parsed = record.set.iter().map(|text| text.parse::<Override>());
    parsed.collect::<Result<_, _>>().map_err(|error| at_fault(image, error))
}

/// What was rendered; everything is checked, since the picture may say anything.
fn shot_of(image: &Path, record: &Provenance, scene: &Scene) -> Result<Shot, Error> {
    let settings = record.render;
    settings.validate().map_err(|error| at_fault(image, error))?;
    let camera = *camera_of(image, record, scene)?;
    camera.project(settings.width, settings.height).map_err(|error| at_fault(image, error))?;
    let region = record.region.map(|[x, y, width, height]| Region { x, y, width, height });
    if region.is_some_and(|region| !region.fits(settings.width, settings.height)) {
        return Err(at_fault(image, "says that it is a part of a picture that has no such part"));
    }
    Ok(Shot { camera, settings, tone: record.tone, region })
}

fn camera_of<'a>(image: &Path, record: &Provenance, scene: &'a Scene) -> Result<&'a Camera, Error> {
    let name = record.camera.as_deref();
    scene.camera_named(name).ok_or_else(|| {
        at_fault(
            image,
            format!("was taken by a camera `{}`, which the scene has no more", name.unwrap_or_default()),
        )
    })
}

/// The passes whose layers the file has.
fn passes_of(image: &Path, record: &Provenance, scene: &Scene) -> Result<Vec<Pass>, Error> {
    let names = record.passes.iter().chain(&record.pass).map(String::as_str);
    if names.clone().next().is_none() {
        return Ok(Vec::new());
    }
    if record.encoding.format() != ImageFormat::Exr || (record.pass.is_some() && !record.passes.is_empty()) {
        return Err(at_fault(image, "says that it holds layers that no such file holds"));
    }
    select(names, &scene.lights)
        .map_err(|error| at_fault(image, format!("was made with passes that the scene has no more: {error}")))
}

/// What came out.
#[derive(Debug, PartialEq)]
enum Verdict {
    /// Every byte is the same.
    Same,
    /// Every pixel is the same, and not every byte.
    SamePixels,
    /// Pixels differ.
    Different {
        /// How many.
        pixels: u64,
        /// Of how many.
        of: u64,
        /// The greatest difference of a channel, in what the file holds.
        max: f64,
        /// The mean difference.
        mean: f64,
        /// The code of 1, if the file holds codes.
        codes: Option<u16>,
    },
    /// Layers differ, in these channels.
    DifferentLayers {
        /// Their names.
        channels: Vec<String>,
    },
}

impl Verdict {
    fn of(image: &Path, bytes: &[u8], again: &[u8], limits: Limits) -> Result<Self, Error> {
        if bytes == again {
            return Ok(Self::Same);
        }
        let decode = |bytes| decode_picture(image, bytes, limits.texture_pixels);
        let (old, new) = (decode(bytes)?, decode(again)?);
        let compared =
            Comparison::of(&old, &new, PIXELS_PER_DEGREE).map_err(|error| at_fault(image, error))?;
        Ok(match compared.differing {
            0 => Self::SamePixels,
            pixels => Self::Different {
                pixels,
                of: u64::from(compared.width) * u64::from(compared.height),
                max: compared.max,
                mean: compared.mean,
                codes: old.codes,
            },
        })
    }

    /// As [`Verdict::of`], of files with layers.
    fn of_layers(image: &Path, bytes: &[u8], again: &[u8], limits: Limits) -> Result<Self, Error> {
        if bytes == again {
            return Ok(Self::Same);
        }
        let channels = differing_channels(bytes, again, limits.texture_pixels)
            .map_err(|message| at_fault(image, message))?;
        Ok(if channels.is_empty() { Self::SamePixels } else { Self::DifferentLayers { channels } })
    }
}

/// The verdict and what it is about.
struct Told<'a> {
    image: &'a Path,
    source: &'a Source,
    record: &'a Provenance,
    hash: SceneHash,
    verdict: Verdict,
}

impl Told<'_> {
    fn text(&self) -> String {
        let verdict = match &self.verdict {
            Verdict::Same => "the same, byte for byte".to_owned(),
            Verdict::SamePixels => {
                "every pixel is the same, but not every byte: another program has written the file since"
                    .to_owned()
            }
            Verdict::Different { pixels, of, max, mean, codes } => {
                let apart = match codes {
                    Some(codes) => format!("{:.0} of {codes}", max * f64::from(*codes)),
                    None => format!("{max:.3e}"),
                };
                format!("{pixels} of {of} pixels differ, by {apart} at most and {mean:.2e} in the mean")
            }
            Verdict::DifferentLayers { channels } => {
                format!("these channels differ: {}", channels.join(", "))
            }
        };
        format!("{}: {verdict} ({} rendered again)\n", self.image.display(), self.source)
    }

    fn json(&self) -> String {
        let (differing, max, mean) = match self.verdict {
            Verdict::Different { pixels, max, mean, .. } => (pixels, max, mean),
            _ => (0, 0.0, 0.0),
        };
        let channels = match &self.verdict {
            Verdict::DifferentLayers { channels } => channels.as_slice(),
            _ => &[],
        };
        json::object(&VerifyJson {
            image: self.image.display().to_string(),
            scene: self.source.to_string(),
            same_bytes: self.verdict == Verdict::Same,
            same_pixels: matches!(self.verdict, Verdict::Same | Verdict::SamePixels),
            same_scene: self.hash == self.record.hash,
            same_version: self.record.lancer == Provenance::VERSION,
            differing,
            max: max.is_finite().then_some(max),
            mean: mean.is_finite().then_some(mean),
            channels,
            record: self.record,
        })
    }
}

/// The names are part of the contract with scripts. `null` stands for infinity.
#[derive(Serialize)]
struct VerifyJson<'a> {
    image: String,
    scene: String,
    same_bytes: bool,
    same_pixels: bool,
    same_scene: bool,
    same_version: bool,
    differing: u64,
    max: Option<f64>,
    mean: Option<f64>,
    /// Those of layers that differ.
    channels: &'a [String],
    record: &'a Provenance,
}
