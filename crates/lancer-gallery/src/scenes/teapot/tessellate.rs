//! From patches to triangles.

use super::patches::Patch;
use lancer_core::geometry::DVec3;
use lancer_core::mesh::{Mesh, MeshData};

/// A mesh with `steps` by `steps` squares, of two triangles each, on every patch.
pub(super) fn tessellate(patches: &[Patch], steps: u32) -> Mesh {
    let mut data = MeshData::default();
    for patch in patches {
        add_patch(&mut data, patch, steps);
    }
    Mesh::new(data).expect("patches with finite control points make a valid mesh")
}

fn add_patch(data: &mut MeshData, patch: &Patch, steps: u32) {
    let first = data.positions.len() as u32;
    let at = |step| f64::from(step) / f64::from(steps);
    for (u, v) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (at(i), at(j)))) {
        data.positions.push(to_f32(patch.point(u, v)));
        data.normals.push(to_f32(patch.normal(u, v).normalize()));
        data.uvs.push([v as f32, u as f32]);
    }
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let corner = |di, dj| first + (i + di) * (steps + 1) + j + dj;
        let square = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
        for triangle in [[square[0], square[1], square[2]], [square[0], square[2], square[3]]] {
            // In the middle of the lid and of the bottom, squares have only three corners.
            let [a, b, c] = triangle.map(|index| data.positions[index as usize]);
            if a != b && b != c && c != a {
                data.indices.push(triangle);
            }
        }
    }
}

fn to_f32(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
