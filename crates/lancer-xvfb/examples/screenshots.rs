//! Takes the pictures of the window that the documents show: both themes, both languages, two sizes.
//!
//! `cargo run -p lancer-xvfb --example screenshots -- target/release/lancer docs/images [NAME...]`

use lancer_xvfb::{Display, Failure, Program};
use std::path::Path;
use std::process::Command;

/// A picture to take.
struct Shot {
    /// The file, without its ending.
    name: &'static str,
    size: (u16, u16),
    language: &'static str,
    scene: &'static str,
    /// What is done before, as [`do_step`] says.
    steps: &'static [&'static str],
}

const LAPTOP: (u16, u16) = (1280, 800);
const DESKTOP: (u16, u16) = (1920, 1080);
const ENGLISH: &str = "en_GB.UTF-8";
const FRENCH: &str = "fr_FR.UTF-8";

const SHOTS: [Shot; 6] = [
    Shot {
        name: "window-dark",
        size: LAPTOP,
        language: ENGLISH,
        scene: "whitted",
        steps: &["say dark theme"],
    },
    Shot {
        name: "window-light",
        size: LAPTOP,
        language: ENGLISH,
        scene: "mirrors",
        steps: &["say light theme"],
    },
    Shot {
        name: "window-french-dark",
        size: DESKTOP,
        language: FRENCH,
        scene: "sphereflake",
        steps: &["say sombre", "key g", "key l"],
    },
    Shot {
        name: "window-french-light",
        size: LAPTOP,
        language: FRENCH,
        scene: "teapot",
        steps: &["say clair", "key question"],
    },
    Shot {
        name: "window-render",
        size: DESKTOP,
        language: ENGLISH,
        scene: "glass",
        steps: &["say light theme", "key F12"],
    },
    Shot {
        name: "window-palette",
        size: LAPTOP,
        language: ENGLISH,
        scene: "shadows",
        steps: &["say dark theme", "key ctrl+k", "type look"],
    },
];

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args_os().skip(1);
    let (Some(lancer), Some(directory)) = (arguments.next(), arguments.next()) else {
        return Err("usage: screenshots LANCER DIRECTORY [NAME...]".into());
    };
    let only = arguments.collect::<Vec<_>>();
    for shot in SHOTS.iter().filter(|shot| only.is_empty() || only.iter().any(|name| name == shot.name)) {
        let display = Display::start(shot.size.0, shot.size.1)?;
        let command = &mut Command::new(&lancer);
        let mut program = Program::start(&display, command.arg(shot.scene).env("LANG", shot.language))?;
        program.place_window(display.area())?;
        program.settle()?;
        for step in shot.steps {
            do_step(&display, &mut program, step)?;
        }
        // Notes of what was done go by themselves.
        program.settle()?;
        display.picture()?.save(&Path::new(&directory).join(shot.name).with_extension("png"))?;
    }
    Ok(())
}

/// Does one thing: `key CHORD`, `type TEXT`, or `say COMMAND` into the command palette.
fn do_step(display: &Display, program: &mut Program<'_>, step: &str) -> Result<(), Failure> {
    match step.split_once(' ') {
        Some(("key", chord)) => display.keys(&[chord])?,
        Some(("type", text)) => display.text(text)?,
        Some(("say", command)) => {
            display.keys(&["ctrl+k"])?;
            program.settle()?;
            display.text(command)?;
            program.settle()?;
            display.keys(&["Return"])?;
        }
        _ => return Err(format!("no such step: {step}").into()),
    }
    program.settle()
}
