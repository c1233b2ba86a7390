//! PNG, JPEG and BMP files, told apart by content, and TGA files, by name.

#![no_main]

use lancer_fuzz::read_texture;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    read_texture("texture.png", input);
    read_texture("texture.tga", input);
});
