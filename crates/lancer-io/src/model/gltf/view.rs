//! Cameras and lights.
//!
//! A light of intensity I, in candela, gives I / r^2 at a distance r, and a matt surface of colour S that faces it the
//! radiance S / pi I / r^2. The renderer's is k_d S L_i / (pi r^2), so L_i is I: a candela for a candela, which makes
//! 1 in the picture a candela a square metre. A directional light of illuminance E becomes a point light so far away
//! that E = L_i / r^2 is the same all over the model.

use super::document::{self, Document};
use super::fault::{Fault, Result, Warnings, entry};
use super::nodes::Graph;
use crate::model::ModelCamera;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{Bounds, DVec3, Transform};
use lancer_core::scene::Light;
use std::collections::HashSet;

/// How far away a directional light is put, in diagonals of the model: its light then differs by a part in five
/// hundred across the model, and shadows by half a thousandth of their length.
const FAR: f64 = 1000.0;

/// The cameras of the scene.
pub(super) fn cameras(
    document: &Document,
    graph: &Graph,
    bounds: Bounds,
    warnings: &mut Warnings,
) -> Result<Vec<ModelCamera>> {
    let mut cameras = Vec::new();
    let mut names = HashSet::new();
    for (index, place) in graph.placed(&document.nodes) {
        let node = &document.nodes[index];
        let Some(camera) = node.camera else { continue };
        let written = entry(&document.cameras, "cameras", camera, format!("/nodes/{index}/camera"))?;
        let at = format!("/cameras/{camera}");
        let Some(perspective) = written.perspective.as_ref().filter(|_| written.kind == "perspective") else {
            warnings.add(at, "an orthographic camera is left out: cameras here are perspective");
            continue;
        };
        let fov = perspective.yfov.to_degrees();
        if !(fov > 0.0 && fov < 180.0) {
            let message = format!("is {} radians, must be between 0 and pi", perspective.yfov);
            return Err(Fault::new(format!("{at}/perspective/yfov"), message));
        }
        let Some(camera) = camera_at(place, fov, bounds) else {
            warnings.add(format!("/nodes/{index}"), "its camera is left out: its transform flattens it");
            continue;
        };
        let base = node.name.as_deref().or(written.name.as_deref()).filter(|name| !name.is_empty());
        let base = base.map_or_else(|| format!("camera {}", cameras.len() + 1), str::to_owned);
        let numbered = (2..).map(|number| format!("{base} {number}"));
        let name = std::iter::once(base.clone()).chain(numbered).find(|name| !names.contains(name));
        let name = name.unwrap_or(base);
        names.insert(name.clone());
        let aspect = perspective.aspect_ratio.filter(|aspect| *aspect > 0.0);
        cameras.push(ModelCamera { name, camera, aspect });
    }
    Ok(cameras)
}

/// The camera that looks along -Z of its place, at the point beside the model's middle, about which one turns.
fn camera_at(place: Transform, fov: f64, bounds: Bounds) -> Option<Camera> {
    let eye = place.translation();
    let forward = place.vector(DVec3::NEG_Z).try_normalize()?;
    let up = place.vector(DVec3::Y).try_normalize()?;
    let ahead = (bounds.center() - eye).dot(forward);
    let least = 0.1 * bounds.diagonal();
    let distance = if ahead > least { ahead } else { least.max(f64::MIN_POSITIVE) };
    let camera = Camera { eye, target: eye + forward * distance, up, fov };
    camera.frame().is_ok().then_some(camera)
}

/// The lights of the scene, in the order of its nodes.
pub(super) fn lights(
    document: &Document,
    graph: &Graph,
    bounds: Bounds,
    warnings: &mut Warnings,
) -> Result<Vec<Light>> {
    let written = document.extensions.lights.as_ref().map_or(&[][..], |lights| &lights.lights);
    let mut lights = Vec::new();
    for (index, place) in graph.placed(&document.nodes) {
        let node = &document.nodes[index];
        let reference = node.extensions.as_ref().and_then(|extensions| extensions.light.as_ref());
        let Some(reference) = reference else { continue };
        let at = format!("/nodes/{index}/extensions/KHR_lights_punctual/light");
        let light = entry(written, "lights", reference.light, at)?;
        let at = format!("/extensions/KHR_lights_punctual/lights/{}", reference.light);
        let intensity = intensity_of(light, &at)?;
        let name = node.name.as_deref().or(light.name.as_deref()).unwrap_or_default().to_owned();
        let (position, intensity) = match light.kind.as_str() {
            "point" => (place.translation(), intensity),
            "spot" => {
                warnings.add(&at, "a spot light is drawn as a point light: it shines in all directions");
                (place.translation(), intensity)
            }
            "directional" => {
                warnings.add(&at, "a directional light is drawn as a point light far away");
                let Some(toward) = place.vector(DVec3::Z).try_normalize() else { continue };
                let diagonal = if bounds.diagonal() > 0.0 { bounds.diagonal() } else { 1.0 };
                let distance = FAR * diagonal;
                (bounds.center() + toward * distance, intensity * (distance * distance))
            }
            other => {
                warnings.add(&at, format!("`{other}` is no kind of light and is left out"));
                continue;
            }
        };
        if position.is_finite() && intensity.is_finite() {
            lights.push(Light { name, position, intensity });
        } else {
            warnings.add(format!("/nodes/{index}"), "its light is left out: it is out of all range");
        }
    }
    Ok(lights)
}

fn intensity_of(light: &document::Light, at: &str) -> Result<Rgb> {
    let color = light.color.unwrap_or([1.0; 3]);
    let intensity = light.intensity.unwrap_or(1.0);
    if !(intensity >= 0.0 && color.iter().all(|channel| *channel >= 0.0)) {
        return Err(Fault::new(at, "its intensity and color must not be negative"));
    }
    Ok(Rgb::from(color) * intensity)
}
