//! Loads a scene or a model, renders it and writes the picture:
//! `cargo run --release -p lancer-io --example render_a_file -- scenes/lens.yaml lens.png`

use lancer_core::render::{Control, render};
use lancer_core::world::{CompileOptions, World};
use lancer_io::image::{ImageFormat, Metadata, encode};
use lancer_io::output::write_atomically;
use lancer_io::{LoadOptions, Loaded, load};
use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut paths = std::env::args_os().skip(1).map(PathBuf::from);
    let scene_path = paths.next().ok_or("which scene or model?")?;
    let picture_path = paths.next().ok_or("where does the picture go?")?;

    let Loaded { scene, warnings, .. } = load(&scene_path, &LoadOptions::default())?;
    let world = World::compile(&scene, &CompileOptions::default())?;
    let picture = render(&world, &scene.camera, &scene.settings, None, &Control::default())?;

    let format = ImageFormat::from_path(&picture_path)?;
    let (image, tone, metadata) = (&picture.image, scene.tone, Metadata::default());
    write_atomically(&picture_path, |out| encode::write(format, image, tone, &metadata, out))?;

    for warning in warnings {
        writeln!(std::io::stderr(), "warning: {warning}")?;
    }
    Ok(())
}
