//! Textures: PNG, JPEG, WebP, TIFF and BMP files, told apart by content, and TGA files, by name.

#![no_main]

use lancer_fuzz::{allow_panics_of_jpeg, read_texture};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: allow_panics_of_jpeg(), |input: &[u8]| {
    read_texture("texture.png", input);
    read_texture("texture.tga", input);
});
