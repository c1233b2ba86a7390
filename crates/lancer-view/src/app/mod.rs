//! The state of the window, and how it reacts.
//!
//! Panels read the state and say what the user wants as [`Action`]s; the application carries them out. So every
//! way to do a thing (menu, shortcut, palette, button) ends in the same place.

mod action;

pub use action::{Action, Selection};
