//! Every built-in scene against a small picture of it that was looked at and kept, in `goldens/NAME.png`.
//!
//! The bytes must be equal: the renderer gives the same ones on every machine. Where they are not, what was
//! expected, what was rendered and where the two differ are written as PNGs, and named. After a change that is
//! meant, `UPDATE_GOLDENS=1 cargo test -p lancer-gallery --test goldens` writes the pictures anew; look at them
//! before they are kept.

use lancer_core::film::to_srgb8;
use lancer_core::render::{Control, render};
use lancer_core::scene::{AmbientOcclusion, Settings};
use lancer_core::world::{CompileOptions, World};
use lancer_gallery::{BuiltinScene, SCENES};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

const WIDTH: u32 = 64;
const HEIGHT: u32 = 48;
/// Enough to see that ambient occlusion is there, at a tenth of what it costs to see it well.
const MOST_AO_SAMPLES: u32 = 4;

/// 8-bit sRGB. Shape: `[HEIGHT * WIDTH][3]`, top row first.
type Pixels = Vec<[u8; 3]>;

#[test]
fn every_scene_looks_as_it_was_kept() {
    let update = std::env::var_os("UPDATE_GOLDENS").is_some();
    let mut faults = Vec::new();
    for scene in SCENES {
        let (golden, actual) = (golden_path(scene.name()), picture(*scene));
        if update {
            write_png(&golden, &actual);
        } else if let Err(fault) = compare(scene.name(), &golden, &actual) {
            faults.push(fault);
        }
    }
    assert!(faults.is_empty(), "{}\nUPDATE_GOLDENS=1 keeps what is rendered now", faults.join("\n"));
}

#[test]
fn every_kept_picture_is_of_a_scene() {
    let kept = fs::read_dir(goldens()).unwrap().map(|entry| entry.unwrap().path()).collect::<BTreeSet<_>>();
    let scenes = SCENES.iter().map(|scene| golden_path(scene.name())).collect::<BTreeSet<_>>();
    let stray = kept.difference(&scenes).collect::<Vec<_>>();
    assert!(stray.is_empty(), "no scene has the name of {stray:?}");
}

fn picture(scene: &dyn BuiltinScene) -> Pixels {
    let scene = scene.build();
    let ao = scene.settings.ao;
    let settings = Settings {
        width: WIDTH,
        height: HEIGHT,
        samples: 1,
        ao: AmbientOcclusion { samples: ao.samples.min(MOST_AO_SAMPLES), ..ao },
        ..scene.settings
    };
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    to_srgb8(&render(&world, &scene.camera, &settings, None, &Control::default()).unwrap().image)
}

/// Tells what differs and where to see it.
fn compare(name: &str, golden: &Path, actual: &Pixels) -> Result<(), String> {
    let Some(expected) = read_png(golden) else {
        return Err(format!("{name}: {} is no picture of {WIDTH} x {HEIGHT} pixels", golden.display()));
    };
    let differing = expected.iter().zip(actual).filter(|(a, b)| a != b).count();
    if differing == 0 {
        return Ok(());
    }
    let mut told = format!("{name}: {differing} of {} pixels differ", actual.len());
    for (kind, pixels) in
        [("expected", &expected), ("actual", actual), ("difference", &difference(&expected, actual))]
    {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{kind}.png"));
        write_png(&path, pixels);
        told += &format!("\n  {kind}: {}", path.display());
    }
    Err(told)
}

/// Black where two pictures agree, and bright enough to see where they differ by the least step.
fn difference(expected: &Pixels, actual: &Pixels) -> Pixels {
    let visible = |a: u8, b: u8| if a == b { 0 } else { a.abs_diff(b).max(64) };
    expected.iter().zip(actual).map(|(a, b)| std::array::from_fn(|i| visible(a[i], b[i]))).collect()
}

fn goldens() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens")
}

fn golden_path(name: &str) -> PathBuf {
    goldens().join(name).with_extension("png")
}

fn write_png(path: &Path, pixels: &Pixels) {
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), WIDTH, HEIGHT);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
}

/// The pixels, if the file is there and holds a picture of the right size and kind.
fn read_png(path: &Path) -> Option<Pixels> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut bytes).ok()?;
    let (pixels, []) = bytes.as_chunks::<3>() else { return None };
    let fits = (info.width, info.height, info.color_type) == (WIDTH, HEIGHT, png::ColorType::Rgb);
    fits.then(|| pixels.to_vec())
}
