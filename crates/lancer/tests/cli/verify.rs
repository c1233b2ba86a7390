//! `lancer verify`: pictures rendered again from what they say of themselves.

use crate::sandbox::{SCENE, Sandbox, text};
use serde_json::Value;

/// Verifies a picture that does not agree, and returns what is told.
fn differs(sandbox: &Sandbox, flags: &str) -> Value {
    let run = sandbox.lancer(format!("verify --json {flags}").split_whitespace()).output().unwrap();
    assert_eq!(run.status.code(), Some(1), "{}", text(&run.stderr));
    serde_json::from_slice(&run.stdout).unwrap()
}

#[test]
fn a_picture_in_every_format_agrees_with_itself() {
    let sandbox = Sandbox::new();
    for (name, flags) in [
        ("a.png", ""),
        ("b.png", "--bits 16 --dpi 300 --tone filmic --exposure 0.3"),
        ("a.jpg", "--quality 71 --dpi 72"),
        ("a.webp", "--tone reinhard"),
        ("a.tif", "--bits 16 --dpi 150"),
        ("b.tif", "--bits 32"),
        ("a.hdr", "--exposure -1.7"),
        ("a.exr", ""),
        ("b.exr", "--bits 16 --compression piz"),
    ] {
        sandbox.ok(&format!("render scene.yaml -o {name} {flags}"));
        let told = text(&sandbox.ok(&format!("verify {name}")).stdout);
        assert!(told.contains("byte for byte"), "{name}: {told}");
    }
}

#[test]
fn every_setting_is_recorded() {
    let sandbox = Sandbox::new();
    let flags = "--width 31 --height 23 --samples 2 --depth 1 --ao 3 --ao-distance 0.7 --no-shadows \
                 --camera top --region 3,4,20,15 --set materials.mirror.reflect=0.31 --set camera.fov=61";
    sandbox.ok(&format!("render scene.yaml -o a.png {flags}"));
    let told = sandbox.json("verify a.png --json");
    assert_eq!(told["same_bytes"], true);
    assert_eq!(told["record"]["set"], serde_json::json!(["materials.mirror.reflect=0.31", "camera.fov=61"]));
    sandbox.ok("render -o b.png --width 16 --height 12 --samples 1 --ao 0 --no-reflection --no-refraction");
    sandbox.ok("verify b.png --threads 1 --accel brute-force");
    sandbox.ok("render scene.yaml -o c.png --ao 2 --ao-distance inf");
    sandbox.ok("verify c.png");
    sandbox.ok("render model.obj -o d.png --width 20 --height 16");
    sandbox.ok("verify d.png");
}

#[test]
fn numbered_pictures_of_a_film_agree_with_themselves() {
    let sandbox = Sandbox::new();
    let small = "--frames 5 --width 12 --height 8 --set camera.fov=50";
    sandbox.ok(&format!("turntable scene.yaml -o orbit_%d.png --axis x {small}"));
    sandbox.ok(&format!("turntable scene.yaml -o top_%d.exr --camera top {small}"));
    sandbox.ok(&format!("turntable scene.yaml -o path_%d.tif --path main,top,main {small}"));
    sandbox.ok("turntable model.obj -o model_%d.png --frames 3 --width 12 --height 8");
    for name in ["orbit_1.png", "orbit_4.png", "top_2.exr", "path_3.tif", "path_4.tif", "model_2.png"] {
        let told = sandbox.json(&format!("verify {name} --json"));
        assert_eq!(
            (&told["same_bytes"], &told["same_scene"]),
            (&Value::Bool(true), &Value::Bool(true)),
            "{name}"
        );
    }
    sandbox.ok("turntable scene.yaml -o film.png --frames 2 --width 12 --height 8");
    assert!(sandbox.fails(3, "verify film.png").contains("films in one file"));
}

#[test]
fn files_with_layers_agree_with_themselves() {
    let sandbox = Sandbox::new();
    let render = "render scene.yaml --set lights.0.name=key --region 2,3,12,10";
    sandbox.ok(&format!("{render} -o all.exr --passes all --compression piz"));
    sandbox.ok(&format!("{render} -o some.exr --passes light.key,depth --exposure 0.5"));
    sandbox.ok(&format!("{render} -o each.exr --passes ambient,cost,depth --separate-passes"));
    for name in ["all.exr", "some.exr", "each.exr", "each.ambient.exr", "each.cost.exr", "each.depth.exr"] {
        let told = text(&sandbox.ok(&format!("verify {name}")).stdout);
        assert!(told.contains("byte for byte"), "{name}: {told}");
    }
}

#[test]
fn layers_that_differ_are_told_by_their_channels() {
    let sandbox = Sandbox::new();
    sandbox.ok("render model.obj -o model.exr --width 24 --height 16 --passes ambient,object_id,cost");
    // The picture and its terms are the same; how much work it was is not.
    let told = differs(&sandbox, "model.exr --accel brute-force");
    assert_eq!((&told["same_pixels"], &told["same_scene"]), (&Value::Bool(false), &Value::Bool(true)));
    let channels = told["channels"].as_array().unwrap();
    assert!(!channels.is_empty() && channels.iter().all(|name| name.as_str().unwrap().starts_with("cost.")));
    sandbox.ok("render scene.yaml -o a.exr --passes ambient,object_id");
    sandbox.write("scene.yaml", SCENE.replace("ambient: 0.2", "ambient: 0.25"));
    let channels = differs(&sandbox, "a.exr")["channels"].to_string();
    assert!(channels.contains("ambient.R") && !channels.contains("object_id"), "{channels}");
}

#[test]
fn a_changed_scene_is_told_with_how_far_the_pixels_are_apart() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    sandbox.write("scene.yaml", SCENE.replace("diffuse: 0.1, reflect: 0.8", "diffuse: 0.1, reflect: 0.4"));
    let told = differs(&sandbox, "a.png");
    assert_eq!((&told["same_scene"], &told["same_bytes"]), (&Value::Bool(false), &Value::Bool(false)));
    let differing = told["differing"].as_u64().unwrap();
    assert!(differing > 0 && differing < 24 * 16, "{told}");
    assert!(told["max"].as_f64().unwrap() > 0.01);
    let run = sandbox.lancer(["verify", "a.png"]).output().unwrap();
    assert!(text(&run.stderr).contains("the scene is not what it was"));
    assert!(text(&run.stdout).contains(&format!("{differing} of 384 pixels differ, by ")));
}

#[test]
fn a_change_that_nobody_sees_is_told_and_the_bytes_still_agree() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    sandbox.write("scene.yaml", format!("{SCENE}\n").replace("name: Two balls", "name: Renamed"));
    assert_eq!(sandbox.json("verify a.png --json")["same_scene"], true);
    let unseen = SCENE.replace("floor: {", "unused: {ior: 2}\n  floor: {");
    sandbox.write("scene.yaml", unseen);
    let told = sandbox.json("verify a.png --json");
    assert_eq!((&told["same_scene"], &told["same_bytes"]), (&Value::Bool(false), &Value::Bool(true)));
}

#[test]
fn pixels_that_were_retouched_are_counted() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.pfm");
    sandbox.ok("render scene.yaml -o a.tif --bits 32 --compression none");
    let (mut bytes, pfm) = (sandbox.read("a.tif"), sandbox.read("a.pfm"));
    // The first row of the picture is the last of a PFM.
    let row = &pfm[pfm.len() - 24 * 12..];
    let at = bytes.windows(row.len()).position(|window| window == row).unwrap();
    bytes[at + 2] ^= 0x40;
    sandbox.write("a.tif", &bytes);
    let told = differs(&sandbox, "a.tif");
    assert_eq!((told["differing"].as_u64(), &told["same_scene"]), (Some(1), &Value::Bool(true)));
}

#[test]
fn the_same_pixels_in_other_bytes_are_told_apart_from_other_pixels() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    let mut bytes = sandbox.read("a.png");
    bytes.extend(b"more");
    sandbox.write("a.png", bytes);
    let told = differs(&sandbox, "a.png");
    assert_eq!((&told["same_pixels"], &told["same_bytes"]), (&Value::Bool(true), &Value::Bool(false)));
}

#[test]
fn what_cannot_be_verified_is_an_error_that_says_what_to_do() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.pfm");
    assert!(sandbox.fails(3, "verify a.pfm").contains("does not say how it was made"));
    sandbox.write("text.png", "no picture");
    assert!(sandbox.fails(3, "verify text.png").contains("does not say how it was made"));
    assert!(sandbox.fails(3, "verify nothing.png").contains("nothing.png"));

    std::fs::create_dir(sandbox.path("elsewhere")).unwrap();
    sandbox.ok("render scene.yaml -o elsewhere/a.png");
    // Beside the picture there is none, in the current directory there is.
    sandbox.ok("verify elsewhere/a.png");
    std::fs::rename(sandbox.path("scene.yaml"), sandbox.path("elsewhere/renamed.yaml")).unwrap();
    assert!(sandbox.fails(3, "verify elsewhere/a.png").contains("--scene"));
    sandbox.ok("verify elsewhere/a.png --scene elsewhere/renamed.yaml");
}

#[test]
fn pictures_name_no_directory() {
    let sandbox = Sandbox::new();
    let directory = sandbox.path("").to_string_lossy().trim_end_matches('/').to_owned();
    let scene = sandbox.path("scene.yaml").to_string_lossy().into_owned();
    let model = sandbox.path("model.obj").to_string_lossy().into_owned();
    std::fs::create_dir(sandbox.path("here")).unwrap();
    let set = format!("objects.0={{shape: {{mesh: \"{model}\"}}}}");
    for name in ["a.png", "a.jpg", "a.webp", "a.tif", "a.hdr", "a.exr", "a.pfm"] {
        let out = sandbox.path(name);
        let args = ["render", &scene, "--allow-outside", "--set", &set, "-o"];
        sandbox.lancer(args).arg(&out).current_dir(sandbox.path("here")).assert().success();
        let bytes = sandbox.read(name);
        let holds = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
        assert!(!holds(&directory), "{name}");
        assert!(name == "a.pfm" || holds("Lancer ") && holds("scene.yaml"), "{name}");
    }
    let told = sandbox.fails(3, "verify a.png");
    assert!(told.contains("--set objects.0=FILE"), "{told}");
    let again = ["verify", "a.png", "--allow-outside", "--set", &set];
    sandbox.lancer(again).assert().success();
}

#[test]
fn a_record_that_lies_is_refused_and_opens_nothing() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.hdr");
    let honest = sandbox.read("a.hdr");
    let lie = |old: &str, new: &str| {
        let at = honest.windows(old.len()).position(|window| window == old.as_bytes()).expect(old);
        sandbox.write("b.hdr", [&honest[..at], new.as_bytes(), &honest[at + old.len()..]].concat());
        sandbox.fails(3, "verify b.hdr")
    };
    lie("\"width\":24", "\"width\":0");
    lie("\"width\":24", "\"width\":4000000000");
    lie("\"samples\":1", "\"samples\":100000");
    lie("\"region\":null", "\"region\":[0,0,25,16]");
    lie("\"camera\":null", "\"camera\":\"nobody's\"");
    lie("\"set\":[]", "\"set\":[\"nonsense\"]");
    assert!(lie("\"file\":\"scene.yaml\"", "\"file\":\"../scene.yaml\"").contains("--scene"));
    assert!(lie("\"file\":\"scene.yaml\"", "\"file\":\"/etc/passwd\"").contains("--scene"));
    lie("\"set\":[]", "\"set\":[\"objects.0={shape: {mesh: /etc/passwd}}\"]");
}

#[test]
fn another_version_is_told() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.hdr");
    let version = env!("CARGO_PKG_VERSION");
    let old = String::from_utf8_lossy(&sandbox.read("a.hdr")).contains(version);
    assert!(old);
    let bytes = sandbox.read("a.hdr");
    let mut found = bytes.clone();
    for at in 0..bytes.len() - version.len() {
        if &bytes[at..at + version.len()] == version.as_bytes() {
            found[at..at + version.len()].copy_from_slice("9".repeat(version.len()).as_bytes());
        }
    }
    sandbox.write("a.hdr", found);
    let run = sandbox.lancer(["verify", "a.hdr"]).output().unwrap();
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    assert!(text(&run.stderr).contains("was made by lancer 9"));
}
