//! `lancer render`: a scene to a picture.

use crate::args::RenderArgs;
use crate::error::Error;
use crate::interrupt;
use crate::job::{Job, Setup, Shot};
use crate::progress::Progress;
use crate::report::{self, Report, Stages};
use crate::terminal;
use lancer_core::render::passes::{Layer, Pass, PassRender, render_passes};
use lancer_core::render::{CancelToken, Control, Render, RenderError, render, with_threads};
use lancer_core::world::World;
use lancer_io::Loaded;
use lancer_io::diagnostics::LoadError;
use std::time::{Duration, Instant};

/// Renders, writes, and tells what was done.
///
/// # Errors
/// See [`Error`].
pub(crate) fn run(args: RenderArgs) -> Result<(), Error> {
    let job = Job::new(args)?;
    let work = with_threads(job.setup.threads, || run_job(&job));
    work.map_err(|error| Error::Render(format!("cannot start {} threads: {error}", job.setup.threads)))?
}

fn run_job(job: &Job) -> Result<(), Error> {
    let setup = &job.setup;
    let progress = Progress::new(job.quiet);
    let mut stages = Stages::default();

    let loaded = timed(&mut stages.load, || progress.during("reading", || setup.source.load(&setup.load)))?;
    let Loaded { scene, mut warnings, .. } = loaded;
    warnings.iter().for_each(terminal::tell_warning);
    let shot = setup.shot(&scene)?;
    let plan = job.passes.as_ref().map(|files| files.plan(&scene)).transpose()?;

    let world =
        timed(&mut stages.build, || progress.during("building", || World::compile(&scene, &setup.compile)))
            .map_err(|error| LoadError::from(setup.source.diagnostic(error)))?;
    let table = plan.as_ref().map(|plan| plan.table(&scene, &world));
    drop(scene);

    let cancel = CancelToken::default();
    let (picture, layers) = timed(&mut stages.render, || {
        let passes = plan.as_ref().map(|plan| plan.passes.as_slice());
        trace(setup, &shot, &world, passes, &cancel, &progress)
    })?;
    timed(&mut stages.write, || {
        progress.during("writing", || {
            let image = shot.tone.expose(&picture.image);
            match &plan {
                None => job.destination.write(&image, &cancel),
                Some(plan) => plan.write(&image, &layers, &cancel),
            }
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

/// Renders the picture, and the layers of passes where some are asked for.
fn trace(
    setup: &Setup,
    shot: &Shot,
    world: &World,
    passes: Option<&[Pass]>,
    cancel: &CancelToken,
    progress: &Progress,
) -> Result<(Render, Vec<Layer>), Error> {
    let _handled = interrupt::cancels(cancel);
    let (width, height) = shot.size();
    let bar = progress.pixels(u64::from(width) * u64::from(height));
    let control = Control {
        cancel: cancel.clone(),
        on_tile: &|tile, rays| bar.advance(tile, rays),
        tile_size: setup.tile_size,
    };
    let &Shot { camera, settings, region, tone } = shot;
    let Some(passes) = passes else {
        return Ok((render(world, &camera, &settings, region, &control)?, Vec::new()));
    };
    match render_passes(world, &camera, &settings, region, passes, tone.factor(), &control) {
        Ok(PassRender { render, layers }) => Ok((render, layers)),
        Err(error @ RenderError::Layers { .. }) => Err(Error::usage(error.to_string())),
        Err(error) => Err(error.into()),
    }
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
