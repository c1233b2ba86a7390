//! A bare model made into a scene that shows it well.
//!
//! In: a model of any size, anywhere. Out: a scene with a camera that frames it, three lights, a ground and
//! ambient occlusion, all in proportion to the model. The model is taken to stand on -Y and to face +Z, or where
//! its format has +Z pointing up, on -Z and to face -Y; then it is turned.
//!
//! A file that has cameras or lights is a scene already: it is seen by its first camera, lit by its own lights, and
//! gets no ground. What it lacks of the two is added.

use crate::model::{Model, ModelCamera, UpAxis};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::film::Tone;
use lancer_core::geometry::{Bounds, DVec3, Transform, portable};
use lancer_core::scene::{AmbientOcclusion, Light, Material, Node, NodeId, Scene, Settings, Shape};
use std::f64::consts::PI;

/// From the model toward the camera: from the front, the right and a little above, so that three sides show.
const TOWARD_CAMERA: DVec3 = DVec3::new(0.6, 0.4, 1.0);

/// The camera's vertical angle in degrees: about a portrait lens, which does not distort.
const FIELD_OF_VIEW: f64 = 35.0;

/// How much larger than the model's box the picture is; below 1 corners are cut off, far above it is small.
const MARGIN: f64 = 1.12;

/// How far lights are, in diagonals of the model. Nearer, its near side would be much brighter than its far
/// one (at 4, by 1.3 at most); further makes no difference.
const LIGHT_DISTANCE: f64 = 4.0;

/// A light: where it is from, in the camera's frame (right, up, toward the camera), and what it gives a white
/// surface that faces it at the model's middle.
struct Lamp {
    name: &'static str,
    from: DVec3,
    radiance: Rgb,
}

/// Three lights as photographers set them. Key, fill and ambient light together give a plaster that faces the
/// key light about 0.8, which leaves room for the near side and for the highlight. All stand high: one near
/// the ground would burn a spot into it. A warm key and cool others tell lit sides from shaded ones by hue too.
const LAMPS: [Lamp; 3] = [
    Lamp { name: "key", from: DVec3::new(-0.7, 0.9, 0.8), radiance: Rgb::new(0.66, 0.61, 0.53) },
    Lamp { name: "fill", from: DVec3::new(1.0, 0.6, 0.6), radiance: Rgb::new(0.15, 0.18, 0.23) },
    Lamp { name: "rim", from: DVec3::new(0.5, 1.8, -0.9), radiance: Rgb::new(0.32, 0.35, 0.40) },
];

/// L_a: fills what no light reaches, so that ambient occlusion shows, and does not flatten the rest.
const AMBIENT: Rgb = Rgb::new(0.22, 0.25, 0.30);

/// How far geometry occludes ambient light, in diagonals: creases and the contact with the ground darken,
/// not whole sides.
const OCCLUSION_DISTANCE: f64 = 0.2;

/// Directions of ambient occlusion at a point: with 2 x 2 subpixels, 64 a pixel, of little noise.
const OCCLUSION_SAMPLES: u32 = 16;

/// How far below the model the ground lies, in diagonals: too little to see, and enough that a flat base and
/// the ground are not one surface.
const GROUND_GAP: f64 = 1e-4;

/// What a file's own lights may give a white surface amid the model before the picture is exposed for them:
/// outside of this nearly all of it would be white, or black.
const WELL_LIT: std::ops::RangeInclusive<f64> = 0.1..=2.5;

/// The most that the lights give such a surface in a picture exposed for them; by whole stops, the least is half.
const EXPOSED_FOR: f64 = 1.0;

/// The least and the most pixels in a row of a picture with a file's own aspect.
const WIDTHS: std::ops::RangeInclusive<f64> = 100.0..=2400.0;

/// The scene that shows a model.
///
/// Where the model's own lights are far from giving 1 (they are in candela, and a lamp gives hundreds), the scene's
/// exposure makes up for it, and ambient light and background are such that they look as ever.
pub fn scene_of_model(mut model: Model) -> Scene {
    let upright = match model.up {
        UpAxis::Y => Transform::IDENTITY,
        UpAxis::Z => Transform::rotate(DVec3::X, -90.0),
    };
    let bounds = model.bounds_under(upright);
    let diagonal = diagonal_of(bounds);
    let is_scene = !model.cameras.is_empty() || !model.lights.is_empty();
    let mut scene = Scene::new(model.name.clone());
    scene.settings = settings(diagonal);
    let cameras = std::mem::take(&mut model.cameras);
    match cameras.first() {
        Some(first) => {
            scene.camera = first.camera;
            scene.settings.width = width_of(first, scene.settings);
        }
        None => scene.camera = framing_camera(bounds, &scene.settings),
    }
    scene.cameras = cameras.into_iter().map(|camera| (camera.name, camera.camera)).collect();
    scene.lights = std::mem::take(&mut model.lights);
    if scene.lights.is_empty() {
        scene.lights = lights(bounds.center(), diagonal, &scene.camera);
    } else {
        scene.tone.exposure = exposure_for(&scene.lights, bounds);
    }
    let shown_as_is = 1.0 / f64::from(scene.tone.factor());
    scene.ambient = AMBIENT * shown_as_is;
    scene.background = Rgb::from_srgb_hex(0xc3_cdd9) * shown_as_is;

    let plaster = scene.add_material(plaster());
    if !is_scene {
        let ground = scene.add_material(ground_material());
        let height = bounds.min.y - GROUND_GAP * diagonal;
        let at = DVec3::new(bounds.center().x, height, bounds.center().z);
        let ground = Node::shape(GROUND, Shape::Plane).with_material(ground);
        scene.add(ground.with_transform(Transform::translate(at)));
    }
    paint(&mut model);
    let model = model.insert_into(&mut scene).with_material(plaster);
    let place = model.transform.then(upright);
    scene.add(model.with_transform(place));
    scene
}

/// Pixels in a row for a camera's own aspect.
fn width_of(camera: &ModelCamera, settings: Settings) -> u32 {
    let width = |aspect: f64| (aspect * f64::from(settings.height)).round();
    camera.aspect.map_or(settings.width, |aspect| width(aspect).clamp(*WIDTHS.start(), *WIDTHS.end()) as u32)
}

/// The stops by which a picture under a file's own lights is to be made brighter, a whole number.
///
/// Judged by the median over points amid the model, since one of them may lie near a light.
fn exposure_for(lights: &[Light], bounds: Bounds) -> f64 {
    let center = bounds.center();
    let points = bounds.corners().map(|corner| center.lerp(corner, 0.5)).into_iter().chain([center]);
    let given = |point: DVec3| {
        let one =
            |light: &Light| light.intensity.max_channel() / (PI * light.position.distance_squared(point));
        lights.iter().map(one).sum::<f64>()
    };
    let mut given = points.map(given).collect::<Vec<_>>();
    given.sort_by(f64::total_cmp);
    let median = given[given.len() / 2];
    if WELL_LIT.contains(&median) || !median.is_normal() {
        return 0.0;
    }
    let brighter = (0..).take_while(|&stops| median * portable::exp2(f64::from(stops + 1)) <= EXPOSED_FOR);
    let darker = (0..).take_while(|&stops| median * portable::exp2(f64::from(-stops)) > EXPOSED_FOR);
    let stops = brighter.count() as f64 - darker.count() as f64;
    stops.clamp(-Tone::MAX_EXPOSURE, Tone::MAX_EXPOSURE)
}

fn settings(diagonal: f64) -> Settings {
    let ao = AmbientOcclusion { samples: OCCLUSION_SAMPLES, distance: OCCLUSION_DISTANCE * diagonal };
    Settings { samples: 2, ao, ..Settings::default() }
}

/// What a model without materials is made of: a warm light plaster with a small highlight.
fn plaster() -> Material {
    Material {
        color: Rgb::new(0.80, 0.77, 0.72).into(),
        specular: Rgb::grey(0.006),
        shininess: 40.0,
        ..Material::named("plaster")
    }
}

/// Gives parts that have colours of their own and no material a white plaster: the warm one would tint them.
fn paint(model: &mut Model) {
    let white = model.materials.len();
    let parts = model.parts.iter_mut().filter(|part| part.material.is_none());
    let painted = parts.filter(|part| !part.mesh.data().colors.is_empty());
    if painted.map(|part| part.material = Some(white)).count() > 0 {
        let name = "painted plaster".to_owned();
        model.materials.push(Material { name, color: Rgb::WHITE.into(), ..plaster() });
    }
}

fn ground_material() -> Material {
    Material { color: Rgb::new(0.52, 0.54, 0.58).into(), ..Material::named("ground") }
}

/// The camera nearest to a model, given by its box, from which all of the box is in a picture of these settings.
pub fn framing_camera(bounds: Bounds, settings: &Settings) -> Camera {
    let center = bounds.center();
    let corners = bounds.corners().map(|corner| corner - center);
    frame(center, &corners, diagonal_of(bounds), settings)
}

/// The camera nearest to a model, given by its box, from which all of the box stays in a picture of these settings
/// while it turns about the vertical line through its middle. The camera looks at a point of that line.
pub fn turning_camera(bounds: Bounds, settings: &Settings) -> Camera {
    let center = bounds.center();
    let half = 0.5 * (bounds.max - bounds.min);
    // Corners go round on two circles; these points lie around them, as many to the left as to the right.
    let front = TOWARD_CAMERA.with_y(0.0).normalize();
    let side = DVec3::Y.cross(front);
    let step = PI / f64::from(AROUND_HALF);
    let radius = half.with_y(0.0).length() / portable::sin_cos(0.5 * step).1;
    let around = (0..2 * AROUND_HALF).flat_map(|i| {
        let (sin, cos) = portable::sin_cos(step * f64::from(i));
        let beside = (front * cos + side * sin) * radius;
        [beside + DVec3::Y * half.y, beside - DVec3::Y * half.y]
    });
    let camera = frame(center, &around.collect::<Vec<_>>(), diagonal_of(bounds), settings);
    // The target is moved along the line of sight, onto the axis.
    let sight = camera.target - camera.eye;
    let (to_axis, sight_across) = ((center - camera.target).with_y(0.0), sight.with_y(0.0));
    let along = to_axis.dot(sight_across) / sight_across.length_squared();
    Camera { target: camera.target + sight * along, ..camera }
}

/// Half of the points around a turning model; more would bring the camera a little nearer.
const AROUND_HALF: u32 = 16;

/// Takes the ground away that [`scene_of_model`] puts under a model.
pub fn hide_ground(scene: &mut Scene) {
    let is_ground = |id: &NodeId| scene.node(*id).name == GROUND;
    if let Some(ground) = scene.roots().iter().copied().find(is_ground) {
        scene.node_mut(ground).hidden = true;
    }
}

/// What the ground is called.
const GROUND: &str = "ground";

/// A model without size is taken for one of size 1.
fn diagonal_of(bounds: Bounds) -> f64 {
    if bounds.diagonal() > 0.0 { bounds.diagonal() } else { 1.0 }
}

/// The camera nearest to some points, given as seen from `center`, from which all are in the picture.
///
/// Across the picture, a point at x to the right and z toward the camera is inside where
/// |x - eye_x| <= t (eye_z - z), with t the tangent of half the angle of view. The points' greatest x + t z
/// and -x + t z thus bound the eye, and the same holds up the picture.
fn frame(center: DVec3, points: &[DVec3], diagonal: f64, settings: &Settings) -> Camera {
    let toward = Camera { eye: TOWARD_CAMERA, target: DVec3::ZERO, fov: FIELD_OF_VIEW, ..Camera::default() };
    let [right, up, backward] = toward.frame().expect("the direction is neither zero nor up");
    let vertical = portable::tan(0.5 * FIELD_OF_VIEW.to_radians()) / MARGIN;
    let horizontal = vertical * f64::from(settings.width) / f64::from(settings.height);

    let reach = |axis: DVec3, tangent: f64| {
        let reaches = points.iter().map(|point| point.dot(axis) + tangent * point.dot(backward));
        reaches.fold(f64::NEG_INFINITY, f64::max)
    };
    let fit = |axis: DVec3, tangent: f64| {
        let (plus, minus) = (reach(axis, tangent), reach(-axis, tangent));
        ((plus + minus) / (2.0 * tangent), 0.5 * (plus - minus))
    };
    let (distance_across, x) = fit(right, horizontal);
    let (distance_up, y) = fit(up, vertical);
    let target = center + right * x + up * y;
    // A model without size would have the eye in it, and so would one that is nothing beside its distance from the
    // origin: eye and target would be rounded to one point.
    let least = (0.5 * diagonal).max(LEAST_DISTANCE * target.abs().max_element());
    let distance = distance_across.max(distance_up).max(least);
    Camera { eye: target + backward * distance, target, ..toward }
}

/// How far the eye is from what it looks at, at least, for each unit that it is from the origin: far enough for a
/// direction that is exact to 1e-4, and so near that only models that are no more than rounding are seen from afar.
const LEAST_DISTANCE: f64 = 1e-12;

fn lights(center: DVec3, diagonal: f64, camera: &Camera) -> Vec<Light> {
    // A model beyond all numbers has no camera; it is refused as soon as it is to be drawn.
    let [right, up, backward] = camera.frame().unwrap_or(DVec3::AXES);
    let distance = LIGHT_DISTANCE * diagonal;
    let light = |lamp: &Lamp| {
        let direction = (right * lamp.from.x + up * lamp.from.y + backward * lamp.from.z).normalize();
        Light {
            name: lamp.name.to_owned(),
            position: center + direction * distance,
            // The light at distance r is L / (pi r^2).
            intensity: lamp.radiance * (PI * distance * distance),
        }
    };
    LAMPS.iter().map(light).collect()
}
