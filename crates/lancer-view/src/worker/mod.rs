//! The thread that loads, compiles and renders, so that the window never waits.
//!
//! In: requests, of which the latest wins. Out: [`Event`]s, to be taken with [`Worker::poll`]. It knows nothing of
//! egui.
//!
//! There are three kinds of threads. One, `lancer-render`, takes one job after the other from the [`desk`]: it
//! refines the viewport, or makes a picture while the viewport rests. It traces on a pool that is kept between
//! jobs. Each scene that is opened has a thread of its own, since reading cannot be interrupted: who cancels no
//! longer waits for it, and what it brings is dropped. Idle threads sleep.
//!
//! What each pass of the viewport is, [`passes`] decides from what the last ones cost.

mod alike;
mod channel;
mod cost;
mod desk;
mod event;
mod film;
mod guard;
mod open;
mod outbox;
mod passes;
mod pool;
mod request;
mod scale;
#[cfg(test)]
mod tests;
mod thread;
mod view;
mod worlds;

pub use event::{Event, Frame, OpenStage, Opened, Progress, RenderFault, Rendered};
pub use request::{Channel, RenderId, RenderRequest, ViewRequest};

use crate::Source;
use desk::Desk;
use lancer_io::LoadOptions;
use open::Opener;
use outbox::Outbox;
use std::sync::Arc;

/// The handle of the worker. All of its methods return at once.
///
/// Dropping it cancels all that goes on; the threads end by themselves, and neither events nor wakes come after.
pub struct Worker {
    desk: Arc<Desk>,
    opener: Arc<Opener>,
    outbox: Arc<Outbox>,
}

impl Worker {
    /// Starts the worker's thread, which sleeps until something is asked for. `wake` is called after every new
    /// event, from whichever thread it comes.
    ///
    /// # Panics
    /// Where the system gives no thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let outbox = Arc::new(Outbox::new(wake));
        let desk = Arc::new(Desk::default());
        let opener = Arc::new(Opener::new(Arc::clone(&outbox)));
        let mut render = thread::RenderThread::new(&desk, &opener, &outbox);
        std::thread::Builder::new()
            .name("lancer-render".into())
            .spawn(move || render.work())
            .expect("a process that has just begun gets a thread");
        Self { desk, opener, outbox }
    }

    /// Reads a scene and builds its trees, as the last request had them built. The latest wins; an
    /// [`Event::Opened`] or [`Event::OpenFailed`] follows, unless it is cancelled or another is opened. The view goes on.
    pub fn open(&self, source: Source, options: LoadOptions) {
        self.opener.open(source, options, self.desk.habits());
    }

    /// Stops opening. An [`Event::OpenCancelled`] follows if a scene was being opened.
    pub fn cancel_open(&self) {
        self.opener.cancel();
    }

    /// Shows this in the viewport. The latest request wins; one that changes nothing does nothing.
    ///
    /// While it moves, one coarse image comes, and it is finished even if the next request comes meanwhile: images
    /// keep up, and never starve. At rest, images come in passes up to the full settings. The last one is what
    /// [`render`](lancer_core::render::render) makes, byte for byte, and then nothing runs.
    pub fn view(&self, request: ViewRequest) {
        self.desk.view(request);
    }

    /// Stops the view until it is asked for again.
    pub fn stop_view(&self) {
        self.desk.stop_view();
    }

    /// Makes a picture, while the view rests. The latest wins: one before it that is not done is cancelled.
    pub fn render(&self, request: RenderRequest) -> RenderId {
        let (id, dropped) = self.desk.render(request);
        self.tell_cancelled(dropped);
        id
    }

    /// Stops the render. An [`Event::RenderFailed`] follows if there was one.
    pub fn cancel_render(&self) {
        self.tell_cancelled(self.desk.cancel_render());
    }

    /// What has happened since the last time.
    pub fn poll(&self) -> Vec<Event> {
        self.outbox.take()
    }

    /// Whether something is being opened, refined or rendered. It is no longer when the last event of it comes.
    pub fn is_busy(&self) -> bool {
        self.opener.is_busy() || self.desk.is_busy()
    }

    fn tell_cancelled(&self, render: Option<RenderId>) {
        if let Some(id) = render {
            self.outbox.push(Event::RenderFailed { id, error: RenderFault::Cancelled });
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.outbox.close();
        self.opener.close();
        self.desk.close();
    }
}
