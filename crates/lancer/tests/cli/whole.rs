//! Built-in scenes and models as files that stand alone, which make the same pictures.

use crate::sandbox::{MODEL, Picture, Sandbox, read_exr};
use lancer_io::scene_file::write_whole;
use lancer_io::{LoadOptions, load};

/// Small, but with the terms that a scene has.
const SIZE: &str = "--width 40 --height 30 --samples 1 --ao 2";

/// The pixels: what the file says of its scene differs, as it should.
fn picture(sandbox: &Sandbox, scene: &str) -> Picture<f32> {
    sandbox.ok(&format!("render {scene} -o picture.exr {SIZE}"));
    read_exr(&sandbox.path("picture.exr"))
}

#[test]
fn each_built_in_scene_makes_the_same_picture_from_a_file() {
    let sandbox = Sandbox::new();
    for builtin in lancer_gallery::SCENES {
        let name = builtin.name();
        let file = format!("{name}.yaml");
        write_whole(&builtin.build(), &sandbox.path(&file)).unwrap_or_else(|error| panic!("{error}"));
        assert!(picture(&sandbox, name) == picture(&sandbox, &file), "{name}");
    }
}

#[test]
fn a_model_makes_the_same_picture_from_a_file_of_its_own() {
    let sandbox = Sandbox::new();
    let far = MODEL.replace("v 1 ", "v 1001.1 ").replace("v 0 ", "v 1000.1 ");
    sandbox.write("model.obj", far);
    let shown = load(&sandbox.path("model.obj"), &LoadOptions::default()).unwrap().scene;
    write_whole(&shown, &sandbox.path("model.json")).unwrap();
    assert_eq!(picture(&sandbox, "model.obj"), picture(&sandbox, "model.json"));
}
