//! What the user wants, carried out.

use super::making::Making;
use super::saving::{save_into_scene_file, save_picture, save_scene_as};
use super::shelf::Showing;
use super::{Action, App, Asking, Selection};
use crate::Source;
use crate::commands::Command;
use crate::document::{Document, Edit, EditKind};
use crate::language::{Language, Phrase};
use crate::navigation::{Axis, Scheme};
use crate::panels::file_picker::Purpose;
use crate::panels::palette::Palette;
use crate::picture::color_image;
use crate::preferences::Theme;
use crate::worker::{Channel, RenderRequest};
use eframe::egui::{Context, ViewportCommand};
use lancer_core::film::{Image, Tone};
use lancer_core::geometry::{Bounds, DVec2};
use lancer_core::scene::{NodeId, Scene};
use lancer_core::world::{ObjectId, World};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const UNDONE: Phrase = Phrase::new("Undone:", "Annulé :");
const REDONE: Phrase = Phrase::new("Redone:", "Rétabli :");
const COPIED: Phrase = Phrase::new("The picture is on the clipboard.", "L’image est dans le presse-papiers.");
const REFINING: Phrase = Phrase::new(
    "The picture will be saved when it is refined.",
    "L’image sera enregistrée quand elle sera affinée.",
);
const CAMERA_SET: Phrase =
    Phrase::new("This view is now the scene’s camera.", "Cette vue est désormais la caméra de la scène.");

impl App {
    /// Carries out what the user wants.
    pub(super) fn perform(&mut self, ctx: &Context, action: Action) {
        match action {
            Action::Command(command) => self.command(ctx, command),
            Action::Open(source) => self.open(source),
            Action::OpenPath(path) => self.open(Source::File(path)),
            Action::Select(selection) => self.selection = selection,
            Action::Frame(selection) => self.frame_view(selection),
            Action::Edit(edit) => self.edit(edit),
            Action::EndGesture => self.end_gesture(),
            Action::UseCamera(name) => self.use_camera(name.as_deref()),
            Action::Options(options) => {
                self.options = options;
                self.preferences.accelerator = options.accelerator;
            }
            Action::Threads(threads) => self.preferences.threads = threads,
            Action::SavePicture(path) => self.save_picture_to(ctx, &path),
            Action::SaveScene(path) => self.save_scene_to(ctx, path),
        }
    }

    pub(super) fn edit(&mut self, edit: Edit) {
        if let Some(document) = &mut self.document {
            document.apply(edit);
        }
    }

    /// Opens a scene, after asking what is to become of changes that no file holds.
    pub(super) fn open(&mut self, source: Source) {
        if self.has_unsaved_work() {
            self.asking = Some(Asking::Open(source));
        } else {
            self.open_now(source);
        }
    }

    /// Opens a scene, whatever becomes of changes.
    pub(super) fn open_now(&self, source: Source) {
        self.worker.open(source, self.load.clone());
    }

    fn command(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.ask_for_file(ctx, Purpose::Open),
            Command::Reload => self.reload(),
            Command::SaveScene => self.save_scene(ctx),
            Command::SaveSceneAs => self.ask_for_file(ctx, Purpose::SaveScene),
            Command::SavePicture => self.ask_for_file(ctx, Purpose::SavePicture),
            Command::CopyPicture => self.copy_picture(ctx),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            Command::Undo => self.undo(),
            Command::Redo => self.redo(),
            Command::Revert => {
                if let Some(document) = &mut self.document {
                    document.revert();
                }
            }
            Command::Deselect => self.selection = Selection::None,
            Command::HideSelection => {
                if let Selection::Node(node) = self.selection {
                    self.edit(Edit::Hidden(node, true));
                    self.end_gesture();
                }
            }
            Command::ShowAll => {
                if let Some(document) = &mut self.document {
                    document.show_all();
                }
            }
            Command::UseViewAsCamera => {
                let camera = self.navigator.camera();
                self.edit(Edit::SceneCamera(camera));
                self.end_gesture();
                self.navigator.set_home(camera);
                self.messages.info(self.language().say(CAMERA_SET));
            }
            Command::FrameAll => self.frame_view(Selection::None),
            Command::FrameSelection => self.frame_view(self.selection),
            Command::Home => self.use_camera(None),
            Command::Front => self.look_along(Axis::Z, false),
            Command::Back => self.look_along(Axis::Z, true),
            Command::Right => self.look_along(Axis::X, false),
            Command::Left => self.look_along(Axis::X, true),
            Command::Top => self.look_along(Axis::Y, false),
            Command::Bottom => self.look_along(Axis::Y, true),
            Command::ShowPicture => self.show_channel(Channel::Picture),
            Command::ShowDepth => self.show_channel(Channel::Depth),
            Command::ShowNormals => self.show_channel(Channel::Normals),
            Command::ShowObjects => self.show_channel(Channel::Objects),
            Command::ShowOcclusion => self.show_channel(Channel::Occlusion),
            Command::Grid => toggle(&mut self.preferences.overlay.grid),
            Command::Axes => toggle(&mut self.preferences.overlay.axes),
            Command::Lights => toggle(&mut self.preferences.overlay.lights),
            Command::Bounds => toggle(&mut self.preferences.overlay.bounds),
            Command::Interest => toggle(&mut self.preferences.overlay.interest),
            Command::Tree => {
                let level = &mut self.preferences.overlay.tree_level;
                *level = if level.is_some() { None } else { Some(0) };
            }
            Command::TreeDeeper => self.step_tree(1),
            Command::TreeShallower => self.step_tree(-1),
            Command::ScenePanel => toggle(&mut self.preferences.panels.tree),
            Command::SettingsPanel => toggle(&mut self.preferences.panels.parameters),
            Command::RendersPanel => toggle(&mut self.preferences.panels.renders),
            Command::MouseHints => toggle(&mut self.preferences.panels.hints),
            Command::FullScreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
            Command::MouseAssignment => self.preferences.scheme = Scheme::Assignment,
            Command::MouseOrbit => self.preferences.scheme = Scheme::Orbit,
            Command::MouseTrackpad => self.preferences.scheme = Scheme::Trackpad,
            Command::ThemeSystem => self.set_theme(ctx, Theme::System),
            Command::ThemeLight => self.set_theme(ctx, Theme::Light),
            Command::ThemeDark => self.set_theme(ctx, Theme::Dark),
            Command::LanguageSystem => self.set_language(ctx, None),
            Command::LanguageEnglish => self.set_language(ctx, Some(Language::English)),
            Command::LanguageFrench => self.set_language(ctx, Some(Language::French)),
            Command::LargerInterface => eframe::egui::gui_zoom::zoom_in(ctx),
            Command::SmallerInterface => eframe::egui::gui_zoom::zoom_out(ctx),
            Command::NormalInterface => ctx.set_zoom_factor(1.0),
            Command::Render => self.render(),
            Command::Cancel => self.cancel(),
            Command::ShowView => self.shelf.showing = Showing::Live,
            Command::PreviousRender => self.shelf.step(true),
            Command::NextRender => self.shelf.step(false),
            Command::Compare => self.shelf.toggle_compare(),
            Command::DeleteRender => {
                if let Showing::Kept(index) | Showing::Compare(index, _) = self.shelf.showing {
                    self.shelf.remove(index);
                }
            }
            Command::ZoomIn => self.zoom(2.0),
            Command::ZoomOut => self.zoom(0.5),
            Command::ActualSize => self.shelf.view = crate::picture::ImageView::actual_size(),
            Command::Fit => self.shelf.view = crate::picture::ImageView::default(),
            Command::Palette => self.palette = Some(Palette::default()),
            Command::Shortcuts => toggle(&mut self.shortcuts_shown),
            Command::About => toggle(&mut self.about_shown),
        }
    }

    fn reload(&mut self) {
        if let Some(document) = &self.document {
            let source = document.source().clone();
            self.open(source);
        }
    }

    fn undo(&mut self) {
        let language = self.language();
        if let Some(kind) = self.document.as_mut().and_then(Document::undo) {
            self.messages.info(did(UNDONE, kind, language));
        }
    }

    fn redo(&mut self) {
        let language = self.language();
        if let Some(kind) = self.document.as_mut().and_then(Document::redo) {
            self.messages.info(did(REDONE, kind, language));
        }
    }

    pub(super) fn end_gesture(&mut self) {
        if let Some(document) = &mut self.document {
            document.end_gesture();
        }
    }

    /// Looks from one of the scene's cameras; without a name, from its main one.
    fn use_camera(&mut self, name: Option<&str>) {
        let Some(document) = &self.document else { return };
        if let Some(camera) = document.scene().camera_named(name) {
            self.navigator.set_camera(*camera);
            self.shelf.showing = Showing::Live;
        }
    }

    fn look_along(&mut self, axis: Axis, negative: bool) {
        self.navigator.look_along(axis, negative);
        self.shelf.showing = Showing::Live;
    }

    fn show_channel(&mut self, channel: Channel) {
        self.live.channel = channel;
        self.shelf.showing = Showing::Live;
    }

    fn step_tree(&mut self, by: i32) {
        let level = &mut self.preferences.overlay.tree_level;
        *level = Some(level.unwrap_or(0).saturating_add_signed(by));
    }

    fn zoom(&mut self, factor: f64) {
        if let Some((width, height)) = self.shelf.shown_size() {
            let image = DVec2::new(f64::from(width), f64::from(height));
            let screen = self.screen_size;
            self.shelf.view.zoom_about(factor, 0.5 * screen, image, screen);
        }
    }

    fn set_theme(&mut self, ctx: &Context, theme: Theme) {
        self.preferences.theme = theme;
        crate::theme::choose(ctx, theme);
    }

    fn set_language(&mut self, ctx: &Context, language: Option<Language>) {
        self.preferences.language = language;
        self.set_title(ctx);
    }

    /// Moves the view so that something fills it; for nothing, everything.
    fn frame_view(&mut self, selection: Selection) {
        let Some(frame) = self.frame_of_document() else { return };
        let Some(document) = &self.document else { return };
        let objects = objects_of(document.scene(), selection, &frame.world);
        let of_objects = |objects: &[ObjectId]| {
            objects
                .iter()
                .map(|&id| frame.world.object_bounds(id))
                .filter(Bounds::is_finite)
                .fold(Bounds::EMPTY, Bounds::union)
        };
        let bounds = match selection {
            Selection::Light(index) => document.scene().lights.get(index).map_or(Bounds::EMPTY, |light| {
                frame.world.bounds().union(Bounds::of_points([light.position]))
            }),
            _ => of_objects(&objects),
        };
        let bounds = if bounds.is_empty() { frame.world.bounds() } else { bounds };
        if !bounds.is_empty() {
            self.navigator.frame(bounds, self.aspect());
            self.shelf.showing = Showing::Live;
        }
    }

    /// Renders the picture; one that is being rendered goes on, and is shown.
    fn render(&mut self) {
        if self.shelf.running.is_some() {
            self.shelf.showing = Showing::Running;
            return;
        }
        let Some(document) = &self.document else { return };
        let scene = Arc::clone(document.scene());
        let (settings, tone) = (scene.settings, scene.tone);
        let source = document.source().clone();
        let request = RenderRequest {
            revision: document.revision(),
            options: self.options,
            threads: self.preferences.threads,
            camera: self.navigator.camera(),
            settings,
            channel: Channel::Picture,
            scene,
        };
        let id = self.worker.render(request);
        self.shelf.begin(id, &source, (settings.width, settings.height), tone);
    }

    /// Ends what is under way: a render, or else the opening of a scene.
    fn cancel(&mut self) {
        if self.shelf.running.is_some() {
            self.worker.cancel_render();
        } else if self.opening.take().is_some() {
            self.worker.cancel_open();
        }
    }

    /// The picture that is shown, and how it is shown and saved; none while there is none, or it is not yet refined.
    fn picture(&self) -> Option<(&Image, Tone)> {
        if self.shelf.showing == Showing::Live {
            let frame = self.live.frame().filter(|_| self.live.is_final())?;
            Some((&frame.image, self.live.tone_of(self.tone())))
        } else {
            self.shelf.shown().map(super::shelf::Kept::picture)
        }
    }

    /// How the picture that is shown was made; none for the live one, which has no settings of its own.
    fn making(&self) -> Option<Making> {
        let is_kept = self.shelf.showing != Showing::Live;
        self.shelf.shown().filter(|_| is_kept).map(super::shelf::Kept::making)
    }

    fn copy_picture(&mut self, ctx: &Context) {
        match self.picture() {
            Some((image, tone)) => {
                ctx.copy_image(color_image(image, tone));
                self.messages.info(self.language().say(COPIED));
            }
            None => self.copy_when_final = true,
        }
    }

    /// Does what waited for the live picture to be refined.
    pub(super) fn finish_pending(&mut self, ctx: &Context) {
        if self.picture().is_none() {
            return;
        }
        if std::mem::take(&mut self.copy_when_final) {
            self.copy_picture(ctx);
        }
        if let Some(path) = self.save_when_final.take() {
            self.save_picture_to(ctx, &path);
        }
    }

    fn save_scene_to(&mut self, ctx: &Context, path: PathBuf) {
        if let Some(document) = &self.document {
            let scene = self.scene_with_view(document.scene());
            let language = self.language();
            self.saver.start(waker(ctx), move || save_scene_as(&path, &scene, language));
        }
    }

    fn save_picture_to(&mut self, ctx: &Context, path: &Path) {
        let language = self.language();
        match self.picture() {
            Some((image, tone)) => {
                let (path, image, making) = (path.to_owned(), image.clone(), self.making());
                self.saver
                    .start(waker(ctx), move || save_picture(&path, &image, tone, making.as_ref(), language));
            }
            None => {
                self.save_when_final = Some(path.to_owned());
                self.messages.info(language.say(REFINING));
            }
        }
    }

    /// Saves the camera of the view and all changes into the scene's own file; asks for one where it has none.
    pub(super) fn save_scene(&mut self, ctx: &Context) {
        let Some(document) = &self.document else { return };
        let path = document.source().path().filter(|path| lancer_io::is_scene_file(path));
        match path.map(Path::to_owned) {
            None => self.ask_for_file(ctx, Purpose::SaveScene),
            Some(path) => {
                let scene = self.scene_with_view(document.scene());
                let (revision, language) = (document.revision(), self.language());
                let load = self.load.clone();
                self.saver.start(waker(ctx), move || {
                    save_into_scene_file(&path, &scene, revision, &load, language)
                });
            }
        }
    }

    /// The scene, with the view as its camera.
    fn scene_with_view(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.camera = self.navigator.camera();
        scene
    }
}

fn toggle(value: &mut bool) {
    *value = !*value;
}

fn waker(ctx: &Context) -> impl FnOnce() + Send + 'static {
    let ctx = ctx.clone();
    move || ctx.request_repaint()
}

/// The objects that a selection draws; for nothing, none.
pub(super) fn objects_of(scene: &Scene, selection: Selection, world: &World) -> Vec<ObjectId> {
    let ids = world.object_ids();
    match selection {
        Selection::None | Selection::Light(_) => Vec::new(),
        Selection::Material(material) => ids.filter(|&id| world.object(id).material() == material).collect(),
        Selection::Node(node) => {
            let below = descendants(scene, node);
            ids.filter(|&id| below.get(world.object(id).node().index()).copied().unwrap_or(false)).collect()
        }
    }
}

/// Which nodes are a node or lie below it. Shape: `[nodes]`.
fn descendants(scene: &Scene, node: NodeId) -> Vec<bool> {
    let mut below = vec![false; scene.nodes().len()];
    let mut pending = vec![node];
    while let Some(id) = pending.pop() {
        if !std::mem::replace(&mut below[id.index()], true) {
            pending.extend_from_slice(&scene.node(id).children);
        }
    }
    below
}

/// "Undone: render settings".
fn did(done: Phrase, kind: EditKind, language: Language) -> String {
    format!("{} {}", language.say(done), language.say(kind.name()).to_lowercase())
}
