//! Meshes to PLY.

use super::header::AS_STORED;
use lancer_core::mesh::{Mesh, MeshData};
use std::io::{self, Write};

/// Writes a mesh as binary PLY, in little-endian order, with its normals, texture coordinates and colours if it has
/// them.
///
/// The header says that the numbers are those of a mesh, so that [`load`](crate::model::load) takes them as they are
/// and gives back an equal mesh: it neither makes normals unit vectors nor moves the vertices about another origin.
///
/// # Errors
/// `out` fails.
pub fn write_ply(mesh: &Mesh, mut out: impl Write) -> io::Result<()> {
    let MeshData { positions, normals, uvs, colors, indices } = mesh.data();
    let mut properties = vec!["x", "y", "z"];
    if !normals.is_empty() {
        properties.extend(["nx", "ny", "nz"]);
    }
    if !uvs.is_empty() {
        properties.extend(["u", "v"]);
    }
    if !colors.is_empty() {
        properties.extend(["red", "green", "blue"]);
    }
    let properties = properties.iter().map(|name| format!("property float {name}\n")).collect::<String>();
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nobj_info {AS_STORED}\nelement vertex {}\n{properties}\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        positions.len(),
        indices.len(),
    )?;
    for (index, position) in positions.iter().enumerate() {
        let normal = normals.get(index).into_iter().flatten();
        let uv = uvs.get(index).into_iter().flatten();
        let color = colors.get(index).into_iter().flatten();
        for number in position.iter().chain(normal).chain(uv).chain(color) {
            out.write_all(&number.to_le_bytes())?;
        }
    }
    for triangle in indices {
        out.write_all(&[3])?;
        for index in triangle {
            out.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(())
}
