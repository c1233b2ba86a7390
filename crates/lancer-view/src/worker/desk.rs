//! What is to be done, and what is being done: all that the handle and the render thread share.
//!
//! The handle puts requests in place of older ones and cancels what they make pointless; the thread takes the
//! next job and sleeps where there is none. What to cancel is decided here and nowhere else.

use super::{RenderId, RenderRequest, ViewRequest};
use lancer_core::render::CancelToken;
use lancer_core::world::CompileOptions;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// What the render thread is to do next.
pub(super) enum Job {
    /// Show the scene in the viewport.
    View(ViewRequest, CancelToken),
    /// Make a picture.
    Render(RenderId, Box<RenderRequest>, CancelToken),
    /// Do anything.
    #[cfg(test)]
    Test(Box<dyn FnOnce() + Send>),
}

/// How far the view's job is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// The world is built: only a request of another world makes that pointless.
    Compiling,
    /// An image is traced.
    Tracing,
}

/// The requests and what runs of them.
#[derive(Default)]
pub(super) struct Desk {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// What the viewport is to show, or shows.
    view: Option<ViewRequest>,
    /// Whether the view is yet to be taken up, or again.
    view_waits: bool,
    render: Option<(RenderId, Box<RenderRequest>)>,
    running: Option<Running>,
    /// How the last request was compiled, and on how many threads.
    habits: (CompileOptions, usize),
    last_id: u64,
    closing: bool,
    #[cfg(test)]
    test: Option<Box<dyn FnOnce() + Send>>,
}

struct Running {
    job: Kind,
    cancel: CancelToken,
}

enum Kind {
    View(Box<ViewRequest>, Phase),
    Render,
    #[cfg(test)]
    Test,
}

impl Running {
    /// Whether it is the view, and not on its way to an end.
    fn shows(&self) -> bool {
        matches!(self.job, Kind::View(..)) && !self.cancel.is_cancelled()
    }
}

impl Desk {
    /// Puts a request for the viewport in place of the one before. Cancels what runs for that one, unless the
    /// new one can do with it.
    pub(super) fn view(&self, request: ViewRequest) {
        let mut state = self.lock();
        state.habits = (request.options, request.threads);
        let mut request = request;
        let asked = state.view.as_ref().map(|old| (old.same_picture(&request), old.moving, old.revision));
        let work_is_the_same = match asked {
            // A picture that comes to rest gets its further passes. One that is at rest stays so until it moves.
            Some((true, was_moving, _)) if !was_moving || request.moving => {
                request.moving = was_moving;
                true
            }
            _ => false,
        };
        if work_is_the_same {
            let told = asked.is_some_and(|(_, _, revision)| revision == request.revision);
            let shown_soon = state.view_waits || state.running.as_ref().is_some_and(Running::shows);
            // Frames are told with the revision that is asked for when they are made; a picture that is done is
            // told once more.
            state.view_waits |= !told && !shown_soon;
        } else {
            if let Some(Running { job: Kind::View(running, phase), cancel }) = &state.running
                && !spares(running, *phase, &request)
            {
                cancel.cancel();
            }
            state.view_waits = true;
        }
        state.view = Some(request);
        drop(state);
        self.changed.notify_one();
    }

    /// Stops the view until the next request for it.
    pub(super) fn stop_view(&self) {
        let mut state = self.lock();
        state.view = None;
        state.view_waits = false;
        state.cancel_view();
    }

    /// Puts a render in place of the one before, and lets the view rest. Returns its number, and that of a render
    /// that was never begun.
    pub(super) fn render(&self, request: RenderRequest) -> (RenderId, Option<RenderId>) {
        let mut state = self.lock();
        state.last_id += 1;
        let id = RenderId(state.last_id);
        let dropped = state.render.replace((id, Box::new(request))).map(|(id, _)| id);
        state.cancel_render();
        if state.cancel_view() {
            state.view_waits = true;
        }
        drop(state);
        self.changed.notify_one();
        (id, dropped)
    }

    /// Cancels the render. Returns one that was never begun.
    pub(super) fn cancel_render(&self) -> Option<RenderId> {
        let mut state = self.lock();
        state.cancel_render();
        state.render.take().map(|(id, _)| id)
    }

    /// Cancels all, now and for ever.
    pub(super) fn close(&self) {
        let mut state = self.lock();
        state.closing = true;
        if let Some(running) = &state.running {
            running.cancel.cancel();
        }
        drop(state);
        self.changed.notify_one();
    }

    /// Whether something is asked for that is not done.
    pub(super) fn is_busy(&self) -> bool {
        let state = self.lock();
        let runs = |running: &Running| !running.cancel.is_cancelled() || matches!(running.job, Kind::Render);
        state.view_waits || state.render.is_some() || state.running.as_ref().is_some_and(runs)
    }

    /// How the last request was compiled, and on how many threads.
    pub(super) fn habits(&self) -> (CompileOptions, usize) {
        self.lock().habits
    }

    /// The next job, as soon as there is one; none when all is over. Renders come first.
    pub(super) fn next(&self) -> Option<Job> {
        let mut state = self.lock();
        loop {
            state.running = None;
            if state.closing {
                return None;
            }
            if let Some(job) = state.take() {
                return Some(job);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Says that the job is at its end: what it tells after this is its last.
    pub(super) fn done(&self) {
        self.lock().running = None;
    }

    /// Says how far the view's job is.
    pub(super) fn enter(&self, phase: Phase) {
        if let Some(Running { job: Kind::View(_, running), .. }) = &mut self.lock().running {
            *running = phase;
        }
    }

    /// Whether another request for the view waits to be taken.
    pub(super) fn view_waits(&self) -> bool {
        self.lock().view_waits
    }

    /// The revision of what the viewport is to show, if that is the picture that is made.
    pub(super) fn revision(&self, made: &ViewRequest) -> u64 {
        let state = self.lock();
        let asked = state.view.as_ref().filter(|asked| !state.view_waits && asked.same_picture(made));
        asked.unwrap_or(made).revision
    }

    #[cfg(test)]
    pub(super) fn run(&self, test: impl FnOnce() + Send + 'static) {
        self.lock().test = Some(Box::new(test));
        self.changed.notify_one();
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // Nothing here is left half done by a panic.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Takes the next job as the running one.
    fn take(&mut self) -> Option<Job> {
        let cancel = CancelToken::default();
        let (job, kind) = if let Some((id, request)) = self.render.take() {
            (Job::Render(id, request, cancel.clone()), Kind::Render)
        } else if self.view_waits {
            self.view_waits = false;
            let request = self.view.clone()?;
            let kind = Kind::View(Box::new(request.clone()), Phase::Compiling);
            (Job::View(request, cancel.clone()), kind)
        } else {
            #[cfg(test)]
            if let Some(test) = self.test.take() {
                self.running = Some(Running { job: Kind::Test, cancel });
                return Some(Job::Test(test));
            }
            return None;
        };
        self.running = Some(Running { job: kind, cancel });
        Some(job)
    }

    /// Cancels the view's job. Returns whether it ran.
    fn cancel_view(&self) -> bool {
        let shows = self.running.as_ref().filter(|running| running.shows());
        shows.is_some_and(|running| {
            running.cancel.cancel();
            true
        })
    }

    fn cancel_render(&self) {
        if let Some(Running { job: Kind::Render, cancel }) = &self.running {
            cancel.cancel();
        }
    }
}

/// Whether what runs is left to run when another request comes. While all moves, requests come faster than
/// images, so the image under way is always finished: otherwise there would be none until all is at rest.
fn spares(running: &ViewRequest, phase: Phase, request: &ViewRequest) -> bool {
    let both_move = running.moving && request.moving;
    let comes_to_rest = running.moving && running.same_picture(request);
    let compiles_for_both = phase == Phase::Compiling && running.same_world(request);
    both_move || comes_to_rest || compiles_for_both
}
