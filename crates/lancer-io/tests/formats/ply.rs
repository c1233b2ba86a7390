//! PLY, as text and in binary of both byte orders.

use crate::common::{area, error_of, first_line, load};
use lancer_io::diagnostics::LoadError;
use lancer_io::model::Model;
use proptest::prelude::*;

pub(crate) fn ply(bytes: impl AsRef<[u8]>) -> Result<Model, LoadError> {
    load("model.ply", bytes)
}

pub(crate) const PLY_SQUARE: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

/// The square in binary with normals, texture coordinates, a list and an element that are not read, and its
/// numbers of odd types in an odd order.
fn binary_square(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement mark 4000000000\r\nelement face 2\r\nproperty uchar red\r\n\
         property list ushort uint vertex_index\r\nelement extra 1\r\nproperty list char double x\r\n\
         element vertex 4\r\nproperty double z\r\nproperty short y\r\nproperty float nx\r\nproperty float ny\r\n\
         property float nz\r\nproperty list uint8 int16 skipped\r\nproperty uchar x\r\nproperty float s\r\n\
         property float t\r\nend_header\r\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| {
        let mut value = little.to_vec();
        if big {
            value.reverse();
        }
        bytes.extend(value);
    };
    for corners in [[0_u32, 1, 2], [0, 2, 3]] {
        put(&[200]);
        put(&3_u16.to_le_bytes());
        corners.iter().for_each(|corner| put(&corner.to_le_bytes()));
    }
    put(&[2]);
    put(&f64::NAN.to_le_bytes());
    put(&1.0_f64.to_le_bytes());
    for (x, y) in [(0_u8, 0_i16), (1, 0), (1, 1), (0, 1)] {
        put(&(-2.5_f64).to_le_bytes());
        put(&y.to_le_bytes());
        [0.0_f32, 0.0, 3.0].iter().for_each(|n| put(&n.to_le_bytes()));
        put(&[1]);
        put(&7_i16.to_le_bytes());
        put(&[x]);
        put(&f32::from(x).to_le_bytes());
        put(&0.5_f32.to_le_bytes());
    }
    bytes
}

#[test]
fn text_and_both_binary_orders_give_the_same_square() {
    let text = ply(PLY_SQUARE).unwrap();
    assert_eq!((text.triangle_count(), area(&text)), (2, 1.0));
    for big in [false, true] {
        let binary = ply(binary_square(big)).unwrap();
        assert_eq!((binary.triangle_count(), area(&binary)), (2, 1.0));
        let data = binary.parts[0].mesh.data();
        assert_eq!(data.positions[2], [1.0, 1.0, -2.5]);
        assert_eq!(data.normals, [[0.0, 0.0, 1.0]; 4]);
        assert_eq!(data.uvs[1], [1.0, 0.5]);
    }
}

#[test]
fn colours_of_vertices_are_srgb_of_any_type() {
    let colored = |kind: &str, colors: [&str; 4]| {
        let header = PLY_SQUARE.split_once("0 0 0\n").unwrap().0.replace(
            "property float z\n",
            &format!("property {kind} blue\nproperty float z\nproperty {kind} red\nproperty {kind} green\n"),
        );
        let vertex = |(position, color): (&str, &str)| {
            let (blue, rest) = color.split_once(' ').unwrap();
            format!("{position} {blue} 0 {rest}\n")
        };
        let vertices = ["0 0", "1 0", "1 1", "0 1"].into_iter().zip(colors).map(vertex).collect::<String>();
        let text = format!("{header}{vertices}4 0 1 2 3\n");
        ply(text).unwrap()
    };
    let fifth = lancer_core::color::srgb_to_linear(0.2) as f32;
    let expected = [[1.0, 0.0, fifth], [0.0; 3], [1.0; 3], [0.0, 0.0, 1.0]];
    for (kind, colors) in [
        ("uchar", ["51 255 0", "0 0 0", "255 255 255", "255 0 0"]),
        ("int", ["51 255 0", "0 0 0", "255 255 999", "255 -3 0"]),
        ("ushort", ["13107 65535 0", "0 0 0", "65535 65535 65535", "65535 0 0"]),
        ("float", ["0.2 1 0", "0 0 0", "1 1 1", "1 -1 0"]),
        ("double", ["51 255 0", "0 0 0", "255 255 255", "255 0 0"]),
    ] {
        let model = colored(kind, colors);
        let found = &model.parts[0].mesh.data().colors;
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-6, "{kind}: {found} is not {expected}");
        }
        assert_eq!(model.warnings.len(), usize::from(kind == "double"), "{kind}");
    }
}

#[test]
fn a_header_line_that_lost_its_keyword_is_passed_over() {
    let model = ply(PLY_SQUARE.replace("comment made by hand", "Created by hand, property of all")).unwrap();
    assert_eq!(model.triangle_count(), 2);
    let told = first_line(&model.warnings[0]);
    assert_eq!(told, "model.ply:3:1: `Created` is not known in a PLY header and is passed over");
}

#[test]
fn what_a_ply_has_that_is_not_drawn_is_told() {
    let text = PLY_SQUARE
        .replace("property float z\n", "property float z\nproperty uchar alpha\n")
        .replace("vertex_indices\n", "vertex_indices\nproperty uchar red\n")
        .replace(
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3",
            "0 0 0 255\n1 0 0 254\n1 1 0 0\n0 1 0 255\n4 0 1 2 3 9",
        );
    let told = ply(text).unwrap().warnings.iter().map(first_line).collect::<Vec<_>>();
    assert_eq!(
        told,
        [
            "model.ply: colours of faces are not drawn, only those of vertices",
            "model.ply: alpha is not drawn: 2 vertices are not opaque",
        ]
    );
}

#[test]
fn text_may_end_lines_as_on_any_system_and_hold_more_than_is_said() {
    for text in [
        PLY_SQUARE.replace('\n', "\r\n"),
        PLY_SQUARE.replace('\n', "\r"),
        PLY_SQUARE.replace("0 1 0\n", "0 1 0 255 0 0\n\n"),
        PLY_SQUARE.trim_end().to_owned(),
    ] {
        assert_eq!(ply(text).unwrap().triangle_count(), 2);
    }
    let latin1 = PLY_SQUARE.replace("hand", "\u{1}").into_bytes();
    let latin1 = latin1.into_iter().map(|byte| if byte == 1 { 0xe9 } else { byte }).collect::<Vec<_>>();
    assert_eq!(ply(latin1).unwrap().triangle_count(), 2);
}

#[test]
fn strips_wind_their_triangles_one_way() {
    let text = PLY_SQUARE
        .replace("element face 1", "element tristrips 1")
        .replace("4 0 1 2 3\n", "9 0 1 3 2 2 -1 0 1 3\n");
    let model = ply(text).unwrap();
    assert_eq!((model.triangle_count(), area(&model)), (3, 1.5));
    let mesh = &model.parts[0].mesh;
    for triangle in 0..3 {
        let [a, b, c] = mesh.corners(triangle);
        assert!((b - a).cross(c - a).z > 0.0);
    }
}

#[test]
fn faults_of_ply_are_told_with_their_places() {
    for (good, bad, expected) in [
        ("ply\n", "plx\n", ":1:1: does not begin with `ply`"),
        ("ascii", "utf8", ":2:8: `utf8` is not an encoding of PLY files"),
        ("float x", "half x", ":5:10: `half` is not a type of PLY files"),
        ("float x", "float w", ": vertices have no number `x`"),
        ("vertex 4", "vertex -4", ":4:16: `-4` is not a number of elements"),
        (
            "vertex 4",
            "vertex 4000000000",
            ": is too short for the 4000000000 elements `vertex` that its header promises",
        ),
        (
            "face 1",
            "face 18446744073709551615",
            ": is too short for the 18446744073709551615 elements `face` that its header promises",
        ),
        ("end_header", "end", ":10:1: `end` is not known in a PLY header"),
        ("vertex_indices", "corners", ": elements `face` have no list `vertex_indices`"),
        ("1 1 0\n", "1 nan 0\n", ":13:3: `nan` is not a finite number"),
        ("1 1 0\n", "1 1\n", ":13:4: the line ends before all numbers of its element"),
        ("4 0 1 2 3", "4 0 1 2 4", ":15:9: vertex 4 is used, but there are 4, the first is 0"),
        ("4 0 1 2 3", "4 0 1 2 0.5", ":15:9: vertex 0.5 is used, but there are 4, the first is 0"),
        ("4 0 1 2 3", "4e9 0 1 2", ":15:1: a list cannot have 4000000000 numbers here"),
        ("4 0 1 2 3", "4 0 1", ":15:1: a list cannot have 4 numbers here"),
        ("0 1 0\n4 0 1 2 3\n", "0 1 0\n  \n  \n", ": ends before all that its header promises"),
        ("element face 1", "element face 0", ": has 4 vertices, but no face to draw"),
    ] {
        assert_eq!(error_of(ply(PLY_SQUARE.replacen(good, bad, 1))), format!("model.ply{expected}"), "{bad}");
    }
}

#[test]
fn every_truncation_of_a_binary_is_an_error() {
    let whole = binary_square(true);
    for length in 0..whole.len() {
        assert!(ply(&whole[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn lying_counts_are_refused() {
    // Believed, each would take minutes or all memory.
    for (elements, body) in [
        (
            "element vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\n",
            &b"\0\0\0\0"[..],
        ),
        ("element face 4294967295\nproperty list uint uint vertex_indices\n", b"\xff\xff\xff\xff"),
        ("element face 1\nproperty list uint uint vertex_indices\n", b"\xff\xff\xff\xff\0\0\0\0"),
        ("element face 18446744073709551615\nproperty double x\n", b""),
        ("element none 18446744073709551615\n", b""),
    ] {
        for order in ["little", "big"] {
            let mut bytes =
                format!("ply\nformat binary_{order}_endian 1.0\n{elements}end_header\n").into_bytes();
            bytes.extend(body);
            assert!(ply(bytes).is_err(), "{elements}");
        }
    }
}

proptest! {
    #[test]
    fn any_change_to_a_ply_is_a_model_or_an_error(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        big in any::<bool>(),
    ) {
        for mut bytes in [binary_square(big), PLY_SQUARE.as_bytes().to_vec()] {
            for (place, value) in &changes {
                let place = place.index(bytes.len());
                bytes[place] = *value;
            }
            let _ = ply(bytes);
        }
    }
}
