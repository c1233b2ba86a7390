//! What the documents and the examples show is what the reader reads.

use lancer_core::world::{CompileOptions, World};
use lancer_io::limits::Limits;
use lancer_io::{LoadOptions, load, scene_file};
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// No scene in these documents refers to a model or an image.
struct NoAssets;

impl scene_file::Assets for NoAssets {
    fn resolve(&self, _: &Path, reference: &str) -> Result<PathBuf, String> {
        Err(format!("`{reference}` is not there"))
    }

    fn model(
        &mut self,
        _: &mut lancer_core::scene::Scene,
        path: &Path,
        _: &lancer_io::model::ModelOptions,
    ) -> Result<scene_file::Model, lancer_io::diagnostics::LoadError> {
        unreachable!("{} was never resolved", path.display())
    }

    fn texture(
        &mut self,
        path: &Path,
    ) -> Result<std::sync::Arc<lancer_core::scene::ImageTexture>, lancer_io::diagnostics::LoadError> {
        unreachable!("{} was never resolved", path.display())
    }
}

#[test]
fn the_scene_in_the_guide_reads_without_a_warning_and_compiles() {
    let path = repository().join("docs/scene-file.md");
    let guide = std::fs::read_to_string(&path).unwrap();
    let (_, rest) = guide.split_once("```yaml\n").unwrap();
    let (yaml, _) = rest.split_once("```").unwrap();
    let loaded = scene_file::read(&path, yaml.as_bytes(), &[], &mut NoAssets, &Limits::default())
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, []);
    World::compile(&loaded.scene, &CompileOptions::default()).unwrap();
}

#[test]
fn the_fault_in_the_guide_is_told_as_the_guide_says() {
    let guide = std::fs::read_to_string(repository().join("docs/scene-file.md")).unwrap();
    let (_, rest) = guide.split_once("```text\n").unwrap();
    let (told, _) = rest.split_once("```").unwrap();
    let yaml = "format: 1\nname: Shiny\nlights: [{position: [4, 6, 4], intensity: 300}]\nobjects:\n- \
                {shape: sphere, material: brass}\nmaterials:\n  brass:\n    metallic: 1\n    shinyness: 80\n";
    let error =
        scene_file::read(Path::new("scene.yaml"), yaml.as_bytes(), &[], &mut NoAssets, &Limits::default())
            .unwrap_err();
    assert_eq!(format!("{error}\n"), told);
}

#[test]
fn the_example_scenes_read_without_a_warning_and_compile() {
    let mut found = 0;
    for entry in std::fs::read_dir(repository().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        let loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.warnings, [], "{}", path.display());
        World::compile(&loaded.scene, &CompileOptions::default()).unwrap();
        found += 1;
    }
    assert!(found >= 2);
}
