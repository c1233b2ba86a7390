//! How soon the window answers: measured from outside, on a virtual display, with the mouse in hand.
//!
//! What is measured is what a person would see: pixels of the display, looked at every few milliseconds. The
//! display is drawn in software, by the processors that trace.

mod session;

use crate::Failure;
use crate::record::{keep, median};
use lancer_xvfb::{Area, Display};
use serde_json::{Value, json};
use session::Session;
use std::path::{Path, PathBuf};

/// `lancer-bench window`.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Built-in scenes, scene files and models to show.
    #[arg(default_values = ["whitted", "mirror-room"])]
    scenes: Vec<String>,
    /// Starts of the window for each scene; medians are printed, all are kept with --raw.
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// Moves of the mouse in each run.
    #[arg(long, default_value_t = 5)]
    moves: usize,
    /// Columns of the display, all of which the window takes.
    #[arg(long, default_value_t = 1280)]
    width: u16,
    /// Rows of the display.
    #[arg(long, default_value_t = 800)]
    height: u16,
    /// Lancer's program, if not beside this one.
    #[arg(long)]
    lancer: Option<PathBuf>,
    /// Write all figures, with the date and the machine's name, into this directory.
    #[arg(long)]
    raw: Option<PathBuf>,
}

/// What one start of the window gave. All times are in seconds.
struct Run {
    /// From before the program's start until its window is seen.
    window: f64,
    /// ... until the scene is seen, however coarse.
    first_picture: f64,
    /// ... until the picture does not change any more.
    sharp: f64,
    /// From each move of the mouse, the left button held and the picture at rest, until the picture changes.
    changes: Vec<f64>,
    /// From letting the button go until the picture does not change any more.
    refinements: Vec<f64>,
    /// Between the pictures that are seen while the mouse moves on and on.
    gaps: Vec<f64>,
    /// ... until a menu lights up for the first time, the mouse having come to it when the window was seen.
    ready: f64,
    /// From each further move of the mouse onto a menu until it lights up.
    answers: Vec<f64>,
    /// From the key that cancels until the window is back, for a render, and for the reading of a file.
    cancels: Vec<f64>,
    /// Processors in use while nothing happens: 1 is all of one.
    idle: f64,
}

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(plan: &Plan) -> Result<(), Failure> {
    let lancer = crate::peers::lancer_program(plan.lancer.as_deref())?;
    println!(
        "The window, {} x {}: seconds from the start; milliseconds from a move; pictures a second in a drag.\n",
        plan.width, plan.height
    );
    println!(
        "| scene | window, s | answers, s | first picture, s | sharp, s | move to change, ms | slowest | let go to sharp, ms | in a drag, 1/s | longest gap, ms | slowest answer, ms | slowest cancel, ms | idle |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let mut records = Vec::new();
    for scene in &plan.scenes {
        let runs = (0..plan.runs.max(1)).map(|_| run(plan, &lancer, scene)).collect::<Result<Vec<_>, _>>()?;
        let name = Path::new(scene).file_stem().unwrap_or_default().to_string_lossy();
        println!("{}", row(&name, &runs));
        records.extend(runs.iter().map(|run| run.record(&name)));
    }
    if let Some(directory) = &plan.raw {
        println!("\nall figures: {}", keep(directory, "window", &records)?.display());
    }
    Ok(())
}

/// Starts the window on a scene, and does what a person would.
fn run(plan: &Plan, lancer: &Path, scene: &str) -> Result<Run, Failure> {
    let display = Display::start(plan.width, plan.height)?;
    let mut session = Session::start(&display, lancer, scene, middle(&display))?;
    let started = session.watch_start()?;
    let moves = (0..plan.moves).map(|_| session.watch_move()).collect::<Result<Vec<_>, _>>()?;
    let (changes, refinements) = moves.into_iter().unzip();
    let gaps = session.watch_drag()?;
    let idle = session.watch_idleness()?;
    let mut cancels = vec![session.watch_cancelled_render()?];
    drop(session);
    let start = || Session::start(&display, lancer, scene, middle(&display));
    let (ready, answers) = start()?.watch_answers()?;
    if Path::new(scene).is_file() {
        cancels.push(start()?.watch_cancelled_reading()?);
    }
    Ok(Run {
        window: started.window,
        first_picture: started.first_picture,
        sharp: started.sharp,
        changes,
        refinements,
        gaps,
        ready,
        answers,
        cancels,
        idle,
    })
}

/// A part in the middle of the viewport, whatever panels are beside it; small, so that looking at it takes little
/// of what is measured.
fn middle(display: &Display) -> Area {
    let (width, height) = display.size();
    Area { x: width * 3 / 10, y: height * 3 / 8, width: width / 5, height: height / 4 }
}

fn row(name: &str, runs: &[Run]) -> String {
    let of = |figure: fn(&Run) -> f64| median(&runs.iter().map(figure).collect::<Vec<_>>());
    let all = |figures: fn(&Run) -> &[f64]| runs.iter().flat_map(figures).copied().collect::<Vec<_>>();
    let [changes, refinements, gaps] =
        [all(|run| &run.changes), all(|run| &run.refinements), all(|run| &run.gaps)];
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    format!(
        "| {name} | {:.2} | {:.2} | {:.2} | {:.2} | {:.0} | {:.0} | {:.0} | {:.0} | {:.0} | {:.0} | {:.0} | {:.1}% |",
        of(|run| run.window),
        of(|run| run.ready),
        of(|run| run.first_picture),
        of(|run| run.sharp),
        1e3 * median(&changes),
        1e3 * most(&changes),
        1e3 * median(&refinements),
        1.0 / median(&gaps),
        1e3 * most(&gaps),
        1e3 * most(&all(|run| &run.answers)),
        1e3 * most(&all(|run| &run.cancels)),
        100.0 * of(|run| run.idle),
    )
}

impl Run {
    fn record(&self, scene: &str) -> Value {
        json!({
            "scene": scene,
            "window_seconds": self.window,
            "first_picture_seconds": self.first_picture,
            "sharp_seconds": self.sharp,
            "change_seconds": self.changes,
            "refinement_seconds": self.refinements,
            "drag_gap_seconds": self.gaps,
            "ready_seconds": self.ready,
            "answer_seconds": self.answers,
            "cancel_seconds": self.cancels,
            "idle_processors": self.idle,
        })
    }
}
