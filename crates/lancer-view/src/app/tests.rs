//! The whole window without a display: what its users do, and what comes of it.

use super::*;
use crate::Command;
use crate::preferences::PreferencesFile;
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lancer_core::render::{Control, render};
use lancer_core::scene::Settings;
use lancer_core::world::World;
use std::path::Path;
use std::time::{Duration, Instant};

/// The application, once there is a context to make it for.
struct Stage {
    source: Source,
    language: Language,
    directory: tempfile::TempDir,
    app: Option<App>,
}

type Window = Harness<'static, Stage>;

const SIZE: Vec2 = vec2(1000.0, 640.0);

fn window_of(source: Source, language: Language) -> Window {
    let mut window = window_before(source, language);
    wait(&mut window, "the scene is shown", |app| app.document.is_some() && app.live.frame().is_some());
    window
}

/// The window when it has just been asked to show something.
fn window_before(source: Source, language: Language) -> Window {
    let directory = tempfile::tempdir().unwrap();
    let stage = Stage { source, language, directory, app: None };
    Harness::builder().with_size(SIZE).with_max_steps(64).build_ui_state(
        |ui, stage: &mut Stage| {
            let Stage { source, language, directory, app } = stage;
            let app = app.get_or_insert_with(|| {
                let options = Options { source: source.clone(), load: LoadOptions::default() };
                let mut remembered = Remembered::load(PreferencesFile::in_directory(directory.path()));
                remembered.preferences.language = Some(*language);
                App::new(ui.ctx(), options, remembered)
            });
            app.frame(ui);
        },
        stage,
    )
}

fn window(name: &str) -> Window {
    window_of(Source::Builtin(lancer_gallery::find(name).unwrap()), Language::English)
}

fn window_on(path: &Path) -> Window {
    window_of(Source::File(path.to_owned()), Language::English)
}

fn app(window: &Window) -> &App {
    window.state().app.as_ref().expect("made by the first frame")
}

/// Lets the window live until something has come about.
fn wait(window: &mut Window, what: &str, is_so: impl Fn(&App) -> bool) {
    // Only a guard against waiting for ever; debug builds on a busy machine are slow.
    let until = Instant::now() + Duration::from_secs(120);
    loop {
        window.run_steps(1);
        if window.state().app.as_ref().is_some_and(&is_so) {
            return;
        }
        assert!(Instant::now() < until, "it never came about that {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn wait_until_refined(window: &mut Window) {
    wait(window, "the picture is refined", |app| app.live.is_final());
}

fn press(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(2);
}

fn command(window: &mut Window, command: Command) {
    let shortcut = command.shortcuts()[0];
    press(window, shortcut.modifiers, shortcut.logical_key);
}

/// The middle of the live picture, on the screen.
fn middle(window: &Window) -> Pos2 {
    window.get_by_label("Live picture").rect().center()
}

fn drag(window: &mut Window, button: PointerButton, from: Pos2, to: Pos2) {
    let pressed = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE };
    window.event(Event::PointerMoved(from));
    window.event(pressed(from, true));
    window.run_steps(1);
    for step in 1..=4_u8 {
        window.event(Event::PointerMoved(from + (to - from) * (f32::from(step) / 4.0)));
        window.run_steps(1);
    }
    window.event(pressed(to, false));
    window.run_steps(2);
}

#[test]
fn the_picture_at_rest_is_the_one_that_render_makes() {
    let mut window = window("shadows");
    wait_until_refined(&mut window);
    let app = app(&window);
    let frame = app.live.frame().unwrap();
    let scene = app.document.as_ref().unwrap().scene();
    let world = World::compile(scene, &CompileOptions::default()).unwrap();
    let settings = Settings { width: frame.width, height: frame.height, ..scene.settings };
    let expected = render(&world, &scene.camera, &settings, None, &Control::default()).unwrap();
    assert!(frame.image == expected.image);
}

#[test]
fn left_drag_keeps_what_was_grabbed_under_the_cursor() {
    let mut window = window("primitives");
    let from = middle(&window);
    let to = from + vec2(60.0, -35.0);
    let before = app(&window).navigator.camera();
    drag(&mut window, PointerButton::Primary, from, to);
    let app = app(&window);
    let camera = app.navigator.camera();
    let (width, height) = app.live.size;
    let world = &app.live.frame().unwrap().world;
    let at = |pos: Pos2| {
        let offset = pos - from;
        DVec2::new(
            0.5 * f64::from(width) + f64::from(offset.x),
            0.5 * f64::from(height) + f64::from(offset.y),
        )
    };
    let start = at(from);
    let grabbed = lancer_core::render::feature_at(world, &before, width, height, start.x, start.y);
    let point = grabbed.unwrap().expect("something is in the middle").point;
    let (x, y, _) = camera.project(width, height).unwrap().pixel_of(point).unwrap();
    assert!((DVec2::new(x, y) - at(to)).length() < 1.0, "({x}, {y}) is not {}", at(to));
    assert!(camera != before);
}

#[test]
fn right_drag_turns_about_the_point_of_interest_and_middle_drag_goes_nearer() {
    let mut window = window("primitives");
    let from = middle(&window);
    let (before, interest) = {
        let app = app(&window);
        (app.navigator.camera(), app.navigator.point_of_interest())
    };
    drag(&mut window, PointerButton::Secondary, from, from + vec2(80.0, 20.0));
    let turned = app(&window).navigator.camera();
    let distance = |eye: lancer_core::geometry::DVec3| (eye - interest).length();
    assert!(turned.eye != before.eye);
    assert!((distance(turned.eye) / distance(before.eye) - 1.0).abs() < 1e-9);
    drag(&mut window, PointerButton::Middle, from, from - vec2(0.0, 60.0));
    assert!(distance(app(&window).navigator.camera().eye) != distance(turned.eye));
}

#[test]
fn keys_look_along_axes_frame_everything_and_go_home() {
    let mut window = window("primitives");
    let home = app(&window).navigator.camera();
    for view in [Command::Front, Command::Right, Command::Top, Command::Back, Command::Left, Command::Bottom]
    {
        command(&mut window, view);
        let camera = app(&window).navigator.camera();
        let along = (camera.eye - app(&window).navigator.point_of_interest()).normalize().abs();
        assert!(along.max_element() > 1.0 - 1e-9, "{view:?} looks along {along}");
    }
    command(&mut window, Command::FrameAll);
    command(&mut window, Command::Home);
    assert_eq!(app(&window).navigator.camera(), home);
}

#[test]
fn a_click_selects_what_it_hits_and_escape_does_not_lose_it() {
    let mut window = window("whitted");
    let at = middle(&window);
    window.event(Event::PointerMoved(at));
    for pressed in [true, false] {
        let event = Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        window.event(event);
        window.run_steps(1);
    }
    window.run_steps(2);
    let Selection::Node(node) = app(&window).selection else { panic!("{:?}", app(&window).selection) };
    let scene = std::sync::Arc::clone(app(&window).document.as_ref().unwrap().scene());
    assert!(window.query_all_by_label_contains(&scene.node(node).name).count() > 0);
}

#[test]
fn hiding_showing_undo_and_redo_restore_exactly() {
    let mut window = window("whitted");
    let scene = |window: &Window| std::sync::Arc::clone(app(window).document.as_ref().unwrap().scene());
    let loaded = scene(&window);
    let node = loaded.roots()[1];
    window.state_mut().app.as_mut().unwrap().selection = Selection::Node(node);
    command(&mut window, Command::HideSelection);
    assert!(scene(&window).node(node).hidden);
    command(&mut window, Command::Undo);
    assert_eq!(scene(&window), loaded);
    command(&mut window, Command::Redo);
    assert!(scene(&window).node(node).hidden);
    command(&mut window, Command::ShowAll);
    assert_eq!(scene(&window), loaded);
}

#[test]
fn a_render_is_what_lancer_renders_and_is_kept_beside_others() {
    let mut window = window("highlights");
    {
        let document = window.state_mut().app.as_mut().unwrap().document.as_mut().unwrap();
        let settings = Settings { width: 60, height: 40, ..document.scene().settings };
        document.apply(crate::Edit::Settings(settings));
        document.end_gesture();
    }
    for count in 1..=2 {
        command(&mut window, Command::Render);
        wait(&mut window, "it is rendered", |app| app.shelf.kept.len() == count);
    }
    {
        let app = app(&window);
        let scene = app.document.as_ref().unwrap().scene();
        let world = World::compile(scene, &CompileOptions::default()).unwrap();
        let expected = render(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap();
        assert!(app.shelf.kept[0].rendered.image == expected.image);
        assert_eq!(app.shelf.showing, Showing::Kept(1));
    }
    command(&mut window, Command::Compare);
    assert_eq!(app(&window).shelf.showing, Showing::Compare(0, 1));
    assert!(window.query_by_label("Split between the two pictures").is_some());
    command(&mut window, Command::Compare);
    command(&mut window, Command::PreviousRender);
    assert_eq!(app(&window).shelf.showing, Showing::Kept(0));
    command(&mut window, Command::DeleteRender);
    assert_eq!(app(&window).shelf.kept.len(), 1);
    window.get_by_role_and_label(Role::Button, "Live").click();
    window.run_steps(2);
    assert_eq!(app(&window).shelf.showing, Showing::Live);
}

#[test]
fn escape_cancels_a_render_and_the_view_goes_on() {
    let mut window = window("mirror-room");
    command(&mut window, Command::Render);
    assert!(app(&window).shelf.running.is_some());
    command(&mut window, Command::Cancel);
    wait(&mut window, "it is cancelled", |app| app.shelf.running.is_none());
    assert!(app(&window).shelf.kept.is_empty());
    assert_eq!(app(&window).shelf.showing, Showing::Live);
}

#[test]
fn a_broken_file_is_told_with_its_line_and_the_picture_stays() {
    let mut window = window("whitted");
    let path = window.state().directory.path().join("broken.yaml");
    std::fs::write(&path, "format: 1\nobjects:\n  - {shape: sphrere}\n").unwrap();
    window.state_mut().app.as_mut().unwrap().open(Source::File(path));
    wait(&mut window, "the fault is told", |app| app.faults.is_some());
    window.run_steps(2);
    assert!(window.query_all_by_label_contains("sphrere").count() > 0);
    assert!(app(&window).live.frame().is_some());
    assert_eq!(app(&window).document.as_ref().unwrap().source().title(), "whitted");
}

#[test]
fn a_window_without_a_scene_invites_to_open_one_in_both_languages() {
    for (language, open) in
        [(Language::English, "or open a file…"), (Language::French, "ou ouvrez un fichier…")]
    {
        let missing = Source::File("is-not-there.ply".into());
        let mut window = window_before(missing, language);
        wait(&mut window, "the fault is told", |app| app.faults.is_some());
        window.run_steps(2);
        window.get_by_label(open).click();
        window.run_steps(2);
        assert!(app(&window).picker.is_some());
    }
}

#[test]
fn a_scene_file_is_read_again_when_it_changes_and_keeps_its_comments_when_it_is_saved() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("ball.yaml");
    let text = |radius: f64| {
        format!(
            "format: 1 # mine\ncamera: {{eye: [0, 0, 6], target: [0, 0, 0]}}\nlights: [{{position: [3, 4, 5], intensity: 90}}]\nobjects:\n  # the ball\n  - {{shape: sphere, transform: [{{scale: {radius}}}]}}\nrender: {{width: 40, height: 30}}\n"
        )
    };
    std::fs::write(&path, text(1.0)).unwrap();
    let mut window = window_on(&path);
    let size = |app: &App| app.live.frame().map_or(0.0, |frame| frame.world.bounds().diagonal());
    let small = size(app(&window));
    std::fs::write(&path, text(2.0)).unwrap();
    wait(&mut window, "the change is seen", |app| size(app) > 1.5 * small);

    command(&mut window, Command::Top);
    let camera = app(&window).navigator.camera();
    command(&mut window, Command::SaveScene);
    wait(&mut window, "it is saved", |app| {
        !app.saver.is_busy() && app.document.as_ref().unwrap().scene().camera == camera
    });
    let saved = std::fs::read_to_string(&path).unwrap();
    assert!(saved.contains("format: 1 # mine") && saved.contains("  # the ball"), "{saved}");
    let read = lancer_io::load(&path, &LoadOptions::default()).unwrap().scene;
    assert_eq!(read.camera, camera);
    assert!(!app(&window).document.as_ref().unwrap().is_changed());
}

#[test]
fn changes_are_not_lost_without_a_question() {
    let mut window = window("whitted");
    let other = Source::Builtin(lancer_gallery::find("glass").unwrap());
    {
        let app = window.state_mut().app.as_mut().unwrap();
        app.edit(crate::Edit::Ambient(lancer_core::Rgb::grey(0.7)));
    }
    window.state_mut().app.as_mut().unwrap().open(other.clone());
    window.run_steps(2);
    window.get_by_label("Go back").click();
    window.run_steps(2);
    assert_eq!(app(&window).document.as_ref().unwrap().source().title(), "whitted");
    window.state_mut().app.as_mut().unwrap().open(other);
    window.run_steps(2);
    window.get_by_label("Discard").click();
    wait(&mut window, "the other is open", |app| app.document.as_ref().unwrap().source().title() == "glass");
}

#[test]
fn views_of_depth_normals_objects_and_occlusion_replace_the_picture() {
    let mut window = window("occlusion");
    for (command_of, channel) in [
        (Command::ShowDepth, crate::Channel::Depth),
        (Command::ShowNormals, crate::Channel::Normals),
        (Command::ShowObjects, crate::Channel::Objects),
        (Command::ShowPicture, crate::Channel::Picture),
    ] {
        let before = app(&window).live.frame().unwrap().image.clone();
        command(&mut window, command_of);
        assert_eq!(app(&window).live.channel, channel);
        wait(&mut window, "it is shown", |app| app.live.frame().unwrap().image != before);
    }
}

#[test]
fn pictures_are_saved_as_they_are_shown() {
    let mut window = window("shadows");
    let path = window.state().directory.path().join("live.png");
    let ctx = window.ctx.clone();
    window.state_mut().app.as_mut().unwrap().perform(&ctx, Action::SavePicture(path.clone()));
    wait(&mut window, "it is written", |app| app.save_when_final.is_none() && !app.saver.is_busy());
    let app = app(&window);
    let mut expected = Vec::new();
    let image = app.tone().expose(&app.live.frame().unwrap().image);
    lancer_io::image::encode::write_png(&image, &Default::default(), &mut expected).unwrap();
    assert!(std::fs::read(path).unwrap() == expected);
}

#[test]
fn the_window_speaks_both_languages_and_shows_no_empty_box() {
    for (language, label) in [(Language::English, "Live picture"), (Language::French, "Image en direct")] {
        let source = Source::Builtin(lancer_gallery::find("whitted").unwrap());
        let mut window = window_of(source, language);
        assert!(window.query_by_label(label).is_some());
        // The harness panics where a glyph is missing or a control has no name.
        for shown in [Command::Shortcuts, Command::Palette, Command::Open] {
            command(&mut window, shown);
            window.run_steps(2);
            press(&mut window, Modifiers::NONE, Key::Escape);
        }
    }
}

#[test]
fn what_is_chosen_is_remembered() {
    let mut window = window("whitted");
    command(&mut window, Command::Grid);
    let directory = window.state().directory.path().to_owned();
    window.state_mut().app.as_mut().unwrap().save_preferences();
    let remembered = Remembered::load(PreferencesFile::in_directory(&directory));
    assert!(remembered.preferences.overlay.grid);
}

#[test]
fn a_built_in_scene_that_is_saved_is_that_file_from_then_on() {
    let mut window = window("shadows");
    command(&mut window, Command::Front);
    let camera = app(&window).navigator.camera();
    let path = window.state().directory.path().join("mine.yaml");
    let ctx = window.ctx.clone();
    window.state_mut().app.as_mut().unwrap().perform(&ctx, Action::SaveScene(path.clone()));
    let source = Source::File(path);
    wait(&mut window, "the file is open", |app| *app.document.as_ref().unwrap().source() == source);
    assert_eq!(app(&window).navigator.camera(), camera);
    assert!(!app(&window).has_unsaved_work());
}
