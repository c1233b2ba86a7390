//! `schema`, `completions`, `man` and the help.

use crate::sandbox::{Sandbox, text};

#[test]
fn the_schema_is_json_that_names_the_keys_of_a_scene() {
    let schema = Sandbox::new().json("schema");
    for key in ["format", "camera", "lights", "materials", "objects", "render"] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
}

#[test]
fn completions_know_the_flags() {
    let sandbox = Sandbox::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(text(&sandbox.ok(&format!("completions {shell}")).stdout).contains("ao-distance"), "{shell}");
    }
}

#[test]
fn the_manual_has_every_command_and_flag() {
    let page = text(&Sandbox::new().ok("man").stdout);
    for part in [
        "LANCER RENDER",
        "LANCER CHECK",
        "LANCER VERIFY",
        "LANCER COMPARE",
        r"\-\-region",
        r"\-\-allow\-outside",
        "130",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn help_and_version_are_results() {
    let sandbox = Sandbox::new();
    assert!(text(&sandbox.ok("--help").stdout).contains("Exit codes"));
    assert!(text(&sandbox.ok("render --help").stdout).contains("--ao-distance"));
    assert_eq!(text(&sandbox.ok("--version").stdout), concat!("lancer ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let sandbox = Sandbox::new();
    for line in
        ["scenes", "man", "schema", "info scene.yaml", "completions bash", "render scene.yaml -q --json"]
    {
        let run = sandbox.process(line.split_whitespace()).stdout(closed_pipe()).output().unwrap();
        assert_eq!(run.status.code(), Some(0), "{line}");
        assert_eq!(text(&run.stderr), "", "{line}");
    }
}

#[cfg(unix)]
#[test]
fn a_picture_that_nobody_takes_exits_with_4() {
    let sandbox = Sandbox::new();
    let run = sandbox.process(["render", "scene.yaml", "-o", "-"]).stdout(closed_pipe()).output().unwrap();
    assert_eq!(run.status.code(), Some(4));
    assert_eq!(text(&run.stderr).lines().count(), 1);
}

/// A pipe without a reader.
#[cfg(unix)]
fn closed_pipe() -> std::io::PipeWriter {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer
}
