//! Scenes and what is said of them: the program itself is asked, in a directory with the files that a page names.

use crate::pages::{Block, Page, all, files_below, repository};
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

#[test]
fn every_scene_in_the_documents_is_valid_unless_its_faults_are_shown() {
    let mut checked = 0;
    for page in all() {
        let directory = directory_with_models();
        for block in page.blocks.iter().filter(|block| block.language == "yaml") {
            let name = file_name(block);
            if name.is_some_and(|name| sessions(&page).any(|session| session.text.contains(name))) {
                continue;
            }
            checked += 1;
            let name = name.unwrap_or("scene.yaml");
            fs::write(directory.path().join(name), whole_scene(&block.text)).unwrap();
            let (said, code) = run(directory.path(), &format!("lancer check {name}"));
            assert_eq!(code, Some(0), "{}: {said}", block.place);
            // An excerpt may leave out the lights, or what uses its materials.
            let is_whole = block.text.contains("\nobjects:") && block.text.contains("format:");
            assert!(!is_whole || !said.contains("warning"), "{}: {said}", block.place);
        }
    }
    assert!(checked >= 10, "only {checked} scenes were found");
}

#[test]
fn the_scenes_of_the_pictures_are_valid() {
    let root = repository();
    let scenes = files_below(&root.join("docs/scenes"), "yaml");
    assert!(scenes.len() >= 12);
    for scene in scenes {
        let scene = scene.strip_prefix(&root).unwrap().display().to_string();
        let (said, code) = run(&root, &format!("lancer check {scene}"));
        assert!(code == Some(0) && !said.contains("warning"), "{scene}: {said}");
    }
}

/// Blocks of `console`: a line with `$ `, then what the program answers.
#[test]
fn what_the_program_says_in_the_documents_is_what_it_says() {
    let mut checked = 0;
    for page in all() {
        let directory = directory_with_models();
        for block in page.blocks.iter().filter(|block| block.language == "yaml") {
            if let Some(name) = file_name(block) {
                fs::write(directory.path().join(name), &block.text).unwrap();
            }
        }
        for session in sessions(&page) {
            for told in session.text.split("$ ").skip(1) {
                let (command, answer) = told.split_once('\n').unwrap_or((told, ""));
                if !is_of_lancer(command) || (opens_a_window(command) && !cfg!(feature = "window")) {
                    continue;
                }
                checked += 1;
                let (said, _) = run(directory.path(), command);
                assert!(is_answer(&said, answer), "{}: `{command}` says\n{said}", session.place);
            }
        }
    }
    assert!(checked >= 10, "only {checked} commands were found");
}

fn sessions(page: &Page) -> impl Iterator<Item = &Block> {
    page.blocks.iter().filter(|block| block.language == "console")
}

/// Whether the program said what a page quotes. A quoted line that ends in `…` is only the beginning of one.
fn is_answer(said: &str, quoted: &str) -> bool {
    let (said, quoted) = (said.trim_end().lines(), quoted.trim_end().lines());
    said.clone().count() == quoted.clone().count()
        && said.zip(quoted).all(|(said, quoted)| match quoted.strip_suffix('…') {
            Some(beginning) => said.starts_with(beginning),
            None => said == quoted,
        })
}

fn is_of_lancer(command: &str) -> bool {
    arguments(command).is_some()
}

fn opens_a_window(command: &str) -> bool {
    let words = arguments(command).unwrap_or("").split_whitespace();
    !words.take(1).any(|word| ["render", "check", "info", "scenes", "help"].contains(&word))
}

/// What follows `lancer` in a command line, perhaps behind other commands and variables.
fn arguments(command: &str) -> Option<&str> {
    let last = command.rsplit("&& ").next()?;
    let program = last.split_whitespace().find(|word| !word.contains('='))?;
    (program == "lancer").then(|| last.split_once("lancer").map_or("", |(_, arguments)| arguments))
}

/// The file that a block is to be saved as, which its first line says: `# ball.yaml`.
fn file_name(block: &Block) -> Option<&str> {
    let name = block.text.lines().next()?.strip_prefix("# ")?;
    (!name.contains(' ') && name.ends_with(".yaml")).then_some(name)
}

/// A scene with the keys that an excerpt of one leaves out.
fn whole_scene(text: &str) -> String {
    let has = |key: &str| text.lines().any(|line| line.starts_with(key));
    let mut scene = String::new();
    for (key, value) in [("format:", "format: 1\n"), ("objects:", "objects: [{shape: sphere}]\n")] {
        if !has(key) {
            scene.push_str(value);
        }
    }
    scene + text
}

/// A directory with the files that the documents' scenes name.
fn directory_with_models() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(directory.path().join(name), bytes).unwrap();
    fs::create_dir(directory.path().join("models")).unwrap();
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    write("models/bunny.obj", tetrahedron.as_bytes());
    let wood = image::RgbImage::from_pixel(2, 2, image::Rgb([160, 110, 60]));
    wood.save(directory.path().join("wood.png")).unwrap();
    directory
}

/// Runs a command line in a directory, without a display: what it says, and its exit code.
fn run(directory: &Path, command: &str) -> (String, Option<i32>) {
    let program = Path::new(env!("CARGO_BIN_EXE_lancer"));
    let mut path = program.parent().unwrap().as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let mut shell = Command::new("sh");
    shell.current_dir(directory).env("PATH", path).args(["-c", &format!("{{ {command}; }} 2>&1")]);
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        // Where the command itself names one, it is there again.
        shell.env_remove(variable);
    }
    let output = shell.output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), output.status.code())
}
