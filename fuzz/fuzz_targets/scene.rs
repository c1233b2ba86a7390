//! Scene files, and after a line of `%%` overrides, one a line; `model.obj` and `t.bmp` lie beside them.

#![no_main]

use lancer_fuzz::{TEXTURE, parts, read};
use libfuzzer_sys::fuzz_target;

/// A model that scenes may name.
const MODEL: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fuzz_target!(|input: &[u8]| {
    let (scene, overrides) = parts(input);
    // Overrides that are no overrides are refused before a scene is read.
    let overrides = String::from_utf8_lossy(overrides).lines().filter_map(|line| line.parse().ok()).collect();
    read(&[("scene.yaml", scene), ("model.obj", MODEL), ("t.bmp", TEXTURE)], overrides);
});
