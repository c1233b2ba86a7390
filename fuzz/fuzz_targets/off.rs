//! OFF files.

#![no_main]

use lancer_fuzz::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    read(&[("model.off", input)], Vec::new());
});
