//! How long work is stopped before its end.
//!
//! Whatever may take long is given a token, looks at it now and then, and gives up once it is cancelled. A token
//! stays cancelled: whoever sees so at the end of work knows whether any part of it may have been left out.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks for the end of some work; shared between who asks and who works.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// Asks for the end. It cannot be taken back.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the end was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
