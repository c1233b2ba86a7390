//! Tells how far a render is, and stops it half way:
//! `cargo run --release -p lancer-core --example watch_a_render`

use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use lancer_core::integrator::RayCounts;
use lancer_core::render::{CancelToken, Control, RenderError, Tile, render};
use lancer_core::scene::{Node, Scene, Shape};
use lancer_core::world::{CompileOptions, World};
use std::error::Error;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new("a ball");
    scene.add_light(DVec3::new(4.0, 6.0, 4.0), Rgb::grey(200.0));
    scene.add(Node::shape("ball", Shape::Sphere));
    let world = World::compile(&scene, &CompileOptions::default())?;

    let pixels = (scene.settings.width * scene.settings.height) as usize;
    let done = AtomicUsize::new(0);
    let cancel = CancelToken::default();
    let on_tile = |tile: &Tile, _: &RayCounts| {
        let so_far = done.fetch_add(tile.pixels.len(), Ordering::Relaxed) + tile.pixels.len();
        // Here a viewer would show the tile's pixels.
        if so_far > pixels / 2 {
            cancel.cancel();
        }
    };
    let control = Control { cancel: cancel.clone(), on_tile: &on_tile, ..Control::default() };
    let stopped = render(&world, &scene.camera, &scene.settings, None, &control);

    assert_eq!(stopped.unwrap_err(), RenderError::Cancelled);
    writeln!(std::io::stdout(), "stopped after {} of {pixels} pixels", done.load(Ordering::Relaxed))?;
    Ok(())
}
