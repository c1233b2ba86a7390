//! The viewport.

use super::*;
use lancer_core::camera::Camera;
use lancer_core::film::Image;
use lancer_core::render::{Control, render, render_occlusion};
use lancer_core::world::World;
use std::sync::mpsc::sync_channel;

fn bits(image: &Image) -> Vec<[u32; 3]> {
    image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn the_final_frame_has_the_bytes_of_the_renderer_and_nothing_comes_after_it() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let watched = Watched::start();
    for channel in [Channel::Picture, Channel::Occlusion] {
        watched.worker.view(ViewRequest { channel, ..request(&scene) });
        let frame = watched.final_frame();
        watched.assert_idle();
        let make = if channel == Channel::Picture { render } else { render_occlusion };
        let expected = make(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap();
        assert_eq!(bits(&frame.image), bits(&expected.image), "{channel:?}");
        assert_eq!(frame.rays, expected.rays);
        assert_eq!((frame.features.width(), frame.features.height()), (160, 120));
    }
}

#[test]
fn every_channel_comes_at_the_size_of_the_viewport() {
    let watched = Watched::start();
    for channel in Channel::ALL {
        watched.worker.view(ViewRequest { channel, ..request(&scene()) });
        let frame = watched.final_frame();
        assert_eq!((frame.image.width(), frame.image.height()), (160, 120), "{channel:?}");
        assert!(
            frame.image.pixels().iter().any(|pixel| pixel != &frame.image.pixels()[0]),
            "{channel:?} is blank"
        );
    }
}

#[test]
fn at_rest_the_images_only_grow_and_the_last_pass_only_gains_tiles() {
    // A wake that waits for the window shows it every frame.
    let (sender, wakes) = sync_channel(0);
    let worker = Worker::start(move || sender.send(()).unwrap_or(()));
    let mut scene = scene();
    scene.settings = Settings { width: 400, height: 300, samples: 3, ..scene.settings };
    worker.view(request(&scene));
    let mut frames = Vec::<Box<Frame>>::new();
    while !frames.last().is_some_and(|frame| frame.is_final) {
        wakes.recv_timeout(HANGS).unwrap();
        for event in worker.poll() {
            match event {
                Event::Frame(frame) => frames.push(frame),
                other => panic!("{other:?}"),
            }
        }
    }
    assert!(frames[0].image.width() < 100, "the first image comes soon");
    for pair in frames.windows(2) {
        let [before, after] = pair else { unreachable!() };
        assert!(before.image.width() <= after.image.width() && before.pass <= after.pass);
        assert!(before.pass < after.pass || before.tiles_done <= after.tiles_done);
        assert!(after.features.width() >= after.image.width());
        assert!(after.pass < after.passes);
    }
    drop(wakes);
}

#[test]
fn the_latest_request_wins() {
    let scene = scene();
    let watched = Watched::start();
    let mut last = request(&scene);
    for i in 0..20_u32 {
        last.camera = Camera { eye: scene.camera.eye + DVec3::X * f64::from(i), ..scene.camera };
        last.revision = i.into();
        watched.worker.view(last.clone());
    }
    let final_of_last =
        |event: &Event| matches!(event, Event::Frame(frame) if frame.is_final && frame.camera == last.camera);
    watched.until(final_of_last);
    watched.assert_idle();
}

#[test]
fn another_request_ends_one_that_takes_for_ever() {
    let watched = Watched::start();
    let scene = scene();
    watched.worker.view(ViewRequest { settings: endless(scene.settings), ..request(&scene) });
    watched.until(|event| matches!(event, Event::Frame(_)));
    watched.worker.view(request(&scene));
    assert_eq!(watched.final_frame().width, scene.settings.width);
    watched.assert_idle();
}

#[test]
fn in_motion_there_is_one_image_and_at_rest_the_picture_comes() {
    let watched = Watched::start();
    let moving = ViewRequest { moving: true, ..request(&scene()) };
    watched.worker.view(moving.clone());
    let Event::Frame(frame) = watched.last_of(|event| matches!(event, Event::Frame(_))) else {
        unreachable!()
    };
    assert!(!frame.is_final);
    watched.assert_idle();
    watched.worker.view(moving.clone());
    watched.assert_idle();
    watched.worker.view(ViewRequest { moving: false, ..moving });
    watched.final_frame();
    watched.assert_idle();
}

#[test]
fn a_request_like_the_last_one_does_nothing() {
    let watched = Watched::start();
    watched.worker.view(request(&scene()));
    watched.final_frame();
    watched.worker.view(request(&scene()));
    watched.assert_idle();
}

#[test]
fn an_edit_of_what_is_not_traced_tells_the_same_image_with_the_new_revision() {
    let watched = Watched::start();
    let mut scene = scene();
    watched.worker.view(request(&scene));
    let first = watched.final_frame();
    scene.tone.exposure = 1.0;
    watched.worker.view(ViewRequest { revision: 2, ..request(&scene) });
    let second = watched.final_frame();
    assert!(Arc::ptr_eq(&first.world, &second.world) && first.image == second.image);
    assert_eq!((first.revision, second.revision), (1, 2));
    scene.materials_mut()[0].diffuse = Rgb::grey(0.1);
    watched.worker.view(ViewRequest { revision: 3, ..request(&scene) });
    let third = watched.final_frame();
    assert!(!Arc::ptr_eq(&first.world, &third.world) && first.image != third.image);
}

#[test]
fn what_cannot_be_shown_is_told_and_the_next_request_is_shown() {
    let watched = Watched::start();
    let good = request(&scene());
    let empty = ViewRequest { scene: Arc::new(Scene::new("empty")), ..good.clone() };
    let blind = ViewRequest { camera: Camera { fov: 0.0, ..good.camera }, ..good.clone() };
    let flat = ViewRequest { settings: Settings { width: 0, ..good.settings }, ..good.clone() };
    let absurd = ViewRequest { settings: Settings { samples: u32::MAX, ..good.settings }, ..good.clone() };
    for (bad, about) in [(empty, "draws nothing"), (blind, "fov"), (flat, "width"), (absurd, "samples")] {
        watched.worker.view(bad);
        match watched.last_of(|event| matches!(event, Event::ViewFailed { .. })) {
            Event::ViewFailed { message } => assert!(message.contains(about), "{message}"),
            other => unreachable!("{other:?}"),
        }
        watched.assert_idle();
        watched.worker.view(good.clone());
        watched.final_frame();
    }
}

#[test]
fn a_panic_on_the_render_thread_becomes_a_message_and_the_next_request_is_shown() {
    let watched = Watched::start();
    watched.worker.desk.run(|| panic!("a test's own"));
    match watched.last_of(|event| matches!(event, Event::ViewFailed { .. })) {
        Event::ViewFailed { message } => assert_eq!(message, "a bug in Lancer: a test's own"),
        other => unreachable!("{other:?}"),
    }
    watched.worker.view(request(&scene()));
    watched.final_frame();
}

#[test]
fn a_stopped_view_lets_go_and_a_dropped_worker_too() {
    let watched = Watched::start();
    let scene = scene();
    let endless = ViewRequest { settings: endless(scene.settings), ..request(&scene) };
    watched.worker.view(endless.clone());
    watched.until(|event| matches!(event, Event::Frame(_)));
    watched.worker.stop_view();
    assert!(!watched.worker.is_busy());
    watched.worker.view(endless.clone());
    let held = Arc::downgrade(&endless.scene);
    drop((watched, endless));
    wait_for(|| held.strong_count() == 0);
}
