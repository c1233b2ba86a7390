//! How soon the picture follows the mouse: measured, not asserted.
//!
//! `cargo test --release -p lancer-view --lib latency -- --ignored --nocapture`, with the path of a large model in
//! `LANCER_LATENCY_MODEL` to measure that too.

use super::*;
use lancer_core::camera::Camera;

/// A viewport of the window at its usual size.
const VIEWPORT: (u32, u32) = (1000, 750);

/// How long is waited for the full settings.
const PATIENCE: Duration = Duration::from_secs(60);

/// Moves of the mouse that are measured.
const MOVES: u32 = 30;

#[test]
#[ignore = "measures, and asserts nothing"]
#[expect(clippy::print_stdout, reason = "its output is what it is for")]
fn latency_of_the_view() {
    let builtins = ["whitted", "glass"].map(|name| Source::Builtin(lancer_gallery::find(name).unwrap()));
    let model = std::env::var_os("LANCER_LATENCY_MODEL").map(|path| Source::File(path.into()));
    println!(
        "milliseconds; moves: median and worst; coarse: the part of the viewport's side that an image has"
    );
    for source in builtins.into_iter().chain(model) {
        let watched = Watched::start();
        let start = Instant::now();
        watched.worker.open(source.clone(), LoadOptions::default());
        let Event::Opened(opened) = watched.last_of(|event| matches!(event, Event::Opened(_))) else {
            unreachable!()
        };
        let open = start.elapsed();
        let mut view = request(&opened.loaded.scene);
        (view.settings.width, view.settings.height) = VIEWPORT;
        let start = Instant::now();
        watched.worker.view(view.clone());
        watched.until(|event| matches!(event, Event::Frame(_)));
        let first = start.elapsed();
        watched.worker.stop_view();
        watched.worker.poll();
        view.moving = true;
        let mut divisor = 0;
        let moves = (1..=MOVES).map(|step| {
            let start = Instant::now();
            view.camera = turned(&opened.loaded.scene.camera, f64::from(step));
            watched.worker.view(view.clone());
            let ours = |event: &Event| matches!(event, Event::Frame(frame) if frame.camera == view.camera);
            if let Event::Frame(frame) = watched.last_of(ours) {
                divisor = VIEWPORT.0.div_ceil(frame.image.width());
            }
            start.elapsed()
        });
        let mut moves = moves.collect::<Vec<_>>();
        moves.sort();
        view.moving = false;
        let start = Instant::now();
        watched.worker.view(view.clone());
        let mut frame = watched.last_of(|event| matches!(event, Event::Frame(_)));
        let sharper = start.elapsed();
        while !matches!(&frame, Event::Frame(frame) if frame.is_final) && start.elapsed() < PATIENCE {
            frame = watched.last_of(|event| matches!(event, Event::Frame(_)));
        }
        let full = start.elapsed();
        let ms = |duration: Duration| duration.as_secs_f64() * 1e3;
        println!(
            "{source}: open {:.0}, first image {:.0}; moves {:.0}, {:.0} at 1/{divisor}; at rest sharper after {:.0}, \
             full after {:.0}",
            ms(open),
            ms(first),
            ms(moves[moves.len() / 2]),
            ms(moves[moves.len() - 1]),
            ms(sharper),
            ms(full),
        );
    }
}

/// The camera turned about what it looks at, by a degree a step.
fn turned(camera: &Camera, steps: f64) -> Camera {
    let turn = Transform::rotate(camera.up, steps);
    Camera { eye: camera.target + turn.vector(camera.eye - camera.target), ..*camera }
}
