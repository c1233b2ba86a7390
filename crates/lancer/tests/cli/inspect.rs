//! `scenes`, `info` and `check`.

use crate::sandbox::{SCENE, Sandbox, text};

#[test]
fn scenes_are_listed_one_a_line_and_as_json() {
    let sandbox = Sandbox::new();
    let listed = text(&sandbox.ok("scenes").stdout);
    let told = sandbox.json("scenes --json");
    let told = told.as_array().unwrap();
    assert!(!told.is_empty());
    assert_eq!(listed.lines().count(), told.len());
    for (line, scene) in listed.lines().zip(told) {
        let (name, summary) = (scene["name"].as_str().unwrap(), scene["summary"].as_str().unwrap());
        assert!(line.starts_with(name) && line.ends_with(summary), "{line}");
    }
    assert!(told.iter().any(|scene| scene["name"] == "whitted"), "the default scene is not listed");
}

#[test]
fn every_listed_scene_passes_the_check() {
    let sandbox = Sandbox::new();
    for scene in sandbox.json("scenes --json").as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        assert!(text(&sandbox.ok(&format!("check {name}")).stdout).starts_with("ok: "), "{name}");
    }
}

#[test]
fn info_tells_what_a_scene_holds() {
    let sandbox = Sandbox::new();
    let told = text(&sandbox.ok("info scene.yaml").stdout);
    for part in ["Two balls", "floor, mirror, glass", "lights      1", "2: top", "24 x 16", "warnings    0"] {
        assert!(told.contains(part), "`{part}` is not in:\n{told}");
    }
}

#[test]
fn info_tells_programs_what_a_scene_holds() {
    let told = Sandbox::new().json("info scene.yaml --json");
    assert_eq!(told["name"], "Two balls");
    assert_eq!(told["objects"], 3);
    assert_eq!(told["materials"], serde_json::json!(["floor", "mirror", "glass"]));
    assert_eq!(told["lights"][0]["position"], serde_json::json!([4.0, 6.0, 4.0]));
    assert_eq!(told["lights"][0]["intensity"], serde_json::json!([200.0, 200.0, 200.0]));
    assert!(told["cameras"][0]["name"].is_null());
    assert_eq!(told["cameras"][1]["name"], "top");
    assert_eq!(told["cameras"][1]["fov"], 50.0);
    assert_eq!(told["picture"]["width"], 24);
    assert_eq!(told["picture"]["shadows"], true);
    assert_eq!(told["picture"]["exposure"], 0.0);
    let low = told["bounds"]["min"][0].as_f64().unwrap();
    assert!((low - -2.2).abs() < 1e-9, "{low}");
    assert_eq!(told["warnings"], serde_json::json!([]));
}

#[test]
fn info_tells_what_the_picture_leaves_out_and_how_bright_it_is() {
    let sandbox = Sandbox::new();
    let picture = "render: {shadows: false, refraction: false, exposure: 1.5, ";
    sandbox.write("scene.yaml", SCENE.replace("render: {", picture));
    let told = text(&sandbox.ok("info scene.yaml").stdout);
    assert!(told.contains("ambient occlusion off, no shadows, no refraction, exposure 1.5\n"), "{told}");
}

#[test]
fn info_tells_what_a_model_holds() {
    let told = Sandbox::new().json("info model.obj --json");
    assert_eq!(told["triangles"], 4);
    assert!(told["mesh_bytes"].as_u64().unwrap() >= 4 * 12 + 4 * 12);
    assert!(told["tree_nodes"].as_u64().unwrap() > 0);
    assert!(!told["lights"].as_array().unwrap().is_empty(), "a model alone is lit");
}

#[test]
fn info_of_a_scene_without_bounds_has_none() {
    let sandbox = Sandbox::new();
    sandbox.write("plane.yaml", "format: 1\nambient: 1\nobjects: [{shape: plane}]\n");
    assert!(sandbox.json("info plane.yaml --json")["bounds"].is_null());
    assert!(text(&sandbox.ok("info plane.yaml").stdout).contains("unbounded"));
}

#[test]
fn check_says_ok_and_renders_nothing() {
    let sandbox = Sandbox::new();
    let told = text(&sandbox.ok("check scene.yaml").stdout);
    assert_eq!(told, "ok: scene.yaml: 3 objects, 0 triangles, 3 materials, 1 light, 2 cameras\n");
    sandbox.ok("check model.obj");
    assert_eq!(sandbox.new_files(), [""; 0]);
}

#[test]
fn check_looks_at_cameras_that_nobody_asked_for() {
    let sandbox = Sandbox::new();
    sandbox.write("scene.yaml", SCENE.replace("up: [0, 0, -1]", "up: [0, 1, 0]"));
    assert!(sandbox.fails(3, "check scene.yaml").contains("top"));
}

#[test]
fn crease_smooths_models_where_the_scene_does_not_say_it_of_one() {
    let sandbox = Sandbox::new();
    let mesh_bytes =
        |line: &str| sandbox.json(&format!("info --json {line}"))["mesh_bytes"].as_u64().unwrap();
    let facets = mesh_bytes("model.obj");
    let smooth = mesh_bytes("model.obj --crease 180");
    assert_eq!(smooth - facets, 4 * 12, "a normal for each of four vertices");
    for (mesh, expected) in [("model.obj", smooth), ("{file: model.obj, crease: 0}", facets)] {
        sandbox.write("s.yaml", format!("format: 1\nambient: 1\nobjects: [{{shape: {{mesh: {mesh}}}}}]\n"));
        assert_eq!(mesh_bytes("s.yaml"), facets);
        assert_eq!(mesh_bytes("s.yaml --crease 180"), expected, "{mesh}");
    }
    assert!(sandbox.fails(2, "check model.obj --crease 181").contains("from 0 to 180"));
}

#[test]
fn limits_are_the_users() {
    let sandbox = Sandbox::new();
    let told = sandbox.fails(3, "check model.obj --limit triangles=3");
    assert!(
        told.contains("more than 3 triangles") && told.contains("--limit triangles=N allows more"),
        "{told}"
    );
    assert!(sandbox.fails(3, "check model.obj --limit memory=100").contains("more than 100 bytes of memory"));
    assert!(sandbox.fails(3, "check model.obj --limit file-bytes=10").contains("longer than 10 bytes"));
    sandbox.ok("check model.obj --limit triangles=4 --limit memory=1G");
    assert!(sandbox.fails(2, "check model.obj --limit triangle=3").contains("those that may be changed are"));
    assert!(text(&sandbox.ok("check --help").stdout).contains("texture-pixels"));
}
