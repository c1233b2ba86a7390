//! Events on their way to the window.

use super::guard::guarded;
use super::{Event, Progress};
use std::sync::{Mutex, PoisonError};

/// Events that wait to be taken. It holds at most one frame and one progress of a render, so that a window that
/// does not look costs no memory.
pub(super) struct Outbox {
    waiting: Mutex<Waiting>,
    wake: Box<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
struct Waiting {
    events: Vec<Event>,
    closed: bool,
}

impl Outbox {
    pub(super) fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self { waiting: Mutex::default(), wake: Box::new(wake) }
    }

    /// Puts an event in and wakes whoever takes them.
    pub(super) fn push(&self, event: Event) {
        self.put(event);
        self.wake();
    }

    /// Puts an event in; to be followed by [`Self::wake`], which must not be called under a lock.
    pub(super) fn put(&self, event: Event) {
        let mut waiting = self.lock();
        if !waiting.closed {
            join(&mut waiting.events, event);
        }
    }

    /// Says that there is news, unless nobody listens any more.
    pub(super) fn wake(&self) {
        if !self.lock().closed {
            // The event stays for the next look; a window that panics has said so itself.
            let _ = guarded(&self.wake);
        }
    }

    /// All that waits.
    pub(super) fn take(&self) -> Vec<Event> {
        std::mem::take(&mut self.lock().events)
    }

    /// Drops what waits and all that is still to come.
    pub(super) fn close(&self) {
        let mut waiting = self.lock();
        waiting.closed = true;
        waiting.events.clear();
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Adds an event to those that wait: a frame takes the place of an older one, a progress is joined with an older
/// one of the same render.
fn join(events: &mut Vec<Event>, mut event: Event) {
    match &mut event {
        Event::Frame(_) => events.retain(|waiting| !matches!(waiting, Event::Frame(_))),
        Event::RenderProgress(id, progress) => {
            let older = |waiting: &Event| matches!(waiting, Event::RenderProgress(other, _) if other == id);
            if let Some(place) = events.iter().position(older)
                && let Event::RenderProgress(_, Progress { mut tiles, .. }) = events.remove(place)
            {
                tiles.append(&mut progress.tiles);
                progress.tiles = tiles;
            }
        }
        _ => {}
    }
    events.push(event);
}
