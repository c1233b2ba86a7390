//! Pictures that are compared and verified: EXR, PFM and Radiance HDR besides the formats of textures, and what they say of
//! themselves.

#![no_main]

use lancer_fuzz::{allow_panics_of_jpeg, read_picture};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: allow_panics_of_jpeg(), |input: &[u8]| {
    read_picture(input);
});
