//! Renders a built-in scene to a PNG, to look at it while it is being written:
//! `cargo run --release -p lancer-gallery --example look -- NAME FILE.png [WIDTH [SAMPLES]]`

use lancer_core::film::to_srgb8;
use lancer_core::render::{Control, render};
use lancer_core::world::{CompileOptions, World};
use std::error::Error;
use std::fs::File;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1).collect::<Vec<_>>();
    let [name, file, sizes @ ..] = arguments.as_slice() else {
        return Err("usage: look NAME FILE.png [WIDTH [SAMPLES]]".into());
    };
    let scene = lancer_gallery::find(name).ok_or("there is no such scene")?.build();
    let mut settings = scene.settings;
    if let Some(width) = sizes.first() {
        let width = width.parse::<u32>()?;
        settings.height = settings.height * width / settings.width;
        settings.width = width;
    }
    if let Some(samples) = sizes.get(1) {
        settings.samples = samples.parse()?;
    }
    let world = World::compile(&scene, &CompileOptions::default())?;
    let picture = render(&world, &scene.camera, &settings, None, &Control::default())?;

    let mut encoder = png::Encoder::new(File::create(file)?, settings.width, settings.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(to_srgb8(&picture.image).as_flattened())?;
    Ok(())
}
