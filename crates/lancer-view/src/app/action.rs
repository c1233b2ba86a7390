//! What a user may want.

use crate::{Command, Edit, Source};
use lancer_core::scene::{MaterialId, NodeId};
use lancer_core::world::CompileOptions;
use std::path::PathBuf;

/// What is selected in the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// Nothing.
    #[default]
    None,
    /// A node, with all below it.
    Node(NodeId),
    /// A light, by its place in the scene's list.
    Light(usize),
    /// A material.
    Material(MaterialId),
}

/// Something that the user wants, said by a panel.
#[derive(Clone, Debug)]
pub enum Action {
    /// What a menu, a key, a button or the palette says.
    Command(Command),
    /// Show another scene.
    Open(Source),
    /// Select something, or nothing.
    Select(Selection),
    /// Move the view so that this fills it.
    Frame(Selection),
    /// Look through a camera of the scene: one of those with a name, or the main one.
    UseCamera(Option<String>),
    /// Search for hits in another way.
    Options(CompileOptions),
    /// Render on so many threads; 0 for one a core.
    Threads(usize),
    /// Show the scene of a file.
    OpenPath(PathBuf),
    /// Write the picture that is shown.
    SavePicture(PathBuf),
    /// Write the whole scene.
    SaveScene(PathBuf),
    /// Change the scene.
    Edit(Edit),
    /// What was done with one control is done: the next edit is a step of its own in the history.
    EndGesture,
}
