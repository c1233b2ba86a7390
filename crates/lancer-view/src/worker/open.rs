//! Scenes read and built, each on a thread of its own.

use super::guard::guarded;
use super::outbox::Outbox;
use super::worlds::Compiled;
use super::{Event, OpenStage, Opened, pool};
use crate::Source;
use lancer_core::render::CancelToken;
use lancer_core::world::{CompileControl, CompileError, CompileOptions, World};
use lancer_io::LoadOptions;
use lancer_io::diagnostics::LoadError;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Opens scenes. Only one is wanted at a time: what threads of others bring is dropped.
pub(super) struct Opener {
    state: Mutex<State>,
    outbox: Arc<Outbox>,
}

#[derive(Default)]
struct State {
    wanted: Option<Wanted>,
    opened: Option<Compiled>,
}

/// What is being opened.
struct Wanted {
    source: Source,
    cancel: CancelToken,
}

impl Opener {
    pub(super) fn new(outbox: Arc<Outbox>) -> Self {
        Self { state: Mutex::default(), outbox }
    }

    /// Opens a scene in place of the one before, compiled as `habits` says and on as many threads.
    pub(super) fn open(
        self: &Arc<Self>,
        source: Source,
        options: LoadOptions,
        (compile, threads): (CompileOptions, usize),
    ) {
        let cancel = CancelToken::default();
        let wanted = Wanted { source: source.clone(), cancel: cancel.clone() };
        self.drop_wanted(Some(wanted));
        let task =
            Task { opener: Arc::clone(self), source: source.clone(), options, compile, threads, cancel };
        task.tell(OpenStage::Reading);
        let thread = std::thread::Builder::new().name("lancer-open".into()).spawn(move || task.work());
        if let Err(error) = thread {
            self.drop_wanted(None);
            let error = fault(&source, format!("the system gives no thread to open it: {error}"));
            self.outbox.push(Event::OpenFailed { source, error });
        }
    }

    /// Stops opening, and says so.
    pub(super) fn cancel(&self) {
        if let Some(Wanted { source, .. }) = self.drop_wanted(None) {
            self.outbox.push(Event::OpenCancelled { source });
        }
    }

    /// Stops opening, and says nothing.
    pub(super) fn close(&self) {
        self.drop_wanted(None);
    }

    pub(super) fn is_busy(&self) -> bool {
        self.lock().wanted.is_some()
    }

    /// The scene that was opened last, once.
    pub(super) fn take_opened(&self) -> Option<Compiled> {
        self.lock().opened.take()
    }

    /// Puts another wish in place of that which there is, which is cancelled and returned.
    fn drop_wanted(&self, next: Option<Wanted>) -> Option<Wanted> {
        let dropped = std::mem::replace(&mut self.lock().wanted, next);
        if let Some(dropped) = &dropped {
            dropped.cancel.cancel();
        }
        dropped
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A scene on its way, on a thread of its own.
struct Task {
    opener: Arc<Opener>,
    source: Source,
    options: LoadOptions,
    compile: CompileOptions,
    threads: usize,
    cancel: CancelToken,
}

impl Task {
    fn work(self) {
        pool::step_back();
        let opened = guarded(|| self.open()).unwrap_or_else(|bug| Err(fault(&self.source, bug)));
        let Self { opener, source, cancel, compile, .. } = self;
        // Under the lock, so that nothing comes from a scene after it was cancelled.
        let mut state = opener.lock();
        if cancel.is_cancelled() {
            return;
        }
        state.wanted = None;
        opener.outbox.put(match opened {
            Ok(opened) => {
                let scene = Arc::new(opened.loaded.scene.clone());
                state.opened = Some(Compiled { scene, options: compile, world: Arc::clone(&opened.world) });
                Event::Opened(Box::new(opened))
            }
            Err(error) => Event::OpenFailed { source, error },
        });
        drop(state);
        opener.outbox.wake();
    }

    fn open(&self) -> Result<Opened, LoadError> {
        let start = Instant::now();
        let pool = pool::start("lancer-build", self.threads).map_err(|error| fault(&self.source, error))?;
        let loaded = self.source.load(&self.options)?;
        self.tell(OpenStage::Building);
        let control = CompileControl { previous: None, cancel: self.cancel.clone() };
        let world = pool
            .install(|| World::compile_with(&loaded.scene, &self.compile, &control))
            .map_err(|error: CompileError| fault(&self.source, error.to_string()))?;
        Ok(Opened {
            source: self.source.clone(),
            options: self.options.clone(),
            loaded,
            world: Arc::new(world),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    fn tell(&self, stage: OpenStage) {
        let state = self.opener.lock();
        if !self.cancel.is_cancelled() {
            self.opener.outbox.put(Event::Opening { source: self.source.clone(), stage });
        }
        drop(state);
        self.opener.outbox.wake();
    }
}

/// An error of a scene as a whole.
fn fault(source: &Source, message: String) -> LoadError {
    let name = source.to_string();
    LoadError::new(source.path().unwrap_or(Path::new(&name)), message)
}
