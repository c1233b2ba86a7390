//! Which edges of models without normals are smooth.

use crate::common::Files;
use crate::obj::{SQUARE, obj};
use crate::ply::ply;
use lancer_io::diagnostics::LoadError;
use lancer_io::model::{Model, ModelPart};

/// Two squares that meet at the edge x = 0, at an angle in degrees, after statements before each.
fn roof(degrees: f64, first: &str, second: &str) -> String {
    let (sin, cos) = lancer_core::geometry::portable::sin_cos(degrees.to_radians());
    let corners =
        format!("v -1 0 0\nv 0 0 0\nv 0 0 -1\nv -1 0 -1\nv {cos} {} 0\nv {cos} {} -1\n", -sin, -sin);
    format!("{corners}{first}\nf 1 2 3 4\n{second}\nf 2 5 6 3\n")
}

/// Whether the edge that two squares share is smooth.
fn is_smooth(result: Result<Model, LoadError>) -> bool {
    let model = result.unwrap();
    let data = model.parts[0].mesh.data();
    data.positions.len() == 6 && !data.normals.is_empty()
}

#[test]
fn faces_without_normals_are_smooth_up_to_an_angle() {
    assert!(is_smooth(obj(roof(39.0, "", ""))));
    assert!(!is_smooth(obj(roof(41.0, "", ""))));
    // The normals at the edge lie half-way between those of the faces.
    let model = obj(roof(30.0, "", "")).unwrap();
    let data = model.parts[0].mesh.data();
    let (sin, cos) = lancer_core::geometry::portable::sin_cos(15_f64.to_radians());
    let at_edge = data.positions.iter().position(|&position| position == [0.0; 3]).unwrap();
    for (found, expected) in data.normals[at_edge].iter().zip([sin, cos, 0.0]) {
        assert!((f64::from(*found) - expected).abs() < 1e-6);
    }
}

#[test]
fn smoothing_groups_decide_where_there_are_any() {
    assert!(is_smooth(obj(roof(70.0, "s 1", ""))));
    assert!(!is_smooth(obj(roof(20.0, "s 1", "s 2"))));
    assert!(!is_smooth(obj(roof(90.0, "s 1", ""))), "boxes in a group stay boxes");
    assert!(!is_smooth(obj(roof(20.0, "s off", ""))));
    assert!(!is_smooth(obj(roof(20.0, "s 0", "s 0"))));
    assert!(!is_smooth(obj(roof(20.0, "s 1", "s off"))));
}

#[test]
fn smoothing_goes_across_materials() {
    let model = obj(roof(30.0, "s 3\nusemtl a", "usemtl b")).unwrap();
    assert_eq!(model.parts.len(), 2);
    let normals = |part: &ModelPart| part.mesh.data().normals.clone();
    let shared =
        normals(&model.parts[0]).iter().filter(|normal| normals(&model.parts[1]).contains(normal)).count();
    assert_eq!(shared, 2, "the edge's two ends have one normal each");
}

#[test]
fn the_user_decides_before_the_file() {
    let with = |text: String, degrees: f64| Files::new().with("m.obj", text).load_smoothed("m.obj", degrees);
    assert!(is_smooth(with(roof(60.0, "s off", ""), 61.0)));
    assert!(!is_smooth(with(roof(60.0, "s 1", ""), 59.0)));
    assert!(!is_smooth(with(roof(1.0, "s 1", ""), 0.0)));
    let own = roof(60.0, "vn 0 1 0", "").replace("f 1 2 3 4", "f 1//1 2//1 3//1 4//1");
    let own = with(own, 180.0).unwrap();
    assert_eq!(own.parts[0].mesh.data().normals[0], [0.0, 1.0, 0.0], "normals of the file stay");
}

#[test]
fn faces_without_normals_are_facets_beside_smooth_ones() {
    let model = obj(format!("{SQUARE}vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\nf 1//1 3 4//1\n")).unwrap();
    let normals = model.parts.iter().map(|part| part.mesh.data().normals.len()).collect::<Vec<_>>();
    assert_eq!(normals, [3, 0]);
    assert_eq!(model.parts[1].mesh.triangle_count(), 2);
}

#[test]
fn meshes_without_normals_are_smooth_across_seams() {
    // A bent strip whose vertices are written twice along the bend, as for two pieces of a texture.
    let text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
        -1 0 0 0 0\n0 0 0 1 0\n0 0 -1 1 1\n-1 0 -1 0 1\n0 0 0 0 0\n1 -0.5 0 1 0\n1 -0.5 -1 1 1\n0 0 -1 0 1\n\
        4 0 1 2 3\n4 4 5 6 7\n";
    let data = ply(text).unwrap().parts[0].mesh.data().clone();
    assert_eq!(data.positions.len(), 8);
    assert_eq!(data.normals[1], data.normals[4]);
    assert_ne!(data.normals[0], data.normals[1]);
}
