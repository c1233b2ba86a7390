//! A bare model made into a scene that shows it well.
//!
//! In: a model of any size, anywhere. Out: a scene with a camera that frames it, three lights, a ground and
//! ambient occlusion, all in proportion to the model. The model is taken to stand on -Y and to face +Z.

use crate::model::Model;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
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

/// The scene that shows a model.
pub fn scene_of_model(model: Model) -> Scene {
    let bounds = model.bounds();
    let diagonal = diagonal_of(bounds);
    let mut scene = Scene::new(model.name.clone());
    scene.settings = settings(diagonal);
    scene.camera = framing_camera(bounds, &scene.settings);
    scene.ambient = AMBIENT;
    scene.background = Rgb::from_srgb_hex(0xc3_cdd9);
    scene.lights = lights(bounds.center(), diagonal, &scene.camera);

    let plaster = scene.add_material(plaster());
    let ground = scene.add_material(ground_material());
    let height = bounds.min.y - GROUND_GAP * diagonal;
    let at = DVec3::new(bounds.center().x, height, bounds.center().z);
    let ground = Node::shape(GROUND, Shape::Plane).with_material(ground);
    scene.add(ground.with_transform(Transform::translate(at)));
    let model = model.insert_into(&mut scene).with_material(plaster);
    scene.add(model);
    scene
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
    // A model without size would have the eye in it.
    let distance = distance_across.max(distance_up).max(0.5 * diagonal);
    let target = center + right * x + up * y;
    Camera { eye: target + backward * distance, target, ..toward }
}

fn lights(center: DVec3, diagonal: f64, camera: &Camera) -> Vec<Light> {
    let [right, up, backward] = camera.frame().expect("the camera was made to be valid");
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
