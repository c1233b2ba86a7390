//! A virtual display with a person before it: the window as its users meet it, for tests, benchmarks and pictures.
//!
//! A [`Display`] is an X server without a screen; a [`Program`] runs on it, with a home of its own. Their pictures
//! are read through the X protocol, keys and mouse are moved by `xdotool`, files are dropped by a [`FileDrag`], and what
//! was copied is pasted by [`Display::clipboard`]. Nothing
//! here waits for a fixed time: [`Program::settle`] and [`wait_for`] wait for what can be seen.
//!
//! It knows nothing of what the window shows. Only Linux has `/proc`, which says when a program rests.

mod clipboard;
mod display;
mod drag;
mod hands;
mod picture;
mod program;

pub use display::{Display, missing_tools};
pub use drag::FileDrag;
pub use hands::Button;
pub use picture::{Area, Picture};
pub use program::Program;

use std::time::{Duration, Instant};

/// Why something could not be done; any error will do.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Far longer than anything takes: when it is over, what was waited for will not come.
const HANG: Duration = Duration::from_secs(300);

/// How often is looked whether something has happened.
const LOOK: Duration = Duration::from_millis(10);

/// Looks until `look` sees something, and returns it.
///
/// # Errors
/// It was not seen for so long that it will not come; or looking failed.
pub fn wait_for<T>(what: &str, mut look: impl FnMut() -> Result<Option<T>, Failure>) -> Result<T, Failure> {
    let start = Instant::now();
    loop {
        match look()? {
            Some(seen) => return Ok(seen),
            None if start.elapsed() > HANG => return Err(format!("waited in vain for {what}").into()),
            None => std::thread::sleep(LOOK),
        }
    }
}
