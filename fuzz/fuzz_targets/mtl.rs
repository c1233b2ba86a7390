//! MTL files, by an OBJ file that uses the materials `a`, `b` and `c`.

#![no_main]

use lancer_fuzz::{TEXTURE, read};
use libfuzzer_sys::fuzz_target;

/// Three triangles with texture coordinates, of three materials.
const MODEL: &[u8] = b"mtllib model.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl a
f 1/1 2/2 3/3
usemtl b
f 3/1 2/2 1/3
usemtl c
f 2/1 3/2 1/3
";

fuzz_target!(|input: &[u8]| {
    read(&[("model.obj", MODEL), ("model.mtl", input), ("t.bmp", TEXTURE)], Vec::new());
});
