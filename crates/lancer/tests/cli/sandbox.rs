//! A directory of its own for a test, with scenes in it, and eyes for what the program leaves there.

use assert_cmd::Command;
use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use tempfile::TempDir;

/// Something of everything: a mirror, glass, a shadow, a background, two cameras.
pub(crate) const SCENE: &str = "
format: 1
name: Two balls
camera: {eye: [0, 2, 8], target: [0, 1, 0], fov: 40}
cameras: {top: {eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], fov: 50}}
ambient: 0.2
background: '#87ceeb'
lights: [{position: [4, 6, 4], intensity: 200}]
materials:
  floor: {color: [0.8, 0.7, 0.6]}
  mirror: {diffuse: 0.1, reflect: 0.8}
  glass: {ambient: 0.1, diffuse: 0.1, specular: 0.5, transmit: 0.8, reflect: 0.1}
objects:
  - {shape: plane, material: floor}
  - {shape: sphere, material: mirror, transform: [{translate: [-1.2, 1, 0]}]}
  - {shape: sphere, material: glass, transform: [{translate: [1.2, 1, 0.5]}]}
render: {width: 24, height: 16, depth: 3}
";

/// A tetrahedron.
pub(crate) const MODEL: &str = "
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
";

/// The scene is in `scene.yaml`, the model in `model.obj`.
pub(crate) struct Sandbox {
    directory: TempDir,
}

impl Sandbox {
    pub(crate) fn new() -> Self {
        let sandbox = Self { directory: tempfile::tempdir().unwrap() };
        sandbox.write("scene.yaml", SCENE);
        sandbox.write("model.obj", MODEL);
        sandbox
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// What lies in the directory, hidden files too, beside the scene and the model.
    pub(crate) fn new_files(&self) -> Vec<String> {
        let mut names = fs::read_dir(self.directory.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name != "scene.yaml" && name != "model.obj")
            .collect::<Vec<_>>();
        names.sort();
        names
    }

    /// The program with its arguments, to be run in the directory.
    pub(crate) fn lancer<S: AsRef<OsStr>>(&self, args: impl IntoIterator<Item = S>) -> Command {
        Command::from_std(self.process(args))
    }

    /// As [`Self::lancer`], for tests that need the running process.
    pub(crate) fn process<S: AsRef<OsStr>>(
        &self,
        args: impl IntoIterator<Item = S>,
    ) -> std::process::Command {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lancer"));
        command.current_dir(self.directory.path()).args(args).env_remove("RUST_BACKTRACE");
        // Nothing here opens a window on the display of whoever runs the tests.
        for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(display);
        }
        command
    }

    /// Runs a command line, its words parted by spaces, which must succeed.
    pub(crate) fn ok(&self, line: &str) -> Output {
        self.lancer(line.split_whitespace()).assert().success().get_output().clone()
    }

    /// Runs a command line that must fail with an exit code and print nothing on standard output. Returns what it
    /// says.
    pub(crate) fn fails(&self, code: i32, line: &str) -> String {
        let output = self.lancer(line.split_whitespace()).output().unwrap();
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "`{line}` says: {stderr}");
        assert_eq!(text(&output.stdout), "", "`{line}`");
        assert!(!stderr.is_empty(), "`{line}` says nothing");
        stderr
    }

    /// Runs a command line that prints one JSON value.
    pub(crate) fn json(&self, line: &str) -> Value {
        serde_json::from_slice(&self.ok(line).stdout).unwrap()
    }

    /// Renders `scene.yaml` with more flags, and returns the pixels of the PNG.
    pub(crate) fn png(&self, flags: &str) -> Picture<u8> {
        self.ok(&format!("render scene.yaml -o picture.png {flags}"));
        read_png(&self.path("picture.png"))
    }

    /// Renders `scene.yaml` with more flags, and returns the pixels of the EXR.
    pub(crate) fn exr(&self, flags: &str) -> Picture<f32> {
        self.ok(&format!("render scene.yaml -o picture.exr {flags}"));
        read_exr(&self.path("picture.exr"))
    }

    /// Renders `scene.yaml` with more flags, and returns the bytes of the EXR, which no clamping makes alike.
    pub(crate) fn bytes(&self, flags: &str) -> Vec<u8> {
        self.exr(flags);
        self.read("picture.exr")
    }
}

/// An image as read back. Shape: `pixels: [height * width][3]`, top row first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture<T> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<[T; 3]>,
}

impl<T: Copy> Picture<T> {
    pub(crate) fn crop(&self, x: usize, y: usize, width: usize, height: usize) -> Self {
        let rows = (y..y + height).map(|row| row * self.width + x);
        let pixels = rows.flat_map(|start| self.pixels[start..start + width].iter().copied()).collect();
        Self { width, height, pixels }
    }
}

pub(crate) fn read_png(path: &Path) -> Picture<u8> {
    let image = image::load_from_memory_with_format(&fs::read(path).unwrap(), image::ImageFormat::Png);
    let image = image.unwrap().into_rgb8();
    Picture {
        width: image.width() as usize,
        height: image.height() as usize,
        pixels: image.pixels().map(|pixel| pixel.0).collect(),
    }
}

pub(crate) fn read_exr(path: &Path) -> Picture<f32> {
    use exr::prelude::*;
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| Picture { width: size.width(), height: size.height(), pixels: vec![[0.0; 3]; size.area()] },
        |picture: &mut Picture<f32>, at, (r, g, b, _): (f32, f32, f32, f32)| {
            picture.pixels[at.y() * picture.width + at.x()] = [r, g, b];
        },
    );
    image.unwrap().layer_data.channel_data.pixels
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
