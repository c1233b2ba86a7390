//! The worker as the window sees it: requests in, events out.
//!
//! No test says how long anything may take, but that it comes at all.

mod latency;
mod opening;
mod rendering;
mod viewing;

use super::*;
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{AmbientOcclusion, Material, Node, Scene, Settings, Shape};
use lancer_core::world::CompileOptions;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Longer than anything here takes: a test that waits so long hangs.
const HANGS: Duration = Duration::from_secs(120);

/// A ball on the ground under the sky.
pub(super) fn scene() -> Scene {
    let mut scene = Scene::new("ball");
    scene.camera.eye = DVec3::new(0.0, 1.5, 6.0);
    scene.camera.target = DVec3::Y;
    scene.ambient = Rgb::grey(0.3);
    scene.background = Rgb::new(0.2, 0.3, 0.5);
    scene.add_light(DVec3::new(4.0, 6.0, 5.0), Rgb::grey(150.0));
    let shiny = scene.add_material(Material { reflect: Rgb::grey(0.3), ..Material::named("shiny") });
    let up = Transform::translate(DVec3::Y);
    scene.add(Node::shape("ball", Shape::Sphere).with_material(shiny).with_transform(up));
    scene.add(Node::shape("ground", Shape::Plane));
    let ao = AmbientOcclusion { samples: 12, distance: 2.0 };
    scene.settings = Settings { width: 160, height: 120, samples: 2, ao, ..Settings::default() };
    scene
}

/// Its picture, at rest.
pub(super) fn request(scene: &Scene) -> ViewRequest {
    ViewRequest {
        scene: Arc::new(scene.clone()),
        revision: 1,
        options: CompileOptions::default(),
        threads: 0,
        camera: scene.camera,
        settings: scene.settings,
        channel: Channel::Picture,
        moving: false,
    }
}

/// The same as a picture of its own.
fn render_request(view: &ViewRequest) -> RenderRequest {
    let ViewRequest { scene, revision, options, threads, camera, settings, channel, .. } = view.clone();
    RenderRequest { scene, revision, options, threads, camera, settings, channel }
}

/// Settings that take longer than any test waits, and a tile of which takes less.
fn endless(settings: Settings) -> Settings {
    let ao = AmbientOcclusion { samples: 64, distance: 2.0 };
    Settings { width: 4000, height: 3000, samples: 8, ao, ..settings }
}

/// A worker, and what wakes its window.
struct Watched {
    worker: Worker,
    wakes: Receiver<()>,
}

impl Watched {
    fn start() -> Self {
        let (sender, wakes) = channel();
        // Who no longer listens ends the test.
        Self { worker: Worker::start(move || sender.send(()).unwrap_or(())), wakes }
    }

    /// All events up to one that `is_last`, which is the last of those returned. They are joined as those that wait
    /// are, or a test would fill the memory with frames.
    fn until(&self, is_last: impl Fn(&Event) -> bool) -> Vec<Event> {
        let deadline = Instant::now() + HANGS;
        let mut events = Vec::new();
        loop {
            self.worker.poll().into_iter().for_each(|event| outbox::join(&mut events, event));
            if let Some(last) = events.iter().position(&is_last) {
                assert_eq!(last + 1, events.len(), "{:?} came after the last", &events[last + 1..]);
                return events;
            }
            let left = deadline.saturating_duration_since(Instant::now());
            assert!(self.wakes.recv_timeout(left).is_ok(), "it never came; these did: {events:?}");
        }
    }

    fn last_of(&self, is_last: impl Fn(&Event) -> bool) -> Event {
        self.until(is_last).pop().unwrap()
    }

    /// The frame at full settings.
    fn final_frame(&self) -> Box<Frame> {
        match self.last_of(|event| matches!(event, Event::Frame(frame) if frame.is_final)) {
            Event::Frame(frame) => frame,
            other => unreachable!("{other:?}"),
        }
    }

    /// Asserts that nothing goes on and nothing was left to tell.
    fn assert_idle(&self) {
        assert!(!self.worker.is_busy());
        let left = self.worker.poll();
        assert!(left.is_empty(), "{left:?}");
    }
}

/// Waits until a condition holds that no event tells of.
fn wait_for(condition: impl Fn() -> bool) {
    let deadline = Instant::now() + HANGS;
    while !condition() {
        assert!(Instant::now() < deadline, "it never came to be");
        std::thread::sleep(Duration::from_millis(2));
    }
}
