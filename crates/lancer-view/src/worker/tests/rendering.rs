//! Pictures of their own.

use super::*;
use lancer_core::render::{Control, render};
use lancer_core::world::World;

fn is_end(event: &Event) -> bool {
    matches!(event, Event::RenderDone(_) | Event::RenderFailed { .. })
}

#[test]
fn a_render_tells_its_tiles_on_the_way_and_ends_with_the_bytes_of_the_renderer() {
    let mut scene = scene();
    scene.settings = Settings { width: 320, height: 240, samples: 4, ..scene.settings };
    let watched = Watched::start();
    let id = watched.worker.render(render_request(&request(&scene)));
    let mut events = watched.until(is_end);
    watched.assert_idle();
    let Some(Event::RenderDone(done)) = events.pop() else { panic!("{events:?}") };
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let expected = render(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap();
    assert_eq!((done.id, done.rays, &done.image), (id, expected.rays, &expected.image));
    assert!(matches!(events.remove(0), Event::RenderStarted(started) if started == id));
    for event in events {
        let Event::RenderProgress(of, progress) = event else { panic!("{event:?}") };
        assert!(of == id && (0.0..=1.0).contains(&progress.done));
        for tile in progress.tiles {
            let mut with_tile = done.image.clone();
            with_tile.put(tile.x, tile.y, tile.width, &tile.pixels);
            assert_eq!(with_tile, done.image, "a tile is a part of the picture");
        }
    }
    let middle = done.feature_at(160, 120).unwrap();
    assert_eq!(scene.node(middle.node).name, "ball");
    assert!(done.feature_at(0, 0).is_none());
}

#[test]
fn a_cancelled_render_says_so_and_the_next_is_made() {
    let watched = Watched::start();
    let mut request = render_request(&request(&scene()));
    let small = request.settings;
    request.settings = endless(small);
    let cancelled = watched.worker.render(request.clone());
    watched.until(|event| matches!(event, Event::RenderProgress(..)));
    watched.worker.cancel_render();
    let failed = watched.last_of(is_end);
    let expected = RenderFault::Cancelled;
    assert!(matches!(failed, Event::RenderFailed { id, error } if id == cancelled && error == expected));
    watched.assert_idle();
    request.settings = small;
    let done = watched.worker.render(request);
    assert!(matches!(watched.last_of(is_end), Event::RenderDone(rendered) if rendered.id == done));
}

#[test]
fn the_latest_render_wins_and_each_other_ends_as_cancelled() {
    let watched = Watched::start();
    let small = render_request(&request(&scene()));
    let long = RenderRequest { settings: endless(small.settings), ..small.clone() };
    let cancelled = (0..3).map(|_| watched.worker.render(long.clone())).collect::<Vec<_>>();
    let last = watched.worker.render(small);
    let mut failed = watched
        .until(|event| matches!(event, Event::RenderDone(done) if done.id == last))
        .into_iter()
        .filter_map(|event| match event {
            Event::RenderFailed { id, error: RenderFault::Cancelled } => Some(id),
            _ => None,
        })
        .collect::<Vec<_>>();
    failed.sort();
    assert_eq!(failed, cancelled);
}

#[test]
fn the_view_rests_while_a_picture_is_made_and_goes_on_after() {
    let watched = Watched::start();
    let scene = scene();
    let view = ViewRequest { settings: endless(scene.settings), ..request(&scene) };
    watched.worker.view(view);
    watched.until(|event| matches!(event, Event::Frame(_)));
    watched.worker.render(render_request(&request(&scene)));
    let events = watched.until(|event| matches!(event, Event::RenderDone(_)));
    let started = events.iter().position(|event| matches!(event, Event::RenderStarted(_))).unwrap();
    assert!(!events[started..].iter().any(|event| matches!(event, Event::Frame(_))));
    watched.until(|event| matches!(event, Event::Frame(_)));
    watched.worker.stop_view();
}

#[test]
fn what_cannot_be_rendered_is_told() {
    let watched = Watched::start();
    let mut request = render_request(&request(&scene()));
    request.settings.width = 0;
    watched.worker.render(request);
    match watched.last_of(is_end) {
        Event::RenderFailed { error: RenderFault::Message(message), .. } => {
            assert!(message.contains("width"));
        }
        other => panic!("{other:?}"),
    }
}
