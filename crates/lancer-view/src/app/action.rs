//! What a user may want.

use crate::{Edit, Source};
use lancer_core::scene::{MaterialId, NodeId};

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
    /// Show another scene.
    Open(Source),
    /// Select something, or nothing.
    Select(Selection),
    /// Move the view so that this fills it.
    Frame(Selection),
    /// Change the scene.
    Edit(Edit),
    /// What was done with one control is done: the next edit is a step of its own in the history.
    EndGesture,
}
