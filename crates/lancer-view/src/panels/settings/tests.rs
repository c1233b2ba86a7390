//! Each control by its name, in both languages, and what it says.

use super::*;
use crate::Source;
use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use lancer_core::accel::Accelerator;
use lancer_core::film::ToneCurve;
use lancer_core::scene::{AmbientOcclusion, Settings};

/// A panel over a document that the actions are carried out on.
struct World {
    panel: SettingsPanel,
    document: Document,
    options: CompileOptions,
    threads: usize,
    language: Language,
    context: CommandContext,
    actions: Vec<Action>,
}

fn window(language: Language) -> Harness<'static, World> {
    window_of("mirror-room", language)
}

fn window_of(name: &str, language: Language) -> Harness<'static, World> {
    let builtin = lancer_gallery::find(name).unwrap();
    let state = World {
        panel: SettingsPanel::default(),
        document: Document::new(Source::Builtin(builtin), builtin.build()),
        options: CompileOptions::default(),
        threads: 0,
        language,
        context: CommandContext { has_document: true, ..CommandContext::default() },
        actions: Vec::new(),
    };
    crate::theme::test_window([320.0, 1100.0]).build_ui_state(
        |ui, world: &mut World| {
            let camera = world.document.scene().camera;
            let recent = [PathBuf::from("/models/bunny.ply")];
            let view = SettingsView {
                document: Some(&world.document),
                recent: &recent,
                camera: &camera,
                options: world.options,
                threads: world.threads,
                commands: &world.context,
            };
            let mut actions = Vec::new();
            world.panel.show(ui, &view, world.language, &mut actions);
            for action in actions {
                match &action {
                    Action::Edit(edit) => world.document.apply(edit.clone()),
                    Action::Options(options) => world.options = *options,
                    Action::Threads(threads) => world.threads = *threads,
                    _ => {}
                }
                world.actions.push(action);
            }
        },
        state,
    )
}

fn settings(window: &Harness<World>) -> Settings {
    window.state().document.scene().settings
}

/// Types a value into the number of that name.
fn set_number(window: &mut Harness<World>, name: &str, text: &str) {
    window.get_by_role_and_label(Role::SpinButton, name).click();
    window.run();
    let field = window.get_all_by_label(name).find(|node| node.accesskit_node().is_focused()).unwrap();
    field.type_text(text);
    window.run();
    window.key_press(eframe::egui::Key::Enter);
    window.run();
}

fn toggle(window: &mut Harness<World>, name: &str) {
    window.get_by_role_and_label(Role::CheckBox, name).click();
    window.run();
}

fn choose(window: &mut Harness<World>, list: &str, entry: &str) {
    window.get_by_role_and_label(Role::ComboBox, list).click();
    window.run();
    window.get_by_role_and_label(Role::Button, entry).click();
    window.run();
}

#[test]
fn numbers_that_are_typed_are_set_in_both_languages() {
    for (language, [width, height, subpixels, depth]) in [
        (Language::English, ["Width", "Height", "Subpixels", "Depth"]),
        (Language::French, ["Largeur", "Hauteur", "Sous-pixels", "Profondeur"]),
    ] {
        let mut window = window(language);
        set_number(&mut window, width, "1920");
        set_number(&mut window, height, "1080");
        set_number(&mut window, subpixels, "3");
        set_number(&mut window, depth, "12");
        let found = settings(&window);
        assert_eq!((found.width, found.height, found.samples, found.depth), (1920, 1080, 3, 12));
    }
}

#[test]
fn typing_a_number_makes_one_edit() {
    let mut window = window(Language::English);
    set_number(&mut window, "Width", "1920");
    assert_eq!(window.state().actions.len(), 1, "{:?}", window.state().actions);
}

#[test]
fn a_number_out_of_its_range_is_set_to_the_end_of_it() {
    let mut window = window(Language::English);
    set_number(&mut window, "Subpixels", "1000");
    assert_eq!(settings(&window).samples, Settings::MAX_SAMPLES);
    set_number(&mut window, "Width", "0");
    assert_eq!(settings(&window).width, 1);
    set_number(&mut window, "Height", "65535");
    set_number(&mut window, "Width", "65535");
    assert_eq!(settings(&window).validate(), Ok(()));
}

#[test]
fn terms_are_switched_in_both_languages() {
    for (language, [shadows, reflections, refractions]) in [
        (Language::English, ["Shadows", "Reflections", "Refractions"]),
        (Language::French, ["Ombres", "Réflexions", "Réfractions"]),
    ] {
        let mut window = window(language);
        toggle(&mut window, shadows);
        toggle(&mut window, reflections);
        toggle(&mut window, refractions);
        let found = settings(&window);
        assert_eq!((found.shadows, found.reflection, found.refraction), (false, false, false));
    }
}

#[test]
fn occlusion_that_is_turned_off_and_on_has_its_samples_again() {
    for (language, [on, samples, distance]) in [
        (Language::English, ["Compute", "Samples", "Distance"]),
        (Language::French, ["Calculer", "Échantillons", "Distance"]),
    ] {
        let mut window = window_of("primitives", language);
        if settings(&window).ao.samples == 0 {
            toggle(&mut window, on);
        }
        set_number(&mut window, samples, "100");
        set_number(&mut window, distance, if language == Language::French { "2,5" } else { "2.5" });
        toggle(&mut window, on);
        assert_eq!(settings(&window).ao.samples, 0);
        toggle(&mut window, on);
        assert_eq!(settings(&window).ao, AmbientOcclusion { samples: 100, distance: 2.5 });
    }
}

#[test]
fn light_background_and_exposure_are_set() {
    let mut window = window(Language::French);
    set_number(&mut window, "Ambiante, vert", "1,5");
    set_number(&mut window, "Arrière-plan, bleu", "0,25");
    set_number(&mut window, "Exposition", "-1");
    let scene = window.state().document.scene();
    assert_eq!((scene.ambient.g, scene.background.b, scene.tone.exposure), (1.5, 0.25, -1.0));
}

#[test]
fn a_tone_curve_is_chosen() {
    for (language, list, name) in
        [(Language::English, "Tone curve", "Filmic"), (Language::French, "Courbe de tons", "Film")]
    {
        let mut window = window(language);
        choose(&mut window, list, name);
        assert_eq!(window.state().document.scene().tone.curve, ToneCurve::Filmic);
    }
}

#[test]
fn a_value_that_was_changed_can_be_reset_and_one_that_was_not_has_no_button() {
    let mut window = window(Language::English);
    assert!(window.query_by_label("Reset Width").is_none());
    let own = settings(&window).width;
    set_number(&mut window, "Width", "99");
    window.get_by_label("Reset Width").click();
    window.run();
    assert_eq!(settings(&window).width, own);
    assert!(window.query_by_label("Reset Width").is_none());
}

#[test]
fn a_usual_size_sets_both_sides_and_linked_sides_follow_it() {
    let mut window = window(Language::English);
    window.get_by_label("Usual sizes").click();
    window.run();
    window.get_by_label_contains("Full HD").click();
    window.run();
    assert_eq!((settings(&window).width, settings(&window).height), (1920, 1080));
    toggle(&mut window, "Keep the ratio");
    set_number(&mut window, "Width", "960");
    assert_eq!((settings(&window).width, settings(&window).height), (960, 540));
}

#[test]
fn the_bounds_of_the_k_d_tree_are_there_when_it_is_chosen() {
    let mut window = window(Language::English);
    assert!(window.query_by_label("Tree depth").is_none());
    choose(&mut window, "Search", "k-d tree");
    assert_eq!(window.state().options.accelerator, Accelerator::KdTree);
    toggle(&mut window, "Triangles a leaf, automatic");
    set_number(&mut window, "Triangles a leaf", "16");
    toggle(&mut window, "Tree depth, automatic");
    set_number(&mut window, "Tree depth", "100");
    let kd = window.state().options.kd;
    assert_eq!((kd.leaf, kd.depth), (Some(16), Some(64)));
    toggle(&mut window, "Tree depth, automatic");
    assert_eq!(window.state().options.kd.depth, None);
}

#[test]
fn threads_are_one_a_core_or_a_number() {
    let mut window = window(Language::French);
    toggle(&mut window, "Fils d’exécution, automatique");
    set_number(&mut window, "Fils d’exécution", "6");
    assert_eq!(window.state().threads, 6);
    toggle(&mut window, "Fils d’exécution, automatique");
    assert_eq!(window.state().threads, 0);
}

#[test]
fn the_list_of_scenes_opens_built_in_ones_and_recent_files() {
    let mut window = window(Language::English);
    choose(&mut window, "Scene", "teapot");
    choose(&mut window, "Scene", "bunny.ply");
    choose(&mut window, "Scene", "Open…");
    let actions = &window.state().actions;
    assert!(matches!(&actions[0], Action::Open(Source::Builtin(scene)) if scene.name() == "teapot"));
    assert!(matches!(&actions[1], Action::Open(Source::File(path)) if path.ends_with("bunny.ply")));
    assert!(matches!(&actions[2], Action::Command(Command::Open)));
}

#[test]
fn the_cameras_of_the_scene_are_listed_with_the_main_one() {
    for (language, list, main) in
        [(Language::English, "Camera", "Main camera"), (Language::French, "Caméra", "Caméra principale")]
    {
        let mut window = window(language);
        let name = window.state().document.scene().cameras[0].0.clone();
        choose(&mut window, list, &name);
        choose(&mut window, list, main);
        let actions = &window.state().actions;
        assert!(matches!(&actions[0], Action::UseCamera(Some(found)) if *found == name));
        assert!(matches!(&actions[1], Action::UseCamera(None)));
    }
}

#[test]
fn the_large_button_renders_and_cancels() {
    for (language, render, cancel) in
        [(Language::English, "Render", "Cancel"), (Language::French, "Calculer l’image", "Interrompre")]
    {
        let mut window = window(language);
        window.get_by_label(render).click();
        window.run();
        window.state_mut().context = CommandContext {
            has_document: true,
            is_working: true,
            is_rendering: true,
            ..CommandContext::default()
        };
        window.run();
        window.get_by_label(cancel).click();
        window.run();
        let actions = &window.state().actions;
        assert!(matches!(actions[..], [Action::Command(Command::Render), Action::Command(Command::Cancel)]));
    }
}
