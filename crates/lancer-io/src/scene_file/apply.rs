//! Overrides on scenes that come from no scene file.
//!
//! What a scene says, but for its geometry, is written as a syntax tree; that is edited and read as a file's would
//! be, and what was edited is put back.

use super::build::{cameras, lights, material};
use super::deserialize;
use super::export::export;
use super::model::{MaterialFile, SceneFile};
use super::overrides::{self, Override};
use super::report::Report;
use super::syntax::{Node, Origin, Place, Problem};
use crate::diagnostics::{LoadError, name_hint};
use crate::limits::Limits;
use lancer_core::scene::{Material, Scene, Texture};
use std::rc::Rc;

/// Puts overrides into a scene that was made by code, or by a model alone.
///
/// Paths are those of a scene file: `name`, `camera`, `cameras`, `ambient`, `background`, `lights`, `materials`
/// and `render`. Objects and assets can be reached in scene files only, and so can images.
///
/// ```
/// use lancer_core::scene::Scene;
/// use lancer_io::scene_file::apply_overrides;
/// let mut scene = Scene::new("built in");
/// apply_overrides(&mut scene, &["render.ao.samples=16".parse()?])?;
/// assert_eq!(scene.settings.ao.samples, 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// All that is wrong with the overrides; the scene is as it was.
pub fn apply_overrides(scene: &mut Scene, overrides: &[Override]) -> Result<(), LoadError> {
    let limits = Limits::default();
    let report = Report::of_overrides(overrides, &limits);
    let original = export(scene);
    let mut root = Rc::clone(&original);

    let mut problems = unreachable_sections(overrides);
    if problems.is_empty() {
        problems = overrides::apply(&mut root, overrides, &limits);
    }
    let (file, unread) = deserialize::read::<SceneFile>(&root, report.most);
    problems.extend(unread);
    let Some(file) = file.filter(|_| problems.is_empty()) else { return Err(report.error(problems)) };

    let edits = Edits { original: &original, edited: &root };
    let materials = edits.materials(scene, &file).map_err(|problems| report.error(problems))?;
    edits.put_back(scene, &file);
    for (index, material) in materials {
        scene.materials_mut()[index] = material;
    }
    Ok(())
}

fn unreachable_sections(overrides: &[Override]) -> Vec<Problem> {
    (0..)
        .zip(overrides)
        .filter(|(_, edit)| matches!(edit.section(), "objects" | "assets"))
        .map(|(index, edit)| {
            let message = format!("`{}` can be set in scene files only", edit.section());
            Problem::new(Place::start_of(Origin::Override(index)), message)
        })
        .collect()
}

/// A tree before and after. An edit parts all nodes on its path from what they were; the others are still shared.
struct Edits<'a> {
    original: &'a Node,
    edited: &'a Node,
}

impl Edits<'_> {
    /// Whether the section, or the entry of that name in it, was edited.
    fn touch(&self, path: &[&str]) -> bool {
        let find = |root| path.iter().try_fold(root, |node: &Node, key| node.get(key));
        match (find(self.original), find(self.edited)) {
            (Some(before), Some(after)) => !std::ptr::eq(before, after),
            (before, after) => before.is_some() != after.is_some(),
        }
    }

    fn put_back(&self, scene: &mut Scene, file: &SceneFile) {
        if self.touch(&["name"]) {
            scene.name.clone_from(&file.name);
        }
        if self.touch(&["camera"]) {
            scene.camera = file.camera.0;
        }
        if self.touch(&["cameras"]) {
            scene.cameras = cameras(&file.cameras);
        }
        if self.touch(&["ambient"]) {
            scene.ambient = file.ambient.0;
        }
        if self.touch(&["background"]) {
            scene.background = file.background.0;
        }
        if self.touch(&["lights"]) {
            scene.lights = lights(&file.lights);
        }
        if self.touch(&["render"]) {
            scene.settings = file.render.settings;
            scene.tone = file.render.tone;
        }
    }

    /// The materials that were edited, by their place in the scene.
    fn materials(&self, scene: &Scene, file: &SceneFile) -> Result<Vec<(usize, Material)>, Vec<Problem>> {
        let mut edited = Vec::new();
        let mut problems = Vec::new();
        for (name, file) in &file.materials.0 {
            if !self.touch(&["materials", &name.value]) {
                continue;
            }
            let before = edited.len();
            for (index, old) in scene.materials().iter().enumerate().filter(|(_, old)| old.name == name.value)
            {
                edited.push((index, self.material(old, file, &mut problems)));
            }
            if edited.len() == before {
                let known = scene.materials().iter().map(|material| material.name.as_str());
                let problem = Problem::new(name.place, format!("unknown material `{}`", name.value));
                problems.push(match name_hint(&name.value, known.filter(|name| !name.is_empty())) {
                    Some(hint) => problem.with_hint(hint),
                    None => problem,
                });
            }
        }
        if problems.is_empty() { Ok(edited) } else { Err(problems) }
    }

    fn material(&self, old: &Material, file: &MaterialFile, problems: &mut Vec<Problem>) -> Material {
        let mut new = material(&old.name, file, |image| {
            problems.push(Problem::new(image.place, "an image can be set in scene files only"));
            None
        });
        // An image has no reference to be written as; it stays, unless something else was put in its place.
        let keeps_image =
            matches!(old.color, Texture::Image { .. }) && !self.touch(&["materials", &old.name, "color"]);
        if keeps_image {
            new.color = old.color.clone();
        }
        new
    }
}
