//! A scene, but for its geometry, as the syntax tree of a scene file.

use super::model::FORMAT;
use super::syntax::{Entry, Node, Origin, Place, Scalar, Value};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Light, Material, Scene, Settings, Texture};
use std::collections::HashSet;
use std::rc::Rc;

/// The tree of a scene. Of materials that share a name the first is in it, nameless ones are not, and neither are
/// images.
pub(crate) fn export(scene: &Scene) -> Rc<Node> {
    let mut names = HashSet::new();
    let materials = scene
        .materials()
        .iter()
        .filter(|material| !material.name.is_empty() && names.insert(material.name.as_str()))
        .map(|material| (material.name.as_str(), of_material(material)));
    mapping([
        ("format", integer(FORMAT as u32)),
        ("name", text(&scene.name)),
        ("camera", of_camera(&scene.camera)),
        ("cameras", mapping(scene.cameras.iter().map(|(name, camera)| (name.as_str(), of_camera(camera))))),
        ("ambient", rgb(scene.ambient)),
        ("background", rgb(scene.background)),
        ("lights", list(scene.lights.iter().map(of_light))),
        ("materials", mapping(materials)),
        ("render", of_settings(&scene.settings, scene.tone)),
    ])
}

fn of_camera(camera: &Camera) -> Rc<Node> {
    mapping([
        ("eye", vector(camera.eye)),
        ("target", vector(camera.target)),
        ("up", vector(camera.up)),
        ("fov", number(camera.fov)),
    ])
}

fn of_light(light: &Light) -> Rc<Node> {
    mapping([
        ("name", text(&light.name)),
        ("position", vector(light.position)),
        ("intensity", rgb(light.intensity)),
    ])
}

fn of_material(material: &Material) -> Rc<Node> {
    let color = match &material.color {
        Texture::Solid(color) => Some(rgb(*color)),
        Texture::Checker { even, odd, size } => {
            let checker = mapping([("even", rgb(*even)), ("odd", rgb(*odd)), ("size", number(*size))]);
            Some(mapping([("checker", checker)]))
        }
        Texture::Image(_) => None,
    };
    let coefficients = [
        ("ambient", rgb(material.ambient)),
        ("diffuse", rgb(material.diffuse)),
        ("specular", rgb(material.specular)),
        ("metallic", rgb(material.metallic)),
        ("shininess", number(material.shininess)),
        ("reflect", rgb(material.reflect)),
        ("transmit", rgb(material.transmit)),
        ("ior", number(material.ior)),
        ("fresnel", boolean(material.fresnel)),
    ];
    mapping(color.map(|color| ("color", color)).into_iter().chain(coefficients))
}

fn of_settings(settings: &Settings, tone: Tone) -> Rc<Node> {
    let ao = mapping([("samples", integer(settings.ao.samples)), ("distance", number(settings.ao.distance))]);
    mapping([
        ("width", integer(settings.width)),
        ("height", integer(settings.height)),
        ("samples", integer(settings.samples)),
        ("depth", integer(settings.depth)),
        ("ao", ao),
        ("shadows", boolean(settings.shadows)),
        ("reflection", boolean(settings.reflection)),
        ("refraction", boolean(settings.refraction)),
        ("exposure", number(tone.exposure)),
    ])
}

fn node(value: Value) -> Rc<Node> {
    Rc::new(Node::new(Place::start_of(Origin::File), value))
}

fn leaf(scalar: Scalar) -> Rc<Node> {
    node(Value::Scalar(scalar))
}

fn number(value: f64) -> Rc<Node> {
    leaf(Scalar::Float(value))
}

fn integer(value: u32) -> Rc<Node> {
    leaf(Scalar::Integer(value.into()))
}

fn boolean(value: bool) -> Rc<Node> {
    leaf(Scalar::Bool(value))
}

fn text(value: &str) -> Rc<Node> {
    leaf(Scalar::text(value))
}

fn vector(value: DVec3) -> Rc<Node> {
    list(value.to_array().map(number))
}

fn rgb(value: Rgb) -> Rc<Node> {
    list(value.to_array().map(number))
}

fn list(items: impl IntoIterator<Item = Rc<Node>>) -> Rc<Node> {
    node(Value::Sequence(items.into_iter().collect()))
}

fn mapping<'a>(entries: impl IntoIterator<Item = (&'a str, Rc<Node>)>) -> Rc<Node> {
    let entry =
        |(key, value): (&str, _)| Entry { key: key.into(), key_place: Place::start_of(Origin::File), value };
    node(Value::Mapping(entries.into_iter().map(entry).collect()))
}
