use super::patches::patches;
use super::tessellate::tessellate;
use lancer_core::geometry::DVec3;
use std::collections::HashMap;

fn unit_grid(steps: u32) -> impl Iterator<Item = (f64, f64)> {
    let at = move |step| f64::from(step) / f64::from(steps);
    (0..=steps).flat_map(move |i| (0..=steps).map(move |j| (at(i), at(j))))
}

#[test]
fn there_are_newells_28_patches_and_4_for_the_bottom() {
    assert_eq!(patches().len(), 32);
}

#[test]
fn the_mesh_fills_the_teapots_known_box() {
    let bounds = tessellate(&patches(), 20).bounds();
    let near = |found: DVec3, known: DVec3| assert!((found - known).length() < 0.01, "{found}");
    near(bounds.min, DVec3::new(-3.0, -2.0, 0.0));
    near(bounds.max, DVec3::new(3.434, 2.0, 3.15));
}

#[test]
fn normals_on_body_lid_and_bottom_face_away_from_the_axis() {
    // Rim, two rows of the belly, and bottom; then knob and lid.
    let turned = &patches()[..24];
    for (index, patch) in turned.iter().enumerate() {
        for (u, v) in unit_grid(8) {
            let (point, normal) = (patch.point(u, v), patch.normal(u, v));
            assert!(normal.length() > 1e-3, "patch {index} at ({u}, {v})");
            let belly = (4..12).contains(&index);
            if belly {
                assert!(normal.dot(DVec3::new(point.x, point.y, 0.0)) > 0.0, "patch {index} at ({u}, {v})");
            }
        }
    }
    let up_at = |patch: usize, u: f64| turned[patch].normal(u, 0.5).normalize().z;
    assert!((up_at(16, 0.0) - 1.0).abs() < 1e-12, "the knob's top faces up");
    assert!((up_at(12, 1.0) + 1.0).abs() < 1e-12, "the bottom's middle faces down");
}

#[test]
fn normals_of_handle_and_spout_face_away_from_the_plane_of_symmetry() {
    for patch in &patches()[24..] {
        for (u, v) in unit_grid(8) {
            let (point, normal) = (patch.point(u, v), patch.normal(u, v));
            // The inside of the spout's lip turns back.
            if point.x < 2.5 {
                assert!(normal.y * point.y >= 0.0, "at {point}");
            }
        }
    }
}

#[test]
fn triangles_wind_as_their_normals_say() {
    let mesh = tessellate(&patches(), 10);
    for triangle in 0..mesh.triangle_count() as u32 {
        let [a, b, c] = mesh.corners(triangle);
        let normals = mesh.corner_normals(triangle).unwrap();
        assert!((b - a).cross(c - a).dot(normals[0] + normals[1] + normals[2]) > 0.0, "triangle {triangle}");
    }
}

#[test]
fn the_only_open_edges_are_the_originals_six_openings() {
    let steps = 10;
    let mesh = tessellate(&patches(), steps);
    // Adding zero joins -0 and 0.
    let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut uses = HashMap::new();
    for triangle in 0..mesh.triangle_count() as u32 {
        let [a, b, c] = mesh.corners(triangle).map(key);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *uses.entry((from.min(to), from.max(to))).or_insert(0) += 1;
        }
    }
    assert!(uses.values().all(|&count| count <= 2));
    let open = uses.values().filter(|&&count| count == 1).count();
    // Rim and lid are closed by four edges of patches, each end of handle and spout by two.
    assert_eq!(open, (2 * 4 + 4 * 2) * steps as usize);
}
