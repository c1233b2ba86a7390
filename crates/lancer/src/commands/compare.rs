//! `lancer compare`: how far two pictures are apart.

use crate::args::{CompareArgs, Metric};
use crate::error::Error;
use crate::job::{on_threads, thread_count};
use crate::{json, terminal};
use lancer_core::film::Tone;
use lancer_io::compare::Comparison;
use lancer_io::diagnostics::Diagnostic;
use lancer_io::image::{ImageFormat, Metadata, encode, read_picture};
use lancer_io::limits::Limits;
use lancer_io::output::write_atomically;
use serde::Serialize;
use std::path::Path;

/// Prints the numbers, and draws the differences where that is asked for.
///
/// # Errors
/// A picture cannot be read, they are not of one size, the drawing cannot be written, or they are further apart than
/// they may be.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Error> {
    let drawing = args.output.as_deref().map(|path| {
        let format = ImageFormat::from_path(path).map_err(|error| Error::usage(error.to_string()))?;
        Ok::<_, Error>((path, format))
    });
    let drawing = drawing.transpose()?;
    let limits = Limits::default();
    let (a, b) = (read_picture(&args.a, limits)?, read_picture(&args.b, limits)?);
    let compared = on_threads(thread_count(args.threads), || {
        Comparison::of(&a, &b, args.pixels_per_degree).map_err(|error| {
            Error::Scene(Diagnostic::new(&args.b, format!("{error}, as `{}` has", args.a.display())).into())
        })
    })?;
    if let Some((path, format)) = drawing {
        draw(&compared, args, path, format)?;
    }
    let is_beyond = args.threshold.is_some_and(|threshold| args.metric.is_beyond(&compared, threshold));
    terminal::print(if args.json { to_json(&compared, args, is_beyond) } else { to_text(&compared) })?;
    if is_beyond { Err(Error::Different) } else { Ok(()) }
}

impl Metric {
    fn value(self, compared: &Comparison) -> f64 {
        match self {
            Self::Mean => compared.mean,
            Self::Rmse => compared.rmse,
            Self::Max => compared.max,
            Self::Psnr => compared.psnr,
            Self::Flip => compared.flip,
        }
    }

    /// What is no number is beyond every threshold.
    fn is_beyond(self, compared: &Comparison, threshold: f64) -> bool {
        let value = self.value(compared);
        let is_within = if self == Self::Psnr { value >= threshold } else { value <= threshold };
        !is_within
    }
}

fn draw(compared: &Comparison, args: &CompareArgs, path: &Path, format: ImageFormat) -> Result<(), Error> {
    let picture = match args.metric {
        Metric::Flip => compared.flip_picture(),
        _ => compared.difference_picture(args.amplify),
    };
    let written = write_atomically(path, |out| {
        encode::write(format, &picture, Tone::default(), &Metadata::default(), out)
    });
    written.map_err(|error| Error::output(path.display().to_string(), &error.source))
}

fn to_text(compared: &Comparison) -> String {
    let Comparison { width, height, is_linear, differing, mean, rmse, max, psnr, flip, .. } = compared;
    let space = if *is_linear { "linear" } else { "sRGB" };
    let pixels = u64::from(*width) * u64::from(*height);
    format!(
        "differing  {differing} of {pixels} pixels ({width} x {height})\n\
         mean       {mean:.6} ({space})\n\
         rmse       {rmse:.6}\n\
         max        {max:.6}\n\
         psnr       {psnr:.2} dB\n\
         flip       {flip:.6}\n"
    )
}

fn to_json(compared: &Comparison, args: &CompareArgs, is_beyond: bool) -> String {
    let finite = |value: f64| value.is_finite().then_some(value);
    json::object(&CompareJson {
        width: compared.width,
        height: compared.height,
        linear: compared.is_linear,
        differing: compared.differing,
        mean: finite(compared.mean),
        rmse: finite(compared.rmse),
        max: finite(compared.max),
        psnr: finite(compared.psnr),
        flip: compared.flip,
        threshold: args.threshold,
        beyond: is_beyond,
    })
}

/// The names are part of the contract with scripts. `null` stands for infinity.
#[derive(Serialize)]
struct CompareJson {
    width: u32,
    height: u32,
    linear: bool,
    differing: u64,
    mean: Option<f64>,
    rmse: Option<f64>,
    max: Option<f64>,
    psnr: Option<f64>,
    flip: f64,
    threshold: Option<f64>,
    beyond: bool,
}
