//! What is told of a render: the summary, warnings, and JSON.

use crate::sandbox::{SCENE, Sandbox, text};
use serde_json::Value;

/// Two mirrors that face each other, seen from between them.
const MIRRORS: &str = "
format: 1
camera: {eye: [0, 0.5, 0], target: [0.1, 1, 0], up: [1, 0, 0], fov: 1}
ambient: 1
materials: {mirror: {ambient: 0.1, reflect: 1}}
objects:
  - {shape: plane, material: mirror}
  - {shape: plane, material: mirror, transform: [{translate: [0, 1, 0]}]}
render: {width: 1, height: 1, depth: 100000}
";

#[test]
fn a_render_is_summed_up_in_one_line() {
    let sandbox = Sandbox::new();
    let run = sandbox.ok("render scene.yaml");
    let said = text(&run.stderr);
    assert_eq!(said.lines().count(), 1, "{said}");
    for part in ["scene.png", "24 x 16", " s, ", " rays", "rays/s"] {
        assert!(said.contains(part), "{said}");
    }
    assert!(run.stdout.is_empty());
}

#[test]
fn quiet_says_nothing_of_success() {
    let run = Sandbox::new().ok("render scene.yaml --quiet");
    assert_eq!((text(&run.stderr), text(&run.stdout)), (String::new(), String::new()));
}

#[test]
fn quiet_still_warns_and_json_holds_the_warnings() {
    let sandbox = Sandbox::new();
    sandbox.write("dark.yaml", SCENE.replace("ambient: 0.2", "").replace("lights: [", "lights: [] #"));
    let run = sandbox.ok("render dark.yaml --quiet --json");
    let said = text(&run.stderr);
    assert!(said.starts_with("warning: dark.yaml:"), "{said}");
    let told = serde_json::from_slice::<Value>(&run.stdout).unwrap();
    let warning = &told["warnings"][0];
    assert!(warning["message"].as_str().unwrap().contains("no light"));
    assert_eq!(warning["file"], "dark.yaml");
    assert_eq!(told["warnings"].as_array().unwrap().len(), 1);
}

#[test]
fn reflections_that_were_cut_short_are_warned_of() {
    let sandbox = Sandbox::new();
    sandbox.write("mirrors.yaml", MIRRORS);
    let run = sandbox.ok("render mirrors.yaml --json");
    assert!(text(&run.stderr).contains("warning: "), "{}", text(&run.stderr));
    let told = serde_json::from_slice::<Value>(&run.stdout).unwrap();
    assert_eq!(told["rays"]["truncated"], 1);
    assert_eq!(told["warnings"].as_array().unwrap().len(), 1);
    let told = sandbox.json("render mirrors.yaml --depth 100 --json");
    assert_eq!(told["rays"]["truncated"], 0);
    assert_eq!(told["rays"]["reflection"], 100);
    assert_eq!(told["warnings"].as_array().unwrap().len(), 0);
}

#[test]
fn a_picture_of_nothing_is_warned_of() {
    let sandbox = Sandbox::new();
    let warnings = |flags: &str| {
        let told = sandbox.json(&format!("render scene.yaml --json {flags}"));
        told["warnings"].as_array().unwrap().len()
    };
    let away = "--set camera.target=[0,9,9]";
    assert_eq!(warnings(away), 1);
    assert_eq!(warnings(&format!("{away} --samples 3")), 1);
    assert_eq!(warnings(&format!("{away} --region 0,0,2,2")), 0);
    assert_eq!(warnings(""), 0);
}

#[test]
fn missing_parts_are_warned_of() {
    let sandbox = Sandbox::new();
    let model = String::from_utf8(sandbox.read("model.obj")).unwrap();
    sandbox.write("parts.obj", format!("mtllib missing.mtl\n{model}"));
    let run = sandbox.ok("render parts.obj --width 4 --height 4 --json");
    assert!(text(&run.stderr).contains("missing.mtl"), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains("missing.mtl"));
    assert!(text(&sandbox.ok("info parts.obj").stdout).contains("missing.mtl"));
    assert!(text(&sandbox.ok("check parts.obj").stderr).contains("missing.mtl"));
}

#[test]
fn the_json_of_a_render_adds_up() {
    let sandbox = Sandbox::new();
    let told = sandbox.json("render scene.yaml --ao 4 --samples 2 --json -o a.png");
    let count = |kind: &str| told["rays"][kind].as_u64().unwrap_or_else(|| panic!("no count of {kind} rays"));
    let kinds = ["primary", "shadow", "ao", "reflection", "refraction"].map(count);
    assert_eq!(kinds.iter().sum::<u64>(), count("total"));
    assert_eq!(count("primary"), 24 * 16 * 4);
    assert!(kinds.iter().all(|&count| count > 0));
    assert_eq!((count("truncated"), count("replaced")), (0, 0));

    let seconds =
        |stage: &str| told["seconds"][stage].as_f64().unwrap_or_else(|| panic!("no time of {stage}"));
    let stages = ["load", "build", "render", "write"].map(seconds);
    assert!(stages.iter().all(|&seconds| seconds > 0.0));
    assert!((stages.iter().sum::<f64>() - seconds("total")).abs() < 1e-6);

    assert_eq!(told["objects"], 3);
    assert_eq!(told["triangles"], 0);
    assert_eq!(told["output"], "a.png");
    assert_eq!(told["scene"], "scene.yaml");
    if cfg!(target_os = "linux") {
        assert!(told["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    } else {
        assert!(told["peak_memory_bytes"].is_null());
    }
}

#[test]
fn the_json_of_a_render_counts_shared_triangles_once_and_as_drawn() {
    let sandbox = Sandbox::new();
    let ball = "{shape: {mesh: model.obj}}, {shape: {mesh: model.obj}, transform: [{translate: [2, 0, 0]}]}";
    sandbox.write(
        "two.yaml",
        format!("format: 1\nambient: 1\nobjects: [{ball}]\nrender: {{width: 4, height: 4}}\n"),
    );
    let told = sandbox.json("render two.yaml --json");
    assert_eq!(told["triangles"], 4);
    assert_eq!(told["instanced_triangles"], 8);
    assert_eq!(told["objects"], 2);
    for bytes in ["tree_nodes", "tree_bytes", "mesh_bytes"] {
        assert!(told[bytes].as_u64().unwrap() > 0, "{bytes}");
    }
}

#[test]
fn the_json_of_a_region_has_the_size_of_what_was_written() {
    let told = Sandbox::new().json("render scene.yaml --region 1,2,5,3 --json");
    assert_eq!(told["image"]["width"], 5);
    assert_eq!(told["image"]["height"], 3);
    assert_eq!(told["rays"]["primary"], 15);
}

#[test]
fn names_in_a_file_do_not_command_the_terminal() {
    let sandbox = Sandbox::new();
    sandbox.write("scene.yaml", SCENE.replace("Two balls", "\"\\e[2J\""));
    assert!(!text(&sandbox.ok("info scene.yaml").stdout).contains('\x1b'));
    sandbox.write("scene.yaml", SCENE.replace("material: floor", "material: \"\\e[2J\""));
    let said = sandbox.fails(3, "check scene.yaml");
    assert!(said.contains("[2J") && !said.contains('\x1b'), "{said:?}");
}
