//! Lancer's program against other renderers, as whole processes, on scenes that are matched.
//!
//! One description ([`scene`]) becomes a scene file of each renderer; then Lancer and its peers are run by turns,
//! and each run's time is divided by that of Lancer in the same turn. A peer that cannot draw a picture says why,
//! and one that is not installed says how to install it. What they drew is compared with Lancer's picture, and
//! laid side by side in a sheet: figures of different pictures would be worth nothing.

mod cycles;
mod look;
mod matched;
mod mitsuba;
mod povray;
mod process;
mod scene;
mod tachyon;

use crate::{Failure, record};
use process::{Outcome, Pinning};
use scene::Picture;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// `lancer-bench peers`.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// The peers to run.
    #[arg(long, value_delimiter = ',', default_value = "povray,tachyon,mitsuba,cycles")]
    renderers: Vec<String>,
    /// The scenes: bunny, bunny-clear (without refraction), bunny-clear-ao7 (with 7 directions of ambient occlusion
    /// at each subpixel, or any other number), and built-in ones.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "bunny,bunny-clear,bunny-clear-ao7,shadows,mirrors,sphereflake"
    )]
    scenes: Vec<String>,
    /// Threads of each renderer; one thread is also bound to one processor.
    #[arg(long, default_value = "1", value_parser = ["1", "all"])]
    threads: String,
    /// Turns; medians are printed, all are kept with --raw.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Write all figures, with the date and the machine's name, into this directory.
    #[arg(long)]
    raw: Option<PathBuf>,
    /// Where `npm install bunny` was run.
    #[arg(long, default_value = ".")]
    models: PathBuf,
    /// Lancer's program, if not beside this one.
    #[arg(long)]
    lancer: Option<PathBuf>,
    /// For the scene files, the pictures and the sheets.
    #[arg(long, default_value = "target/peers")]
    output: PathBuf,
}

/// Another renderer.
trait Peer {
    /// As in `--renderers`.
    fn name(&self) -> &'static str;

    /// How to install it.
    fn hint(&self) -> &'static str;

    /// How it does otherwise than Lancer in what is compared.
    fn differs(&self) -> &'static [&'static str];

    /// What it says of itself; `None` where it cannot be run.
    fn version(&self) -> Option<String>;

    /// Why it cannot draw a picture.
    fn unsuited(&self, picture: &Picture) -> Option<&'static str>;

    /// Writes its scene files, and says what to run.
    fn entries(&self, picture: &Picture, place: &Place) -> Result<Vec<Entry>, Failure>;
}

const PEERS: [&dyn Peer; 4] = [&povray::PovRay, &tachyon::Tachyon, &mitsuba::Mitsuba, &cycles::Cycles];

/// Where a picture's files are, and on how many threads it is drawn.
struct Place {
    directory: PathBuf,
    threads: usize,
}

/// A program to run.
struct Entry {
    label: &'static str,
    /// The program and its arguments.
    command: Vec<String>,
    image: PathBuf,
    reading: Reading,
}

impl Entry {
    fn new(
        label: &'static str,
        command: impl IntoIterator<Item = String>,
        image: PathBuf,
        reading: Reading,
    ) -> Self {
        Self { label, command: command.into_iter().collect(), image, reading }
    }
}

/// How an image is meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reading {
    /// Encoded in sRGB, and of the picture's size.
    Finished,
    /// Encoded in sRGB, each subpixel a pixel.
    Subpixels,
    /// Not encoded, each subpixel a pixel.
    LinearSubpixels,
}

/// The name of Lancer's scene file, which scripts of other renderers read too.
const LANCER_FILE: &str = "lancer.json";

/// One regular grid of subpixels for all, with neither jitter nor a threshold.
const SUPERSAMPLED: &str =
    "draws each subpixel as a pixel of a larger image: the same rays; taking their means is not timed";

#[expect(clippy::print_stdout, reason = "the tables are what the command is for")]
pub(crate) fn measure(plan: &Plan) -> Result<(), Failure> {
    let lancer = lancer_program(plan.lancer.as_deref())?;
    let threads = if plan.threads == "all" { std::thread::available_parallelism()?.get() } else { 1 };
    let pinning = Pinning::choose(threads);
    let peers = installed(&plan.renderers)?;
    println!("Medians of {} turns; {threads} thread(s), {pinning}.", plan.runs);
    println!(
        "whole: seconds of the process, start and output included. own: without the start of Python and its"
    );
    println!(
        "imports; Lancer's is reading, building, rendering and writing. cpu: seconds of all processors."
    );
    println!(
        "ratio: whole, over Lancer's of the same turn. apart: mean difference from Lancer's picture, of 255."
    );

    let mut records = Vec::new();
    for name in &plan.scenes {
        let Some(picture) = picture_named(name, &plan.models)? else {
            println!("\n{name}: skipped; npm install bunny, and --models with the directory");
            continue;
        };
        let place = Place { directory: std::path::absolute(plan.output.join(name))?, threads };
        let settings = &picture.settings;
        println!(
            "\n{name}: {} x {}, {}^2 subpixels, depth {}, {} things",
            settings.width,
            settings.height,
            settings.samples,
            settings.depth,
            picture.things.len()
        );
        let mut entries = vec![lancer_entry(&lancer, &picture, &place)?];
        for peer in &peers {
            match peer.unsuited(&picture) {
                Some(reason) => println!("{:<22} left out: {reason}", peer.name()),
                None => entries.extend(peer.entries(&picture, &place)?),
            }
        }
        drop_failing(&mut entries, pinning)?;
        if entries.len() == 1 {
            continue;
        }
        let rows = take_turns(&entries, plan.runs, pinning)?;
        let distances = look::compare(&picture, &entries, &place.directory.with_extension("png"))?;
        print_table(&entries, &rows, &distances);
        records.push(json!({
            "scene": name,
            "threads": threads,
            "rows": entries.iter().zip(&rows).zip(&distances).map(|((entry, row), distance)| json!({
                "renderer": entry.label,
                "whole_seconds": row.iter().map(|outcome| outcome.whole).collect::<Vec<_>>(),
                "own_seconds": row.iter().map(|outcome| outcome.own).collect::<Vec<_>>(),
                "cpu_seconds": row.iter().map(|outcome| outcome.cpu).collect::<Vec<_>>(),
                "apart_of_255": distance,
                "lancer": row.last().and_then(|outcome| outcome.report.clone()),
            })).collect::<Vec<_>>(),
        }));
    }
    println!("\npictures side by side: {}", plan.output.display());
    for peer in &peers {
        for difference in peer.differs() {
            println!("{}: {difference}", peer.name());
        }
    }
    if let Some(directory) = &plan.raw {
        println!("all figures: {}", keep(directory, &peers, pinning, &records)?.display());
    }
    Ok(())
}

/// The peers asked for that can be run; of the others it is told how to get them.
#[expect(clippy::print_stdout, reason = "what is skipped belongs above the tables")]
fn installed(names: &[String]) -> Result<Vec<&'static dyn Peer>, Failure> {
    let mut peers = Vec::new();
    for name in names {
        let known = || PEERS.map(Peer::name).join(", ");
        let peer = PEERS.into_iter().find(|peer| peer.name() == name);
        let peer = peer.ok_or_else(|| format!("no renderer {name:?}; there are {}", known()))?;
        match peer.version() {
            Some(version) => {
                println!("{name}: {version}");
                peers.push(peer);
            }
            None => println!("{name}: skipped; {}", peer.hint()),
        }
    }
    Ok(peers)
}

/// The picture of a name; `None` where its model is missing.
fn picture_named(name: &str, models: &Path) -> Result<Option<Picture>, Failure> {
    if let Some(scene) = lancer_gallery::find(name) {
        return Ok(Some(Picture::of(&scene.build())));
    }
    if !name.starts_with("bunny") {
        return Err(format!("no scene {name:?}").into());
    }
    let index = models.join("node_modules/bunny/index.js");
    if !index.exists() {
        return Ok(None);
    }
    let picture = Picture::of(&matched::whitted(&Arc::new(matched::bunny(&index)?)));
    if name == "bunny" {
        return Ok(Some(picture));
    }
    let clear = matched::without_refraction(picture);
    if name == "bunny-clear" {
        return Ok(Some(clear));
    }
    let samples = name.strip_prefix("bunny-clear-ao").and_then(|samples| samples.parse().ok());
    let samples = samples.ok_or_else(|| format!("no scene {name:?}"))?;
    Ok(Some(matched::with_occlusion(clear, samples)))
}

/// Lancer's program: the one that is named, or else the one beside this program.
pub(crate) fn lancer_program(named: Option<&Path>) -> Result<PathBuf, Failure> {
    let beside = std::env::current_exe()?.with_file_name(format!("lancer{}", std::env::consts::EXE_SUFFIX));
    let program = named.map_or(beside, Path::to_owned);
    if program.exists() {
        Ok(program)
    } else {
        Err(format!("{} is missing: cargo build --release -p lancer", program.display()).into())
    }
}

fn lancer_entry(program: &Path, picture: &Picture, place: &Place) -> Result<Entry, Failure> {
    fs::create_dir_all(&place.directory)?;
    picture.write_meshes(&place.directory)?;
    let file = place.directory.join(LANCER_FILE);
    fs::write(&file, picture.to_lancer().to_string())?;
    let image = place.directory.join("lancer.png");
    let command = [
        program.display().to_string(),
        "render".to_owned(),
        file.display().to_string(),
        "--output".to_owned(),
        image.display().to_string(),
        "--threads".to_owned(),
        place.threads.to_string(),
        "--quiet".to_owned(),
        "--json".to_owned(),
    ];
    Ok(Entry::new("lancer", command, image, Reading::Finished))
}

/// Runs every entry once, untimed: files are in memory then, and what fails is told and left out.
#[expect(clippy::print_stdout, reason = "what fails belongs above the table")]
fn drop_failing(entries: &mut Vec<Entry>, pinning: Pinning) -> Result<(), Failure> {
    // Without Lancer there is nothing to compare with.
    process::run(&entries[0], pinning)?;
    for i in (1..entries.len()).rev() {
        if let Err(failure) = process::run(&entries[i], pinning) {
            println!("{:<22} failed: {}", entries[i].label, brief(&failure.to_string()));
            entries.remove(i);
        }
    }
    Ok(())
}

/// The lines of a complaint that fit on a screen.
fn brief(complaint: &str) -> String {
    const LINES: usize = 6;
    const COLUMNS: usize = 100;
    let lines = complaint.lines().filter(|line| !line.trim().is_empty()).take(LINES);
    lines.map(|line| line.chars().take(COLUMNS).collect::<String>()).collect::<Vec<_>>().join("\n    ")
}

/// Runs every entry once a turn, so that what else the machine does falls on all alike. One list an entry.
fn take_turns(entries: &[Entry], turns: usize, pinning: Pinning) -> Result<Vec<Vec<Outcome>>, Failure> {
    let mut rows = entries.iter().map(|_| Vec::new()).collect::<Vec<_>>();
    for _ in 0..turns.max(1) {
        for (entry, row) in entries.iter().zip(&mut rows) {
            row.push(process::run(entry, pinning)?);
        }
    }
    Ok(rows)
}

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
fn print_table(entries: &[Entry], rows: &[Vec<Outcome>], distances: &[f64]) {
    println!(
        "{:<22} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8}",
        "renderer", "whole s", "own s", "cpu s", "ratio", "cpu ratio", "apart"
    );
    for ((entry, row), distance) in entries.iter().zip(rows).zip(distances) {
        let over = |of: fn(&Outcome) -> f64| median(row.iter().map(of));
        let ratio = |of: fn(&Outcome) -> f64| {
            median(row.iter().zip(&rows[0]).map(|(peer, lancer)| of(peer) / of(lancer)))
        };
        println!(
            "{:<22} {:>8.3} {:>8.3} {:>8.2} {:>8.2} {:>9.2} {distance:>8.2}",
            entry.label,
            over(|outcome| outcome.whole),
            over(|outcome| outcome.own.unwrap_or(outcome.whole)),
            over(|outcome| outcome.cpu),
            ratio(|outcome| outcome.whole),
            ratio(|outcome| outcome.cpu),
        );
    }
}

/// The upper one of two middles.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted = values.collect::<Vec<_>>();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// The program that runs Python scripts.
fn python() -> String {
    "python3".to_owned()
}

/// The line of a program's answer that holds `word`, from there on; `None` where it cannot be run or says nothing.
fn version_line(program: &str, arguments: &[&str], word: &str) -> Option<String> {
    let answer = std::process::Command::new(program).args(arguments).output().ok()?;
    let text = [answer.stdout, answer.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    text.lines().find_map(|line| line.find(word).map(|start| line[start..].trim().to_owned()))
}

/// Writes all figures with what is needed to understand them later.
fn keep(
    directory: &Path,
    peers: &[&dyn Peer],
    pinning: Pinning,
    records: &[Value],
) -> Result<PathBuf, Failure> {
    let about =
        |peer: &&dyn Peer| (peer.name(), json!({"version": peer.version(), "differs": peer.differs()}));
    let fields = json!({
        "processors": std::thread::available_parallelism()?.get(),
        "load_at_end": process::load(),
        "pinning": pinning.to_string(),
        "peers": peers.iter().map(about).collect::<std::collections::BTreeMap<_, _>>(),
        "scenes": records,
    });
    record::keep_fields(directory, "peers", fields)
}
