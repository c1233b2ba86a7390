//! glTF files, and GLB files, which begin with `glTF`; `b.bin` and `t.bmp` lie beside them.

#![no_main]

use lancer_fuzz::{TEXTURE, parts, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    if input.starts_with(b"glTF") {
        read(&[("model.glb", input), ("t.bmp", TEXTURE)], Vec::new());
    } else {
        let (document, buffer) = parts(input);
        read(&[("model.gltf", document), ("b.bin", buffer), ("t.bmp", TEXTURE)], Vec::new());
    }
});
