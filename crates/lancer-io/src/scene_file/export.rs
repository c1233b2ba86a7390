//! A scene, but for its geometry, as the syntax tree of a scene file.

use super::model::FORMAT;
use super::syntax::{Entry, Node, Origin, Place, Scalar, Value};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::{DVec3, Transform};
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
        ("lights", list(scene.lights.iter().map(|light| of_light(light, rgb)))),
        ("materials", mapping(materials)),
        ("render", of_settings(&scene.settings, scene.tone)),
    ])
}

/// The entries of a mapping.
type Entries<const N: usize> = [(&'static str, Rc<Node>); N];

pub(super) fn of_camera(camera: &Camera) -> Rc<Node> {
    mapping(camera_entries(camera))
}

pub(super) fn camera_entries(camera: &Camera) -> Entries<4> {
    [
        ("eye", vector(camera.eye)),
        ("target", vector(camera.target)),
        ("up", vector(camera.up)),
        ("fov", number(camera.fov)),
    ]
}

/// How colours and coefficients are written: [`rgb`] or [`short_rgb`].
type Channels = fn(Rgb) -> Rc<Node>;

pub(super) fn of_light(light: &Light, rgb: Channels) -> Rc<Node> {
    let name = (!light.name.is_empty()).then(|| ("name", text(&light.name)));
    let rest = [("position", vector(light.position)), ("intensity", rgb(light.intensity))];
    mapping(name.into_iter().chain(rest))
}

fn of_material(material: &Material) -> Rc<Node> {
    let color = of_texture(&material.color, rgb).map(|color| ("color", color));
    mapping(color.into_iter().chain(material_entries(material, rgb)))
}

/// `None` for an image, which has no reference to be written as.
pub(super) fn of_texture(texture: &Texture, rgb: Channels) -> Option<Rc<Node>> {
    match texture {
        Texture::Solid(color) => Some(rgb(*color)),
        Texture::Checker { even, odd, size } => {
            let checker = mapping([("even", rgb(*even)), ("odd", rgb(*odd)), ("size", number(*size))]);
            Some(mapping([("checker", checker)]))
        }
        Texture::Image { .. } => None,
    }
}

/// All but the colour.
pub(super) fn material_entries(material: &Material, rgb: Channels) -> Entries<9> {
    [
        ("ambient", rgb(material.ambient)),
        ("diffuse", rgb(material.diffuse)),
        ("specular", rgb(material.specular)),
        ("metallic", rgb(material.metallic)),
        ("shininess", number(material.shininess)),
        ("reflect", rgb(material.reflect)),
        ("transmit", rgb(material.transmit)),
        ("ior", number(material.ior)),
        ("fresnel", boolean(material.fresnel)),
    ]
}

pub(super) fn of_settings(settings: &Settings, tone: Tone) -> Rc<Node> {
    let (ao, rest) = settings_entries(settings, tone);
    mapping(rest.into_iter().chain([("ao", mapping(ao))]))
}

/// The settings of ambient occlusion, and the others.
pub(super) fn settings_entries(settings: &Settings, tone: Tone) -> (Entries<2>, Entries<9>) {
    let ao = [("samples", integer(settings.ao.samples)), ("distance", number(settings.ao.distance))];
    let rest = [
        ("width", integer(settings.width)),
        ("height", integer(settings.height)),
        ("samples", integer(settings.samples)),
        ("depth", integer(settings.depth)),
        ("shadows", boolean(settings.shadows)),
        ("reflection", boolean(settings.reflection)),
        ("refraction", boolean(settings.refraction)),
        ("exposure", number(tone.exposure)),
        ("tone", text(tone.curve.name())),
    ];
    (ao, rest)
}

/// The steps of a transform: those that a person would write where they give just the same, or else its matrix.
pub(super) fn of_steps(transform: Transform) -> Rc<Node> {
    let linear = transform.linear();
    let factors = DVec3::new(linear.x_axis.x, linear.y_axis.y, linear.z_axis.z);
    let offset = transform.translation();
    let mut steps = Vec::new();
    let mut written = Transform::IDENTITY;
    if factors != DVec3::ONE {
        let is_uniform = factors == DVec3::splat(factors.x);
        steps.push(("scale", if is_uniform { number(factors.x) } else { vector(factors) }));
        written = written.then(Transform::scale(factors));
    }
    if offset != DVec3::ZERO {
        steps.push(("translate", vector(offset)));
        written = written.then(Transform::translate(offset));
    }
    if written != transform {
        let row = |i: usize| linear.row(i).to_array().into_iter().chain([offset[i]]);
        let numbers = (0..3).flat_map(row).chain([0.0, 0.0, 0.0, 1.0]);
        steps = vec![("matrix", list(numbers.map(number)))];
    }
    list(steps.into_iter().map(|step| mapping([step])))
}

fn node(value: Value) -> Rc<Node> {
    Rc::new(Node::new(Place::start_of(Origin::File), value))
}

pub(super) fn leaf(scalar: Scalar) -> Rc<Node> {
    node(Value::Scalar(scalar))
}

pub(super) fn number(value: f64) -> Rc<Node> {
    leaf(Scalar::Float(value))
}

pub(super) fn integer(value: u32) -> Rc<Node> {
    leaf(Scalar::Integer(value.into()))
}

pub(super) fn boolean(value: bool) -> Rc<Node> {
    leaf(Scalar::Bool(value))
}

pub(super) fn text(value: &str) -> Rc<Node> {
    leaf(Scalar::text(value))
}

pub(super) fn vector(value: DVec3) -> Rc<Node> {
    list(value.to_array().map(number))
}

fn rgb(value: Rgb) -> Rc<Node> {
    list(value.to_array().map(number))
}

/// As [`rgb`], but one number where the channels are alike.
pub(super) fn short_rgb(value: Rgb) -> Rc<Node> {
    let [red, green, blue] = value.to_array();
    if red == green && green == blue { number(red) } else { rgb(value) }
}

pub(super) fn list(items: impl IntoIterator<Item = Rc<Node>>) -> Rc<Node> {
    node(Value::Sequence(items.into_iter().collect()))
}

pub(super) fn mapping<'a>(entries: impl IntoIterator<Item = (&'a str, Rc<Node>)>) -> Rc<Node> {
    let entry =
        |(key, value): (&str, _)| Entry { key: key.into(), key_place: Place::start_of(Origin::File), value };
    node(Value::Mapping(entries.into_iter().map(entry).collect()))
}
