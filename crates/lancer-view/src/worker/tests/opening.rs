//! Scenes that are opened.

use super::*;
use lancer_core::mesh::{Mesh, MeshData};
use lancer_gallery::BuiltinScene;
use std::sync::Mutex;
use std::sync::mpsc::Sender;

fn builtin(name: &str) -> Source {
    Source::Builtin(lancer_gallery::find(name).unwrap())
}

fn is_end(event: &Event) -> bool {
    matches!(event, Event::Opened(_) | Event::OpenFailed { .. } | Event::OpenCancelled { .. })
}

/// A scene whose code panics.
struct Faulty;

impl BuiltinScene for Faulty {
    fn name(&self) -> &'static str {
        "faulty"
    }

    fn summary(&self) -> &'static str {
        "Nothing"
    }

    fn build(&self) -> Scene {
        panic!("the scene is faulty")
    }
}

/// A scene that takes as long to read as the test wants.
struct Slow {
    gate: Mutex<Receiver<()>>,
    mesh: Mutex<Option<Arc<Mesh>>>,
}

impl Slow {
    /// The scene, what opens its gate, and what lives as long as the scene that is built.
    fn source() -> (Source, Sender<()>, std::sync::Weak<Mesh>) {
        let (open, gate) = channel();
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let data = MeshData { positions, indices: vec![[0, 1, 2]], ..MeshData::default() };
        let mesh = Arc::new(Mesh::new(data).unwrap());
        let alive = Arc::downgrade(&mesh);
        let slow = Self { gate: Mutex::new(gate), mesh: Mutex::new(Some(mesh)) };
        (Source::Builtin(Box::leak(Box::new(slow))), open, alive)
    }
}

impl BuiltinScene for Slow {
    fn name(&self) -> &'static str {
        "slow"
    }

    fn summary(&self) -> &'static str {
        "A triangle"
    }

    fn build(&self) -> Scene {
        self.gate.lock().unwrap().recv().unwrap();
        let mut scene = Scene::new("slow");
        scene.add(Node::mesh("triangle", self.mesh.lock().unwrap().take().unwrap()));
        scene
    }
}

#[test]
fn a_scene_is_read_built_and_opened_and_the_view_takes_its_world() {
    let watched = Watched::start();
    watched.worker.open(builtin("teapot"), LoadOptions::default());
    let mut events = watched.until(is_end);
    watched.assert_idle();
    let Some(Event::Opened(opened)) = events.pop() else { panic!("{events:?}") };
    let stages = events.iter().map(|event| match event {
        Event::Opening { source, stage } if *source == builtin("teapot") => *stage,
        other => panic!("{other:?}"),
    });
    assert_eq!(stages.collect::<Vec<_>>(), [OpenStage::Reading, OpenStage::Building]);
    let scene = &opened.loaded.scene;
    watched.worker.view(ViewRequest {
        settings: Settings { width: 20, height: 15, ..scene.settings },
        ..request(scene)
    });
    assert!(Arc::ptr_eq(&watched.final_frame().world, &opened.world));
}

#[test]
fn a_broken_file_is_told_with_its_line_and_the_old_scene_is_still_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.yaml");
    std::fs::write(&path, "objects:\n  - sphere: {radius: -1}\n").unwrap();
    let watched = Watched::start();
    watched.worker.view(request(&scene()));
    let before = watched.final_frame();
    watched.worker.open(Source::File(path.clone()), LoadOptions::default());
    match watched.last_of(is_end) {
        Event::OpenFailed { source, error } => {
            assert_eq!(source, Source::File(path));
            assert!(error.to_string().contains("broken.yaml:2:"), "{error}");
        }
        other => panic!("{other:?}"),
    }
    watched.assert_idle();
    let mut moved = request(&scene());
    moved.camera.fov = 20.0;
    watched.worker.view(moved);
    assert!(Arc::ptr_eq(&watched.final_frame().world, &before.world));
}

#[test]
fn a_scene_that_draws_nothing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("empty.yaml");
    std::fs::write(&path, "objects: []\n").unwrap();
    let watched = Watched::start();
    watched.worker.open(Source::File(path), LoadOptions::default());
    let failed = watched.last_of(is_end);
    assert!(
        matches!(&failed, Event::OpenFailed { error, .. } if error.to_string().contains("empty.yaml")),
        "{failed:?}"
    );
}

#[test]
fn a_scene_that_panics_becomes_a_message_and_the_next_is_opened() {
    let watched = Watched::start();
    watched.worker.open(Source::Builtin(&Faulty), LoadOptions::default());
    match watched.last_of(is_end) {
        Event::OpenFailed { error, .. } => {
            assert!(error.to_string().contains("the scene is faulty"), "{error}");
        }
        other => panic!("{other:?}"),
    }
    watched.assert_idle();
    watched.worker.open(builtin("whitted"), LoadOptions::default());
    assert!(matches!(watched.last_of(is_end), Event::Opened(_)));
}

#[test]
fn opening_is_cancelled_while_a_file_is_still_read_and_what_it_brings_is_dropped() {
    let watched = Watched::start();
    let (slow, gate, alive) = Slow::source();
    watched.worker.open(slow.clone(), LoadOptions::default());
    assert!(watched.worker.is_busy());
    watched.worker.cancel_open();
    let last = watched.last_of(is_end);
    assert!(matches!(last, Event::OpenCancelled { source } if source == slow));
    watched.assert_idle();
    gate.send(()).unwrap();
    wait_for(|| alive.strong_count() == 0);
    watched.assert_idle();
}

#[test]
fn the_scene_that_was_opened_last_wins() {
    let watched = Watched::start();
    let (slow, gate, alive) = Slow::source();
    watched.worker.open(slow, LoadOptions::default());
    watched.worker.open(builtin("whitted"), LoadOptions::default());
    match watched.last_of(is_end) {
        Event::Opened(opened) => assert_eq!(opened.source, builtin("whitted")),
        other => panic!("{other:?}"),
    }
    gate.send(()).unwrap();
    wait_for(|| alive.strong_count() == 0);
    watched.assert_idle();
}

#[test]
fn the_view_goes_on_while_a_scene_is_opened() {
    let watched = Watched::start();
    let (slow, gate, _) = Slow::source();
    watched.worker.open(slow, LoadOptions::default());
    watched.worker.view(request(&scene()));
    watched.final_frame();
    assert!(watched.worker.is_busy(), "the scene is still being read");
    gate.send(()).unwrap();
    assert!(matches!(watched.last_of(is_end), Event::Opened(_)));
    watched.assert_idle();
}
