//! Whatever a user names, read into a scene: the kind of a file is told by its extension.

use crate::diagnostics::{Diagnostic, LoadError};
use crate::image::load_texture;
use crate::limits::Limits;
use crate::model::{self, ModelOptions};
use crate::progress::ReadProgress;
use crate::resolver::Resolver;
use crate::scene_file::{self, Assets, Origins, Override};
use crate::showcase;
use lancer_core::scene::{ImageTexture, Scene};
use lancer_core::world::World;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a file is read.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// How much it may ask for.
    pub limits: Limits,
    /// Whether it may refer to files outside of its own directory.
    pub allow_outside: bool,
    /// How its models are read, where a scene file does not say it of one.
    pub model: ModelOptions,
    /// Hears how far the reading of each model is.
    pub progress: ReadProgress,
    /// What is to be read in place of what it says.
    pub overrides: Vec<Override>,
}

/// A scene, and what its author should know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What is odd but no error, in the order of the places.
    pub warnings: Vec<Diagnostic>,
    /// Which of its parts the scene file itself holds; none where it is no scene file.
    pub origins: Origins,
}

impl From<Scene> for Loaded {
    /// A scene that comes from no file.
    fn from(scene: Scene) -> Self {
        Self { scene, warnings: Vec::new(), origins: Origins::default() }
    }
}

/// The extensions of scene files.
pub const SCENE_EXTENSIONS: [&str; 3] = ["yaml", "yml", "json"];

/// Reads a scene file, or a model, which gets a camera that frames it, lights and a ground.
///
/// # Errors
/// All that is wrong with the file and with what it refers to.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let mut resolver = Resolver::for_file(path, options.allow_outside, options.limits);
    resolver.progress = options.progress.clone();
    load_with(path, &resolver, options)
}

/// As [`load`], from what `resolver` opens: files in memory, say. The limits, and what may be opened, are the
/// resolver's, not those of `options`.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, resolver: &Resolver, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let loaded = read(path, resolver, options)?;
    let most = resolver.limits.objects;
    // What is wrong with the scene's tree is told when it is compiled.
    match World::count_objects(&loaded.scene) {
        Ok(count) if count > most => {
            let message = format!("the scene draws {count} objects, more than {most}");
            Err(Diagnostic::new(path, message).with_hint("--limit objects=N allows more").into())
        }
        _ => Ok(loaded),
    }
}

fn read(path: &Path, resolver: &Resolver, options: &LoadOptions) -> Result<Loaded, LoadError> {
    if is_scene_file(path) {
        let bytes = resolver.read(path)?;
        let mut assets = Files { resolver: resolver.clone(), options: options.model };
        return scene_file::read(path, &bytes, &options.overrides, &mut assets, &resolver.limits);
    }
    if !model::is_model_file(path) {
        return Err(unknown_kind(path));
    }
    let mut model = model::load(path, resolver, &options.model)?;
    let mut warnings = std::mem::take(&mut model.warnings);
    let mut scene = showcase::scene_of_model(model);
    if scene.camera.frame().is_err() {
        return Err(LoadError::new(path, "reaches further than numbers do, so no camera can see it"));
    }
    if scene.tone.exposure != 0.0 {
        let stops = scene.tone.exposure;
        let message = format!("its own lights are far from 1, so the picture is exposed by {stops:+} stops");
        warnings.push(Diagnostic::new(path, message).with_hint("--exposure chooses otherwise"));
    }
    scene_file::apply_overrides(&mut scene, &options.overrides)?;
    Ok(Loaded { warnings, ..Loaded::from(scene) })
}

/// Whether a file is a scene file, by its name.
pub fn is_scene_file(path: &Path) -> bool {
    path.extension()
        .is_some_and(|found| SCENE_EXTENSIONS.iter().any(|known| found.eq_ignore_ascii_case(known)))
}

fn unknown_kind(path: &Path) -> LoadError {
    let known = SCENE_EXTENSIONS.into_iter().chain(model::model_extensions());
    let known = known.map(|known| format!(".{known}")).collect::<Vec<_>>();
    let hint = format!("the kind of a file is told by its name: {}", known.join(", "));
    Diagnostic::new(path, "is neither a scene file nor a model of a known format").with_hint(hint).into()
}

/// The models and images of a scene file, from disk.
struct Files {
    resolver: Resolver,
    options: ModelOptions,
}

impl Assets for Files {
    fn resolve(&self, from: &Path, reference: &str) -> Result<PathBuf, String> {
        self.resolver.resolve(from, reference)
    }

    fn model(
        &mut self,
        scene: &mut Scene,
        path: &Path,
        options: &ModelOptions,
    ) -> Result<scene_file::Model, LoadError> {
        let options = ModelOptions { crease: options.crease.or(self.options.crease) };
        let mut model = model::load(path, &self.resolver, &options)?;
        let warnings = std::mem::take(&mut model.warnings);
        let node = model.insert_into(scene);
        Ok(scene_file::Model { root: scene.insert(node), warnings })
    }

    fn texture(&mut self, path: &Path) -> Result<Arc<ImageTexture>, LoadError> {
        load_texture(path, &self.resolver)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(name: &str, text: &str, limits: Limits) -> String {
        let resolver = Resolver::in_memory([(name.into(), text.as_bytes().to_vec())], limits);
        load_with(name.as_ref(), &resolver, &LoadOptions::default()).unwrap_err().to_string()
    }

    #[test]
    fn scenes_draw_no_more_objects_than_allowed() {
        let assets = (0..21).map(|i| {
            let below = format!("{{use: a{}}}", i + 1);
            format!("  a{i}: {{children: [{below}, {below}]}}\n")
        });
        let assets = assets.collect::<String>();
        let text = format!("format: 1\nassets:\n{assets}  a21: {{shape: cube}}\nobjects: [{{use: a0}}]\n");
        let message = "s.yaml: the scene draws 2097152 objects, more than 1048576\n\
                       hint: --limit objects=N allows more";
        assert_eq!(error_of("s.yaml", &text, Limits::default()), message);
        let resolver = Resolver::in_memory(
            [("s.yaml".into(), text.into_bytes())],
            Limits { objects: 1 << 21, ..Limits::default() },
        );
        assert!(load_with("s.yaml".as_ref(), &resolver, &LoadOptions::default()).is_ok());
    }

    #[test]
    fn a_model_beyond_all_numbers_is_refused() {
        let uri = "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"children": [1], "scale": [1e100, 1e100, 1e100]}},
            {{"mesh": 0, "scale": [1e100, 1e100, 1e100]}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"byteLength": 36, "uri": "{uri}"}}]}}"#
        );
        let error = error_of("a.gltf", &text, Limits::default());
        assert_eq!(error, "a.gltf: reaches further than numbers do, so no camera can see it");
    }
}
