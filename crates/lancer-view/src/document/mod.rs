//! The scene that is being edited, and how it came to be.
//!
//! In: a scene as it was loaded, and [`Edit`]s. Out: the scene as it is now, shared with whoever renders it.
//! An edit is applied by exchanging its value with the scene's, which leaves the edit that takes it back: so what
//! undo restores is the very value that was there. It knows neither windows nor files, nor what is selected.

mod edit;
#[cfg(test)]
mod tests;

pub use edit::{Edit, EditKind};

use crate::Source;
use lancer_core::scene::{NodeId, Scene};
use std::mem;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A scene that is being edited.
///
/// ```
/// use lancer_core::{Rgb, scene::Scene};
/// use lancer_view::{Document, Edit, Source};
///
/// let source = Source::Builtin(lancer_gallery::find("whitted").unwrap());
/// let mut document = Document::new(source, Scene::new("empty"));
/// document.apply(Edit::Ambient(Rgb::WHITE));
/// assert_eq!(document.scene().ambient, Rgb::WHITE);
/// document.undo();
/// assert_eq!(document.scene().ambient, Rgb::BLACK);
/// ```
#[derive(Clone, Debug)]
pub struct Document {
    source: Source,
    scene: Arc<Scene>,
    revision: u64,
    saved: Arc<Scene>,
    saved_revision: u64,
    done: Vec<Step>,
    undone: Vec<Step>,
    /// Whether the last step of `done` is of the gesture that still goes on.
    in_gesture: bool,
}

/// A step of the history: what leads to the state on its other side, and that state's revision.
#[derive(Clone, Debug)]
struct Step {
    revision: u64,
    change: Change,
}

#[derive(Clone, Debug)]
enum Change {
    Edit(Edit),
    /// The whole scene, where more than one of its values changes.
    Whole(EditKind, Arc<Scene>),
}

impl Change {
    fn kind(&self) -> EditKind {
        match self {
            Self::Edit(edit) => edit.kind(),
            Self::Whole(kind, _) => *kind,
        }
    }
}

impl Document {
    /// A scene as it was loaded.
    pub fn new(source: Source, scene: Scene) -> Self {
        let scene = Arc::new(scene);
        let revision = new_revision();
        Self {
            source,
            saved: Arc::clone(&scene),
            scene,
            revision,
            saved_revision: revision,
            done: Vec::new(),
            undone: Vec::new(),
            in_gesture: false,
        }
    }

    /// Where the scene was loaded from, or last saved to.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The scene as it is now.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The scene as it was loaded or last saved.
    pub fn saved(&self) -> &Arc<Scene> {
        &self.saved
    }

    /// A number that stands for the scene as it is now: equal numbers mean equal scenes, among all documents.
    ///
    /// Every change changes it; undo and redo bring back the number of the state that they bring back.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Makes a change.
    ///
    /// What has the value already stays without a step, and so does what the scene has not. Edits of the same value
    /// that follow one another until [`Document::end_gesture`] become one step.
    pub fn apply(&mut self, mut edit: Edit) {
        if !edit.would_change(&self.scene) {
            return;
        }
        edit.swap(Arc::make_mut(&mut self.scene));
        let before = mem::replace(&mut self.revision, new_revision());
        self.undone.clear();
        if !self.joins(&edit) {
            self.done.push(Step { revision: before, change: Change::Edit(edit) });
            self.in_gesture = true;
        }
    }

    /// Whether the last step already leads back to before this edit.
    fn joins(&self, edit: &Edit) -> bool {
        let last = self.done.last().filter(|_| self.in_gesture);
        matches!(last, Some(Step { change: Change::Edit(first), .. }) if first.has_target_of(edit))
    }

    /// Ends what the user does with one control: the next edit is a step of its own.
    ///
    /// A gesture that ended where it began leaves no step.
    pub fn end_gesture(&mut self) {
        if !mem::take(&mut self.in_gesture) {
            return;
        }
        let scene = &self.scene;
        let idle = |step: &mut Step| matches!(&step.change, Change::Edit(edit) if !edit.would_change(scene));
        if let Some(step) = self.done.pop_if(idle) {
            self.revision = step.revision;
        }
    }

    /// Takes the last step back. Returns what it was.
    pub fn undo(&mut self) -> Option<EditKind> {
        self.end_gesture();
        let step = self.done.pop()?;
        let step = self.swap(step);
        let kind = step.change.kind();
        self.undone.push(step);
        Some(kind)
    }

    /// Makes again what was last taken back. Returns what it was.
    pub fn redo(&mut self) -> Option<EditKind> {
        self.end_gesture();
        let step = self.undone.pop()?;
        let step = self.swap(step);
        let kind = step.change.kind();
        self.done.push(step);
        Some(kind)
    }

    /// Goes to the step's other side. Returns the step that leads back.
    fn swap(&mut self, mut step: Step) -> Step {
        match &mut step.change {
            Change::Edit(edit) => edit.swap(Arc::make_mut(&mut self.scene)),
            Change::Whole(_, scene) => mem::swap(scene, &mut self.scene),
        }
        mem::swap(&mut step.revision, &mut self.revision);
        step
    }

    /// Whether there is a step to take back.
    pub fn can_undo(&self) -> bool {
        !self.done.is_empty()
    }

    /// Whether there is a step to make again.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// What [`Document::undo`] would take back.
    pub fn undo_name(&self) -> Option<EditKind> {
        self.done.last().map(|step| step.change.kind())
    }

    /// What [`Document::redo`] would make again.
    pub fn redo_name(&self) -> Option<EditKind> {
        self.undone.last().map(|step| step.change.kind())
    }

    /// Whether the scene has been edited since it was loaded or saved.
    pub fn is_changed(&self) -> bool {
        self.revision != self.saved_revision
    }

    /// The scene has been saved as it is now.
    pub fn mark_saved(&mut self) {
        self.end_gesture();
        self.saved = Arc::clone(&self.scene);
        self.saved_revision = self.revision;
    }

    /// The scene has been saved as it is now in another place, from which it now is.
    pub fn mark_saved_as(&mut self, source: Source) {
        self.source = source;
        self.mark_saved();
    }

    /// Goes back to the scene as it was loaded or saved, as one step that can be undone.
    pub fn revert(&mut self) {
        self.end_gesture();
        if self.is_changed() {
            self.replace(EditKind::Revert, Arc::clone(&self.saved), self.saved_revision);
        }
    }

    /// Hides nothing any more, as one step that can be undone.
    pub fn show_all(&mut self) {
        self.end_gesture();
        let is_hidden = |id: &NodeId| self.scene.node(*id).hidden;
        let hidden = self.scene.node_ids().filter(is_hidden).collect::<Vec<_>>();
        if !hidden.is_empty() {
            let mut scene = Scene::clone(&self.scene);
            hidden.into_iter().for_each(|id| scene.node_mut(id).hidden = false);
            self.replace(EditKind::Hidden, Arc::new(scene), new_revision());
        }
    }

    /// Puts another scene in the place of this one, as one step.
    fn replace(&mut self, kind: EditKind, scene: Arc<Scene>, revision: u64) {
        let step = self.swap(Step { revision, change: Change::Whole(kind, scene) });
        self.done.push(step);
        self.undone.clear();
    }
}

/// A number that no state of any document has had: renderers that serve several documents one after the other
/// tell scenes apart by it.
fn new_revision() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}
