//! `lancer turntable`: a scene to a film, by a camera that moves.

use super::render::timed;
use crate::args::{FilmArgs, TurntableArgs};
use crate::error::Error;
use crate::film::{FilmDestination, FilmWriter};
use crate::job::{Setup, Shot, camera_named, on_threads};
use crate::progress::{Progress, rays_per_second, short_count};
use crate::report::{self, ImageJson, RaysJson, SecondsJson, Stages, WorldJson};
use crate::{interrupt, json, terminal};
use lancer_core::camera::{Camera, CameraPath};
use lancer_core::geometry::DVec3;
use lancer_core::integrator::RayCounts;
use lancer_core::render::{CancelToken, Control, render};
use lancer_core::scene::Scene;
use lancer_core::world::World;
use lancer_io::Loaded;
use lancer_io::diagnostics::LoadError;
use lancer_io::image::Metadata;
use lancer_io::image::animation::Film;
use lancer_io::provenance::{Provenance, SceneHash, camera_overrides};
use lancer_io::showcase::turning_camera;
use serde::Serialize;

/// What the scene's camera is called in a path, where no other has that name.
const MAIN: &str = "main";

/// Renders all pictures, writes them, and tells what was done.
///
/// # Errors
/// See [`Error`].
pub(crate) fn run(args: TurntableArgs) -> Result<(), Error> {
    let TurntableArgs { scene, output, film, picture, work, reading, json, quiet } = args;
    let destination = FilmDestination::find(&output)?;
    let setup = Setup::new(Some(&scene), picture, &work, reading)?;
    let job = FilmJob { setup, destination, film, json, quiet };
    on_threads(job.setup.threads, || job.run())
}

struct FilmJob {
    setup: Setup,
    destination: FilmDestination,
    film: FilmArgs,
    json: bool,
    quiet: bool,
}

impl FilmJob {
    fn run(&self) -> Result<(), Error> {
        let setup = &self.setup;
        let progress = Progress::new(self.quiet);
        let mut stages = Stages::default();

        let loaded =
            timed(&mut stages.load, || progress.during("reading", || setup.source.load(&setup.load)))?;
        let Loaded { scene, mut warnings, .. } = loaded;
        warnings.iter().for_each(terminal::tell_warning);
        let shot = setup.shot(&scene)?;
        let (width, height) = shot.size();
        let film = Film { width, height, frames: self.film.frames, fps: self.film.fps };
        let way = self.way(&scene, &shot)?;
        self.destination.check(&film)?;

        let world = timed(&mut stages.build, || {
            progress.during("building", || World::compile(&scene, &setup.compile))
        })
        .map_err(|error| LoadError::from(setup.source.diagnostic(error)))?;
        let cameras = way.cameras(&world, &shot, &film)?;
        let frames = timed(&mut stages.load, || self.frames(&scene, &shot, cameras));
        drop(scene);

        let rays = self.shoot(&film, &frames, &shot, &world, &progress, &mut stages)?;

        let late = report::cut_short(&rays);
        let late = late.iter().map(|message| setup.source.diagnostic(message)).collect::<Vec<_>>();
        late.iter().for_each(terminal::tell_warning);
        warnings.extend(late);
        if !self.quiet {
            terminal::note(format!(
                "wrote {}: {} pictures of {width} x {height}, {:.2} s, {} rays, {}",
                self.destination,
                film.frames,
                stages.total().as_secs_f64(),
                short_count(rays.total() as f64),
                rays_per_second(rays.total(), stages.render),
            ));
        }
        if !self.json {
            return Ok(());
        }
        terminal::print(json::object(&FilmJson {
            scene: setup.source.to_string(),
            image: ImageJson { width, height },
            frames: film.frames,
            fps: film.fps,
            threads: setup.threads,
            accelerator: setup.compile.accelerator.name(),
            rays: rays.into(),
            seconds: stages.into(),
            world: world.statistics().into(),
            output: self.destination.to_string(),
            warnings: warnings.iter().map(json::DiagnosticJson::from).collect(),
        }))
    }

    /// How the camera moves.
    fn way(&self, scene: &Scene, shot: &Shot) -> Result<Way, Error> {
        let names = &self.film.path;
        if names.is_empty() {
            let axis = match self.film.axis.as_str() {
                "x" => DVec3::X,
                "z" => DVec3::Z,
                _ => DVec3::Y,
            };
            // A bare model has no camera of its author's: so it gets one that sees it from all sides.
            let is_framed = self.setup.is_bare_model() && axis == DVec3::Y;
            return Ok(Way::Orbit { axis, camera: (!is_framed).then_some(shot.camera) });
        }
        let named = |name: &String| {
            let name = name.trim();
            let is_main = name == MAIN && scene.camera_named(Some(MAIN)).is_none();
            camera_named(scene, (!is_main).then_some(name), "--path").copied()
        };
        let cameras = names.iter().map(named).collect::<Result<Vec<_>, _>>()?;
        let path = CameraPath::new(cameras).ok_or_else(|| {
            let hint = format!("as in --path {MAIN},{}", names[0]);
            Error::usage_with_hint("a path takes two cameras or more", hint)
        })?;
        Ok(Way::Path(path))
    }

    /// The pictures from these cameras. Each is recorded as one of the scene whose own camera is where it is then.
    fn frames(&self, scene: &Scene, shot: &Shot, cameras: Vec<Camera>) -> Frames {
        let records = self.destination.picture_format().and_then(|format| {
            let hashes = SceneHash::of_each(scene, &cameras);
            // Each picture's hash takes the place of the first's.
            let record = self.setup.record(scene, shot, *hashes.first()?, format.into());
            Some((Provenance { camera: None, ..record }, hashes))
        });
        Frames { cameras, records }
    }

    /// Renders and writes all pictures.
    fn shoot(
        &self,
        film: &Film,
        frames: &Frames,
        shot: &Shot,
        world: &World,
        progress: &Progress,
        stages: &mut Stages,
    ) -> Result<RayCounts, Error> {
        let cancel = CancelToken::default();
        let _handled = match &self.destination {
            // A second request would leave ffmpeg and its file behind.
            FilmDestination::Video { .. } => interrupt::only_cancels(&cancel),
            _ => interrupt::cancels(&cancel),
        };
        let bar = progress.pixels(u64::from(film.width) * u64::from(film.height) * u64::from(film.frames));
        let control = Control {
            cancel: cancel.clone(),
            on_tile: &|tile, rays| bar.advance(tile, rays),
            tile_size: self.setup.tile_size,
        };
        let mut writer = FilmWriter::new(&self.destination, *film, shot.tone, &cancel)?;
        let mut rays = RayCounts::default();
        for (index, camera) in frames.cameras.iter().enumerate() {
            let picture =
                timed(&mut stages.render, || render(world, camera, &shot.settings, shot.region, &control))?;
            rays += picture.rays;
            timed(&mut stages.write, || writer.add(&picture.image, &frames.metadata(index)))?;
        }
        timed(&mut stages.write, || writer.finish())?;
        Ok(rays)
    }
}

/// The pictures of a film.
struct Frames {
    cameras: Vec<Camera>,
    /// How they were made, where each has a file that can say so: what is the same for all, and the scene as each
    /// camera sees it.
    records: Option<(Provenance, Vec<SceneHash>)>,
}

impl Frames {
    /// What the file of a picture says beside its pixels.
    fn metadata(&self, index: usize) -> Metadata {
        let Some((record, hashes)) = &self.records else { return Metadata::default() };
        let mut record = Provenance { hash: hashes[index], ..record.clone() };
        record.set.extend(camera_overrides(&self.cameras[index]));
        record.metadata()
    }
}

/// How the camera moves.
enum Way {
    /// Once around, from this camera or, without one, from one that sees all of the world.
    Orbit { axis: DVec3, camera: Option<Camera> },
    /// Past cameras.
    Path(CameraPath),
}

impl Way {
    /// The camera of each picture.
    ///
    /// # Errors
    /// One of them makes no picture.
    fn cameras(&self, world: &World, shot: &Shot, film: &Film) -> Result<Vec<Camera>, Error> {
        let frames = f64::from(film.frames);
        let camera_at = |frame: u32| match self {
            Self::Orbit { axis, camera } => {
                let camera = camera.unwrap_or_else(|| turning_camera(world.bounds(), &shot.settings));
                camera.orbited(*axis, 360.0 * f64::from(frame) / frames)
            }
            // A closed path does not show its first camera twice, as an orbit does not.
            Self::Path(path) => {
                let steps = if path.is_closed() { frames } else { (frames - 1.0).max(1.0) };
                path.at(path.duration() * f64::from(frame) / steps)
            }
        };
        let valid = |frame: u32| {
            let camera = camera_at(frame);
            match camera.project(shot.settings.width, shot.settings.height) {
                Ok(_) => Ok(camera),
                Err(error) => Err(Error::usage_with_hint(
                    format!("at picture {} of {}: {error}", frame + 1, film.frames),
                    "another --axis, or one more camera on the --path, leads around it",
                )),
            }
        };
        (0..film.frames).map(valid).collect()
    }
}

#[derive(Serialize)]
struct FilmJson<'a> {
    scene: String,
    image: ImageJson,
    frames: u32,
    fps: u16,
    threads: usize,
    accelerator: &'static str,
    rays: RaysJson,
    seconds: SecondsJson,
    #[serde(flatten)]
    world: WorldJson,
    output: String,
    warnings: Vec<json::DiagnosticJson<'a>>,
}
