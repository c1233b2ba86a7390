//! `lancer info`: what a scene or a model holds.

use crate::args::InfoArgs;
use crate::error::Error;
use crate::report::WorldJson;
use crate::source::Source;
use crate::{json, process, terminal};
use indicatif::{HumanBytes, HumanCount};
use lancer_core::camera::Camera;
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::geometry::{Bounds, DVec3};
use lancer_core::scene::{Light, Scene, Settings};
use lancer_core::world::{CompileOptions, World, WorldStatistics};
use lancer_io::diagnostics::{Diagnostic, LoadError};
use lancer_io::{LoadOptions, Loaded};
use serde::Serialize;
use std::fmt::Write;

/// Prints what the scene holds.
///
/// # Errors
/// It cannot be read or compiled.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Error> {
    let source = Source::find(Some(&args.file))?;
    let options = LoadOptions { allow_outside: args.access.allow_outside, ..LoadOptions::default() };
    let Loaded { scene, warnings, .. } = source.load(&options)?;
    let world = World::compile(&scene, &CompileOptions::default())
        .map_err(|error| LoadError::from(source.diagnostic(error)))?;
    let info = Info { source: &source, scene: &scene, world: &world, warnings: &warnings };
    terminal::print(if args.json { info.json() } else { terminal::harmless(&info.text()) })
}

struct Info<'a> {
    source: &'a Source,
    scene: &'a Scene,
    world: &'a World,
    warnings: &'a [Diagnostic],
}

impl Info<'_> {
    /// For people: a line for each matter.
    fn text(&self) -> String {
        let statistics = self.world.statistics();
        let mut text = String::new();
        let mut line = |matter: &str, told: String| {
            writeln!(text, "{matter:<10}  {told}").expect("memory can be written");
        };
        line("scene", self.source.to_string());
        line("name", self.scene.name.clone());
        line("objects", HumanCount(statistics.objects as u64).to_string());
        line("triangles", triangles(&statistics));
        line("bounds", bounds(&self.world.bounds()));
        line("materials", listed(self.scene.materials().iter().map(|material| material.name.as_str())));
        line("lights", listed(self.scene.lights.iter().map(|light| light.name.as_str())));
        line("cameras", listed(cameras(self.scene).map(|(name, _)| name.unwrap_or(""))));
        line("picture", picture(&self.scene.settings, self.scene.tone));
        line("tree", tree(&statistics));
        line("memory", memory(&statistics));
        line("warnings", self.warnings.len().to_string());
        for warning in self.warnings {
            writeln!(text, "{warning}").expect("memory can be written");
        }
        text
    }

    /// For programs.
    fn json(&self) -> String {
        let bounds = self.world.bounds();
        json::object(&InfoJson {
            scene: self.source.to_string(),
            name: &self.scene.name,
            world: self.world.statistics().into(),
            bounds: (!bounds.is_empty()).then(|| BoundsJson::from(bounds)),
            materials: self.scene.materials().iter().map(|material| material.name.as_str()).collect(),
            lights: self.scene.lights.iter().map(LightJson::from).collect(),
            cameras: cameras(self.scene).map(CameraJson::from).collect(),
            picture: PictureJson::of(self.scene),
            peak_memory_bytes: process::peak_memory_bytes(),
            warnings: self.warnings.iter().map(json::DiagnosticJson::from).collect(),
        })
    }
}

/// The main camera, which has no name, and the named ones.
fn cameras(scene: &Scene) -> impl Iterator<Item = (Option<&str>, &Camera)> {
    let named = scene.cameras.iter().map(|(name, camera)| (Some(name.as_str()), camera));
    std::iter::once((None, &scene.camera)).chain(named)
}

fn triangles(statistics: &WorldStatistics) -> String {
    let WorldStatistics { triangles, instanced_triangles, meshes, .. } = *statistics;
    let mut told = HumanCount(triangles).to_string();
    if meshes > 0 {
        let noun = if meshes == 1 { "mesh" } else { "meshes" };
        write!(told, " in {} {noun}", HumanCount(meshes as u64)).expect("memory can be written");
    }
    if instanced_triangles != triangles {
        write!(told, ", {} as drawn", HumanCount(instanced_triangles)).expect("memory can be written");
    }
    told
}

fn bounds(bounds: &Bounds) -> String {
    if bounds.is_empty() {
        return "none: all objects are unbounded".into();
    }
    let point = |p: DVec3| format!("({})", p.to_array().map(short).join(", "));
    format!("{} to {}", point(bounds.min), point(bounds.max))
}

/// A number with five digits, as few as tell models of any size apart from their rounding errors.
fn short(number: f64) -> String {
    let rounded = format!("{number:.4e}").parse::<f64>();
    rounded.expect("a number that was written can be read").to_string()
}

/// A count and the names, where there are any.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    /// Names that are shown; a scene made by a program may have thousands.
    const SHOWN: usize = 12;
    let names = names.collect::<Vec<_>>();
    let named = names.iter().copied().filter(|name| !name.is_empty()).collect::<Vec<_>>();
    let mut told = HumanCount(names.len() as u64).to_string();
    if !named.is_empty() {
        let more = if named.len() > SHOWN { ", ..." } else { "" };
        let shown = named[..named.len().min(SHOWN)].join(", ");
        write!(told, ": {shown}{more}").expect("memory can be written");
    }
    told
}

fn picture(settings: &Settings, tone: Tone) -> String {
    let Settings { width, height, samples, depth, ao, shadows, reflection, refraction } = settings;
    let occlusion = match ao.samples {
        0 => "off".into(),
        samples => format!("{samples} to {}", short(ao.distance)),
    };
    let mut told =
        format!("{width} x {height}, samples {samples}, depth {depth}, ambient occlusion {occlusion}");
    for (name, on) in [("shadows", shadows), ("reflection", reflection), ("refraction", refraction)] {
        if !on {
            write!(told, ", no {name}").expect("memory can be written");
        }
    }
    if tone.exposure != 0.0 {
        write!(told, ", exposure {}", short(tone.exposure)).expect("memory can be written");
    }
    if tone.curve != ToneCurve::default() {
        write!(told, ", tone {}", tone.curve.name()).expect("memory can be written");
    }
    told
}

fn tree(statistics: &WorldStatistics) -> String {
    format!("{} nodes, {} deep", HumanCount(statistics.tree_nodes), statistics.tree_depth)
}

fn memory(statistics: &WorldStatistics) -> String {
    let peak = match process::peak_memory_bytes() {
        Some(bytes) => HumanBytes(bytes).to_string(),
        None => "unknown".into(),
    };
    let (meshes, trees) = (HumanBytes(statistics.mesh_bytes), HumanBytes(statistics.tree_bytes));
    format!("meshes {meshes}, trees {trees}, peak {peak}")
}

#[derive(Serialize)]
struct InfoJson<'a> {
    scene: String,
    name: &'a str,
    #[serde(flatten)]
    world: WorldJson,
    bounds: Option<BoundsJson>,
    materials: Vec<&'a str>,
    lights: Vec<LightJson<'a>>,
    cameras: Vec<CameraJson<'a>>,
    picture: PictureJson,
    peak_memory_bytes: Option<u64>,
    warnings: Vec<json::DiagnosticJson<'a>>,
}

#[derive(Serialize)]
struct BoundsJson {
    min: [f64; 3],
    max: [f64; 3],
}

impl From<Bounds> for BoundsJson {
    fn from(bounds: Bounds) -> Self {
        Self { min: bounds.min.to_array(), max: bounds.max.to_array() }
    }
}

#[derive(Serialize)]
struct LightJson<'a> {
    name: &'a str,
    position: [f64; 3],
    intensity: [f64; 3],
}

impl<'a> From<&'a Light> for LightJson<'a> {
    fn from(light: &'a Light) -> Self {
        Self { name: &light.name, position: light.position.to_array(), intensity: light.intensity.to_array() }
    }
}

#[derive(Serialize)]
struct CameraJson<'a> {
    name: Option<&'a str>,
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    fov: f64,
}

impl<'a> From<(Option<&'a str>, &Camera)> for CameraJson<'a> {
    fn from((name, camera): (Option<&'a str>, &Camera)) -> Self {
        let Camera { eye, target, up, fov } = camera;
        Self { name, eye: eye.to_array(), target: target.to_array(), up: up.to_array(), fov: *fov }
    }
}

#[derive(Serialize)]
struct PictureJson {
    width: u32,
    height: u32,
    samples: u32,
    depth: u32,
    ao: OcclusionJson,
    shadows: bool,
    reflection: bool,
    refraction: bool,
    exposure: f64,
    tone: &'static str,
}

#[derive(Serialize)]
struct OcclusionJson {
    samples: u32,
    distance: f64,
}

impl PictureJson {
    fn of(scene: &Scene) -> Self {
        let Settings { width, height, samples, depth, ao, shadows, reflection, refraction } = scene.settings;
        let ao = OcclusionJson { samples: ao.samples, distance: ao.distance };
        let Tone { exposure, curve } = scene.tone;
        let tone = curve.name();
        Self { width, height, samples, depth, ao, shadows, reflection, refraction, exposure, tone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_at_every_size() {
        let shown = [0.0, 1.0 / 3.0, -1.000_000_000_2, 123_456_789.0, 1.5e-7].map(short);
        assert_eq!(shown, ["0", "0.33333", "-1", "123460000", "0.00000015"]);
        assert_eq!(short(f64::INFINITY), "inf");
    }

    #[test]
    fn long_lists_of_names_are_cut() {
        assert_eq!(listed(["", ""].into_iter()), "2");
        assert_eq!(listed(["", "sun"].into_iter()), "2: sun");
        let many = listed(std::iter::repeat_n("a", 100));
        assert!(many.starts_with("100: a, a") && many.ends_with("a, ..."), "{many}");
    }
}
