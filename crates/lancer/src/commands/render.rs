//! `lancer render`: a scene to a picture.

use crate::args::RenderArgs;
use crate::error::Error;
use crate::interrupt;
use crate::job::{Job, Shot, on_threads};
use crate::progress::Progress;
use crate::report::{self, Report, Stages};
use crate::terminal;
use lancer_core::integrator::RayCounts;
use lancer_core::render::passes::{Layer, Pass, PassRender, render_passes};
use lancer_core::render::{CancelToken, Control, Render, RenderError, Tile, render};
use lancer_core::world::World;
use lancer_io::diagnostics::LoadError;
use lancer_io::{LoadOptions, Loaded};
use std::time::{Duration, Instant};

/// Renders, writes, and tells what was done.
///
/// # Errors
/// See [`Error`].
pub(crate) fn run(args: RenderArgs) -> Result<(), Error> {
    let job = Job::new(args)?;
    on_threads(job.setup.threads, || run_job(&job))
}

fn run_job(job: &Job) -> Result<(), Error> {
    let setup = &job.setup;
    let progress = Progress::new(job.quiet);
    let mut stages = Stages::default();

    let loaded = timed(&mut stages.load, || {
        let reading = progress.reading();
        setup.source.load(&LoadOptions { progress: reading.hears(), ..setup.load.clone() })
    })?;
    let Loaded { scene, mut warnings, .. } = loaded;
    warnings.iter().for_each(terminal::tell_warning);
    let shot = job.shot(&scene)?;
    let plan = job.passes.as_ref().map(|files| files.plan(&scene)).transpose()?;
    let record = timed(&mut stages.load, || job.record(&scene, &shot));

    let world =
        timed(&mut stages.build, || progress.during("building", || World::compile(&scene, &setup.compile)))
            .map_err(|error| LoadError::from(setup.source.diagnostic(error)))?;
    let table = plan.as_ref().map(|plan| plan.table(&scene, &world));
    drop(scene);

    let cancel = CancelToken::default();
    let (picture, layers) = timed(&mut stages.render, || match &plan {
        None => Ok((trace(&shot, setup.tile_size, &world, &cancel, &progress)?, Vec::new())),
        Some(plan) => trace_passes(&shot, setup.tile_size, &world, &plan.passes, &cancel, &progress),
    })?;
    timed(&mut stages.write, || {
        progress.during("writing", || match &plan {
            None => job.destination.write(&picture.image, shot.tone, &record.metadata(), &cancel),
            Some(plan) => plan.write(&picture.image, &layers, &record, &cancel),
        })
    })?;

    let late = report::warnings_about(&picture, &world, &shot);
    let late = late.iter().map(|message| setup.source.diagnostic(message)).collect::<Vec<_>>();
    late.iter().for_each(terminal::tell_warning);
    warnings.extend(late);
    let (world, rays) = (world.statistics(), picture.rays);
    let layers = table;
    tell(&Report { job, shot: &shot, world, rays, stages, layers, warnings: &warnings })
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
    watched(shot, tile_size, cancel, progress, |control| {
        Ok(render(world, &shot.camera, &shot.settings, shot.region, control)?)
    })
}

/// As [`trace`], with the layers of passes.
pub(super) fn trace_passes(
    shot: &Shot,
    tile_size: u32,
    world: &World,
    passes: &[Pass],
    cancel: &CancelToken,
    progress: &Progress,
) -> Result<(Render, Vec<Layer>), Error> {
    let &Shot { camera, settings, region, tone } = shot;
    watched(shot, tile_size, cancel, progress, |control| {
        match render_passes(world, &camera, &settings, region, passes, tone.factor(), control) {
            Ok(PassRender { render, layers }) => Ok((render, layers)),
            Err(error @ RenderError::Layers { .. }) => Err(Error::usage(error.to_string())),
            Err(error) => Err(error.into()),
        }
    })
}

/// Draws how a render goes on; a request to stop cancels it.
fn watched<T>(
    shot: &Shot,
    tile_size: u32,
    cancel: &CancelToken,
    progress: &Progress,
    render: impl FnOnce(&Control) -> Result<T, Error>,
) -> Result<T, Error> {
    let handled = interrupt::cancels(cancel);
    let (width, height) = shot.size();
    let bar = progress.pixels(u64::from(width) * u64::from(height));
    let on_tile = |tile: &Tile, rays: &RayCounts| bar.advance(tile, rays);
    let picture = render(&Control { cancel: cancel.clone(), on_tile: &on_tile, tile_size })?;
    // From here on, a request to stop ends the program. One that came after the last tile has looked must not be
    // lost: what follows may wait for a reader for ever.
    drop(handled);
    if cancel.is_cancelled() { Err(Error::Interrupted) } else { Ok(picture) }
}

fn tell(report: &Report) -> Result<(), Error> {
    if !report.job.quiet {
        terminal::note(report.summary());
    }
    if report.job.json { terminal::print(report.json()) } else { Ok(()) }
}

/// Does `work` and notes how long it took, beside what was noted before.
pub(super) fn timed<T>(duration: &mut Duration, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *duration += start.elapsed();
    result
}
