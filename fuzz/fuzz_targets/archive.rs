//! Zip archives, as archives of a model and as 3MF; and what is compressed by gzip.

#![no_main]

use lancer_fuzz::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    if input.starts_with(b"PK") {
        read(&[("model.zip", input)], Vec::new());
        read(&[("model.3mf", input)], Vec::new());
    } else {
        read(&[("model.ply.gz", input)], Vec::new());
        read(&[("model.gz", input)], Vec::new());
    }
});
