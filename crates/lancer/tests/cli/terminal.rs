//! What is for the eyes of a person at a terminal, and for nobody else.

use crate::sandbox::Sandbox;
use nix::pty::openpty;
use std::fs::File;
use std::io::Read;
use std::process::{ExitStatus, Stdio};

/// Long enough for progress to be drawn a few times.
const SECONDS: &str = "render scene.yaml --width 300 --height 200 --samples 2 --ao 64 -o picture.png";

/// Runs a command line with standard error, and perhaps standard output, on a terminal; what is seen there.
fn at_terminal(line: &str, variables: &[(&str, &str)], stdout: bool) -> (ExitStatus, String) {
    let sandbox = Sandbox::new();
    let terminal = openpty(None, None).unwrap();
    let mut command = sandbox.process(line.split_whitespace());
    command.env("TERM", "xterm").env_remove("NO_COLOR").envs(variables.iter().copied());
    command.stderr(Stdio::from(terminal.slave.try_clone().unwrap()));
    command.stdout(if stdout { Stdio::from(terminal.slave.try_clone().unwrap()) } else { Stdio::null() });
    let mut child = command.spawn().unwrap();
    // The terminal ends once nobody holds its other side.
    drop((command, terminal.slave));
    let mut seen = Vec::new();
    // The end is told as an error.
    let _ = File::from(terminal.master).read_to_end(&mut seen);
    (child.wait().unwrap(), String::from_utf8(seen).unwrap())
}

#[test]
fn progress_is_drawn_and_taken_away_again() {
    let (status, seen) = at_terminal(SECONDS, &[], false);
    assert!(status.success());
    for part in ["rendering ", "%", "rays/s", " left"] {
        assert!(seen.contains(part), "`{part}` is not in {seen:?}");
    }
    let last = seen.trim_end().rsplit("\x1b[2K").next().unwrap();
    assert!(last.starts_with("wrote picture.png"), "{last:?}");
}

#[test]
fn quiet_draws_no_progress() {
    let (status, seen) = at_terminal(&format!("{SECONDS} --quiet"), &[], false);
    assert!(status.success());
    assert_eq!(seen, "");
}

#[test]
fn errors_are_coloured_unless_no_color_is_set() {
    let wrong = "render no-such-scene";
    assert!(at_terminal(wrong, &[], false).1.contains("\x1b["));
    let (_, plain) = at_terminal(wrong, &[("NO_COLOR", "1")], false);
    assert!(plain.starts_with("error: ") && !plain.contains('\x1b'), "{plain:?}");
}

#[test]
fn progress_has_no_colours_where_no_color_is_set() {
    let (_, seen) = at_terminal(SECONDS, &[("NO_COLOR", "1")], false);
    // Colours are the escapes that end in `m`.
    assert!(!seen.split("\x1b[").skip(1).any(|escape| {
        escape.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m')
    }));
}

#[test]
fn a_png_is_not_poured_onto_a_terminal() {
    let (status, seen) = at_terminal("render scene.yaml -o -", &[], true);
    assert_eq!(status.code(), Some(2));
    assert!(seen.contains("--output"), "{seen:?}");
}
