//! Pictures at the chosen size.

use crate::sitting::{shows_a_scene, sit};
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
    sit("render", &["scene.yaml"], &[("scene.yaml", SCENE)], |sitting| {
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
fn a_long_render_is_cancelled_and_the_view_is_back() {
    // Fifty times as many pixels as the view has: minutes.
    let long = SCENE.replace("width: 160, height: 120", "width: 4000, height: 3000");
    sit("cancel", &["long.yaml"], &[("long.yaml", &long)], |sitting| {
        sitting.wait_for_title("long.yaml - Lancer")?;
        let live = sitting.see("live")?;
        sitting.keys(&["F12"])?;
        sitting.wait_for_change(&live)?;
        sitting.keep("rendering")?;
        sitting.keys(&["Escape"])?;
        assert!(sitting.see("cancelled")? == live);
        Ok(())
    });
}
