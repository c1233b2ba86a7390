//! `lancer render`: a scene to a picture.

use crate::args::RenderArgs;
use crate::error::Error;
use crate::interrupt;
use crate::job::{Job, Shot};
use crate::progress::Progress;
use crate::report::{self, Report, Stages};
use crate::terminal;
use lancer_core::render::{CancelToken, Control, Render, render, with_threads};
use lancer_core::world::World;
use lancer_io::Loaded;
use lancer_io::diagnostics::LoadError;
use lancer_io::image::Metadata;
use std::time::{Duration, Instant};

/// Renders, writes, and tells what was done.
///
/// # Errors
/// See [`Error`].
pub(crate) fn run(args: RenderArgs) -> Result<(), Error> {
    let job = Job::new(args)?;
    let work = with_threads(job.threads, || run_job(&job));
    work.map_err(|error| Error::Render(format!("cannot start {} threads: {error}", job.threads)))?
}

fn run_job(job: &Job) -> Result<(), Error> {
    let progress = Progress::new(job.quiet);
    let mut stages = Stages::default();

    let loaded = timed(&mut stages.load, || progress.during("reading", || job.source.load(&job.load)))?;
    let Loaded { scene, mut warnings, .. } = loaded;
    warnings.iter().for_each(terminal::tell_warning);
    let shot = job.shot(&scene)?;
    let metadata = timed(&mut stages.load, || job.metadata(&scene, &shot));

    let world =
        timed(&mut stages.build, || progress.during("building", || World::compile(&scene, &job.compile)))
            .map_err(|error| LoadError::from(job.source.diagnostic(error)))?;
    drop(scene);

    let cancel = CancelToken::default();
    let picture = timed(&mut stages.render, || trace(&shot, job.tile_size, &world, &cancel, &progress))?;
    timed(&mut stages.write, || write(job, &shot, &picture, &metadata, &cancel, &progress))?;

    let late = report::warnings_about(&picture, &world, &shot);
    let late = late.iter().map(|message| job.source.diagnostic(message)).collect::<Vec<_>>();
    late.iter().for_each(terminal::tell_warning);
    warnings.extend(late);
    let (world, rays) = (world.statistics(), picture.rays);
    tell(&Report { job, shot: &shot, world, rays, stages, warnings: &warnings })
}

/// Renders, and draws how it goes on; a request to stop cancels it.
///
/// # Errors
/// It was cancelled, or failed.
pub(super) fn trace(
    shot: &Shot,
    tile_size: u32,
    world: &World,
    cancel: &CancelToken,
    progress: &Progress,
) -> Result<Render, Error> {
    let _handled = interrupt::cancels(cancel);
    let (width, height) = shot.size();
    let bar = progress.pixels(u64::from(width) * u64::from(height));
    let control =
        Control { cancel: cancel.clone(), on_tile: &|tile, rays| bar.advance(tile, rays), tile_size };
    Ok(render(world, &shot.camera, &shot.settings, shot.region, &control)?)
}

fn write(
    job: &Job,
    shot: &Shot,
    picture: &Render,
    metadata: &Metadata,
    cancel: &CancelToken,
    progress: &Progress,
) -> Result<(), Error> {
    progress.during("writing", || job.destination.write(&picture.image, shot.tone, metadata, cancel))
}

fn tell(report: &Report) -> Result<(), Error> {
    if !report.job.quiet {
        terminal::note(report.summary());
    }
    if report.job.json { terminal::print(report.json()) } else { Ok(()) }
}

/// Does `work` and notes how long it took, beside what was noted before.
fn timed<T>(duration: &mut Duration, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *duration += start.elapsed();
    result
}
