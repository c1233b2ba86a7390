//! The window of Lancer: choose a scene, move in it, set what the picture is to be, render.
//!
//! The viewport shows what the renderer makes and nothing else: there is no second shading model. What can be
//! said without a window is plain code, tested as such; only the application and its panels know egui.
//!
//! It knows nothing of how rays are intersected or shaded, and its own thread never waits for a render.

mod app;
pub mod commands;
pub mod document;
mod language;
pub mod navigation;
pub mod overlay;
pub mod panels;
pub mod picture;
pub mod preferences;
mod source;
pub mod theme;
pub mod watch;
mod window;
pub mod worker;

pub use app::{Action, App, Options, Remembered, Selection};
pub use commands::{Command, CommandContext};
pub use document::{Document, Edit, EditKind};
pub use language::{Language, Phrase};
pub use preferences::{
    Panels, Preferences, PreferencesFile, PreferencesWarning, RecentFiles, Theme, WindowPlace,
};
pub use source::Source;
pub use watch::{Watch, WatchError};
pub use window::{WindowError, run};
pub use worker::{
    Channel, Event, Frame, OpenStage, Opened, Progress, RenderFault, RenderId, RenderRequest, Rendered,
    ViewRequest, Worker,
};
