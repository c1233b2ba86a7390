//! The dialog in a window: each control by its name, and what it says.

use super::super::{Place, Purpose};
use super::*;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;

struct State {
    picker: Option<FilePicker>,
    language: Language,
    actions: Vec<Action>,
}

fn directory() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    for name in ["a.ply", "b.yaml", "shot.png"] {
        fs::write(directory.path().join(name), name).unwrap();
    }
    fs::create_dir(directory.path().join("more")).unwrap();
    directory
}

fn window(purpose: Purpose, directory: &Path, name: &str, language: Language) -> Harness<'static, State> {
    let places = vec![Place { name: None, path: directory.join("more") }];
    let picker = FilePicker::new(purpose, directory, name, places, || {});
    let state = State { picker: Some(picker), language, actions: Vec::new() };
    let mut window = crate::theme::test_window([900.0, 640.0]).with_step_dt(1.0 / 60.0).build_ui_state(
        |ui, state: &mut State| {
            if let Some(picker) = &mut state.picker
                && !picker.show(ui.ctx(), state.language, &mut state.actions)
            {
                state.picker = None;
            }
        },
        state,
    );
    settle(&mut window);
    window
}

/// Draws until the disk has answered and what it said is drawn.
fn settle(window: &mut Harness<State>) {
    window.run_steps(2);
    while window.state().picker.as_ref().is_some_and(FilePicker::is_waiting) {
        sleep(Duration::from_millis(1));
        window.step();
    }
    window.run();
}

#[test]
fn a_file_that_is_double_clicked_is_opened() {
    let directory = directory();
    let mut window = window(Purpose::Open, directory.path(), "", Language::English);
    for _ in 0..2 {
        window.get_by_label("a.ply").click();
    }
    settle(&mut window);
    let [Action::OpenPath(path)] = &window.state().actions[..] else { panic!() };
    assert_eq!(*path, directory.path().join("a.ply"));
    assert!(window.state().picker.is_none());
}

#[test]
fn a_path_is_typed_and_entered_in_both_languages() {
    let directory = directory();
    for language in Language::ALL {
        let mut window = window(Purpose::SaveScene, directory.path(), "", language);
        window.get_by_label(language.say(PATH_HINT)).type_text("more/new");
        window.run();
        window.key_press(Key::Enter);
        settle(&mut window);
        let [Action::SaveScene(path)] = &window.state().actions[..] else { panic!() };
        assert_eq!(*path, directory.path().join("more/new.yaml"));
    }
}

#[test]
fn arrows_enter_and_backspace_walk_through_directories() {
    let directory = directory();
    let mut window = window(Purpose::Open, directory.path(), "", Language::English);
    let here = |window: &Harness<State>| window.state().picker.as_ref().unwrap().directory().to_owned();
    window.key_press(Key::ArrowDown);
    window.run();
    window.key_press(Key::Enter);
    settle(&mut window);
    assert_eq!(here(&window), directory.path().join("more"));
    window.key_press(Key::Backspace);
    settle(&mut window);
    assert_eq!(here(&window), directory.path());
}

#[test]
fn a_place_is_gone_to() {
    let directory = directory();
    let mut window = window(Purpose::SavePicture, directory.path(), "", Language::English);
    window.get_all_by_label("more").next().unwrap().click();
    settle(&mut window);
    assert_eq!(window.state().picker.as_ref().unwrap().directory(), directory.path().join("more"));
}

#[test]
fn a_file_is_replaced_after_a_question_and_escape_keeps_it() {
    let directory = directory();
    let mut window = window(Purpose::SavePicture, directory.path(), "shot.png", Language::French);
    window.get_by_label("Enregistrer").click();
    settle(&mut window);
    window.key_press(Key::Escape);
    window.run();
    assert!(window.state().actions.is_empty());
    window.get_by_label("Enregistrer").click();
    settle(&mut window);
    window.get_by_label("Le remplacer").click();
    settle(&mut window);
    assert!(matches!(&window.state().actions[..], [Action::SavePicture(path)] if path.ends_with("shot.png")));
}

#[test]
fn what_is_wrong_is_said_in_place_and_in_the_language() {
    let directory = directory();
    for (language, expected) in [(Language::English, "There is no file"), (Language::French, "Il n’y a pas")]
    {
        let mut window = window(Purpose::Open, directory.path(), "none.ply", language);
        window.get_by_label(language.say(PATH_HINT)).type_text("none.ply");
        window.run();
        window.get_by_label(language.say(Purpose::Open.verb())).click();
        settle(&mut window);
        window.get_by_label_contains(expected);
    }
}

#[test]
fn escape_and_the_button_close_it() {
    let directory = directory();
    for close in [
        |window: &Harness<State>| window.key_press(Key::Escape),
        |window: &Harness<State>| {
            window.get_by_label("Close").click();
        },
    ] {
        let mut window = window(Purpose::Open, directory.path(), "", Language::English);
        close(&window);
        settle(&mut window);
        assert!(window.state().picker.is_none() && window.state().actions.is_empty());
    }
}

#[test]
fn sizes_are_read_at_a_glance() {
    let shown = [0, 999, 1000, 45_600, 12_300_000_000].map(|bytes| size_text(bytes, Language::English));
    assert_eq!(shown, ["0 B", "999 B", "1.0 kB", "46 kB", "12 GB"]);
    assert_eq!(size_text(1500, Language::French), "1,5 ko");
}
