//! What is told of a render after it: as JSON to programs, as a line to people.
//!
//! The names of the JSON's members are part of the contract with scripts: members may be added, and none renamed.

use crate::job::{Job, Shot};
use crate::passes::LayersJson;
use crate::progress::{rays_per_second, short_count};
use crate::{json, process};
use lancer_core::Rgb;
use lancer_core::film::Image;
use lancer_core::integrator::RayCounts;
use lancer_core::render::Render;
use lancer_core::world::{World, WorldStatistics};
use lancer_io::diagnostics::Diagnostic;
use serde::Serialize;
use std::time::Duration;

/// What a finished render has to tell.
pub(crate) struct Report<'a> {
    pub(crate) job: &'a Job,
    pub(crate) shot: &'a Shot,
    pub(crate) world: WorldStatistics,
    pub(crate) rays: RayCounts,
    pub(crate) stages: Stages,
    pub(crate) layers: Option<LayersJson>,
    pub(crate) warnings: &'a [Diagnostic],
}

/// How long each stage took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stages {
    /// Files to scene.
    pub(crate) load: Duration,
    /// Scene to world.
    pub(crate) build: Duration,
    /// World to image.
    pub(crate) render: Duration,
    /// Image to file.
    pub(crate) write: Duration,
}

impl Stages {
    /// All of them.
    pub(crate) fn total(&self) -> Duration {
        self.load + self.build + self.render + self.write
    }
}

impl Report<'_> {
    /// One line for people.
    pub(crate) fn summary(&self) -> String {
        let (width, height) = self.shot.size();
        format!(
            "wrote {}: {width} x {height}, {:.2} s, {} rays, {}",
            self.job.destination,
            self.stages.total().as_secs_f64(),
            short_count(self.rays.total() as f64),
            rays_per_second(self.rays.total(), self.stages.render),
        )
    }

    /// One object for programs.
    pub(crate) fn json(&self) -> String {
        let (width, height) = self.shot.size();
        json::object(&RenderJson {
            scene: self.job.setup.source.to_string(),
            image: ImageJson { width, height },
            samples: self.shot.settings.samples,
            depth: self.shot.settings.depth,
            threads: self.job.setup.threads,
            accelerator: self.job.setup.compile.accelerator.name(),
            rays: self.rays.into(),
            seconds: self.stages.into(),
            world: self.world.into(),
            peak_memory_bytes: process::peak_memory_bytes(),
            output: self.job.destination.to_string(),
            passes: self.layers.as_ref(),
            warnings: self.warnings.iter().map(json::DiagnosticJson::from).collect(),
        })
    }
}

/// What to warn of after a render.
pub(crate) fn warnings_about(picture: &Render, world: &World, shot: &Shot) -> Vec<String> {
    let mut warnings = cut_short(&picture.rays);
    // A part of a picture may well show nothing.
    if shot.region.is_none() && is_all(&picture.image, world.background()) {
        warnings.push("every pixel is the background: the camera sees nothing".into());
    }
    warnings
}

/// What to warn of after any rays.
pub(crate) fn cut_short(rays: &RayCounts) -> Vec<String> {
    let mut warnings = Vec::new();
    if rays.truncated > 0 {
        let count = camera_rays(rays.truncated);
        warnings
            .push(format!("the reflections of {count} were cut short; less --depth would keep them whole"));
    }
    if rays.replaced > 0 {
        let count = camera_rays(rays.replaced);
        warnings.push(format!("the radiance of {count} was not finite and was replaced by black"));
    }
    warnings
}

fn is_all(image: &Image, color: Rgb) -> bool {
    /// The mean of equal samples differs from them by a few roundings at most.
    const ROUNDING: f64 = 1e-6;
    let color = color.to_array();
    image.pixels().iter().all(|pixel| {
        let mut channels = pixel.iter().zip(color);
        channels.all(|(&found, expected)| (f64::from(found) - expected).abs() <= ROUNDING * expected)
    })
}

fn camera_rays(count: u64) -> String {
    if count == 1 { "1 camera ray".into() } else { format!("{count} camera rays") }
}

#[derive(Serialize)]
struct RenderJson<'a> {
    scene: String,
    image: ImageJson,
    samples: u32,
    depth: u32,
    threads: usize,
    accelerator: &'static str,
    rays: RaysJson,
    seconds: SecondsJson,
    #[serde(flatten)]
    world: WorldJson,
    peak_memory_bytes: Option<u64>,
    output: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    passes: Option<&'a LayersJson>,
    warnings: Vec<json::DiagnosticJson<'a>>,
}

/// The pixels that were written: those of the region, where one was asked for.
#[derive(Serialize)]
pub(crate) struct ImageJson {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// Rays by kind.
#[derive(Serialize)]
pub(crate) struct RaysJson {
    primary: u64,
    shadow: u64,
    ao: u64,
    reflection: u64,
    refraction: u64,
    /// Of the five before.
    total: u64,
    truncated: u64,
    replaced: u64,
}

impl From<RayCounts> for RaysJson {
    fn from(rays: RayCounts) -> Self {
        let RayCounts { primary, shadow, ao, reflection, refraction, truncated, replaced } = rays;
        Self { primary, shadow, ao, reflection, refraction, total: rays.total(), truncated, replaced }
    }
}

/// Seconds by stage.
#[derive(Serialize)]
pub(crate) struct SecondsJson {
    load: f64,
    build: f64,
    render: f64,
    write: f64,
    total: f64,
}

impl From<Stages> for SecondsJson {
    fn from(stages: Stages) -> Self {
        Self {
            load: stages.load.as_secs_f64(),
            build: stages.build.as_secs_f64(),
            render: stages.render.as_secs_f64(),
            write: stages.write.as_secs_f64(),
            total: stages.total().as_secs_f64(),
        }
    }
}

/// What a world holds; `info` tells it too.
#[derive(Serialize)]
pub(crate) struct WorldJson {
    objects: usize,
    meshes: usize,
    triangles: u64,
    instanced_triangles: u64,
    tree_nodes: u64,
    tree_bytes: u64,
    tree_depth: u32,
    mesh_bytes: u64,
}

impl From<WorldStatistics> for WorldJson {
    fn from(world: WorldStatistics) -> Self {
        let WorldStatistics {
            objects,
            meshes,
            triangles,
            instanced_triangles,
            tree_nodes,
            tree_bytes,
            mesh_bytes,
            tree_depth,
        } = world;
        Self {
            objects,
            meshes,
            triangles,
            instanced_triangles,
            tree_nodes,
            tree_bytes,
            tree_depth,
            mesh_bytes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_ray_that_was_cut_short_is_told() {
        assert_eq!(cut_short(&RayCounts::default()), [""; 0]);
        let warnings = cut_short(&RayCounts { truncated: 1, replaced: 5, ..RayCounts::default() });
        assert!(warnings[0].contains("1 camera ray "));
        assert!(warnings[1].contains("5 camera rays "));
    }

    #[test]
    fn a_picture_of_one_color_is_told_from_one_with_a_pixel_of_another() {
        let sky = Rgb::new(0.3, 0.0, 2.0);
        let mut image = Image::black(3, 2).map(|_| sky.to_array().map(|channel| channel as f32));
        assert!(is_all(&image, sky));
        image.put(2, 1, 1, &[[0.3, 1e-20, 2.0]]);
        assert!(!is_all(&image, sky));
    }
}
