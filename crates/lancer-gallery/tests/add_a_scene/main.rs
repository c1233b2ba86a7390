//! The scene that `docs/add-a-scene.md` has its reader write: that it is what stands there, and that it works.

mod snowman;

use lancer_core::render::{Control, render};
use lancer_core::scene::Settings;
use lancer_core::world::{CompileOptions, World};
// Where a scene of the gallery itself finds the trait: at the root of its crate.
use lancer_gallery::BuiltinScene;

const TUTORIAL: &str = include_str!("../../../../docs/add-a-scene.md");

/// The list as the tutorial has it grow.
const SCENES: &[&dyn BuiltinScene] = &[&snowman::Snowman];

#[test]
fn the_tutorial_prints_the_file_that_is_tested_here() {
    let (_, from_code) = TUTORIAL.split_once("```rust\n").expect("the tutorial has a block of Rust");
    let (code, _) = from_code.split_once("```").expect("the block has an end");
    assert_eq!(code, include_str!("snowman.rs"));
}

#[test]
fn a_scene_of_ones_own_renders() {
    let scene = SCENES[0].build();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let settings = Settings { width: 40, height: 30, samples: 1, ..scene.settings };
    let image = render(&world, &scene.camera, &settings, None, &Control::default()).unwrap().image;

    let sky = scene.background.to_array().map(|channel| channel as f32);
    assert_eq!(image.pixel(0, 0), sky);
    let [red, _, blue] = image.pixel(14, 20);
    assert!(red > blue, "the low sun warms the left of the belly");
}
