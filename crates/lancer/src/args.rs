//! The command line as typed.
//!
//! In: the words of the user. Out: [`Args`], in which every word has the right form and nothing more is known:
//! no file was looked at. What they mean together is for [`crate::job`] to say.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use lancer_core::accel::{Accelerator, KdTree};
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::render::Region;
use lancer_core::scene::Settings;
use lancer_core::simd::InstructionSet;
use lancer_io::LoadOptions;
use lancer_io::compare::PIXELS_PER_DEGREE;
use lancer_io::image::{Compression, ImageFormat};
use lancer_io::limits::{LimitChange, Limits};
use lancer_io::model::{Crease, ModelOptions};
use lancer_io::scene_file::Override;
use std::ffi::OsString;
use std::path::PathBuf;

/// Told at the end of `--help`, since a program that calls this one wants to know.
const EXIT_CODES: &str = "\
Exit codes:
    0  done
    1  verify: the picture is another; compare: beyond the threshold
    2  the command line is wrong
    3  the scene, a model or an image is at fault
    4  the output could not be written
    5  the render failed
  130  interrupted";

/// A recursive (Whitted) ray tracer: exact, repeatable pictures of scenes and meshes
#[derive(Debug, Parser)]
#[command(name = "lancer", version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,

    /// Open the window on this scene: a built-in one, a scene file or a model
    pub(crate) scene: Option<OsString>,
}

/// What the program is asked to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a file
    Render(Box<RenderArgs>),
    /// Render a film: an orbit about what the scene shows, or a way past its cameras
    Turntable(Box<TurntableArgs>),
    /// Render a small picture of a scene or a model, as file managers show
    Thumbnail(ThumbnailArgs),
    /// List the built-in scenes
    Scenes(ScenesArgs),
    /// Tell what a scene or a model holds
    Info(InfoArgs),
    /// Read and validate a scene, and render nothing
    Check(CheckArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Print the completions of a shell
    Completions(CompletionsArgs),
    /// Print the manual page
    Man,
    /// Render a picture again and tell whether its bytes agree
    Verify(Box<VerifyArgs>),
    /// Tell how far two pictures are apart
    Compare(CompareArgs),
}

/// `lancer render`.
#[derive(Debug, ClapArgs)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct RenderArgs {
    /// A built-in scene, a scene file (.yaml, .yml, .json) or a model (.obj, .ply, .stl, .off, .gltf, .glb, .3mf; packed
    /// as .gz or .zip)
    ///
    /// Without it, the default built-in scene. `lancer scenes` lists the built-in ones. A model is framed, lit and
    /// given a default material.
    pub(crate) scene: Option<OsString>,

    /// Where the picture goes: a file, or `-` for standard output
    ///
    /// The extension says the format: .png, .jpg, .webp, .tif for displays, .hdr, .pfm, .exr for radiance. Without
    /// it, SCENE's name with .png, in the current directory, unless that would replace a file that lancer did not
    /// make. The file is written whole or not at all.
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) passes: PassArgs,

    #[command(flatten)]
    pub(crate) work: WorkArgs,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,

    /// Print one JSON object about the render on standard output
    #[arg(long, help_heading = "Messages")]
    pub(crate) json: bool,

    /// Draw no progress and print no summary; warnings and errors are still told
    #[arg(short, long, help_heading = "Messages")]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) encoding: EncodingArgs,
}

/// How the picture becomes a file.
#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "File")]
pub(crate) struct EncodingArgs {
    /// The format, whatever the file's extension; `-` is a PNG without it
    #[arg(long, value_name = "NAME", requires = "output", value_parser = format_parser())]
    pub(crate) format: Option<ImageFormat>,

    /// Bits a channel: PNG 8 or 16, TIFF 8, 16 or 32 (linear floats), EXR 32 or 16 (half floats)
    #[arg(long, value_name = "N")]
    pub(crate) bits: Option<u8>,

    /// How pixels are packed, without losses: EXR zip, piz or none, TIFF zip or none
    #[arg(long, value_name = "NAME", value_parser = compression_parser())]
    pub(crate) compression: Option<Compression>,

    /// The quality of a JPEG, 1 to 100; without it, 92
    #[arg(long, value_name = "Q")]
    pub(crate) quality: Option<u8>,

    /// Pixels to the inch, for print: a note in the file, which changes no pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) dpi: Option<u16>,
}

/// `lancer turntable`.
#[derive(Debug, ClapArgs)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct TurntableArgs {
    /// A built-in scene, a scene file (.yaml, .yml, .json) or a model
    pub(crate) scene: OsString,

    /// Where the film goes: a .png (animated), .gif, .webp or .mp4 file, or numbered pictures, as in frame_%04d.png
    ///
    /// An .mp4 takes ffmpeg. A film in one file is written whole or not at all, and so is each picture.
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) film: FilmArgs,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) work: WorkArgs,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,

    /// Print one JSON object about the film on standard output
    #[arg(long, help_heading = "Messages")]
    pub(crate) json: bool,

    /// Draw no progress and print no summary; warnings and errors are still told
    #[arg(short, long, help_heading = "Messages")]
    pub(crate) quiet: bool,
}

/// What moves in a film.
#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Film")]
pub(crate) struct FilmArgs {
    /// Pictures in the film
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=MAX_FRAMES))]
    pub(crate) frames: u32,

    /// Pictures a second
    #[arg(long, value_name = "F", default_value_t = 25, value_parser = clap::value_parser!(u16).range(1..=MAX_FPS))]
    pub(crate) fps: u16,

    /// The axis of the orbit about the camera's target
    #[arg(long, value_name = "AXIS", default_value = "y", value_parser = ["x", "y", "z"])]
    pub(crate) axis: String,

    /// Instead of the orbit, a smooth way past these cameras, as in front,side,front; `main` is the scene's own
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with_all = ["axis", "camera"])]
    pub(crate) path: Vec<String>,
}

/// More would be a film of an hour.
const MAX_FRAMES: i64 = 100_000;
/// Faster than any display.
const MAX_FPS: i64 = 240;

/// `lancer thumbnail`.
#[derive(Debug, ClapArgs)]
pub(crate) struct ThumbnailArgs {
    /// A built-in scene, a scene file or a model
    pub(crate) scene: OsString,

    /// The file to write, a PNG whatever its name
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub(crate) output: PathBuf,

    /// The longer side in pixels
    #[arg(short, long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=MAX_THUMBNAIL))]
    pub(crate) size: u32,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// What is larger is no thumbnail.
const MAX_THUMBNAIL: i64 = 4096;

/// What decides the pixels.
#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureArgs {
    /// Pixels in a row
    #[arg(long, value_name = "W")]
    pub(crate) width: Option<u32>,

    /// Rows of pixels
    #[arg(long, value_name = "H")]
    pub(crate) height: Option<u32>,

    /// Each pixel is the mean of N x N rays
    #[arg(long, value_name = "N")]
    pub(crate) samples: Option<u32>,

    /// How many reflections and refractions may follow one another
    #[arg(long, value_name = "D")]
    pub(crate) depth: Option<u32>,

    /// Directions of ambient occlusion at each point; 0 turns it off
    #[arg(long, value_name = "N")]
    pub(crate) ao: Option<u32>,

    /// How far geometry occludes, in scene units
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub(crate) ao_distance: Option<f64>,

    /// Let light through everything: nothing casts a shadow
    #[arg(long)]
    pub(crate) no_shadows: bool,

    /// Trace no mirror images
    #[arg(long)]
    pub(crate) no_reflection: bool,

    /// Trace nothing through glass
    #[arg(long)]
    pub(crate) no_refraction: bool,

    /// One of the scene's named cameras
    #[arg(long, value_name = "NAME")]
    pub(crate) camera: Option<String>,

    /// Render only the W x H pixels whose top left one is X,Y
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_region)]
    pub(crate) region: Option<Region>,

    /// Make the picture brighter (or darker, below 0) by EV stops
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    pub(crate) exposure: Option<f64>,

    /// What becomes of light brighter than a display: linear cuts it, reinhard and filmic compress it; raw writes
    /// linear values without sRGB encoding. Formats of radiance (.hdr, .pfm, .exr, 32-bit .tif) take none
    #[arg(long, value_name = "CURVE", value_parser = tone_parser())]
    pub(crate) tone: Option<ToneCurve>,
}

/// What is written beside the picture.
#[derive(Debug, Default, ClapArgs)]
#[command(next_help_heading = "Passes")]
pub(crate) struct PassArgs {
    /// Write these layers beside the picture, into the same .exr file: `all`, or names parted by commas
    ///
    /// `terms` (ambient, diffuse, specular, reflection, transmission, background) and `lights` (all_ambient,
    /// all_background, one light.NAME for each light) each add up to the picture, exactly. The others: ao, depth,
    /// distance, position, normal, geometric_normal, uv, object_id, material_id, cost.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) passes: Vec<String>,

    /// Write each layer into a file of its own, as picture.NAME.exr
    #[arg(long, requires = "passes")]
    pub(crate) separate_passes: bool,
}

/// What decides how long it takes, and nothing in the pixels.
#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Speed (the picture stays the same)")]
pub(crate) struct WorkArgs {
    /// Threads to work on; without it, one a core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_THREADS))]
    pub(crate) threads: Option<u32>,

    /// How rays find what they hit; without it, bvh, or kd-tree where its bounds are given
    #[arg(long, value_name = "NAME", value_parser = accelerator_parser())]
    pub(crate) accel: Option<Accelerator>,

    /// Vector instructions to use; without it, the best that the processor has
    #[arg(long, value_name = "SET", value_parser = instructions_parser())]
    pub(crate) instructions: Option<InstructionSet>,

    /// Triangles in a leaf of the k-d tree, at most; without it, chosen by cost
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) kd_leaf: Option<u32>,

    /// Depth of the k-d tree, at most; without it, chosen by size
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(KdTree::MAX_DEPTH)))]
    pub(crate) kd_depth: Option<u32>,

    /// The side in pixels of the squares that threads share
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(Settings::MAX_SIDE)))]
    pub(crate) tile_size: Option<u32>,
}

/// How files are read.
#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Reading")]
pub(crate) struct ReadingArgs {
    /// Change a value of the scene, as in `--set camera.fov=60`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) overrides: Vec<Override>,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// What files may do, and how models are read.
#[derive(Debug, ClapArgs)]
pub(crate) struct FileArgs {
    /// Let the scene name files outside of its own directory
    #[arg(long)]
    pub(crate) allow_outside: bool,

    /// Smooth models without normals across edges of up to this angle; 0 for facets, 180 for no edge at all
    #[arg(long, value_name = "DEGREES", value_parser = parse_crease)]
    pub(crate) crease: Option<Crease>,

    /// Let files ask for more, or less, as in `--limit triangles=500M`; may be repeated
    #[arg(long = "limit", value_name = "NAME=N", long_help = limit_help())]
    pub(crate) limits: Vec<LimitChange>,
}

impl FileArgs {
    /// How files are read.
    pub(crate) fn load_options(&self) -> LoadOptions {
        let mut limits = Limits::default();
        self.limits.iter().for_each(|change| limits.change(*change));
        LoadOptions {
            limits,
            allow_outside: self.allow_outside,
            model: ModelOptions { crease: self.crease },
            ..LoadOptions::default()
        }
    }
}

fn limit_help() -> String {
    let limit = |(name, most, what): (&str, u64, &str)| format!("  {name:<16}{most:>12}  {what}");
    let all = Limits::default().listed().map(limit).join("\n");
    format!(
        "Let files ask for more, or less, as in `--limit triangles=500M`; may be repeated. N is a whole number, \
         or one with k, M or G after it for thousands, millions and billions. The limits and their defaults:\n\n{all}"
    )
}

fn parse_crease(text: &str) -> Result<Crease, String> {
    let crease = text.parse().ok().and_then(Crease::from_degrees);
    crease.ok_or_else(|| "must be a number of degrees from 0 to 180".to_owned())
}

/// `lancer scenes`.
#[derive(Debug, ClapArgs)]
pub(crate) struct ScenesArgs {
    /// Print a JSON array instead
    #[arg(long)]
    pub(crate) json: bool,
}

/// `lancer info`.
#[derive(Debug, ClapArgs)]
pub(crate) struct InfoArgs {
    /// A built-in scene, a scene file or a model
    pub(crate) file: OsString,

    /// Print a JSON object instead
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// `lancer check`.
#[derive(Debug, ClapArgs)]
pub(crate) struct CheckArgs {
    /// A built-in scene, a scene file or a model
    pub(crate) scene: OsString,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// `lancer completions`.
#[derive(Debug, ClapArgs)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

/// `lancer verify`.
#[derive(Debug, ClapArgs)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct VerifyArgs {
    /// A picture that lancer made, in any format but PFM
    pub(crate) image: PathBuf,

    /// The scene; without it, the one that the picture names, beside the picture or in the current directory
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<OsString>,

    #[command(flatten)]
    pub(crate) work: WorkArgs,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,

    /// Print a JSON object instead
    #[arg(long, help_heading = "Messages")]
    pub(crate) json: bool,

    /// Draw no progress; the verdict, warnings and errors are still told
    #[arg(short, long, help_heading = "Messages")]
    pub(crate) quiet: bool,
}

/// `lancer compare`.
#[derive(Debug, ClapArgs)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct CompareArgs {
    /// A picture: PNG, JPEG, WebP, TIFF, HDR, PFM or EXR
    pub(crate) a: PathBuf,

    /// Another one, of the same size
    pub(crate) b: PathBuf,

    /// What --threshold is about, and what --output shows
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Metric::Flip)]
    pub(crate) metric: Metric,

    /// Exit with 1 where the pictures are further apart: the metric above T, or for psnr below
    #[arg(short, long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) threshold: Option<f64>,

    /// Draw the differences: FLIP as colours from black to white, or the differences themselves
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,

    /// Make drawn differences other than FLIP brighter by this factor
    #[arg(long, value_name = "F", default_value_t = 8.0, value_parser = parse_factor)]
    pub(crate) amplify: f32,

    /// For FLIP: how many pixels an eye sees in a degree; 67 is a 0.7 m wide 4K display from 0.7 m away
    #[arg(long, value_name = "P", default_value_t = PIXELS_PER_DEGREE, value_parser = parse_pixels_per_degree)]
    pub(crate) pixels_per_degree: f64,

    /// Threads to work on; without it, one a core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_THREADS))]
    pub(crate) threads: Option<u32>,

    /// Print a JSON object instead
    #[arg(long)]
    pub(crate) json: bool,
}

/// A number that says how far two pictures are apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Metric {
    /// The mean absolute difference
    Mean,
    /// The root of the mean square difference
    Rmse,
    /// The greatest difference
    Max,
    /// The peak signal-to-noise ratio, in decibels
    Psnr,
    /// How different they look to somebody who flips between them
    Flip,
}

/// More threads than any machine has cores, and few enough that their stacks fit in memory.
const MAX_THREADS: i64 = 1024;

fn accelerator_parser() -> impl TypedValueParser<Value = Accelerator> {
    PossibleValuesParser::new(Accelerator::ALL.map(Accelerator::name)).map(|name| {
        let named = |accelerator: &Accelerator| accelerator.name() == name;
        Accelerator::ALL.into_iter().find(named).expect("the parser lets only these names through")
    })
}

fn instructions_parser() -> impl TypedValueParser<Value = InstructionSet> {
    let available = || InstructionSet::ALL.into_iter().filter(|set| set.is_available());
    PossibleValuesParser::new(available().map(InstructionSet::name)).map(move |name| {
        available().find(|set| set.name() == name).expect("the parser lets only these names through")
    })
}

fn tone_parser() -> impl TypedValueParser<Value = ToneCurve> {
    PossibleValuesParser::new(ToneCurve::ALL.map(ToneCurve::name))
        .map(|name| ToneCurve::from_name(&name).expect("the parser lets only these names through"))
}

fn format_parser() -> impl TypedValueParser<Value = ImageFormat> {
    PossibleValuesParser::new(ImageFormat::ALL.map(ImageFormat::name))
        .map(|name| ImageFormat::from_name(&name).expect("the parser lets only these names through"))
}

fn compression_parser() -> impl TypedValueParser<Value = Compression> {
    PossibleValuesParser::new(Compression::ALL.map(Compression::name))
        .map(|name| Compression::from_name(&name).expect("the parser lets only these names through"))
}

fn parse_region(text: &str) -> Result<Region, String> {
    let numbers = text.split(',').map(|number| number.trim().parse::<u32>()).collect::<Result<Vec<_>, _>>();
    match numbers.as_deref() {
        Ok(&[x, y, width, height]) => Ok(Region { x, y, width, height }),
        _ => Err("must be four whole numbers, as in 10,20,64,48".into()),
    }
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    let stops = text.parse::<f64>().map_err(|_| "must be a number".to_owned())?;
    let most = Tone::MAX_EXPOSURE;
    if stops.abs() <= most { Ok(stops) } else { Err(format!("must be between -{most} and {most}")) }
}

fn parse_factor(text: &str) -> Result<f32, String> {
    let factor = text.parse::<f32>().map_err(|_| "must be a number".to_owned())?;
    if factor > 0.0 && factor.is_finite() { Ok(factor) } else { Err("must be above 0".into()) }
}

fn parse_pixels_per_degree(text: &str) -> Result<f64, String> {
    let pixels = text.parse::<f64>().map_err(|_| "must be a number".to_owned())?;
    if (1.0..=1000.0).contains(&pixels) { Ok(pixels) } else { Err("must be from 1 to 1000".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn a_region_is_four_numbers() {
        assert_eq!(parse_region("1,2,3,4"), Ok(Region { x: 1, y: 2, width: 3, height: 4 }));
        assert_eq!(parse_region("1, 2, 3, 4"), parse_region("1,2,3,4"));
        for wrong in ["", "1,2,3", "1,2,3,4,5", "1,2,3,-4", "1,2,3,x", "1,2,3,4294967296"] {
            assert!(parse_region(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn exposure_is_finite_and_moderate() {
        assert_eq!(parse_exposure("-1.5"), Ok(-1.5));
        for wrong in ["nan", "inf", "-inf", "101", "-101", "bright"] {
            assert!(parse_exposure(wrong).is_err(), "{wrong}");
        }
    }
}
