//! `--set PATH=VALUE`, in files and on scenes made by code.

use crate::common::{load_bytes, vector, wood};
use crate::whole::EXAMPLE;
use lancer_core::Rgb;
use lancer_core::scene::{Light, Material, Scene, Texture};
use lancer_io::scene_file::{Override, apply_overrides};

fn messages(edits: &[&str]) -> Vec<String> {
    let error = load_bytes(EXAMPLE.as_bytes(), edits).unwrap_err();
    error.diagnostics.iter().map(ToString::to_string).collect()
}

#[test]
fn overrides_edit_what_the_file_says() {
    let edits = [
        "materials.glass.ior=1.3",
        "lights.0.intensity=200",
        "render.ao.samples=16",
        "objects.0.transform.0.scale=2",
        "objects.group.children.1.shape=cube",
        "background=#ff0000",
        "cameras.side={eye: [5, 0, 0]}",
    ];
    let scene = load_bytes(EXAMPLE.as_bytes(), &edits).unwrap().scene;
    assert_eq!(scene.materials()[0].ior, 1.3);
    assert_eq!(scene.lights[0].intensity, Rgb::grey(200.0));
    assert_eq!(scene.settings.ao.samples, 16);
    assert_eq!(scene.node(scene.roots()[0]).transform.point(vector(0.0, 1.0, 0.0)), vector(0.0, 3.0, 0.0));
    assert_eq!(scene.background, Rgb::new(1.0, 0.0, 0.0));
    assert_eq!(scene.camera_named(Some("side")).unwrap().eye, vector(5.0, 0.0, 0.0));
}

#[test]
fn errors_in_overrides_name_the_override() {
    assert_eq!(
        messages(&["materials.glass.ior=x"]),
        ["--set materials.glass.ior=x: ior is the text `x`, must be a number above 0"]
    );
    assert_eq!(
        messages(&["lights.1.intensity=3", "objects.0.shape=spheer"]),
        [
            "--set lights.1.intensity=3: `lights` has one item, 0, but no `1`",
            "--set objects.0.shape=spheer: shape is `spheer`, which is not known\nhint: did you mean `sphere`?",
        ]
    );
    assert_eq!(
        messages(&["materials.glass.iro=1"]),
        ["--set materials.glass.iro=1: unknown key `iro`\nhint: did you mean `ior`?"]
    );
    assert!(messages(&["name=[1, "])[0].starts_with("--set name=[1,: "));
    assert!(messages(&["lights=oops"])[0].contains("lights is the text `oops`, must be a list"));
}

fn made_by_code() -> Scene {
    let mut scene = Scene::new("built in");
    scene.add_material(Material { color: wood().into(), ..Material::named("wood") });
    scene.add_material(Material::named("Material.001"));
    scene.add_material(Material::default());
    scene.lights.push(Light { name: "sun".into(), position: vector(1.0, 2.0, 3.0), intensity: Rgb::WHITE });
    scene
}

fn apply(edits: &[&str]) -> Result<Scene, String> {
    let mut scene = made_by_code();
    let edits = edits.iter().map(|edit| edit.parse().unwrap()).collect::<Vec<Override>>();
    apply_overrides(&mut scene, &edits).map(|()| scene).map_err(|error| error.to_string())
}

#[test]
fn a_scene_made_by_code_takes_overrides_and_keeps_the_rest() {
    assert_eq!(apply(&[]).unwrap(), made_by_code());

    let edits = [
        "camera.fov=30",
        "lights.sun.intensity=[1, 2, 3]",
        "materials.Material.001.ior=1.3",
        "materials.wood.reflect=0.5",
        "render.width=100",
        "name=other",
    ];
    let scene = apply(&edits).unwrap();
    let mut expected = made_by_code();
    expected.camera.fov = 30.0;
    expected.lights[0].intensity = Rgb::new(1.0, 2.0, 3.0);
    expected.materials_mut()[0].reflect = Rgb::grey(0.5);
    expected.materials_mut()[1].ior = 1.3;
    expected.settings.width = 100;
    expected.name = "other".into();
    assert_eq!(scene, expected);

    let scene = apply(&["materials.wood.color=0.5"]).unwrap();
    assert_eq!(scene.materials()[0].color, Texture::Solid(Rgb::grey(0.5)));
}

#[test]
fn what_a_scene_made_by_code_cannot_take_is_told() {
    assert_eq!(
        apply(&["objects.0.name=x"]).unwrap_err(),
        "--set objects.0.name=x: `objects` can be set in scene files only"
    );
    assert_eq!(
        apply(&["materials.wod.ior=2"]).unwrap_err(),
        "--set materials.wod.ior=2: unknown material `wod`\nhint: did you mean `wood`?"
    );
    assert_eq!(
        apply(&["materials.wood.color={image: a.png}"]).unwrap_err(),
        "--set materials.wood.color={image: a.png}: an image can be set in scene files only"
    );
    assert_eq!(
        apply(&["camera.target=[0, 0, 5]"]).unwrap_err(),
        "--set: the camera's eye and target are the same point, so it looks nowhere"
    );
}
