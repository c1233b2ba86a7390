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
pub(super) fn join(events: &mut Vec<Event>, mut event: Event) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worker::RenderId;
    use lancer_core::integrator::RayCounts;
    use lancer_core::render::Tile;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::time::Duration;

    fn progress(id: u64, x: u32) -> Event {
        let tiles = vec![Tile { x, y: 0, width: 1, height: 1, pixels: vec![[0.0; 3]] }];
        let (rays, elapsed) = (RayCounts::default(), Duration::ZERO);
        Event::RenderProgress(RenderId(id), Progress { done: x as f32, rays, elapsed, tiles })
    }

    #[test]
    fn progress_that_waits_is_joined_and_no_tile_is_lost() {
        let outbox = Outbox::new(|| {});
        for x in 0..3 {
            outbox.push(progress(1, x));
        }
        outbox.push(progress(2, 7));
        let events = outbox.take();
        let [Event::RenderProgress(_, first), Event::RenderProgress(_, other)] = &events[..] else {
            panic!("{events:?}");
        };
        assert_eq!(first.tiles.iter().map(|tile| tile.x).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!((first.done, other.done), (2.0, 7.0));
        assert!(outbox.take().is_empty());
    }

    #[test]
    fn each_event_wakes_and_none_does_once_it_is_closed() {
        let wakes = Arc::new(AtomicU32::new(0));
        let counted = Arc::clone(&wakes);
        let outbox = Outbox::new(move || {
            counted.fetch_add(1, Ordering::Relaxed);
        });
        outbox.push(progress(1, 0));
        outbox.push(progress(1, 1));
        outbox.close();
        outbox.push(progress(1, 2));
        assert_eq!(wakes.load(Ordering::Relaxed), 2);
        assert!(outbox.take().is_empty());
    }

    #[test]
    fn a_wake_that_panics_leaves_the_event() {
        let outbox = Outbox::new(|| panic!("no window"));
        outbox.push(progress(1, 0));
        assert_eq!(outbox.take().len(), 1);
    }
}
