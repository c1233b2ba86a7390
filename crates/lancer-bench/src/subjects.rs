//! What is measured: generated meshes of any size, and models from files.

use crate::Failure;
use lancer_core::geometry::portable::sin_cos;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::sampling::Key;
use lancer_core::scene::{Scene, Shape};
use lancer_io::limits::Limits;
use lancer_io::model::{Crease, ModelOptions};
use lancer_io::resolver::Resolver;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

/// A mesh with a name.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) mesh: Arc<Mesh>,
}

/// Files without normals are measured as facets, whatever would look best.
const FACETS: ModelOptions = ModelOptions { crease: Some(Crease::FACETS) };

/// The largest mesh of a model file.
pub(crate) fn from_file(path: &Path) -> Result<Subject, Failure> {
    let resolver = Resolver::for_file(path, true, Limits::default());
    let model = lancer_io::model::load(path, &resolver, &FACETS)?;
    let mut scene = Scene::new("model");
    let node = model.insert_into(&mut scene);
    scene.add(node);
    let meshes = scene.nodes().iter().filter_map(|node| match &node.shape {
        Some(Shape::Mesh(mesh)) => Some(mesh),
        _ => None,
    });
    let mesh = meshes.max_by_key(|mesh| mesh.triangle_count()).ok_or("the model has no mesh")?;
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Ok(Subject { name, mesh: Arc::clone(mesh) })
}

/// All meshes of a model file as one, of flat facets.
pub(crate) fn whole_file(path: &Path) -> Result<Mesh, Failure> {
    let resolver = Resolver::for_file(path, true, Limits::default());
    let model = lancer_io::model::load(path, &resolver, &FACETS)?;
    let mut scene = Scene::new("model");
    let _node = model.insert_into(&mut scene);
    let mut all = MeshData::default();
    for node in scene.nodes() {
        if let Some(Shape::Mesh(mesh)) = &node.shape {
            let first = all.positions.len() as u32;
            all.positions.extend(&mesh.data().positions);
            all.indices.extend(mesh.data().indices.iter().map(|corners| corners.map(|index| first + index)));
        }
    }
    Ok(Mesh::new(all)?)
}

/// The mesh of npm's package `bunny`: a JavaScript module that exports nested arrays, `positions` and `cells`.
pub(crate) fn bunny(module: &str) -> Result<Mesh, Failure> {
    let positions = exported_triples(module, "positions")?;
    let indices = exported_triples(module, "cells")?;
    Ok(Mesh::new(MeshData { positions, indices, ..MeshData::default() })?)
}

/// The triples of numbers in `exports.<name>=[[a,b,c],[...],...]`.
fn exported_triples<T: FromStr>(module: &str, name: &str) -> Result<Vec<[T; 3]>, Failure>
where
    Failure: From<T::Err>,
{
    let start = format!("exports.{name}=[[");
    let after = module.split_once(&start).ok_or_else(|| format!("the module does not export {name}"))?.1;
    let list = after.split_once("]]").ok_or_else(|| format!("the list of {name} does not end"))?.0;
    list.split("],[")
        .map(|triple| {
            let numbers = triple.split(',').map(|word| Ok(word.trim().parse()?));
            let numbers: Vec<T> = numbers.collect::<Result<_, Failure>>()?;
            numbers.try_into().map_err(|_| format!("an entry of {name} is not a triple: {triple}").into())
        })
        .collect()
}

/// A height field with noise at every scale: many triangles, all visible, all alike.
pub(crate) fn terrain(triangles: u32) -> Result<Subject, Failure> {
    let side = f64::from(triangles / 2).sqrt() as u32;
    let mut data = MeshData::default();
    for (z, x) in (0..=side).flat_map(|z| (0..=side).map(move |x| (z, x))) {
        let (u, v) = (f64::from(x) / f64::from(side), f64::from(z) / f64::from(side));
        let height = (0..8).map(|octave| value_noise(u, v, octave) / f64::from(1 << octave)).sum::<f64>();
        data.positions.push([(2.0 * u - 1.0) as f32, (0.2 * height) as f32, (2.0 * v - 1.0) as f32]);
    }
    let row = side + 1;
    for (z, x) in (0..side).flat_map(|z| (0..side).map(move |x| (z, x))) {
        let corner = z * row + x;
        data.indices
            .extend([[corner, corner + row, corner + 1], [corner + 1, corner + row, corner + row + 1]]);
    }
    Ok(Subject { name: "terrain".into(), mesh: Arc::new(Mesh::new(data)?) })
}

/// Bilinear noise in [0, 1] on a grid of 4 * 2^octave cells.
fn value_noise(u: f64, v: f64, octave: u32) -> f64 {
    let cells = f64::from(4_u32 << octave);
    let (x, y) = (u * cells, v * cells);
    let at = |dx: f64, dy: f64| {
        let key = Key::camera((x.floor() + dx) as u32, (y.floor() + dy) as u32, octave);
        key.stream().next_unit()
    };
    let (s, t) = (x.fract(), y.fract());
    (at(0.0, 0.0) * (1.0 - s) + at(1.0, 0.0) * s) * (1.0 - t)
        + (at(0.0, 1.0) * (1.0 - s) + at(1.0, 1.0) * s) * t
}

/// Balls on balls, as triangles: deep concavities and triangles of four sizes.
pub(crate) fn sphereflake(triangles: u32) -> Result<Subject, Failure> {
    // A small one has a level less, so that its balls stay round.
    let (levels, balls) = if triangles < 100_000 { (2, 1 + 9 + 81) } else { (3, 1 + 9 + 81 + 729) };
    let rings = f64::from(triangles / balls / 4).sqrt().max(3.0) as u32;
    let mut data = MeshData::default();
    let mut pending = vec![(Transform::IDENTITY, levels)];
    while let Some((place, levels)) = pending.pop() {
        add_ball(&mut data, &place, rings);
        if levels > 0 {
            pending.extend(nine_around(&place).map(|child| (child, levels - 1)));
        }
    }
    Ok(Subject { name: "sphereflake".into(), mesh: Arc::new(Mesh::new(data)?) })
}

/// Haines' arrangement: six balls around the equator and three above, a third of the size.
fn nine_around(place: &Transform) -> impl Iterator<Item = Transform> {
    let place = *place;
    (0..9).map(move |i| {
        let (tilt, turn) =
            if i < 6 { (90.0, 60.0 * f64::from(i)) } else { (35.0, 120.0 * f64::from(i) + 30.0) };
        Transform::scale(DVec3::splat(1.0 / 3.0))
            .then(Transform::translate(DVec3::Y * (4.0 / 3.0)))
            .then(Transform::rotate(DVec3::Z, tilt))
            .then(Transform::rotate(DVec3::Y, turn))
            .then(place)
    })
}

/// A ball of about so many triangles, to be used many times.
pub(crate) fn ball(triangles: u32) -> Result<Subject, Failure> {
    let mut data = MeshData::default();
    add_ball(&mut data, &Transform::IDENTITY, f64::from(triangles / 4).sqrt().max(3.0) as u32);
    Ok(Subject { name: "ball".into(), mesh: Arc::new(Mesh::new(data)?) })
}

fn add_ball(data: &mut MeshData, place: &Transform, rings: u32) {
    let segments = 2 * rings;
    let first = data.positions.len() as u32;
    for (ring, segment) in (0..=rings).flat_map(|ring| (0..=segments).map(move |segment| (ring, segment))) {
        let (radius, y) = sin_cos(PI * f64::from(ring) / f64::from(rings));
        let (sin, cos) = sin_cos(TAU * f64::from(segment) / f64::from(segments));
        let point = place.point(DVec3::new(radius * sin, y, radius * cos));
        data.positions.push(point.as_vec3().to_array());
    }
    let row = segments + 1;
    for (ring, segment) in (0..rings).flat_map(|ring| (0..segments).map(move |segment| (ring, segment))) {
        let corner = first + ring * row + segment;
        data.indices
            .extend([[corner, corner + row, corner + 1], [corner + 1, corner + row, corner + row + 1]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bunny_is_read_from_a_javascript_module() {
        let module = "exports.positions=[[0,0,0],[1.5,0,-2e-1],[0,1,0]]\nexports.cells=[[0,1,2]]\n";
        let mesh = bunny(module).unwrap();
        assert_eq!(mesh.vertices(0), [[0.0, 0.0, 0.0], [1.5, 0.0, -0.2], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn a_module_that_is_no_mesh_is_refused() {
        for module in
            ["", "exports.positions=[[0,0]]", "exports.positions=[[0,0,x]]\nexports.cells=[[0,1,2]]"]
        {
            assert!(bunny(module).is_err());
        }
    }
}
