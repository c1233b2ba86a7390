//! An autumn valley of ten thousand trees.
//!
//! There are two small meshes of leaves. A tree is a group that uses them, and that many nodes share: it
//! leaves the colour of its crown to the node that plants it. So over twenty million triangles are drawn
//! out of two thousand.

use crate::BuiltinScene;
use crate::parts::{at, lamp};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform, portable};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::sampling::{Key, Stream};
use lancer_core::scene::{Material, MaterialId, Node, NodeId, Scene, Settings, Shape};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Shared subtrees, ten thousand times.
pub(crate) struct TenThousand;

impl BuiltinScene for TenThousand {
    fn name(&self) -> &'static str {
        "ten-thousand"
    }

    fn summary(&self) -> &'static str {
        "An autumn valley of ten thousand trees of four kinds, in shared subtrees"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("ten-thousand");
        scene.camera = Camera {
            eye: DVec3::new(5.0, 10.5, 30.0),
            target: DVec3::new(-1.0, 3.6, -60.0),
            fov: 40.0,
            ..Camera::default()
        };
        let hilltop = Camera {
            eye: DVec3::new(40.0, 44.0, 45.0),
            target: DVec3::new(-6.0, 8.0, -90.0),
            ..scene.camera
        };
        scene.cameras = vec![("hilltop".into(), hilltop)];
        scene.background = Rgb::from_srgb_hex(0xa9cdec);
        scene.ambient = scene.background;
        scene.lights = vec![
            lamp("sun", DVec3::new(-560.0, 480.0, 600.0), DVec3::ZERO, Rgb::new(1.75, 1.3, 0.82)),
            lamp("sky", DVec3::new(300.0, 900.0, -200.0), DVec3::ZERO, Rgb::new(0.10, 0.15, 0.24)),
        ];
        scene.settings = Settings { samples: 3, depth: 2, ..Settings::default() };

        let water = scene.add_material(Material {
            color: Rgb::from_srgb_hex(0x1d3a4a).into(),
            diffuse: Rgb::grey(0.15),
            reflect: Rgb::WHITE,
            ior: 1.33,
            fresnel: true,
            ..Material::named("water")
        });
        scene.add(Node::shape("river", Shape::Plane).with_material(water));
        let tufts = Tufts::grow();
        let strips = (0..STRIPS).map(|strip| Strip::lay(&mut scene, strip, &tufts)).collect::<Vec<_>>();
        plant(&mut scene, &strips);
        scene
    }
}

const TREES: u32 = 10_000;

/// The valley is cut across into strips, each seen through air of one thickness.
const STRIPS: u32 = 40;
/// How long a strip is, in world units; much longer, and the ground shows steps of haze.
const STRIP_LENGTH: f64 = 12.5;
/// Where the nearest strip begins, behind the camera.
const NEAR_END: f64 = 50.0;
/// How far the ground reaches to both sides.
const HALF_WIDTH: f64 = 350.0;
/// The edge of a square of the ground's mesh; divides the two lengths above.
const GROUND_STEP: f64 = 6.25;
/// The lowest ground above the river on which trees grow.
const SHORE: f64 = 0.4;
/// The share of the sky's colour that lights a shadow; less, and shadows are black holes; more, and they are
/// none.
const SKYLIGHT: f64 = 0.4;
/// The distance on which haze takes half of what is seen.
const HAZE_HALF_LIFE: f64 = 300.0;

/// A tree of height 1, standing on the origin.
struct Kind {
    name: &'static str,
    /// The height of a grown one, in world units.
    height: f64,
    bark: u32,
    /// The colours that its crown comes in.
    leaves: &'static [u32],
    crown: &'static [Crown],
}

/// A part of a tree's crown: a tuft of leaves, stretched and then lifted.
struct Crown {
    tuft: fn(&Tufts) -> &Arc<Mesh>,
    stretch: DVec3,
    center: DVec3,
}

const KINDS: [Kind; 4] = [
    Kind {
        name: "oak",
        height: 10.0,
        bark: 0x4a3a2c,
        leaves: &[0xb5431c, 0xd2691e, 0x8f2f1a, 0xc98a1b, 0x75702a],
        crown: &[
            round([0.30, 0.27, 0.30], [0.0, 0.70, 0.0]),
            round([0.24, 0.20, 0.24], [0.22, 0.52, 0.06]),
            round([0.23, 0.19, 0.23], [-0.16, 0.50, 0.16]),
            round([0.22, 0.18, 0.22], [-0.06, 0.55, -0.22]),
        ],
    },
    Kind {
        name: "birch",
        height: 9.5,
        bark: 0xe4ded0,
        leaves: &[0xf0b323, 0xe3c23b, 0xd99a1c],
        crown: &[
            round([0.17, 0.24, 0.17], [0.02, 0.74, 0.0]),
            round([0.18, 0.20, 0.18], [-0.05, 0.50, 0.04]),
        ],
    },
    Kind {
        name: "poplar",
        height: 11.0,
        bark: 0x5a5040,
        leaves: &[0xb9a52e, 0xe0a526],
        crown: &[round([0.12, 0.44, 0.12], [0.0, 0.56, 0.0])],
    },
    Kind {
        name: "fir",
        height: 10.5,
        bark: 0x3d2f26,
        leaves: &[0x2c4a2a, 0x36552f, 0x24402c],
        crown: &[Crown {
            tuft: |tufts| &tufts.tiered,
            stretch: DVec3::new(1.0, 0.9, 1.0),
            center: DVec3::new(0.0, 0.1, 0.0),
        }],
    },
];

const fn round(stretch: [f64; 3], center: [f64; 3]) -> Crown {
    Crown {
        tuft: |tufts| &tufts.round,
        stretch: DVec3::from_array(stretch),
        center: DVec3::from_array(center),
    }
}

/// The meshes that all crowns are made of.
struct Tufts {
    /// Around the unit sphere.
    round: Arc<Mesh>,
    /// Around a cone of height 1 on the origin, in tiers like a fir's.
    tiered: Arc<Mesh>,
}

impl Tufts {
    fn grow() -> Self {
        let sphere = |stream: &mut Stream| {
            let y = between(stream, -1.0, 1.0);
            (y, (1.0 - y * y).sqrt())
        };
        let fir = |stream: &mut Stream| {
            // The square root spreads the leaves evenly over the cone, which is wide at its foot.
            let y = 1.0 - stream.next_unit().sqrt();
            (y, (0.01 + 0.25 * (1.0 - y)) * (1.0 - 0.5 * (7.0 * y).fract()))
        };
        let mut stream = Key::camera(0, 0, 0).stream();
        Self {
            round: leaves(1_200, 0.115, DVec3::ZERO, sphere, &mut stream),
            tiered: leaves(1_100, 0.045, DVec3::Y * 0.2, fir, &mut stream),
        }
    }
}

/// Leaves about the surface of revolution on which `outline` picks a height and the radius there; they face
/// away from `heart`, each a little askew.
fn leaves(
    count: u32,
    size: f64,
    heart: DVec3,
    outline: impl Fn(&mut Stream) -> (f64, f64),
    stream: &mut Stream,
) -> Arc<Mesh> {
    let mut data = MeshData::default();
    for leaf in 0..count {
        let (y, radius) = outline(stream);
        let (sin, cos) = portable::sin_cos(TAU * stream.next_unit());
        let radius = radius * between(stream, 0.75, 1.05);
        let place = DVec3::new(radius * sin, y, radius * cos);
        let askew = DVec3::from_array([(); 3].map(|()| between(stream, -0.7, 0.7)));
        let normal = ((place - heart).normalize() + askew).normalize();
        let along = normal.cross(askew).normalize() * size;
        let across = normal.cross(along);
        let corners = [along, across * 0.8 - along * 0.5, across * -0.8 - along * 0.5];
        data.positions.extend(corners.map(|corner| (place + corner).as_vec3().to_array()));
        data.indices.push([0, 1, 2].map(|corner| 3 * leaf + corner));
    }
    Arc::new(Mesh::new(data).expect("leaves are finite, and each has three corners of its own"))
}

/// The trees that grow in one strip of the valley: the same as in all others, but for the air before them.
struct Strip {
    species: Vec<Species>,
}

struct Species {
    tree: NodeId,
    foliage: Vec<MaterialId>,
}

impl Strip {
    /// Lays the strip's ground, and readies its trees.
    fn lay(scene: &mut Scene, strip: u32, tufts: &Tufts) -> Self {
        let near = NEAR_END - STRIP_LENGTH * f64::from(strip);
        let haze = 1.0 - portable::exp2((near - NEAR_END) / HAZE_HALF_LIFE);
        let paint = |scene: &mut Scene, name: &str, rrggbb: u32| {
            let name = format!("{name} of strip {strip}");
            scene.add_material(hazy(name, Rgb::from_srgb_hex(rrggbb), haze))
        };
        let grass = paint(scene, "grass", 0x9a8a3c);
        let land = Node::mesh(format!("ground of strip {strip}"), ground_mesh(near - STRIP_LENGTH));
        scene.add(land.with_material(grass));
        let species = KINDS.iter().map(|kind| {
            let bark = paint(scene, &format!("{} bark", kind.name), kind.bark);
            let leaves = format!("{} leaves", kind.name);
            let foliage = kind.leaves.iter().map(|&rrggbb| paint(scene, &leaves, rrggbb)).collect();
            Species { tree: kind.grow(scene, bark, tufts), foliage }
        });
        Self { species: species.collect() }
    }
}

impl Kind {
    /// The tree's shared subtree, whose crown has no material yet.
    fn grow(&self, scene: &mut Scene, bark: MaterialId, tufts: &Tufts) -> NodeId {
        let upright =
            Transform::scale(DVec3::new(0.022, 0.3, 0.022)).then(Transform::translate(DVec3::Y * 0.25));
        let trunk = Node::shape("trunk", Shape::Cylinder { capped: false });
        let mut parts = vec![scene.insert(trunk.with_material(bark).with_transform(upright))];
        for crown in self.crown {
            let place = Transform::scale(crown.stretch).then(Transform::translate(crown.center));
            let node = Node::mesh("crown", Arc::clone((crown.tuft)(tufts)));
            parts.push(scene.insert(node.with_transform(place)));
        }
        scene.insert(Node::group(self.name, parts))
    }
}

/// A matte material as it looks through air that hides the share `haze` of it.
///
/// The model knows no air. But the ambient term is the same from everywhere, so it can carry what air adds,
/// where the scene's ambient light has the colour of that air. No channel of `color`, by which the term is
/// multiplied, may be 0.
fn hazy(name: String, color: Rgb, haze: f64) -> Material {
    let clear = 1.0 - haze;
    Material {
        color: color.into(),
        diffuse: Rgb::grey(clear),
        ambient: color.map(|channel| SKYLIGHT * clear + haze / channel),
        ..Material::named(name)
    }
}

/// How high the ground lies above the river.
fn ground(x: f64, z: f64) -> f64 {
    let from_river = x - 22.0 * sin(z / 42.0) + 8.0 * sin(z / 23.0);
    let valley = from_river * from_river / (from_river * from_river + 5_000.0);
    let rolling = 4.0 * sin(x / 23.0 + z / 41.0) + 3.0 * sin(z / 19.0 - x / 37.0);
    let far_hills = ((-z - 200.0) / 250.0).max(0.0);
    (44.0 + rolling) * valley - 1.0 + 45.0 * far_hills * far_hills
}

/// The ground of the strip that reaches from `far` one strip's length toward the camera.
fn ground_mesh(far: f64) -> Mesh {
    let columns = (2.0 * HALF_WIDTH / GROUND_STEP) as u32 + 1;
    let rows = (STRIP_LENGTH / GROUND_STEP) as u32 + 1;
    let mut data = MeshData::default();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let x = GROUND_STEP * f64::from(column) - HALF_WIDTH;
        let z = GROUND_STEP * f64::from(row) + far;
        let slope = |dx, dz| ground(x + dx, z + dz) - ground(x - dx, z - dz);
        data.positions.push([x, ground(x, z), z].map(|x| x as f32));
        data.normals.push([-slope(0.5, 0.0), 1.0, -slope(0.0, 0.5)].map(|x| x as f32));
        if row + 1 < rows && column + 1 < columns {
            let here = row * columns + column;
            let nearer = here + columns;
            data.indices.extend([[here, nearer, nearer + 1], [here, nearer + 1, here + 1]]);
        }
    }
    Mesh::new(data).expect("a grid of two rows and columns or more is a mesh")
}

/// Plants all trees at random where the camera sees them and the ground is dry.
fn plant(scene: &mut Scene, strips: &[Strip]) {
    let mut stream = Key::camera(0, 0, 1).stream();
    let length = STRIP_LENGTH * f64::from(STRIPS);
    let mut planted = 0;
    while planted < TREES {
        let distance = between(&mut stream, 0.0, length);
        let x = between(&mut stream, -HALF_WIDTH, HALF_WIDTH);
        let z = NEAR_END - distance;
        let y = ground(x, z);
        if y < SHORE || x.abs() > 45.0 + 0.6 * distance {
            continue;
        }
        let kind = pick(&mut stream, KINDS.len());
        let species = &strips[(distance / STRIP_LENGTH) as usize].species[kind];
        let leaves = species.foliage[pick(&mut stream, species.foliage.len())];
        let height = KINDS[kind].height * between(&mut stream, 0.6, 1.2);
        let width = height * between(&mut stream, 0.85, 1.15);
        let place = Transform::scale(DVec3::new(width, height, width))
            .then(Transform::rotate(DVec3::Y, between(&mut stream, 0.0, 360.0)))
            .then(at(x, y, z));
        let name = format!("{} {planted}", KINDS[kind].name);
        scene.add(Node::group(name, [species.tree]).with_material(leaves).with_transform(place));
        planted += 1;
    }
}

fn sin(radians: f64) -> f64 {
    portable::sin_cos(radians).0
}

fn between(stream: &mut Stream, low: f64, high: f64) -> f64 {
    low + (high - low) * stream.next_unit()
}

fn pick(stream: &mut Stream, len: usize) -> usize {
    (stream.next_unit() * len as f64) as usize
}
