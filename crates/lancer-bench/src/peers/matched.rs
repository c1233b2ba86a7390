//! The matched Whitted scene: a bunny, a glass ball and a mirror ball, and what it becomes for renderers without
//! refraction or with ambient occlusion.

use super::scene::Picture;
use crate::Failure;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{AmbientOcclusion, Material, Node, Scene, Settings, Shape};
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The matched Whitted scene: a bunny between a glass ball and a mirror ball on endless ground, under two lights.
///
/// Lambert's law alone, since highlights are where renderers differ most. The sky is as bright as the ambient
/// light, as it is for a path tracer.
pub(super) fn whitted(bunny: &Arc<Mesh>) -> Scene {
    let mut scene = Scene::new("bunny");
    scene.camera = Camera {
        eye: DVec3::new(0.0, 2.6, 7.0),
        target: DVec3::new(0.0, 0.85, 0.0),
        fov: 36.0,
        ..Camera::default()
    };
    scene.ambient = Rgb::grey(0.3);
    scene.background = Rgb::new(0.24, 0.3, 0.36);
    scene.settings = Settings { width: 800, height: 600, samples: 3, depth: 5, ..Settings::default() };
    scene.add_light(DVec3::new(-4.0, 6.0, 5.0), Rgb::new(1.0, 0.94, 0.86) * 130.0);
    scene.add_light(DVec3::new(5.0, 5.0, 3.0), Rgb::new(0.8, 0.9, 1.0) * 55.0);
    let matte =
        |name: &str, hex: u32| Material { color: Rgb::from_srgb_hex(hex).into(), ..Material::named(name) };
    let ground = scene.add_material(matte("ground", 0xb4aa98));
    let fur = scene.add_material(matte("fur", 0xc8905c));
    let clear = Material { ambient: Rgb::BLACK, diffuse: Rgb::BLACK, ..Material::named("mirror") };
    let mirror = scene.add_material(Material { reflect: Rgb::grey(0.9), ..clear.clone() });
    let glass = Material { name: "glass".into(), reflect: Rgb::WHITE, transmit: Rgb::WHITE, ..clear };
    let glass = scene.add_material(Material { ior: 1.5, fresnel: true, ..glass });

    scene.add(Node::shape("ground", Shape::Plane).with_material(ground));
    let bounds = bunny.bounds();
    let size = bounds.max - bounds.min;
    let foot = DVec3::new(bounds.center().x, bounds.min.y, bounds.center().z);
    let stand = Transform::translate(-foot).then(Transform::scale(DVec3::splat(2.0 / size.y)));
    scene.add(Node::mesh("bunny", Arc::clone(bunny)).with_material(fur).with_transform(stand));
    let mut ball = |name: &str, material, radius: f64, x: f64, z: f64| {
        let place =
            Transform::scale(DVec3::splat(radius)).then(Transform::translate(DVec3::new(x, radius, z)));
        scene.add(Node::shape(name, Shape::Sphere).with_material(material).with_transform(place));
    };
    ball("glass ball", glass, 0.75, 1.55, 1.2);
    ball("mirror ball", mirror, 1.0, -1.9, -0.9);
    scene
}

/// The glass of [`whitted`] for renderers without refraction: a ball that is seen through straight, in fixed parts.
pub(super) fn without_refraction(mut picture: Picture) -> Picture {
    for material in picture.materials.iter_mut().filter(|material| material.fresnel) {
        *material = Material {
            reflect: Rgb::grey(0.15),
            transmit: Rgb::grey(0.85),
            ior: 1.0,
            fresnel: false,
            ..material.clone()
        };
    }
    picture
}

/// With `samples` directions of ambient occlusion above each point's horizon, of any length.
///
/// Lancer counts directions on the whole sphere, of which it traces the half above the horizon.
pub(super) fn with_occlusion(mut picture: Picture, samples: u32) -> Picture {
    /// Beyond everything but the far ground.
    const FAR: f64 = 1e3;
    picture.settings.ao = AmbientOcclusion { samples: 2 * samples, distance: FAR };
    picture
}

/// The bunny of npm's package `bunny`, 3,674 triangles, subdivided twice by Loop's scheme to 58,784.
///
/// # Errors
/// The file cannot be read, or is not what that package holds.
pub(super) fn bunny(index_js: &Path) -> Result<Mesh, Failure> {
    let text = fs::read_to_string(index_js)?;
    let array = |name: &str| -> Result<Value, Failure> {
        let start = text.find(name).ok_or_else(|| format!("{} has no {name}", index_js.display()))?;
        let start = start + text[start..].find('[').ok_or("no array")?;
        let mut values = serde_json::Deserializer::from_str(&text[start..]).into_iter::<Value>();
        Ok(values.next().ok_or("no array")??)
    };
    let mut mesh = MeshData {
        positions: serde_json::from_value(array("exports.positions")?)?,
        indices: serde_json::from_value(array("exports.cells")?)?,
        ..MeshData::default()
    };
    for _ in 0..2 {
        mesh = subdivide(&mesh);
    }
    Ok(Mesh::new(mesh)?)
}

/// One step of Loop's subdivision of a closed or open mesh: four triangles for each.
///
/// Source: Loop, "Smooth Subdivision Surfaces Based on Triangles" (1987), with Warren's simpler vertex weights.
fn subdivide(mesh: &MeshData) -> MeshData {
    let point = |i: u32| DVec3::from(mesh.positions[i as usize].map(f64::from));
    // Of each edge: the corners that face it.
    let mut facing = HashMap::<[u32; 2], Vec<u32>>::new();
    for &[a, b, c] in &mesh.indices {
        for [from, to, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
            facing.entry([from.min(to), from.max(to)]).or_default().push(apex);
        }
    }
    let mut edges = facing.into_iter().collect::<Vec<_>>();
    edges.sort_unstable();

    let count = mesh.positions.len();
    let (mut around, mut valence) = (vec![DVec3::ZERO; count], vec![0_u32; count]);
    let (mut rim, mut on_rim) = (vec![DVec3::ZERO; count], vec![false; count]);
    for ([a, b], apexes) in &edges {
        for [this, other] in [[*a, *b], [*b, *a]] {
            around[this as usize] += point(other);
            valence[this as usize] += 1;
            if apexes.len() != 2 {
                rim[this as usize] += point(other);
                on_rim[this as usize] = true;
            }
        }
    }
    let moved = (0..count).map(|i| {
        let old = point(i as u32);
        match (on_rim[i], valence[i]) {
            (_, 0) => old,
            (true, _) => old * 0.75 + rim[i] * 0.125,
            (false, n) => {
                let weight = if n == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * f64::from(n)) };
                old * (1.0 - f64::from(n) * weight) + around[i] * weight
            }
        }
    });
    let mut positions = moved.collect::<Vec<_>>();
    let mut middles = HashMap::new();
    for ([a, b], apexes) in &edges {
        let ends = point(*a) + point(*b);
        middles.insert([*a, *b], positions.len() as u32);
        positions.push(match apexes[..] {
            [c, d] => ends * 0.375 + (point(c) + point(d)) * 0.125,
            _ => ends * 0.5,
        });
    }
    let middle = |a: u32, b: u32| middles[&[a.min(b), a.max(b)]];
    let indices = mesh.indices.iter().flat_map(|&[a, b, c]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    });
    MeshData {
        positions: positions.iter().map(|point| point.as_vec3().to_array()).collect(),
        indices: indices.collect(),
        ..MeshData::default()
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::tests::octahedron;
    use super::*;

    #[test]
    fn subdivision_makes_four_of_each_triangle_and_rounds_corners_evenly() {
        let mesh = subdivide(&octahedron());
        assert_eq!(mesh.indices.len(), 32);
        assert_eq!(mesh.positions.len(), 6 + 12);
        let radius = |i: usize| DVec3::from(mesh.positions[i].map(f64::from)).length();
        assert!((0..6).all(|i| (radius(i) - 0.625).abs() < 1e-6), "{}", radius(0));
        assert!((6..18).all(|i| (radius(i) - radius(6)).abs() < 1e-6));
    }
}
