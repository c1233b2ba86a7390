//! OBJ files, and after a line of `%%` the MTL file that they may name `model.mtl`.

#![no_main]

use lancer_fuzz::{TEXTURE, parts, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let (model, materials) = parts(input);
    read(&[("model.obj", model), ("model.mtl", materials), ("t.bmp", TEXTURE)], Vec::new());
});
