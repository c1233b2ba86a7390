//! Vertex colours in S.

use super::*;
use crate::accel::Accelerator;
use crate::mesh::{Mesh, MeshData};
use crate::scene::Texture;

/// A triangle about the origin whose corners are red, green and blue, in white ambient light alone.
fn triangle(colors: Vec<[f32; 3]>, transform: Transform) -> Scene {
    let mut scene = Scene::new("triangle");
    scene.ambient = Rgb::WHITE;
    let color = Texture::Solid(Rgb::new(0.5, 0.25, 1.0));
    let material = scene.add_material(Material { color, ambient: Rgb::WHITE, ..dark() });
    let positions = vec![[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, -2.0]];
    let mesh = Mesh::new(MeshData { positions, colors, indices: vec![[0, 1, 2]], ..MeshData::default() });
    let node = Node::mesh("triangle", mesh.unwrap()).with_material(material);
    scene.add(node.with_transform(transform));
    scene
}

fn primaries() -> Vec<[f32; 3]> {
    vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

fn seen_from_above(scene: &Scene, accelerator: Accelerator, x: f64, z: f64) -> Rgb {
    let options = CompileOptions { accelerator, ..CompileOptions::default() };
    let world = World::compile(scene, &options).unwrap();
    let ray = Ray { origin: DVec3::new(x, 5.0, z), direction: DVec3::NEG_Y, t_max: f64::INFINITY };
    radiance(&world, &settings(0, 0, 1.0), ray)
}

#[test]
fn s_is_the_materials_colour_times_the_interpolated_vertex_colour() {
    // The third of each primary is at the barycentre, the half of two in the middle of an edge.
    let scene = triangle(primaries(), Transform::IDENTITY);
    let moved = triangle(primaries(), Transform::scale(DVec3::new(-2.0, 1.0, 3.0)));
    for accelerator in Accelerator::ALL {
        let third = 1.0 / 3.0;
        let at_barycentre = Rgb::new(0.5 * third, 0.25 * third, third);
        assert_same(seen_from_above(&scene, accelerator, 0.0, 0.0), at_barycentre);
        let at_edge = seen_from_above(&scene, accelerator, 0.0, 1.0 - 1e-13);
        let off = (at_edge.r - 0.25).abs() + (at_edge.g - 0.125).abs() + at_edge.b.abs();
        assert!(off < 1e-12, "{}: {at_edge:?}", accelerator.name());
        assert_same(seen_from_above(&moved, accelerator, 0.0, 0.0), at_barycentre);
    }
}

#[test]
fn white_vertices_leave_the_materials_colour() {
    for accelerator in Accelerator::ALL {
        let without = seen_from_above(&triangle(vec![], Transform::IDENTITY), accelerator, 0.1, 0.2);
        assert_eq!(without, Rgb::new(0.5, 0.25, 1.0));
        let white = triangle(vec![[1.0; 3]; 3], Transform::IDENTITY);
        assert_same(seen_from_above(&white, accelerator, 0.1, 0.2), without);
    }
}
