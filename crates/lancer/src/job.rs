//! A render as meant: what the words of [`crate::args`] come to.
//!
//! In: the words. Out: a [`Job`], in which all that can be known before the scene is read was checked; then, with
//! the scene, a [`Shot`], in which the rest was. So nothing that was mistyped shows only after a long render.

use crate::args::{PictureArgs, ReadingArgs, RenderArgs, WorkArgs};
use crate::destination::Destination;
use crate::error::Error;
use crate::passes::PassFiles;
use crate::source::Source;
use lancer_core::accel::{Accelerator, KdSettings};
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::render::{Control, Region, RenderError, with_threads};
use lancer_core::scene::{AmbientOcclusion, Scene, Settings};
use lancer_core::world::CompileOptions;
use lancer_io::LoadOptions;
use lancer_io::image::Encoding;
use lancer_io::provenance::{Provenance, SceneHash, record_overrides};
use std::ffi::OsStr;
use std::num::NonZero;

/// What to render, how, and where to.
pub(crate) struct Job {
    pub(crate) setup: Setup,
    pub(crate) destination: Destination,
    pub(crate) passes: Option<PassFiles>,
    pub(crate) json: bool,
    pub(crate) quiet: bool,
    dpi: Option<u16>,
}

/// What to render and how.
pub(crate) struct Setup {
    pub(crate) source: Source,
    pub(crate) load: LoadOptions,
    pub(crate) compile: CompileOptions,
    pub(crate) threads: usize,
    pub(crate) tile_size: u32,
    picture: PictureArgs,
}

/// What to render of a scene that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    pub(crate) camera: Camera,
    pub(crate) settings: Settings,
    pub(crate) tone: Tone,
    pub(crate) region: Option<Region>,
}

impl Job {
    /// What the words mean.
    ///
    /// # Errors
    /// They contradict one another; a setting is out of its range; there is no such scene; the output cannot be
    /// written.
    pub(crate) fn new(args: RenderArgs) -> Result<Self, Error> {
        let RenderArgs { scene, output, picture, passes, work, reading, json, quiet, encoding } = args;
        let setup = Setup::new(scene.as_deref(), picture, &work, reading)?;
        let destination = Destination::find(output.as_deref(), &encoding, &setup.source)?;
        if json && destination.is_stdout() {
            return Err(Error::usage("--json and the picture cannot both go to standard output"));
        }
        let passes = PassFiles::new(passes, &destination)?;
        destination.check()?;
        Ok(Self { setup, destination, passes, json, quiet, dpi: encoding.dpi })
    }

    /// What to render of `scene`.
    ///
    /// # Errors
    /// As [`Setup::shot`]; or the format cannot hold the picture.
    pub(crate) fn shot(&self, scene: &Scene) -> Result<Shot, Error> {
        let shot = self.setup.shot(scene)?;
        let (width, height) = shot.size();
        self.destination.encoding().check_size(width, height).map_err(usage)?;
        Ok(shot)
    }

    /// How the picture was made.
    pub(crate) fn record(&self, scene: &Scene, shot: &Shot) -> Provenance {
        let hash = SceneHash::of(scene, &shot.camera);
        let record = self.setup.record(scene, shot, hash, self.destination.encoding());
        Provenance { dpi: self.dpi, ..record }
    }
}

impl Setup {
    /// What the words mean.
    ///
    /// # Errors
    /// A setting is out of its range; there is no such scene.
    pub(crate) fn new(
        scene: Option<&OsStr>,
        picture: PictureArgs,
        work: &WorkArgs,
        reading: ReadingArgs,
    ) -> Result<Self, Error> {
        // The values that are not given are the defaults, which no given one can make illegal.
        settings_for(&picture, Settings::default()).validate().map_err(usage)?;
        Ok(Self {
            source: Source::find(scene)?,
            load: load_options(reading),
            compile: compile_options(work),
            threads: thread_count(work.threads),
            tile_size: work.tile_size.unwrap_or(Control::DEFAULT_TILE_SIZE),
            picture,
        })
    }

    /// How a picture of `scene` was made, which has this hash.
    pub(crate) fn record(
        &self,
        scene: &Scene,
        shot: &Shot,
        hash: SceneHash,
        encoding: Encoding,
    ) -> Provenance {
        let (set, unrecorded) = record_overrides(&self.load.overrides);
        Provenance {
            lancer: Provenance::VERSION.to_owned(),
            scene: self.source.record(),
            name: scene.name.clone(),
            hash,
            camera: self.picture.camera.clone(),
            region: shot.region.map(|Region { x, y, width, height }| [x, y, width, height]),
            render: shot.settings,
            tone: shot.tone,
            set,
            unrecorded,
            encoding,
            dpi: None,
            passes: Vec::new(),
            pass: None,
        }
    }

    /// Whether the scene is a bare model that nothing was changed of: then it is up to the program how it is shown.
    pub(crate) fn is_bare_model(&self) -> bool {
        let is_model = matches!(&self.source, Source::File(path) if !lancer_io::is_scene_file(path));
        is_model && self.load.overrides.is_empty()
    }

    /// What to render of `scene`.
    ///
    /// # Errors
    /// The scene's settings or its camera are at fault, or else the flags do not fit the scene.
    pub(crate) fn shot(&self, scene: &Scene) -> Result<Shot, Error> {
        let settings = settings_for(&self.picture, scene.settings);
        if let Err(error) = settings.validate() {
            return Err(match scene.settings.validate() {
                Ok(()) => usage(error),
                Err(_) => self.scene_fault(error),
            });
        }
        let camera = *self.camera(scene)?;
        camera.project(settings.width, settings.height).map_err(|error| self.scene_fault(error))?;
        let region = self.picture.region;
        if let Some(region) = region.filter(|region| !region.fits(settings.width, settings.height)) {
            let Settings { width, height, .. } = settings;
            return Err(usage(RenderError::Region { region, width, height }));
        }
        let tone = Tone {
            exposure: self.picture.exposure.unwrap_or(scene.tone.exposure),
            curve: self.picture.tone.unwrap_or(scene.tone.curve),
        };
        let shot = Shot { camera, settings, tone, region };
        let tiles = shot.tiles(self.tile_size);
        if tiles > MAX_TILES {
            return Err(Error::usage(format!(
                "--tile-size {} makes {tiles} tiles of this picture, more than {MAX_TILES}",
                self.tile_size
            )));
        }
        Ok(shot)
    }

    fn camera<'a>(&self, scene: &'a Scene) -> Result<&'a Camera, Error> {
        camera_named(scene, self.picture.camera.as_deref(), "--camera")
    }

    /// A fault of the scene as a whole.
    pub(crate) fn scene_fault(&self, error: impl std::error::Error) -> Error {
        Error::Scene(self.source.diagnostic(error).into())
    }
}

/// The scene's camera of a name that a flag gives, or without a name its main one.
///
/// # Errors
/// There is none.
pub(crate) fn camera_named<'a>(
    scene: &'a Scene,
    name: Option<&str>,
    flag: &str,
) -> Result<&'a Camera, Error> {
    scene.camera_named(name).ok_or_else(|| {
        let message = format!("the scene has no camera `{}`", name.unwrap_or_default());
        let names = scene.cameras.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>();
        let hint = match names.as_slice() {
            [] => format!("leave out {flag}: the scene has one camera, without a name"),
            names => format!("its cameras are {}", names.join(", ")),
        };
        Error::usage_with_hint(message, hint)
    })
}

impl Shot {
    /// Columns and rows of the picture.
    pub(crate) fn size(&self) -> (u32, u32) {
        match self.region {
            Some(region) => (region.width, region.height),
            None => (self.settings.width, self.settings.height),
        }
    }

    /// Tiles of the picture.
    fn tiles(&self, tile_size: u32) -> u64 {
        let (width, height) = self.size();
        u64::from(width.div_ceil(tile_size)) * u64::from(height.div_ceil(tile_size))
    }
}

/// The most tiles of a picture: each costs a few hundred bytes beside its pixels.
const MAX_TILES: u64 = 1 << 22;

fn usage(error: impl std::error::Error) -> Error {
    Error::usage(error.to_string())
}

/// The scene's settings, with what the flags say in their place.
fn settings_for(flags: &PictureArgs, scene: Settings) -> Settings {
    Settings {
        width: flags.width.unwrap_or(scene.width),
        height: flags.height.unwrap_or(scene.height),
        samples: flags.samples.unwrap_or(scene.samples),
        depth: flags.depth.unwrap_or(scene.depth),
        ao: AmbientOcclusion {
            samples: flags.ao.unwrap_or(scene.ao.samples),
            distance: flags.ao_distance.unwrap_or(scene.ao.distance),
        },
        shadows: scene.shadows && !flags.no_shadows,
        reflection: scene.reflection && !flags.no_reflection,
        refraction: scene.refraction && !flags.no_refraction,
    }
}

pub(crate) fn load_options(reading: ReadingArgs) -> LoadOptions {
    LoadOptions { overrides: reading.overrides, ..reading.files.load_options() }
}

pub(crate) fn compile_options(work: &WorkArgs) -> CompileOptions {
    let kd = KdSettings { leaf: work.kd_leaf, depth: work.kd_depth };
    let chosen = if kd == KdSettings::default() { Accelerator::default() } else { Accelerator::KdTree };
    CompileOptions {
        accelerator: work.accel.unwrap_or(chosen),
        kd,
        instructions: work.instructions,
        ..CompileOptions::default()
    }
}

/// The threads to work on: as many as were asked for, or one a core; one where the system does not tell.
pub(crate) fn thread_count(asked: Option<u32>) -> usize {
    let all_cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    asked.map_or_else(all_cores, |threads| threads as usize)
}

/// Works on so many threads.
///
/// # Errors
/// They cannot be started, or the work fails.
pub(crate) fn on_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> Result<T, Error> {
    with_threads(threads, work)
        .map_err(|error| Error::Render(format!("cannot start {threads} threads: {error}")))?
}
