//! Threads that trace.

use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of `threads` threads, 0 for one a core, named `name` with a number.
///
/// # Errors
/// The system gives no more threads, in words for a person.
pub(super) fn start(name: &'static str, threads: usize) -> Result<ThreadPool, String> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(move |number| format!("{name}-{number}"))
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
