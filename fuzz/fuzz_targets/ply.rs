//! PLY files, in text and binary.

#![no_main]

use lancer_fuzz::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    read(&[("model.ply", input)], Vec::new());
});
