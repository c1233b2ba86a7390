//! Why the program ends without having done what it was asked, and the exit code that says so.

use lancer_core::render::RenderError;
use lancer_io::diagnostics::LoadError;
use std::io;
use std::process::ExitCode;

/// Why there is no result.
#[derive(Debug)]
pub(crate) enum Error {
    /// The command line asks for what cannot be.
    Usage {
        /// What is wrong.
        message: String,
        /// What to do instead.
        hint: Option<String>,
    },
    /// The scene or a model is at fault.
    Scene(LoadError),
    /// The output could not be written.
    Output {
        /// The file, or standard output.
        to: String,
        /// Why, in the operating system's words.
        reason: String,
    },
    /// The render failed.
    Render(String),
    /// The user asked to stop.
    Interrupted,
    /// Pictures are not the same, or further apart than they may be. It was told as a result.
    Different,
    /// Who read standard output has seen enough, as in `lancer scenes | head -1`: nobody's fault.
    ReaderGone,
}

impl Error {
    /// A wrong command line.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), hint: None }
    }

    /// A wrong command line, and what to do instead.
    pub(crate) fn usage_with_hint(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), hint: Some(hint.into()) }
    }

    /// Output that could not be written.
    pub(crate) fn output(to: impl Into<String>, error: &io::Error) -> Self {
        Self::Output { to: to.into(), reason: lancer_io::resolver::reason(error) }
    }

    /// The exit code: part of the contract with scripts.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::ReaderGone => 0,
            Self::Different => 1,
            Self::Usage { .. } => 2,
            Self::Scene(_) => 3,
            Self::Output { .. } => 4,
            Self::Render(_) => 5,
            Self::Interrupted => Self::INTERRUPTED,
        }
    }

    /// The exit code of a program that was interrupted: what shells report for SIGINT.
    pub(crate) const INTERRUPTED: u8 = 130;
}

impl From<&Error> for ExitCode {
    fn from(error: &Error) -> Self {
        Self::from(error.code())
    }
}

impl From<LoadError> for Error {
    fn from(error: LoadError) -> Self {
        Self::Scene(error)
    }
}

impl From<RenderError> for Error {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Cancelled => Self::Interrupted,
            // Settings, camera and region were checked before, where it is known who is at fault.
            error => Self::Render(error.to_string()),
        }
    }
}
