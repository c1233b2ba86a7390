//! Whole frames: Lancer's `render` against the best renderer on Embree.

use super::embree_side::{scene_of, triangles_of};
use super::stage::{HEIGHT, Stage, WIDTH};
use super::{Plan, directions};
use crate::Failure;
use crate::embree::ffi::{Build, Device, Quality, Scene};
use crate::embree::renderer::{self, Beams, Fans, Picture, Style};
use crate::record::{Ratio, median, seconds};
use lancer_core::camera::Camera;
use lancer_core::film::Image;
use lancer_core::geometry::{DVec3, Placement, portable};
use lancer_core::render::{Control, Render, render, with_threads};
use lancer_core::sampling::HemisphereLattice;
use lancer_core::scene::{Settings, Texture};
use lancer_core::world::{CompileOptions, World};
use lancer_io::image::Metadata;
use lancer_io::image::encode::write_png;
use serde_json::{Value, json};
use std::f64::consts::FRAC_1_PI;
use std::path::Path;
use std::sync::Arc;

pub(super) const HEADING: &str = "\nFrames of 1024 x 768, primary and shadow rays of two lights, with N directions \
of ambient occlusion on the whole sphere: milliseconds. Ratios are Embree's time to Lancer's, medians over the runs \
(least..most).\n
| scene | N | threads | Lancer | Embree | its style | ratio | mean difference | largest | over 1/255 |
|---|---:|---:|---:|---:|---|---:|---:|---:|---:|";

/// Directions on the whole sphere; about half of them are traced.
const DIRECTIONS: [u32; 3] = [0, 32, 128];

/// How far rays start off a surface in `f32`, of the scene's diagonal; as for the rays by kind.
const OFF_SURFACE: f64 = 1e-5;

/// Prints a stage's rows; returns its figures.
#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(super) fn measure(stage: &Stage, device: &Arc<Device>, plan: &Plan) -> Result<Vec<Value>, Failure> {
    let world = World::compile(&stage.scene, &CompileOptions::default())?;
    let build = Build { quality: Quality::High, robust: false };
    let scene = scene_of(stage, &triangles_of(stage), device, build)?;
    let mut records = Vec::new();
    for &threads in &plan.threads {
        let mut beams = Beams::Packets;
        for directions in DIRECTIONS {
            let frames = with_threads(threads, || {
                Frames::measure(stage, &world, &scene, directions, &mut beams, plan.runs)
            })??;
            println!("{}", frames.row(stage, directions, threads));
            if let Some(directory) = &plan.images {
                frames.write(directory, &format!("{}-{directions}", stage.name))?;
            }
            records.push(frames.to_json(stage, directions, threads));
        }
    }
    Ok(records)
}

/// Seconds a frame, one entry a run.
struct Frames {
    lancer: Vec<f64>,
    embree: Vec<f64>,
    style: Style,
    /// One frame in each style, from which the style was chosen.
    tried: Vec<(Style, f64)>,
    rays: u64,
    ours: Image,
    theirs: Image,
    difference: Difference,
}

impl Frames {
    /// Tries Embree's styles once, then takes turns with the best. `beams` is chosen without ambient occlusion and
    /// kept for the frames with it.
    fn measure(
        stage: &Stage,
        world: &World,
        scene: &Scene,
        directions: u32,
        beams: &mut Beams,
        runs: usize,
    ) -> Result<Self, Failure> {
        let settings = settings(stage, directions);
        let picture = picture(stage, directions)?;
        let theirs = |style| seconds(|| renderer::render(&picture, scene, style, &directions::shift));
        let styles: Vec<Style> = match directions {
            0 => Beams::ALL.iter().map(|&beams| Style { beams, fans: Fans::OnePoint }).collect(),
            _ => Fans::ALL.iter().map(|&fans| Style { beams: *beams, fans }).collect(),
        };
        let tried: Vec<(Style, f64)> = styles.into_iter().map(|style| (style, theirs(style).0)).collect();
        let fastest = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1)).ok_or("there are styles")?;
        let style = fastest.0;
        *beams = style.beams;
        let ours = || seconds(|| render(world, &stage.scene.camera, &settings, None, &Control::default()));
        let (mut lancer, mut embree) = (Vec::new(), Vec::new());
        let mut last = None;
        for _ in 0..runs {
            let (time, our_picture) = ours();
            lancer.push(time);
            let (time, their_image) = theirs(style);
            embree.push(time);
            last = Some((our_picture?, their_image));
        }
        let (Render { image, rays }, their_image) = last.ok_or("there are runs")?;
        let difference = Difference::between(&image, &their_image);
        let mut theirs = Image::black(WIDTH, HEIGHT);
        theirs.put(0, 0, WIDTH, &their_image);
        Ok(Self { lancer, embree, style, tried, rays: rays.total(), ours: image, theirs, difference })
    }

    /// Writes both pictures.
    fn write(&self, directory: &Path, name: &str) -> Result<(), Failure> {
        std::fs::create_dir_all(directory)?;
        for (image, side) in [(&self.ours, "lancer"), (&self.theirs, "embree")] {
            let file = std::fs::File::create(directory.join(format!("{name}-{side}.png")))?;
            write_png(image, &Metadata::default(), std::io::BufWriter::new(file))?;
        }
        Ok(())
    }

    fn row(&self, stage: &Stage, directions: u32, threads: usize) -> String {
        let Difference { mean, most, visible } = self.difference;
        format!(
            "| {} | {directions} | {threads} | {:.1} | {:.1} | {} | {} | {mean:.1e} | {most:.2} | {visible:.1e} |",
            stage.name,
            1e3 * median(&self.lancer),
            1e3 * median(&self.embree),
            style_name(self.style, directions),
            Ratio::of(&self.embree, &self.lancer),
        )
    }

    fn to_json(&self, stage: &Stage, directions: u32, threads: usize) -> Value {
        let tried: Vec<Value> = self
            .tried
            .iter()
            .map(|(style, time)| json!({ "style": style_name(*style, directions), "seconds": time }))
            .collect();
        json!({
            "table": "frames",
            "scene": stage.name,
            "triangles": stage.triangles(),
            "directions": directions,
            "rays": self.rays,
            "threads": threads,
            "lancer_seconds": self.lancer,
            "embree_seconds": self.embree,
            "embree_style": style_name(self.style, directions),
            "embree_tried": tried,
            "difference": {
                "mean": self.difference.mean,
                "largest": self.difference.most,
                "over_1_255": self.difference.visible,
            },
        })
    }
}

fn style_name(style: Style, directions: u32) -> String {
    match directions {
        0 => style.beams.name().to_owned(),
        _ => format!("{}, AO {}", style.beams.name(), style.fans.name()),
    }
}

pub(super) fn settings(stage: &Stage, directions: u32) -> Settings {
    let mut settings = stage.scene.settings;
    settings.ao.samples = directions;
    settings
}

/// The stage's picture in the numbers of Embree's renderer.
fn picture(stage: &Stage, directions: u32) -> Result<Picture, Failure> {
    let scene = &stage.scene;
    let material = &scene.materials()[0];
    let Texture::Solid(color) = material.color else { return Err("the stage has one colour".into()) };
    let single = |vector: DVec3| vector.as_vec3().to_array();
    let Camera { eye, fov, .. } = scene.camera;
    let [right, up, backward] = scene.camera.frame()?;
    let pixel = 2.0 * portable::tan(0.5 * fov.to_radians()) / f64::from(HEIGHT);
    let corner = up * (0.5 * f64::from(HEIGHT) * pixel) - right * (0.5 * f64::from(WIDTH) * pixel) - backward;
    let rows = |place: &lancer_core::geometry::Transform| -> Result<[[f32; 3]; 3], Failure> {
        Placement::new(*place)?;
        // The inverse transpose's rows are the columns of the inverse.
        let inverse = place.linear().inverse();
        Ok([single(inverse.x_axis), single(inverse.y_axis), single(inverse.z_axis)])
    };
    Ok(Picture {
        width: WIDTH as usize,
        height: HEIGHT as usize,
        eye: single(eye),
        top_left: single(corner),
        right: single(right * pixel),
        down: single(up * -pixel),
        background: scene.background.to_array().map(|channel| channel as f32),
        ambient: (scene.ambient * material.ambient * color).to_array().map(|channel| channel as f32),
        lights: scene
            .lights
            .iter()
            .map(|light| {
                let reflected = light.intensity * material.diffuse * color * FRAC_1_PI;
                (single(light.position), reflected.to_array().map(|channel| channel as f32))
            })
            .collect(),
        normal_matrices: stage.places.iter().map(rows).collect::<Result<_, _>>()?,
        off_surface: (OFF_SURFACE * stage.diagonal) as f32,
        samples: directions,
        azimuths: HemisphereLattice::new(directions)
            .azimuths()
            .map(|azimuth| azimuth.map(|x| x as f32))
            .collect(),
        reach: scene.settings.ao.distance as f32,
    })
}

/// How far two pictures differ, by channel.
struct Difference {
    mean: f64,
    most: f64,
    /// The part of the pixels with a channel that differs by more than 1/255.
    visible: f64,
}

impl Difference {
    fn between(ours: &Image, theirs: &[[f32; 3]]) -> Self {
        let (mut sum, mut most, mut visible) = (0.0, 0.0_f64, 0_u32);
        for (a, b) in ours.pixels().iter().zip(theirs) {
            let off = [0, 1, 2].map(|channel| f64::from(a[channel] - b[channel]).abs());
            let worst = off[0].max(off[1]).max(off[2]);
            sum += (off[0] + off[1] + off[2]) / 3.0;
            most = most.max(worst);
            visible += u32::from(worst > 1.0 / 255.0);
        }
        let pixels = theirs.len() as f64;
        Self { mean: sum / pixels, most, visible: f64::from(visible) / pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::device;
    use crate::versus::embree_side::{Form, Prepared};
    use crate::versus::kinds;
    use crate::versus::rays::lots;
    use crate::versus::stage;

    #[test]
    #[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
    fn both_sides_see_the_same_where_embree_is_installed() {
        let Ok(library) = device::find(None) else {
            return eprintln!("skipped: Embree was not found");
        };
        let device = Device::new(&library, "").unwrap();
        for stage in [stage::sphereflake(10_000).unwrap(), stage::instances(9).unwrap()] {
            let world = World::compile(&stage.scene, &CompileOptions::default()).unwrap();
            let build = Build { quality: Quality::High, robust: false };
            let scene = scene_of(&stage, &triangles_of(&stage), &device, build).unwrap();
            for lot in lots(&stage, &world).unwrap() {
                let prepared = Prepared::new(&lot);
                let ours = kinds::trace(&world, &lot);
                for form in Form::all(&lot) {
                    let off = prepared.trace(&scene, form).abs_diff(ours);
                    assert!(off * 1000 < lot.rays.len(), "{off} of {} {}", lot.rays.len(), form.name(&lot));
                }
            }
            let ours = |n| {
                render(&world, &stage.scene.camera, &settings(&stage, n), None, &Control::default()).unwrap()
            };
            let check = |image: &Image, directions, style: Style| {
                let picture = picture(&stage, directions).unwrap();
                let theirs = renderer::render(&picture, &scene, style, &directions::shift);
                let difference = Difference::between(image, &theirs);
                assert!(difference.mean < 1e-3, "{} {style:?}: {}", stage.name, difference.mean);
            };
            let without = ours(0).image;
            Beams::ALL.iter().for_each(|&beams| check(&without, 0, Style { beams, fans: Fans::OnePoint }));
            let with = ours(8).image;
            Fans::ALL.iter().for_each(|&fans| check(&with, 8, Style { beams: Beams::Packets, fans }));
        }
    }
}
