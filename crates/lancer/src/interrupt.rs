//! Ctrl-C and the other requests to stop.
//!
//! Reading and building leave nothing behind, so there the program just ends. A render is cancelled, and unwinds
//! in its own time unless it is asked again. While a file is written it is always unwound, so that no half of it
//! stays behind.

use crate::error::Error;
use lancer_core::render::CancelToken;
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};

/// What a request to stop does now.
#[derive(Clone)]
enum Handling {
    /// Ends the program.
    Exit,
    /// Cancels; ends the program where that was asked for before.
    CancelThenExit(CancelToken),
    /// Cancels, however often it is asked for.
    Cancel(CancelToken),
}

static HANDLING: Mutex<Handling> = Mutex::new(Handling::Exit);

/// From now on, requests to stop are handled here.
pub(crate) fn install() {
    #[cfg(unix)]
    hangup::keep_ignored();
    // It fails where the system has no room for one more thread; then signals end the program as they always do.
    let _ = ctrlc::set_handler(|| match current() {
        Handling::CancelThenExit(token) if !token.is_cancelled() => token.cancel(),
        Handling::Cancel(token) => token.cancel(),
        Handling::Exit | Handling::CancelThenExit(_) => exit(),
    });
}

/// Until the guard is dropped, the first request to stop cancels `token`, and the next one ends the program.
#[must_use]
pub(crate) fn cancels(token: &CancelToken) -> Guard {
    Guard(set(Handling::CancelThenExit(token.clone())))
}

/// Until the guard is dropped, requests to stop cancel `token` and do no more.
#[must_use]
pub(crate) fn only_cancels(token: &CancelToken) -> Guard {
    Guard(set(Handling::Cancel(token.clone())))
}

/// Puts back what requests to stop did before: a film's pictures are written amid its render.
pub(crate) struct Guard(Handling);

impl Drop for Guard {
    fn drop(&mut self) {
        set(self.0.clone());
    }
}

/// Changes what a request to stop does, and returns what it did.
fn set(handling: Handling) -> Handling {
    std::mem::replace(&mut *HANDLING.lock().unwrap_or_else(PoisonError::into_inner), handling)
}

fn current() -> Handling {
    HANDLING.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn exit() {
    if std::io::stderr().is_terminal() {
        // Leaves the line on which progress was drawn.
        crate::terminal::note("");
    }
    std::process::exit(i32::from(Error::INTERRUPTED));
}

/// A program that was started to outlive its terminal, as by `nohup`, is told to ignore hangups. The handler, which
/// cannot tell a hangup from a Ctrl-C, would end just those renders that were meant to go on.
#[cfg(unix)]
mod hangup {
    use nix::sys::signal::{SigSet, Signal};

    /// Keeps hangups from the handler where they are ignored; to be called before any thread is started.
    pub(super) fn keep_ignored() {
        if is_ignored() {
            let mut hangup = SigSet::empty();
            hangup.add(Signal::SIGHUP);
            // It fails for sets that are no sets of signals.
            let _ = hangup.thread_block();
        }
    }

    fn is_ignored() -> bool {
        let mask = crate::process::status("SigIgn").and_then(|mask| u64::from_str_radix(&mask, 16).ok());
        let bit = 1 << (Signal::SIGHUP as u32 - 1);
        mask.is_some_and(|mask| mask & bit != 0)
    }
}
