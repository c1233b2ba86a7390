//! Renders that are stopped in the middle.

use crate::sandbox::{Sandbox, read_png, text};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Hours of work.
const LONG: &str = "render scene.yaml --width 2000 --height 2000 --samples 8 --ao 4096 -o picture.png";

fn start(sandbox: &Sandbox, line: &str) -> Child {
    sandbox.process(line.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn send(child: &Child, signal: Signal) {
    kill(Pid::from_raw(child.id() as i32), signal).unwrap();
}

fn assert_stops_at(signal: Signal) {
    let sandbox = Sandbox::new();
    for old in [None, Some("old")] {
        if let Some(old) = old {
            sandbox.write("picture.png", old);
        }
        let child = start(&sandbox, LONG);
        sleep(Duration::from_millis(300));
        send(&child, signal);
        let asked = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(asked.elapsed() < Duration::from_secs(5), "{signal} took {:?}", asked.elapsed());
        assert_eq!(output.status.code(), Some(130), "{signal}");
        assert_eq!(text(&output.stderr), "interrupted\n");
        match old {
            None => assert_eq!(sandbox.new_files(), [""; 0]),
            Some(old) => {
                assert_eq!(sandbox.read("picture.png"), old.as_bytes());
                assert_eq!(sandbox.new_files(), ["picture.png"]);
            }
        }
    }
}

#[test]
fn ctrl_c_exits_with_130_and_leaves_the_old_file_or_none() {
    assert_stops_at(Signal::SIGINT);
}

#[test]
fn sigterm_exits_with_130_and_leaves_the_old_file_or_none() {
    assert_stops_at(Signal::SIGTERM);
}

/// One pixel of this takes minutes, and is not left before it is done.
#[test]
fn a_second_ctrl_c_does_not_wait_for_the_pixel() {
    let sandbox = Sandbox::new();
    let child = start(&sandbox, "render scene.yaml --width 1 --height 1 --samples 64 --ao 65536");
    sleep(Duration::from_millis(300));
    send(&child, Signal::SIGINT);
    sleep(Duration::from_millis(100));
    send(&child, Signal::SIGINT);
    let asked = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(asked.elapsed() < Duration::from_secs(5));
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(sandbox.new_files(), [""; 0]);
}

/// The pictures before the one at which it was stopped are whole, and there is no other file.
#[test]
fn a_film_that_is_stopped_leaves_whole_pictures_and_no_half_film() {
    let sandbox = Sandbox::new();
    let film = "turntable scene.yaml --frames 100000 --width 60 --height 40 --samples 2 --ao 8";
    for output in ["frame_%06d.png", "film.gif", "film.png"] {
        let child = start(&sandbox, &format!("{film} -o {output}"));
        sleep(Duration::from_millis(1500));
        send(&child, Signal::SIGINT);
        let asked = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(asked.elapsed() < Duration::from_secs(5));
        assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(130), "interrupted\n"));
    }
    let pictures = sandbox.new_files();
    assert!(!pictures.is_empty());
    for (index, name) in pictures.iter().enumerate() {
        assert_eq!(*name, format!("frame_{:06}.png", index + 1));
        let picture = read_png(&sandbox.path(name));
        assert_eq!((picture.width, picture.height), (60, 40));
    }
}

#[test]
fn waiting_for_a_reader_can_be_interrupted() {
    let sandbox = Sandbox::new();
    let size = "--width 500 --height 500";
    // More than a pipe holds.
    let child = start(&sandbox, &format!("render scene.yaml -o - --exposure 0.3 --samples 2 --ao 2 {size}"));
    sleep(Duration::from_millis(1500));
    send(&child, Signal::SIGINT);
    let mut child = child;
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_render_started_by_nohup_outlives_its_terminal() {
    let sandbox = Sandbox::new();
    let render = format!("{} {LONG}", env!("CARGO_BIN_EXE_lancer"));
    let mut child = std::process::Command::new("sh")
        .current_dir(sandbox.path(""))
        .args(["-c", &format!("trap '' HUP; exec {render}")])
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(300));
    send(&child, Signal::SIGHUP);
    sleep(Duration::from_millis(300));
    assert_eq!(child.try_wait().unwrap(), None);
    send(&child, Signal::SIGTERM);
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

/// Killed at times that spread over a whole render, the writing of the file included.
#[test]
fn sigkill_leaves_the_old_file_or_the_whole_new_one() {
    /// Kills; enough to hit each stage several times.
    const KILLS: u32 = 40;
    let sandbox = Sandbox::new();
    let line = "render scene.yaml --width 200 --height 150 -o picture.exr";
    let begin = Instant::now();
    sandbox.ok(line);
    let whole = begin.elapsed();
    let new = sandbox.read("picture.exr");
    for i in 0..KILLS {
        sandbox.write("picture.exr", "old");
        let mut child = start(&sandbox, line);
        sleep(whole * (i + 1) / KILLS);
        child.kill().unwrap();
        child.wait().unwrap();
        let found = sandbox.read("picture.exr");
        assert!(found == b"old" || found == new, "kill {i} left {} bytes of another kind", found.len());
    }
}
