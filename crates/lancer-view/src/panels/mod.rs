//! What is drawn around the view.
//!
//! A panel reads what it is given, draws it, and says as [`Action`](crate::Action)s what the user wants. It changes
//! nothing itself but its own state, as what is typed or unfolded.

pub mod about;
mod fields;
pub mod file_picker;
pub mod inspector;
pub mod menu_bar;
pub mod messages;
pub mod palette;
pub mod scene_tree;
mod scenes;
pub mod settings;
pub mod shortcuts;
