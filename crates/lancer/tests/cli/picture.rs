//! The flags that decide the pixels.

use crate::sandbox::{MODEL, SCENE, Sandbox, read_png};

#[test]
fn width_and_height_size_the_picture() {
    let sandbox = Sandbox::new();
    let picture = sandbox.png("--width 7 --height 5");
    assert_eq!((picture.width, picture.height), (7, 5));
    let picture = sandbox.png("--width 7");
    assert_eq!((picture.width, picture.height), (7, 16));
    let picture = sandbox.png("--width 1 --height 1");
    assert_eq!((picture.width, picture.height), (1, 1));
}

#[test]
fn without_flags_the_settings_are_the_scenes() {
    let sandbox = Sandbox::new();
    let told = sandbox.json("render scene.yaml --json");
    assert_eq!(told["image"]["width"], 24);
    assert_eq!(told["image"]["height"], 16);
    assert_eq!(told["samples"], 1);
    assert_eq!(told["depth"], 3);
}

#[test]
fn samples_traces_n_by_n_camera_rays_a_pixel() {
    let sandbox = Sandbox::new();
    let told = sandbox.json("render scene.yaml --samples 3 --json");
    assert_eq!(told["rays"]["primary"], 24 * 16 * 9);
    assert_ne!(sandbox.exr("--samples 3"), sandbox.exr("--samples 1"));
}

#[test]
fn depth_0_follows_no_reflection_and_no_refraction() {
    let sandbox = Sandbox::new();
    let local = sandbox.json("render scene.yaml --depth 0 --json");
    assert_eq!(local["rays"]["reflection"], 0);
    assert_eq!(local["rays"]["refraction"], 0);
    let recursive = sandbox.json("render scene.yaml --depth 2 --json");
    assert!(recursive["rays"]["reflection"].as_u64().unwrap() > 0);
    assert!(recursive["rays"]["refraction"].as_u64().unwrap() > 0);
    assert_ne!(sandbox.exr("--depth 0"), sandbox.exr("--depth 2"));
}

#[test]
fn ao_traces_rays_that_only_its_distance_lets_occlude() {
    let sandbox = Sandbox::new();
    let off = sandbox.json("render scene.yaml --json");
    assert_eq!(off["rays"]["ao"], 0);
    let on = sandbox.json("render scene.yaml --ao 16 --json");
    assert!(on["rays"]["ao"].as_u64().unwrap() > 0);
    let (near, far) = (sandbox.exr("--ao 16 --ao-distance 1e-3"), sandbox.exr("--ao 16 --ao-distance 100"));
    assert_ne!(near, far);
    let brightness = |pixels: &[[f32; 3]]| pixels.iter().flatten().sum::<f32>();
    assert!(brightness(&near.pixels) > brightness(&far.pixels));
}

#[test]
fn camera_takes_the_picture_of_the_named_one() {
    let sandbox = Sandbox::new();
    let top = sandbox.exr("--camera top");
    assert_ne!(top, sandbox.exr(""));
    let main = "camera: {eye: [0, 2, 8], target: [0, 1, 0], fov: 40}";
    assert!(SCENE.contains(main));
    let same = "camera: {eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], fov: 50}";
    sandbox.write("scene.yaml", SCENE.replace(main, same));
    assert_eq!(sandbox.exr(""), top);
}

#[test]
fn a_region_has_the_pixels_of_the_whole_picture() {
    let sandbox = Sandbox::new();
    let flags = "--samples 2 --ao 4";
    let whole = sandbox.exr(flags);
    for (x, y, width, height) in [(5, 3, 9, 7), (0, 0, 24, 16), (23, 15, 1, 1)] {
        let part = sandbox.exr(&format!("{flags} --region {x},{y},{width},{height}"));
        assert_eq!(part, whole.crop(x, y, width, height));
    }
}

#[test]
fn exposure_multiplies_linear_values_by_powers_of_2() {
    let sandbox = Sandbox::new();
    let plain = sandbox.exr("");
    let times = |stops: &str, factor: f32| {
        let exposed = sandbox.exr(&format!("--exposure {stops}"));
        let expected = plain.pixels.iter().map(|pixel| pixel.map(|channel| channel * factor));
        assert!(exposed.pixels.iter().copied().eq(expected), "{stops} stops");
    };
    times("1", 2.0);
    times("-2", 0.25);
    times("0", 1.0);
    assert_ne!(sandbox.png("--exposure 1"), sandbox.png(""));
}

#[test]
fn exposure_overrides_the_scenes() {
    let sandbox = Sandbox::new();
    let (plain, brighter) = (sandbox.exr(""), sandbox.exr("--exposure 1"));
    let set = "--set render.exposure=1";
    assert_eq!(sandbox.exr(set), brighter);
    assert_eq!(sandbox.exr(&format!("{set} --exposure 0")), plain);
}

#[test]
fn shadows_reflection_and_refraction_are_turned_off_by_flags_and_by_the_scene_alike() {
    let sandbox = Sandbox::new();
    let plain = sandbox.exr("");
    for (name, kind) in [("shadows", "shadow"), ("reflection", "reflection"), ("refraction", "refraction")] {
        let without = sandbox.exr(&format!("--no-{name}"));
        assert_ne!(without, plain, "{name}");
        assert_eq!(without, sandbox.exr(&format!("--set render.{name}=false")), "{name}");
        let rays = sandbox.json(&format!("render scene.yaml --no-{name} --json"))["rays"].clone();
        assert_eq!(rays[kind], 0, "{rays}");
    }
    let local = sandbox.exr("--no-reflection --no-refraction");
    assert_eq!(local, sandbox.exr("--depth 0"));
}

#[test]
fn what_is_hidden_is_not_drawn() {
    let sandbox = Sandbox::new();
    let hidden = sandbox.exr("--set objects.1.hidden=true");
    let line = "  - {shape: sphere, material: mirror, transform: [{translate: [-1.2, 1, 0]}]}\n";
    assert!(SCENE.contains(line));
    sandbox.write("scene.yaml", SCENE.replace(line, ""));
    assert_eq!(sandbox.exr(""), hidden);
}

#[test]
fn set_changes_the_scene_as_if_the_file_said_so() {
    let sandbox = Sandbox::new();
    let set = sandbox.exr("--set camera.fov=60 --set materials.floor.diffuse=0.5");
    assert_ne!(set, sandbox.exr(""));
    let written = SCENE
        .replace("target: [0, 1, 0], fov: 40", "target: [0, 1, 0], fov: 60")
        .replace("floor: {", "floor: {diffuse: 0.5, ");
    sandbox.write("scene.yaml", written);
    assert_eq!(sandbox.exr(""), set);
}

#[test]
fn flags_go_before_set() {
    let sandbox = Sandbox::new();
    assert_eq!(sandbox.png("--set render.width=9").width, 9);
    assert_eq!(sandbox.png("--set render.width=9 --width 5").width, 5);
}

#[test]
fn set_changes_built_in_scenes_too() {
    let sandbox = Sandbox::new();
    let render = |flags: &str| {
        sandbox.ok(&format!("render --width 16 --height 12 --samples 1 --ao 0 -o a.png {flags}"));
        read_png(&sandbox.path("a.png"))
    };
    assert_ne!(render(""), render("--set camera.fov=90"));
}

#[test]
fn a_model_alone_makes_a_picture_that_shows_something() {
    let sandbox = Sandbox::new();
    sandbox.ok("render model.obj --width 24 --height 16 --samples 1 --ao 0");
    let picture = read_png(&sandbox.path("model.png"));
    let center = picture.pixels[8 * 24 + 12];
    assert_ne!(center, picture.pixels[0], "the model is not in the middle");
    assert!(center.iter().any(|&channel| channel > 20), "the model is black");
}

#[test]
fn files_outside_of_the_scenes_directory_are_opened_only_where_allowed() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("scenes")).unwrap();
    sandbox.write("outside.obj", MODEL);
    let scene =
        "format: 1\nambient: 1\nobjects: [{shape: {mesh: ../outside.obj}}]\nrender: {width: 4, height: 4}\n";
    sandbox.write("scenes/s.yaml", scene);
    assert!(sandbox.fails(3, "render scenes/s.yaml").contains("outside"));
    sandbox.ok("render scenes/s.yaml --allow-outside");
    sandbox.fails(3, "check scenes/s.yaml");
    sandbox.ok("check scenes/s.yaml --allow-outside");
    sandbox.fails(3, "info scenes/s.yaml");
    sandbox.ok("info scenes/s.yaml --allow-outside");
}
