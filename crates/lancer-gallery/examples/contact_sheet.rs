//! Renders a built-in scene with all passes, and shows them side by side in one PNG:
//! `cargo run --release -p lancer-gallery --example contact_sheet -- NAME FILE.png [WIDTH [COLUMNS]]`
//!
//! It prints which pass is where. Colours are sRGB as in a picture; what is no colour is made one: lengths become
//! lighter the nearer, vectors and coordinates become red, green and blue, ids get colours of their own, and costs
//! become lighter by their logarithm.

use lancer_core::Rgb;
use lancer_core::film::{Image, to_srgb8};
use lancer_core::render::Control;
use lancer_core::render::passes::{Layer, Samples, light_names, render_passes, select};
use lancer_core::scene::Settings;
use lancer_core::world::{CompileOptions, World};
use std::error::Error;
use std::fs::File;
use std::io::Write;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1).collect::<Vec<_>>();
    let [name, file, sizes @ ..] = arguments.as_slice() else {
        return Err("usage: contact_sheet NAME FILE.png [WIDTH [COLUMNS]]".into());
    };
    let scene = lancer_gallery::find(name).ok_or("there is no such scene")?.build();
    let width = sizes.first().map_or(Ok(200), |width| width.parse::<u32>())?.max(1);
    let columns = sizes.get(1).map_or(Ok(4), |columns| columns.parse::<u32>())?.max(1);
    let height = (scene.settings.height * width / scene.settings.width).max(1);
    let settings = Settings { width, height, ..scene.settings };
    let world = World::compile(&scene, &CompileOptions::default())?;
    let passes = select(["all"], world.lights())?;
    let control = Control::default();
    let picture = render_passes(&world, &scene.camera, &settings, None, &passes, 1.0, &control)?;

    let lights = light_names(world.lights());
    let mut tiles = vec![("beauty".to_owned(), picture.render.image.pixels().to_vec())];
    for Layer { pass, samples } in &picture.layers {
        let name = pass.name(&lights);
        let shown = shown(samples);
        let labels = if shown.len() == 1 { [""; 3] } else { [".rays", ".nodes", ".triangles"] };
        let named = |(place, pixels)| (format!("{name}{}", labels[place]), pixels);
        tiles.extend(shown.into_iter().enumerate().map(named));
    }
    let rows = (tiles.len() as u32).div_ceil(columns);
    let mut sheet = Image::black(columns * width, rows * height).map(|_| [1.0; 3]);
    for (place, (name, pixels)) in (0..).zip(&tiles) {
        let (column, row) = (place % columns, place / columns);
        writeln!(std::io::stdout(), "{}, {}: {name}", row + 1, column + 1)?;
        sheet.put(column * width, row * height, width, pixels);
    }

    let mut encoder = png::Encoder::new(File::create(file)?, sheet.width(), sheet.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.write_header()?.write_image_data(to_srgb8(&sheet).as_flattened())?;
    Ok(())
}

/// A layer as colours; one picture for each count.
fn shown(samples: &Samples) -> Vec<Vec<[f32; 3]>> {
    match samples {
        Samples::Color(values) => vec![values.clone()],
        Samples::Vector(values) => {
            let bounded = |x: f32| if x.abs() <= 1.0 { x } else { x.signum() * (2.0 - 1.0 / x.abs()) / 2.0 };
            let is_direction = values.iter().flatten().all(|x| x.abs() < 1.001);
            let shade = |x: f32| 0.5 + 0.5 * if is_direction { x } else { bounded(x / 4.0) };
            vec![values.iter().map(|&value| encoded(value.map(shade))).collect()]
        }
        Samples::Coordinates(values) => {
            vec![values.iter().map(|&[u, v]| encoded([u.rem_euclid(1.0), v.rem_euclid(1.0), 0.0])).collect()]
        }
        Samples::Length(values) => {
            let nearest = values.iter().copied().fold(f32::INFINITY, f32::min);
            vec![values.iter().map(|&length| encoded([nearest / length; 3])).collect()]
        }
        Samples::Factor(values) => vec![values.iter().map(|&value| encoded([value; 3])).collect()],
        Samples::Id(values) => vec![values.iter().map(|&id| color_of(id)).collect()],
        Samples::Counts(values) => {
            (0..3).map(|place| heat(values.iter().map(|counts| counts[place]))).collect()
        }
    }
}

/// Codes of a display as linear light.
fn encoded(codes: [f32; 3]) -> [f32; 3] {
    codes.map(|code| lancer_core::color::srgb_to_linear(f64::from(code.clamp(0.0, 1.0))) as f32)
}

fn heat(counts: impl Iterator<Item = u32> + Clone) -> Vec<[f32; 3]> {
    let bits = |count: u32| (1.0 + f64::from(count)).log2() as f32;
    let (least, most) = (counts.clone().min().unwrap_or(0), counts.clone().max().unwrap_or(0));
    let range = (bits(most) - bits(least)).max(1e-6);
    counts.map(|count| encoded([(bits(count) - bits(least)) / range; 3])).collect()
}

/// Neighbours in number get colours far apart.
fn color_of(id: u32) -> [f32; 3] {
    if id == 0 {
        return [0.0; 3];
    }
    let turn = |offset: f64| (f64::from(id) * 0.618_033_988_749_895 + offset).fract();
    let channel = |offset: f64| (1.5 - 6.0 * (turn(offset) - 0.5).abs()).clamp(0.1, 1.0);
    Rgb::new(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)).to_array().map(|channel| channel as f32)
}
