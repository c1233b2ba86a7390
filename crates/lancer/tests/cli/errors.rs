//! What goes wrong, the exit codes that say so, and that it shows before the long work.

use crate::sandbox::{SCENE, Sandbox};
use std::fs;

#[test]
fn wrong_flags_exit_with_2() {
    let sandbox = Sandbox::new();
    for flags in [
        "--no-such-flag",
        "--width 0",
        "--height 0",
        "--width -3",
        "--width 65536",
        "--width 4294967296",
        "--width 65535 --height 65535",
        "--samples 0",
        "--samples 65",
        "--depth 100001",
        "--depth -1",
        "--ao 65537",
        "--ao-distance 0",
        "--ao-distance -1",
        "--ao-distance nan",
        "--camera bottom",
        "--region 1,2,3",
        "--region 0,0,25,1",
        "--region 24,0,1,1",
        "--region 4294967295,0,4294967295,1",
        "--region 0,0,0,1",
        "--exposure nan",
        "--exposure 1000",
        "--threads 0",
        "--threads 100000",
        "--accel magic",
        "--instructions mmx",
        "--kd-leaf 0",
        "--kd-depth 65",
        "--tile-size 0",
        "--set camera.fov",
        "-o picture.gif",
        "-o picture",
        "-o -  --json",
        "--width 4 --width 5",
        "other.yaml",
    ] {
        let said = sandbox.fails(2, &format!("render scene.yaml {flags}"));
        assert!(said.starts_with("error: "), "{flags}: {said}");
    }
    sandbox.fails(2, "render --width 60000 --height 60000 --tile-size 1");
    sandbox.fails(2, "scenes extra");
    sandbox.fails(2, "info");
    sandbox.fails(2, "check");
    sandbox.fails(2, "completions klingon");
    assert_eq!(sandbox.new_files(), [""; 0]);
}

#[test]
fn a_camera_that_is_not_there_is_answered_with_those_that_are() {
    let sandbox = Sandbox::new();
    assert!(sandbox.fails(2, "render scene.yaml --camera bottom").contains("top"));
    assert!(sandbox.fails(2, "render model.obj --camera bottom").contains("leave out --camera"));
}

#[test]
fn scenes_that_are_not_there_exit_with_3_and_say_what_was_meant() {
    let sandbox = Sandbox::new();
    for command in ["render", "info", "check"] {
        assert!(sandbox.fails(3, &format!("{command} scen.yaml")).contains("did you mean `scene.yaml`"));
        assert!(sandbox.fails(3, &format!("{command} whited")).contains("did you mean `whitted`"));
        assert!(sandbox.fails(3, &format!("{command} qqqq")).contains("lancer scenes"));
    }
}

#[test]
fn faults_of_a_scene_exit_with_3_and_all_are_told_with_their_places() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "broken.yaml",
        "format: 1\nobjets: []\nobjects:\n  - {shape: spere}\n  - {shape: sphere, material: gold}\n",
    );
    for command in ["render", "check", "info"] {
        let said = sandbox.fails(3, &format!("{command} broken.yaml"));
        assert!(said.contains("broken.yaml:2:1: "), "{said}");
        assert!(said.contains("broken.yaml:4:"), "{said}");
        assert!(said.contains("broken.yaml:5:"), "{said}");
    }
    assert_eq!(sandbox.new_files(), ["broken.yaml"]);
}

#[test]
fn scenes_that_cannot_be_traced_exit_with_3() {
    let sandbox = Sandbox::new();
    let ball = "format: 1\nobjects: [{name: flat ball, shape: sphere, transform: [{scale: [1, 0, 1]}]}]\n";
    sandbox.write("flat.yaml", ball);
    sandbox.write("empty.yaml", "format: 1\nobjects: []\n");
    sandbox.write(
        "blind.yaml",
        SCENE.replace("eye: [0, 2, 8], target: [0, 1, 0]", "eye: [0, 2, 8], target: [0, 2, 8]"),
    );
    sandbox.write("huge.yaml", SCENE.replace("width: 24", "width: 0"));
    for command in ["render", "check"] {
        let fails = |file: &str| sandbox.fails(3, &format!("{command} {file}"));
        assert!(fails("flat.yaml").contains("flat ball"));
        assert!(!fails("empty.yaml").is_empty());
        assert!(fails("blind.yaml").contains("camera"));
        assert!(fails("huge.yaml").contains("width"));
    }
}

#[test]
fn scenes_that_are_no_scenes_exit_with_3() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("directory.yaml")).unwrap();
    sandbox.write("empty.yaml", "");
    sandbox.write("binary.yaml", [0xff, 0xfe, 0, 1, 2]);
    sandbox.write("empty.obj", "");
    sandbox.write("picture.gif", "GIF89a");
    for file in ["directory.yaml", "empty.yaml", "binary.yaml", "empty.obj", "picture.gif"] {
        sandbox.fails(3, &format!("render {file} -o out.png"));
    }
}

#[test]
fn values_set_to_nonsense_are_told_with_the_flag() {
    let sandbox = Sandbox::new();
    for set in ["camera.fov=wide", "lights.7.intensity=1", "materials.floor.shine=2"] {
        let said = sandbox.fails(3, &format!("render scene.yaml --set {set}"));
        assert!(said.contains("--set"), "{said}");
    }
}

#[test]
fn output_that_cannot_be_written_exits_with_4() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("directory.png")).unwrap();
    for output in ["no/such/directory/a.png", "directory.png", "scene.yaml/a.png"] {
        let said = sandbox.fails(4, &format!("render scene.yaml -o {output}"));
        assert!(said.contains(output), "{said}");
    }
    assert_eq!(sandbox.new_files(), ["directory.png"]);
}

#[test]
fn a_read_only_file_is_kept() {
    let sandbox = Sandbox::new();
    sandbox.write("kept.png", "old");
    let mut permissions = fs::metadata(sandbox.path("kept.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(sandbox.path("kept.png"), permissions).unwrap();
    assert!(sandbox.fails(4, "render scene.yaml -o kept.png").contains("read-only"));
    assert_eq!(sandbox.read("kept.png"), b"old");
}

/// Where even the superuser, as whom tests may run, can make no file.
#[cfg(target_os = "linux")]
#[test]
fn a_directory_that_takes_no_files_exits_with_4() {
    Sandbox::new().fails(4, "render scene.yaml -o /proc/picture.png");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_exits_with_4() {
    let sandbox = Sandbox::new();
    for line in
        ["render scene.yaml -o -", "render scene.yaml --json", "scenes", "schema", "man", "check scene.yaml"]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let run = sandbox.process(line.split_whitespace()).stdout(full).output().unwrap();
        assert_eq!(run.status.code(), Some(4), "{line}");
        assert!(!run.stderr.is_empty(), "{line}");
    }
}

/// The limit of a file's size stands in for a disk that fills up while the picture is written.
#[cfg(unix)]
#[test]
fn a_disk_that_fills_up_leaves_the_old_file() {
    let sandbox = Sandbox::new();
    sandbox.write("old.exr", "old");
    let render = format!("{} render scene.yaml --width 99 -o old.exr", env!("CARGO_BIN_EXE_lancer"));
    let run = assert_cmd::Command::new("sh")
        .current_dir(sandbox.path(""))
        .args(["-c", &format!("trap '' XFSZ; ulimit -f 1; exec {render}")])
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(4));
    assert!(String::from_utf8(run.stderr).unwrap().contains("old.exr"));
    assert_eq!(sandbox.read("old.exr"), b"old");
    assert_eq!(sandbox.new_files(), ["old.exr"]);
}

/// Threads that the system does not give are the one failure of a render that can be had without a bug.
#[cfg(target_os = "linux")]
#[test]
fn a_render_that_fails_exits_with_5() {
    let sandbox = Sandbox::new();
    let render = format!("{} render scene.yaml --threads 1000", env!("CARGO_BIN_EXE_lancer"));
    let run = assert_cmd::Command::new("sh")
        .current_dir(sandbox.path(""))
        .args(["-c", &format!("ulimit -v 1000000; exec {render}")])
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(5), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(String::from_utf8(run.stderr).unwrap().contains("1000 threads"));
    assert_eq!(sandbox.new_files(), [""; 0]);
}

#[test]
fn mistakes_show_before_the_long_work() {
    let sandbox = Sandbox::new();
    // It would take days.
    let long = "--width 4000 --height 4000 --samples 64 --ao 65536";
    sandbox.fails(2, &format!("render scene.yaml {long} -o picture.bmp"));
    sandbox.fails(2, &format!("render scene.yaml {long} --camera bottom"));
    sandbox.fails(2, &format!("render scene.yaml {long} --region 0,0,4001,1"));
    sandbox.fails(3, &format!("render scene.yml {long}"));
    sandbox.fails(4, &format!("render scene.yaml {long} -o no/directory.png"));
}

#[test]
fn without_a_display_it_is_said_how_to_render() {
    let sandbox = Sandbox::new();
    assert!(sandbox.fails(2, "").contains("lancer render"));
    assert!(sandbox.fails(2, "scene.yaml").contains("lancer render scene.yaml"));
    assert!(sandbox.fails(2, "rendr").contains("did you mean `lancer render`"));
    sandbox.fails(3, "nothing.yaml");
}

/// A display that is named and not there: to be told as an error, and not as a panic.
#[cfg(all(target_os = "linux", feature = "window"))]
#[test]
fn without_its_display_it_is_said_how_to_render() {
    let sandbox = Sandbox::new();
    for (variable, display) in [("DISPLAY", ":65000"), ("DISPLAY", "nonsense"), ("WAYLAND_DISPLAY", "none")] {
        let run = sandbox.lancer(["scene.yaml"]).env(variable, display).output().unwrap();
        let said = crate::sandbox::text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{variable}={display}: {said}");
        assert!(said.contains("lancer render scene.yaml"), "{said}");
    }
}
