//! From what a file says to a scene: names are looked up, assets placed, models and images fetched.
//!
//! In: a [`SceneFile`], whose values are in their ranges. Out: a [`Scene`], and every problem found on the way,
//! after each of which it goes on with the rest.

mod materials;
mod models;
mod names;
mod nodes;
mod use_order;

pub(crate) use materials::material;

use super::assets::Assets;
use super::deserialize::Spanned;
use super::model::{CameraFile, LightFile, Named, SceneFile};
use super::syntax::{Node as Syntax, Problem};
use crate::diagnostics::{Diagnostic, LoadError};
use lancer_core::camera::Camera;
use lancer_core::scene::{Light, MaterialId, Scene};
use materials::Textures;
use models::Models;
use names::Names;
use nodes::Variants;
use std::path::{Path, PathBuf};

/// What was built, sound only where there are no problems.
pub(crate) struct Built {
    pub(crate) scene: Scene,
    /// Those from before, too.
    pub(crate) problems: Vec<Problem>,
    pub(crate) warnings: Vec<Warning>,
}

/// Something odd.
pub(crate) enum Warning {
    /// In the scene file.
    Here(Problem),
    /// In a file that it refers to.
    Elsewhere(Diagnostic),
}

/// Builds the scene of the file at `path`, whose syntax tree is `root`; `problems` are those found in it so far.
pub(crate) fn build(
    file: &SceneFile,
    root: &Syntax,
    path: &Path,
    assets: &mut dyn Assets,
    problems: Vec<Problem>,
) -> Built {
    let mut builder = Builder {
        scene: scene_without_objects(file),
        source: Source { path, assets },
        materials: Names::new("material", root, "materials"),
        assets: Names::new("asset", root, "assets"),
        depends_on_material_above: false,
        textures: Textures::default(),
        models: Models::default(),
        problems,
        warnings: Vec::new(),
    };
    builder.add_materials(&file.materials);
    builder.add_assets(&file.assets);
    for object in &file.objects {
        let node = builder.node(object, false);
        builder.scene.add(node);
    }
    builder.finish(root)
}

struct Builder<'a> {
    scene: Scene,
    source: Source<'a>,
    materials: Names<'a, MaterialId>,
    /// `None` while it is not built, and for good where it holds itself.
    assets: Names<'a, Option<Variants>>,
    /// Whether what was built since this was last cleared would be another if it inherited a material.
    depends_on_material_above: bool,
    textures: Textures,
    models: Models,
    problems: Vec<Problem>,
    warnings: Vec<Warning>,
}

impl Builder<'_> {
    fn finish(mut self, root: &Syntax) -> Built {
        if self.problems.is_empty() && draws_nothing(&self.scene) {
            let place = root.get("objects").map_or(root.place, |objects| objects.place);
            let hint = "list what is drawn under `objects`; `assets` are drawn where an object has `use`";
            self.problems.push(Problem::new(place, "there is nothing to draw").with_hint(hint));
        }
        let unused = self.materials.unused().chain(self.assets.unused());
        self.warnings.extend(unused.map(Warning::Here));
        if self.scene.lights.is_empty() && self.scene.ambient.is_black() {
            let warning = Problem::new(root.place, "there is no light: neither `lights` nor `ambient`");
            self.warnings.push(Warning::Here(warning));
        }
        Built { scene: self.scene, problems: self.problems, warnings: self.warnings }
    }
}

/// Everything of a scene that does not need to be looked up.
fn scene_without_objects(file: &SceneFile) -> Scene {
    let mut scene = Scene::new(&file.name);
    scene.camera = file.camera.0;
    scene.cameras = cameras(&file.cameras);
    scene.ambient = file.ambient.0;
    scene.background = file.background.0;
    scene.lights = lights(&file.lights);
    scene.settings = file.render.settings;
    scene.tone = file.render.tone;
    scene
}

pub(crate) fn cameras(cameras: &Named<CameraFile>) -> Vec<(String, Camera)> {
    cameras.0.iter().map(|(name, camera)| (name.value.clone(), camera.0)).collect()
}

pub(crate) fn lights(lights: &[LightFile]) -> Vec<Light> {
    lights
        .iter()
        .map(|light| Light {
            name: light.name.clone(),
            position: light.position.0,
            intensity: light.intensity.get(),
        })
        .collect()
}

fn draws_nothing(scene: &Scene) -> bool {
    let mut seen = vec![false; scene.nodes().len()];
    let mut waiting = scene.roots().to_vec();
    while let Some(id) = waiting.pop() {
        let node = scene.node(id);
        if node.shape.is_some() {
            return false;
        }
        if !std::mem::replace(&mut seen[id.index()], true) {
            waiting.extend(&node.children);
        }
    }
    true
}

/// Where the things come from that a scene file only refers to.
struct Source<'a> {
    path: &'a Path,
    assets: &'a mut dyn Assets,
}

impl Source<'_> {
    /// The file that a reference names, by a path that is the same for all references to it.
    fn resolve(&self, reference: &Spanned<String>) -> Result<PathBuf, Problem> {
        let found = self.assets.resolve(self.path, &reference.value);
        let path = found.map_err(|message| Problem::new(reference.place, message))?;
        Ok(path.canonicalize().unwrap_or(path))
    }
}

/// The errors of a file, told where it is referred to.
fn problems_of_reference(reference: &Spanned<String>, error: &LoadError) -> Vec<Problem> {
    let told = |diagnostic: &Diagnostic| {
        let file = diagnostic.file.display();
        let place = diagnostic.location.map_or(String::new(), |at| format!(":{}:{}", at.line, at.column));
        let message = format!("cannot load `{}`: {file}{place}: {}", reference.value, diagnostic.message);
        Problem { place: reference.place, message, hint: diagnostic.hint.clone() }
    };
    error.diagnostics.iter().map(told).collect()
}
