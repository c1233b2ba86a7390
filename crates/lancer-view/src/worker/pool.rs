//! Threads that trace, and step back for the window.

use rayon::{ThreadPool, ThreadPoolBuilder};
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Out of 100, where an ordinary thread has 50; on Linux it is a nice value of 10, which leaves nine tenths of a
/// contended core to the window. Lower would let other programs starve a render; higher would let rays delay an answer.
const PRIORITY: u8 = 25;

/// Lets the window's own thread go first where both want the same core.
///
/// A system that does not allow it leaves the thread as it is: the window then answers later, and nothing else differs.
pub(super) fn step_back() {
    let priority = ThreadPriorityValue::try_from(PRIORITY).map(ThreadPriority::Crossplatform);
    let _ = priority.map(set_current_thread_priority);
}

/// A pool of `threads` threads, 0 for one a core, named `name` with a number.
///
/// # Errors
/// The system gives no more threads, in words for a person.
pub(super) fn start(name: &'static str, threads: usize) -> Result<ThreadPool, String> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(move |number| format!("{name}-{number}"))
        .start_handler(|_| step_back())
        .build()
        .map_err(|error| format!("the system gives no {threads} threads: {error}; ask for fewer"))
}

/// A pool that is kept as long as the same number of threads is asked for.
#[derive(Default)]
pub(super) struct KeptPool(Option<(usize, ThreadPool)>);

impl KeptPool {
    /// The pool of so many threads.
    ///
    /// # Errors
    /// See [`start`].
    pub(super) fn of(&mut self, threads: usize) -> Result<&ThreadPool, String> {
        let kept = self.0.take().filter(|(number, _)| *number == threads);
        let kept = match kept {
            Some(kept) => kept,
            None => (threads, start("lancer-ray", threads)?),
        };
        Ok(&self.0.insert(kept).1)
    }
}
