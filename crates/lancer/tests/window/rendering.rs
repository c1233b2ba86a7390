//! Pictures at the chosen size.

use crate::sitting::{shows_a_scene, sit, sit_in};
use std::fs;

/// Small, with something of everything.
const SCENE: &str = "
format: 1
camera: {eye: [0, 2, 8], target: [0, 1, 0], fov: 40}
ambient: 0.2
background: '#87ceeb'
lights: [{position: [4, 6, 4], intensity: 200}]
materials:
  floor: {color: [0.8, 0.7, 0.6]}
  mirror: {diffuse: 0.1, reflect: 0.8}
  glass: {ambient: 0.1, diffuse: 0.1, specular: 0.5, transmit: 0.8, reflect: 0.1}
objects:
  - {shape: plane, material: floor}
  - {shape: sphere, material: mirror, transform: [{translate: [-1.2, 1, 0]}]}
  - {shape: sphere, material: glass, transform: [{translate: [1.2, 1, 0.5]}]}
render: {width: 160, height: 120, depth: 3, samples: 2, ao: {samples: 8}}
";

#[test]
fn a_saved_render_has_the_bytes_of_lancer_render() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.yaml"), SCENE).unwrap();
    sit_in(directory, "render", ["scene.yaml"], |sitting| {
        sitting.wait_for_title("scene.yaml - Lancer")?;
        let live = sitting.see("live")?;
        sitting.keys(&["F12"])?;
        sitting.wait_for_change(&live)?;
        assert!(shows_a_scene(&sitting.see("rendered")?));
        sitting.command("Save picture")?;
        sitting.see("asked-for-a-name")?;
        let saved = sitting.path("saved.png");
        sitting.enter(&saved.to_string_lossy())?;
        sitting.see("saved")?;
        sitting.lancer("render scene.yaml -o rendered.png");
        assert!(fs::read(saved)? == fs::read(sitting.path("rendered.png"))?);
        Ok(())
    });
}

#[test]
fn a_long_render_is_cancelled() {
    let directory = tempfile::tempdir().unwrap();
    let long = SCENE
        .replace("width: 160, height: 120", "width: 4000, height: 3000")
        .replace("samples: 8", "samples: 4096");
    fs::write(directory.path().join("long.yaml"), long).unwrap();
    sit_in(directory, "cancel", ["long.yaml"], |sitting| {
        sitting.wait_for_title("long.yaml - Lancer")?;
        Ok(())
    });
    let _ = sit::<&str>;
}
