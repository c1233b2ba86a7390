//! The render thread: one job after the other, and sleep.

use super::desk::{Desk, Job, Phase};
use super::film::Count;
use super::guard::guarded;
use super::open::Opener;
use super::outbox::Outbox;
use super::pool::{self, KeptPool};
use super::view::{Showing, View};
use super::worlds::Worlds;
use super::{Event, Frame, Progress, RenderFault, RenderId, RenderRequest, Rendered, ViewRequest, channel};
use lancer_core::render::{CancelToken, Control, RenderError, Tile};
use lancer_core::world::CompileError;
use std::sync::{Arc, Mutex, PoisonError};

/// What lives on the render thread.
pub(super) struct RenderThread {
    desk: Arc<Desk>,
    opener: Arc<Opener>,
    outbox: Arc<Outbox>,
    pool: KeptPool,
    worlds: Worlds,
    view: View,
}

impl RenderThread {
    pub(super) fn new(desk: &Arc<Desk>, opener: &Arc<Opener>, outbox: &Arc<Outbox>) -> Self {
        Self {
            desk: Arc::clone(desk),
            opener: Arc::clone(opener),
            outbox: Arc::clone(outbox),
            pool: KeptPool::default(),
            worlds: Worlds::default(),
            view: View::default(),
        }
    }

    /// Works until the desk is closed.
    pub(super) fn work(&mut self) {
        pool::step_back();
        let desk = Arc::clone(&self.desk);
        while let Some(job) = desk.next() {
            if let Some(opened) = self.opener.take_opened() {
                self.worlds.expect(opened);
                self.view.forget_costs();
            }
            let last = match job {
                Job::View(request, cancel) => {
                    let shown =
                        guarded(|| self.show(&request, &cancel)).unwrap_or_else(|bug| Err(bug.into()));
                    view_event(shown).filter(|_| !cancel.is_cancelled())
                }
                Job::Render(id, request, cancel) => {
                    let rendered = guarded(|| self.render(id, *request, &cancel));
                    Some(match rendered.unwrap_or_else(|bug| Err(bug.into())) {
                        Ok(rendered) => Event::RenderDone(rendered),
                        Err(error) => Event::RenderFailed { id, error },
                    })
                }
                #[cfg(test)]
                Job::Test(test) => guarded(test).err().map(|message| Event::ViewFailed { message }),
            };
            // First, so that nobody who takes the last event finds the worker busy.
            desk.done();
            if let Some(event) = last {
                self.outbox.push(event);
            }
        }
    }

    /// Shows a picture in the viewport. Returns its last frame, or none where another request came in between.
    fn show(&mut self, request: &ViewRequest, cancel: &CancelToken) -> Result<Option<Frame>, RenderFault> {
        request.settings.validate().map_err(RenderError::from)?;
        let Self { desk, outbox, worlds, view, .. } = self;
        let pool = self.pool.of(request.threads)?;
        let world = pool.install(|| worlds.world(&request.scene, &request.options, cancel))?;
        // The world is the next request's too, unless all moves: then it shows one image in any case.
        if !request.moving && desk.view_waits() {
            return Ok(None);
        }
        desk.enter(Phase::Tracing);
        let showing = Showing { request, world: &world, cancel, desk, outbox };
        Ok(Some(pool.install(|| view.show(&showing))?))
    }

    /// Makes a picture.
    fn render(
        &mut self,
        id: RenderId,
        request: RenderRequest,
        cancel: &CancelToken,
    ) -> Result<Box<Rendered>, RenderFault> {
        let Self { outbox, worlds, .. } = self;
        outbox.push(Event::RenderStarted(id));
        request.settings.validate().map_err(RenderError::from)?;
        let pool = self.pool.of(request.threads)?;
        let world = pool.install(|| worlds.world(&request.scene, &request.options, cancel))?;
        let pixels = u64::from(request.settings.width) * u64::from(request.settings.height);
        let film = Mutex::new((Count::of(pixels), Vec::new()));
        let on_tile = |tile: &Tile, rays: &_| {
            let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
            let (count, tiles) = &mut *film;
            tiles.push(tile.clone());
            if count.add(tile, rays) {
                let progress = Progress {
                    done: count.part(),
                    rays: count.rays,
                    elapsed: count.start.elapsed(),
                    tiles: std::mem::take(tiles),
                };
                drop(film);
                outbox.push(Event::RenderProgress(id, progress));
            }
        };
        let control = Control { cancel: cancel.clone(), on_tile: &on_tile, ..Control::default() };
        let trace = || channel::trace(request.channel, &world, &request.camera, &request.settings, &control);
        let made = pool.install(trace)?;
        let elapsed = film.into_inner().unwrap_or_else(PoisonError::into_inner).0.start.elapsed();
        Ok(Box::new(Rendered { id, request, image: made.image, world, rays: made.rays, elapsed }))
    }
}

/// What is told at the end of the view's job.
fn view_event(shown: Result<Option<Frame>, RenderFault>) -> Option<Event> {
    match shown {
        Ok(frame) => frame.map(|frame| Event::Frame(Box::new(frame))),
        Err(RenderFault::Cancelled) => None,
        Err(RenderFault::Message(message)) => Some(Event::ViewFailed { message }),
    }
}

impl From<String> for RenderFault {
    fn from(message: String) -> Self {
        Self::Message(message)
    }
}

impl From<RenderError> for RenderFault {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Cancelled => Self::Cancelled,
            error => Self::Message(error.to_string()),
        }
    }
}

impl From<CompileError> for RenderFault {
    fn from(error: CompileError) -> Self {
        match error {
            CompileError::Cancelled => Self::Cancelled,
            error => Self::Message(error.to_string()),
        }
    }
}
