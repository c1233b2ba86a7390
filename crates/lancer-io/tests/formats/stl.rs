//! STL.

use crate::common::{Files, area, error_of, load, mutated, mutations, warnings_of};
use lancer_core::geometry::DVec3;
use lancer_io::limits::Limits;
use lancer_io::model::UpAxis;
use proptest::prelude::*;

/// The corners of a tetrahedron's faces, seen from outside.
const TETRAHEDRON: [[[f32; 3]; 3]; 4] = {
    const O: [f32; 3] = [0.0; 3];
    const X: [f32; 3] = [1.0, 0.0, 0.0];
    const Y: [f32; 3] = [0.0, 2.0, 0.0];
    const Z: [f32; 3] = [-0.0, 0.0, 3.0];
    [[O, Y, X], [O, X, Z], [O, Z, Y], [X, Y, Z]]
};

fn binary(header: &[u8], triangles: &[[[f32; 3]; 3]], count: u32) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0x34, 0x92]);
    }
    bytes
}

fn text(triangles: &[[[f32; 3]; 3]]) -> String {
    let vertex = |[x, y, z]: &[f32; 3]| format!("      vertex {x} {y:e} {z}\n");
    let facet = |corners: &[[f32; 3]; 3]| {
        let vertices = corners.iter().map(vertex).collect::<String>();
        format!("  facet normal 0 0 0\n    outer loop\n{vertices}    endloop\n  endfacet\n")
    };
    let facets = triangles.iter().map(facet).collect::<String>();
    format!("solid a name of words\n{facets}endsolid a name of words\n")
}

#[test]
fn binary_is_told_by_size_though_its_header_says_solid() {
    for header in [&b"made by a program"[..], b"solid made by a program", b"solid\nfacet normal"] {
        let model = load("a.stl", binary(header, &TETRAHEDRON, 4)).unwrap();
        assert_eq!(model.triangle_count(), 4);
        assert_eq!(model.parts[0].mesh.data().positions.len(), 4, "equal vertices are one");
        assert!(model.parts[0].mesh.data().normals.is_empty());
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        assert_eq!(model.up, UpAxis::Z);
    }
}

#[test]
fn text_and_binary_give_one_mesh() {
    let from_text = load("a.stl", text(&TETRAHEDRON)).unwrap();
    let from_binary = load("a.STL", binary(b"", &TETRAHEDRON, 4)).unwrap();
    assert_eq!(from_text.parts[0].mesh, from_binary.parts[0].mesh);
    assert_eq!(from_text.parts[0].name, "a name of words");
    assert_eq!(from_text.bounds().max, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn edges_are_smooth_up_to_a_crease_angle_on_request() {
    let files = Files::new().with("a.stl", binary(b"", &TETRAHEDRON, 4));
    let vertices = |degrees| files.load_smoothed("a.stl", degrees).unwrap().parts[0].mesh.data().clone();
    assert_eq!(vertices(180.0).normals.len(), 4);
    assert_eq!(vertices(0.0).normals.len(), 0);
}

#[test]
fn each_solid_is_a_part_and_empty_ones_are_none() {
    let both = format!("{}solid\nendsolid\n{}", text(&TETRAHEDRON[..1]), text(&TETRAHEDRON[1..]));
    let model = load("a.stl", both).unwrap();
    let triangles = model.parts.iter().map(|part| part.mesh.triangle_count()).collect::<Vec<_>>();
    assert_eq!(triangles, [1, 3]);
}

#[test]
fn text_may_be_in_any_case_on_any_lines_with_polygons_and_split_ends() {
    let model = load(
        "a.stl",
        "\u{feff}  SOLID\r\nFACET NORMAL nan nan nan OUTER LOOP VERTEX 0 0 0 vertex 2 0 0\rvertex 2 2 0\n\
         vertex 0 2 0 END LOOP end facet\nfacet\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 1 2 1\n\
         endloop\nendfacet\nend solid",
    );
    let model = model.unwrap();
    assert_eq!((model.triangle_count(), area(&model)), (3, 5.0));
}

#[test]
fn bytes_beyond_the_triangles_are_told() {
    let mut bytes = binary(b"", &TETRAHEDRON, 4);
    bytes.extend(b"more");
    let model = load("a.stl", bytes).unwrap();
    assert_eq!(model.triangle_count(), 4);
    assert_eq!(warnings_of(&model), ["a.stl: holds 4 bytes beyond its 4 triangles, which are passed over"]);
}

#[test]
fn faults_of_binary_files_are_told() {
    for (bytes, expected) in [
        (Vec::new(), "is neither STL text nor long enough for binary STL"),
        (vec![0; 83], "is neither STL text nor long enough for binary STL"),
        (binary(b"", &[], 0), "holds no triangle to draw"),
        (
            binary(b"", &TETRAHEDRON, u32::MAX),
            "ends after 4 of the 4294967295 triangles that its header promises",
        ),
        (
            binary(b"", &[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, f32::NAN, 0.0]]], 1),
            "vertex 3 of triangle 0 (byte 120) is not finite",
        ),
        (
            binary(b"", &[[[0.0; 3], [f32::INFINITY, 0.0, 0.0], [0.0; 3]]], 1),
            "vertex 2 of triangle 0 (byte 108) is not finite",
        ),
    ] {
        assert_eq!(error_of(load("a.stl", bytes)), format!("a.stl: {expected}"));
    }
}

#[test]
fn faults_of_text_files_are_told_with_their_places() {
    let facet = "facet normal 0 0 1\nouter loop\n";
    for (rest, expected) in [
        ("vertex 0 0 x\n", "4:12: `x` is not a finite number"),
        ("vertex 0 inf 0\n", "4:10: `inf` is not a finite number"),
        ("vertex 0 0 1e39\n", "4:12: `1e39` is not a finite number"),
        ("vertex 1 2", "4:1: the file ends in this vertex"),
        ("vertex 1 2 3\n", "2:1: the file ends before this `facet` does"),
        ("vortex 1 2 3\nendfacet\nendsolid", "4:1: `vortex` is not expected here"),
        ("endloop\nendfacet\n", "1:1: the file ends before this `solid` does"),
        ("endloop\nendfacet\nendsolid\nfacet\nendsolid", "7:1: `facet` is not expected here"),
    ] {
        let error = error_of(load("a.stl", format!("solid\n{facet}{rest}")));
        assert_eq!(error, format!("a.stl:{expected}"), "{rest}");
    }
    assert_eq!(error_of(load("a.stl", "solid\nendsolid\n")), "a.stl: holds no triangle to draw");
}

#[test]
fn more_triangles_than_allowed_are_refused() {
    let limits = Limits { triangles: 3, ..Limits::default() };
    let load = |bytes: Vec<u8>| error_of(Files::new().with("a.stl", bytes).load_within("a.stl", limits));
    assert_eq!(load(binary(b"", &TETRAHEDRON, 4)), "a.stl: there are more than 3 triangles");
    assert_eq!(
        load(text(&TETRAHEDRON).into_bytes()),
        "a.stl:29:3: from here on there are more than 3 triangles"
    );
}

proptest! {
    #[test]
    fn no_change_of_bytes_makes_it_panic(mutations in mutations(), cut: bool, is_text: bool) {
        let valid = if is_text { text(&TETRAHEDRON).into_bytes() } else { binary(b"", &TETRAHEDRON, 4) };
        if let Ok(model) = load("a.stl", mutated(&valid, &mutations, cut)) {
            prop_assert!(model.triangle_count() > 0);
        }
    }
}
