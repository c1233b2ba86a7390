//! What becomes of a panic, which is always a bug: a message that says so, and an exit code.

use crate::error::Error;
use std::panic::{self, UnwindSafe};

/// Does `work`, and turns a panic in it into an error.
///
/// The core catches the panics of its own threads, names the pixel and returns an error; so the hook itself must
/// not speak, unless the user asked for backtraces.
pub(crate) fn caught<T>(work: impl FnOnce() -> Result<T, Error> + UnwindSafe) -> Result<T, Error> {
    let default_hook = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0") {
            default_hook(panic);
        }
    }));
    panic::catch_unwind(work).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(Error::Render(format!(
            "a bug in lancer: {message}\nhint: RUST_BACKTRACE=1 shows where; please report it with the command"
        )))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_with_its_message() {
        let caught = caught(|| -> Result<(), Error> { panic!("a test's panic") });
        assert!(matches!(caught, Err(Error::Render(message)) if message.contains("a test's panic")));
    }
}
