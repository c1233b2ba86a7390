//! A room at night: two mirrors that face each other, and glass on a polished table between them.
//!
//! What is the same is said once: the four walls share one subtree, and so do the two mirrors and the three
//! lampshades.

use crate::BuiltinScene;
use crate::parts::{Finish, at, clear, lathe, matte, mirror};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec2, DVec3, Transform};
use lancer_core::mesh::Mesh;
use lancer_core::scene::{
    AmbientOcclusion, Light, Material, MaterialId, Node, Scene, Settings, Shape, Texture,
};
use std::f64::consts::PI;

/// Mirrors, glass and lamps.
pub(crate) struct MirrorRoom;

impl BuiltinScene for MirrorRoom {
    fn name(&self) -> &'static str {
        "mirror-room"
    }

    fn summary(&self) -> &'static str {
        "A lamplit room between two mirrors, with glass on the table"
    }

    fn build(&self) -> Scene {
        let mut scene = Scene::new("mirror-room");
        scene.camera = Camera {
            eye: DVec3::new(1.0, 1.5, 1.95),
            target: DVec3::new(0.02, 1.17, -0.6),
            fov: 50.0,
            ..Camera::default()
        };
        let table = Camera {
            eye: DVec3::new(0.5, 1.15, 0.75),
            target: DVec3::new(-0.05, 0.95, -0.55),
            fov: 40.0,
            ..Camera::default()
        };
        scene.cameras = vec![("table".into(), table)];
        scene.ambient = Rgb::new(0.17, 0.15, 0.14);
        scene.settings = Settings {
            samples: 2,
            depth: 8,
            ao: AmbientOcclusion { samples: 16, distance: 0.8 },
            ..Settings::default()
        };
        build_room(&mut scene);
        hang_mirrors(&mut scene);
        light_lamps(&mut scene);
        lay_table(&mut scene);
        scene
    }
}

/// Half of the room's width along x and of its length along z, and its height.
const HALF_WIDTH: f64 = 2.6;
const HALF_LENGTH: f64 = 3.0;
const HEIGHT: f64 = 2.8;
/// The bulb of the lamp above the table.
const PENDANT: DVec3 = DVec3::new(-0.1, 2.12, -0.6);

fn build_room(scene: &mut Scene) {
    let floor = scene.add_material(polished(
        "floor tiles",
        Texture::Checker { even: Rgb::from_srgb_hex(0xd9cbb0), odd: Rgb::from_srgb_hex(0x3a2c24), size: 0.5 },
    ));
    let plaster = scene.add_material(matte("plaster", Rgb::from_srgb_hex(0xe6ddcc)));
    let paper = scene.add_material(matte("wallpaper", Rgb::from_srgb_hex(0x2f6156)));
    let panel = scene.add_material(matte("panelling", Rgb::from_srgb_hex(0xcfc0a0)));

    scene.add(Node::shape("floor", Shape::Plane).with_material(floor));
    let overhead = Transform::rotate(DVec3::X, 180.0).then(at(0.0, HEIGHT, 0.0));
    scene.add(Node::shape("ceiling", Shape::Plane).with_material(plaster).with_transform(overhead));

    // A wall faces +z.
    let upright = Transform::rotate(DVec3::X, 90.0);
    let parts = [
        Node::shape("wall", Shape::Plane).with_material(paper).with_transform(upright),
        block("panelling", panel, [4.0, 0.4, 0.02], [0.0, 0.4, 0.0]),
        block("rail", panel, [4.0, 0.025, 0.05], [0.0, 0.82, 0.0]),
        block("skirting", panel, [4.0, 0.07, 0.04], [0.0, 0.07, 0.0]),
        block("cornice", plaster, [4.0, 0.06, 0.06], [0.0, HEIGHT - 0.06, 0.0]),
    ];
    let parts = parts.map(|part| scene.insert(part));
    for (name, degrees, distance) in [
        ("back wall", 0.0, HALF_LENGTH),
        ("left wall", 90.0, HALF_WIDTH),
        ("front wall", 180.0, HALF_LENGTH),
        ("right wall", 270.0, HALF_WIDTH),
    ] {
        let place = at(0.0, 0.0, -distance).then(Transform::rotate(DVec3::Y, degrees));
        scene.add(Node::group(name, parts).with_transform(place));
    }
}

/// Two mirrors on opposite walls, so that each shows the other.
fn hang_mirrors(scene: &mut Scene) {
    let silver = scene.add_material(mirror("silvered glass", Rgb::new(0.93, 0.95, 0.93)));
    let gilt = scene.add_material(metal("gilt", 0xc8963c));
    let ebony = scene.add_material(matte("ebony", Rgb::from_srgb_hex(0x2a1c16)));

    let (width, height) = (1.15, 0.72);
    let mut parts = vec![scene.insert(block("pane", silver, [width, height, 0.01], [0.0; 3]))];
    for (name, material, inset, half, depth) in [
        ("bead", gilt, 0.0, 0.025, 0.035),
        ("moulding", ebony, 0.05, 0.06, 0.055),
        ("edge", gilt, 0.12, 0.02, 0.045),
    ] {
        let (x, y) = (width + inset, height + inset);
        for side in [-1.0, 1.0] {
            let across = block(name, material, [x + half, half, depth], [0.0, side * y, 0.0]);
            let along = block(name, material, [half, y - half, depth], [side * x, 0.0, 0.0]);
            parts.extend([across, along].map(|node| scene.insert(node)));
        }
    }
    let hung = at(0.0, 1.68, -HALF_LENGTH + 0.01);
    scene.add(Node::group("back mirror", parts.clone()).with_transform(hung));
    let opposite = hung.then(Transform::rotate(DVec3::Y, 180.0));
    scene.add(Node::group("front mirror", parts).with_transform(opposite));
}

/// A lamp above the table and one on each side of the back mirror, and what little comes from elsewhere.
fn light_lamps(scene: &mut Scene) {
    let parchment = scene.add_material(Material {
        // A shade glows. The model has no emission, but an ambient coefficient may be as large as one likes;
        // what the bulb, so near, would add by the diffuse one is left out.
        ambient: Rgb::new(6.0, 5.0, 3.4),
        diffuse: Rgb::grey(0.01),
        ..matte("parchment", Rgb::from_srgb_hex(0xf6dfb4))
    });
    let brass = scene.add_material(metal("brass", 0xb08d4a));
    let shade = [
        Node::shape("shade", Shape::Cylinder { capped: false }).with_material(parchment),
        rim("lower rim", brass, -1.0),
        rim("upper rim", brass, 1.0),
    ];
    let shade = shade.map(|part| scene.insert(part));

    let warm = Rgb::new(1.0, 0.74, 0.45);
    for (name, position, [radius, half_height], at_distance_1) in [
        ("pendant", PENDANT, [0.34, 0.12], 4.5),
        ("left sconce", DVec3::new(-1.75, 1.75, 0.2 - HALF_LENGTH), [0.12, 0.17], 0.6),
        ("right sconce", DVec3::new(1.75, 1.75, 0.2 - HALF_LENGTH), [0.12, 0.17], 0.6),
    ] {
        let place =
            Transform::scale(DVec3::new(radius, half_height, radius)).then(Transform::translate(position));
        scene.add(Node::group(name, shade).with_transform(place));
        scene.lights.push(Light { name: name.into(), position, intensity: warm * (PI * at_distance_1) });
    }
    // The lid keeps the bulb from burning a spot into the ceiling.
    let lid = Transform::scale(DVec3::new(0.34, 0.005, 0.34)).then(at(0.0, 0.11, 0.0));
    let cord = Transform::scale(DVec3::new(0.012, 0.5, 0.012)).then(at(0.0, 0.6, 0.0));
    for (name, place) in [("lid", lid), ("cord", cord)] {
        let place = place.then(Transform::translate(PENDANT));
        let node = Node::shape(name, Shape::Cylinder { capped: true }).with_material(brass);
        scene.add(node.with_transform(place));
    }
    let fill = DVec3::new(1.9, 2.4, 2.2);
    scene.lights.push(Light {
        name: "fill".into(),
        position: fill,
        intensity: Rgb::new(1.0, 0.95, 0.9) * (PI * 2.6),
    });
}

fn rim(name: &str, material: MaterialId, y: f64) -> Node {
    let thin = Transform::scale(DVec3::new(1.02, 0.05, 1.02)).then(at(0.0, y, 0.0));
    Node::shape(name, Shape::Cylinder { capped: false }).with_material(material).with_transform(thin)
}

const TABLE_HEIGHT: f64 = 0.76;

/// The table and what stands on it, in a space whose y = 0 is the table's top.
fn lay_table(scene: &mut Scene) {
    let walnut = scene.add_material(polished("walnut", Rgb::from_srgb_hex(0x5a331e)));
    let crystal = scene.add_material(clear("crystal", 1.5, Rgb::WHITE));
    let green = scene.add_material(clear("green glass", 1.5, Rgb::new(0.55, 0.90, 0.68)));
    let silver = scene.add_material(mirror("silver", Rgb::new(0.95, 0.90, 0.82)));

    let top = Transform::scale(DVec3::new(0.8, 0.025, 0.8)).then(at(0.0, -0.025, 0.0));
    let floor = at(0.0, -TABLE_HEIGHT, 0.0);
    let table = [
        Node::shape("top", Shape::Cylinder { capped: true }).with_material(walnut).with_transform(top),
        Node::mesh("leg", turned(&LEG)).with_material(walnut).with_transform(floor),
        Node::mesh("vase", turned(&VASE)).with_material(green).with_transform(at(-0.28, 0.0, -0.1)),
        Node::mesh("goblet", turned(&GOBLET)).with_material(crystal).with_transform(at(0.36, 0.0, -0.18)),
        ball("glass ball", crystal, 0.14, [0.14, 0.24]),
        ball("silver ball", silver, 0.17, [0.04, -0.36]),
    ];
    let table = table.map(|part| scene.insert(part));
    scene.add(Node::group("table", table).with_transform(at(-0.1, TABLE_HEIGHT, -0.6)));
}

/// The sections of what is turned, as (radius, height). They run upward along the outside.
const LEG: [[f64; 2]; 8] = [
    [0.0, 0.02],
    [0.34, 0.0],
    [0.32, 0.02],
    [0.08, 0.10],
    [0.05, 0.30],
    [0.09, 0.48],
    [0.06, 0.60],
    [0.0, 0.73],
];
/// Glass has a thickness: its section goes over the lip and comes back down along the inside.
const VASE: [[f64; 2]; 16] = [
    [0.0, 0.012],
    [0.06, 0.01],
    [0.085, 0.0],
    [0.10, 0.012],
    [0.106, 0.03],
    [0.145, 0.16],
    [0.13, 0.30],
    [0.062, 0.42],
    [0.085, 0.52],
    [0.08, 0.524],
    [0.074, 0.52],
    [0.05, 0.42],
    [0.118, 0.30],
    [0.133, 0.16],
    [0.085, 0.035],
    [0.0, 0.03],
];
const GOBLET: [[f64; 2]; 15] = [
    [0.0, 0.004],
    [0.07, 0.0],
    [0.082, 0.004],
    [0.06, 0.012],
    [0.012, 0.03],
    [0.010, 0.11],
    [0.03, 0.145],
    [0.085, 0.20],
    [0.092, 0.26],
    [0.078, 0.33],
    [0.0755, 0.332],
    [0.073, 0.33],
    [0.087, 0.26],
    [0.08, 0.205],
    [0.0, 0.155],
];

/// Segments of a turned mesh: around the axis, and along its section from point to point.
const AROUND: u32 = 96;
const BETWEEN: u32 = 8;

/// The surface that the smooth curve through `section` sweeps about the y axis, on which both its ends lie.
fn turned(section: &[[f64; 2]]) -> Mesh {
    lathe(&smooth(section), AROUND, Finish::Polished)
}

/// Points of a curve through `section`.
///
/// Source: Catmull, Rom, "A class of local interpolating splines" (1974). Beyond each end stands the mirror
/// image of the point before it, so that the curve meets the axis at a right angle.
fn smooth(section: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mirrored = |[radius, y]: [f64; 2]| [-radius, y];
    let mut points = vec![mirrored(section[1])];
    points.extend(section);
    points.push(mirrored(section[section.len() - 2]));
    let points = points.into_iter().map(DVec2::from_array).collect::<Vec<_>>();

    let mut curve = Vec::new();
    for p in points.windows(4) {
        let linear = (p[2] - p[0]) * 0.5;
        let square = p[0] - p[1] * 2.5 + p[2] * 2.0 - p[3] * 0.5;
        let cube = (p[1] - p[2]) * 1.5 + (p[3] - p[0]) * 0.5;
        curve.extend((0..BETWEEN).map(|i| {
            let t = f64::from(i) / f64::from(BETWEEN);
            (p[1] + (linear + (square + cube * t) * t) * t).to_array()
        }));
    }
    curve.extend(section.last());
    curve
}

/// A box of half the edges `half` around `center`.
fn block(name: &str, material: MaterialId, half: [f64; 3], center: [f64; 3]) -> Node {
    let place =
        Transform::scale(DVec3::from_array(half)).then(Transform::translate(DVec3::from_array(center)));
    Node::shape(name, Shape::Cube).with_material(material).with_transform(place)
}

/// A ball that lies on y = 0 at (x, z).
fn ball(name: &str, material: MaterialId, radius: f64, [x, z]: [f64; 2]) -> Node {
    let place = Transform::scale(DVec3::splat(radius)).then(at(x, radius, z));
    Node::shape(name, Shape::Sphere).with_material(material).with_transform(place)
}

/// A colour under clear lacquer.
fn polished(name: &str, color: impl Into<Texture>) -> Material {
    Material {
        color: color.into(),
        specular: Rgb::grey(0.002),
        shininess: 400.0,
        reflect: Rgb::WHITE,
        fresnel: true,
        ..Material::named(name)
    }
}

/// Metal that is too rough to mirror.
fn metal(name: &str, rrggbb: u32) -> Material {
    Material {
        diffuse: Rgb::grey(0.6),
        specular: Rgb::grey(0.3),
        metallic: Rgb::WHITE,
        shininess: 30.0,
        ..matte(name, Rgb::from_srgb_hex(rrggbb))
    }
}
