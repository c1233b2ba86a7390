//! OBJ: statements, corners and polygons.

use crate::common::{Files, area, error_of, first_line, load};
use crate::ply::{PLY_SQUARE, ply};
use lancer_core::geometry::DVec3;
use lancer_core::scene::Scene;
use lancer_io::diagnostics::LoadError;
use lancer_io::limits::Limits;
use lancer_io::model::Model;
use proptest::prelude::*;

pub(crate) fn obj(text: impl AsRef<[u8]>) -> Result<Model, LoadError> {
    load("model.obj", text)
}

pub(crate) const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn all_forms_of_corners_and_indices_mean_the_same() {
    let attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\n";
    for face in
        ["f 1 2 3", "f -4 -3 -2", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 -3/-2/-1 3/3/1", "f 1/ 2// 3"]
    {
        let model = obj(format!("{SQUARE}{attributes}{face}\n")).unwrap();
        let data = model.parts[0].mesh.data();
        assert_eq!(data.positions, [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], "{face}");
        assert!(data.normals.is_empty() || data.normals == [[0.0, 0.0, 1.0]; 3], "{face}");
        assert!(data.uvs.is_empty() || data.uvs == [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], "{face}");
    }
}

#[test]
fn negative_indices_count_from_the_face() {
    let triangle = |x: u32| format!("v {x} 0 0\nv {x} 1 0\nv {x} 0 2\nf -3 -2 -1\n");
    let model = obj((0..5).map(triangle).collect::<String>()).unwrap();
    assert_eq!(model.triangle_count(), 5);
    assert_eq!(area(&model), 5.0);
    assert_eq!(model.bounds().max, DVec3::new(4.0, 1.0, 2.0));
}

#[test]
fn faces_may_stand_before_their_vertices() {
    assert_eq!(obj(format!("f 1 2 3 4\n{SQUARE}")).unwrap().triangle_count(), 2);
    assert_eq!(
        error_of(obj(format!("f 1 2 3 5\n{SQUARE}"))),
        "model.obj:1:9: vertex 5 is used, but there are only 4"
    );
}

#[test]
fn concave_polygons_have_the_right_area() {
    let model = obj("v 0 0 5\nv 4 0 5\nv 4 4 5\nv 3 1 5\nf 3 4 1 2\n").unwrap();
    assert_eq!((model.triangle_count(), area(&model)), (2, 4.0));
}

#[test]
fn a_hole_joined_to_its_outline_stays_a_hole() {
    // A square of 16 with a hole of 4, as one polygon that goes in and out along the same edge.
    let outline = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]];
    for start in 0..outline.len() {
        let mut corners = outline;
        corners.rotate_left(start);
        let vertices = corners.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect::<String>();
        let model = obj(format!("{vertices}f 1 2 3 4 5 6 7 8 9 10\n")).unwrap();
        assert!((area(&model) - 12.0).abs() < 1e-9, "from corner {start}: {}", area(&model));
    }
}

#[test]
fn degenerate_polygons_do_no_harm() {
    let model = obj(format!("{SQUARE}f 1 1 1 1 1\nf 1 2\nf 3\nf\nf 1 2 3 4\n")).unwrap();
    assert_eq!(model.triangle_count(), 5);
    assert_eq!(
        first_line(&model.warnings[0]),
        "model.obj:6:1: a face of fewer than 3 corners is not drawn (and 2 more)"
    );
}

#[test]
fn a_polygon_too_large_to_clip_is_an_error() {
    let corners = 20_000;
    let zigzag = (0..corners).map(|i| format!("v {i} {} 0\n", i % 2)).collect::<String>();
    let face = (1..=corners).map(|i| format!(" {i}")).collect::<String>();
    assert!(error_of(obj(format!("{zigzag}f{face}\n"))).contains("has 20000 corners"));
}

#[test]
fn line_ends_tabs_continuations_and_latin_1_are_read() {
    let text = b"# caf\xe9 \\\r\n\tv 0 0 0 \r\nv 1\t0 \\\r\n 0\r\nv 1 1 0 1.0\r\nv 0 1 0 0.5 0.5 0.5\r\no caf\xe9\r\nf 1 2\\\r\n3 4 # all\r\n";
    let model = obj(text).unwrap();
    assert_eq!((model.triangle_count(), area(&model)), (2, 1.0));
    assert_eq!(model.parts[0].name, "caf\u{e9}");
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn three_numbers_after_a_position_are_its_colour_in_srgb() {
    let colored = "v 0 0 0 1 0.5 0\nv 1 0 0 1.0 0 0 1\nv 1 1 0\nf 1 2 3\n";
    let model = obj(colored).unwrap();
    let half = lancer_core::color::srgb_to_linear(0.5) as f32;
    assert_eq!(model.parts[0].mesh.data().colors, [[1.0, half, 0.0], [0.0, 0.0, 1.0], [1.0; 3]]);
    assert!(model.warnings.is_empty());

    let of_255 = obj("v 0 0 0 255 0 51\nv 1 0 0 0 0 0\nv 1 1 0 300 0 0\nf 1 2 3\n").unwrap();
    let fifth = lancer_core::color::srgb_to_linear(0.2) as f32;
    assert_eq!(of_255.parts[0].mesh.data().colors, [[1.0, 0.0, fifth], [0.0; 3], [1.0, 0.0, 0.0]]);
    assert!(of_255.warnings[0].message.contains("255"));

    for other in ["v 0 0 0 1", "v 0 0 0 1 1", "v 0 0 0 1 1 1 1 1", "v 0 0 0 red 0 0", "v 0 0 0 # 1 1 1"] {
        let model = obj(format!("{other}\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")).unwrap();
        assert!(model.parts[0].mesh.data().colors.is_empty(), "{other}");
    }
}

#[test]
fn decimal_commas_are_faults_that_say_so() {
    let error = obj("v 0,5 0 0\n").unwrap_err();
    assert_eq!(error.diagnostics[0].message, "`0,5` is not a finite number");
    assert!(error.diagnostics[0].hint.as_deref().unwrap().contains("decimal point"));
    assert_eq!(obj("v 0,x 0 0\n").unwrap_err().diagnostics[0].hint, None);
    let error = ply(PLY_SQUARE.replace("1 1 0", "1,0 1 0")).unwrap_err();
    assert!(error.diagnostics[0].hint.as_deref().unwrap().contains("decimal point"));
}

#[test]
fn corners_are_shared_where_all_attributes_are() {
    let grid = "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n";
    let model = obj(format!("{SQUARE}{grid}")).unwrap();
    assert_eq!(model.parts[0].mesh.data().positions.len(), 5);
}

#[test]
fn what_is_not_drawn_is_told_once() {
    let text = format!(
        "{SQUARE}l 1 2\np 1\nl 3 4\ncurv 0 1 1 2 \\\n 3\nsurf 1\nfoo\nbar 1\ncsh rm -rf\ncall x.obj\ns off\nf 1 2 3\n"
    );
    let warnings = obj(text).unwrap().warnings;
    let told = warnings.iter().map(first_line).collect::<Vec<_>>();
    assert_eq!(
        told,
        [
            "model.obj:5:1: points and lines are not drawn: `l` (and 2 more)",
            "model.obj:8:1: free-form geometry is not drawn: `curv` (and 1 more)",
            "model.obj:11:1: `foo` is no statement of OBJ files and is passed over (and 1 more)",
            "model.obj:13:1: `csh` is not done: a model runs nothing and reads no other model (and 1 more)",
        ]
    );
}

#[test]
fn faults_are_told_with_their_places() {
    for (line, expected) in [
        ("v 0 nan 0", "5:5: `nan` is not a finite number"),
        ("v 0 0 1e39", "5:7: `1e39` is not a finite number"),
        ("v 0,5 0 0", "5:3: `0,5` is not a finite number"),
        ("v 0 0", "5:1: `v` needs 3 numbers, there are 2"),
        ("vn inf 0 0", "5:4: `inf` is not a finite number"),
        ("f 1 2 5", "5:7: vertex 5 is used, but there are only 4"),
        ("f 1 2 -5", "5:7: vertex -5 is used, but there are only 4"),
        ("f 1 2 0", "5:7: there is no vertex 0: the first is 1"),
        ("f 1 2/1 3", "5:5: texture vertex 1 is used, but there are none"),
        ("f 1 2 99999999999999999999", "5:7: `99999999999999999999` is not a whole number"),
        ("f 1 2 4294967296", "5:7: vertex 4294967296 is used, but there are only 4"),
        ("f 1 2 3/1/1/1", "5:7: `3/1/1/1` is not a corner as v, v/vt, v//vn or v/vt/vn"),
        ("f a b c", "5:3: `a` is not a whole number"),
    ] {
        assert_eq!(error_of(obj(format!("{SQUARE}{line}\n"))), format!("model.obj:{expected}"), "{line}");
    }
}

#[test]
fn all_errors_come_at_once_up_to_a_bound() {
    let error = obj(format!("{SQUARE}f 9 9 9\nv x\n{}", "f 0 0 0\n".repeat(100))).unwrap_err();
    assert_eq!(error.diagnostics.len(), Limits::default().errors + 1);
    assert!(
        error
            .diagnostics
            .windows(2)
            .all(|pair| pair[0].location <= pair[1].location || pair[1].location.is_none())
    );
    assert!(error.to_string().contains("\n  6 | v x\n"));
    assert!(error.diagnostics.last().unwrap().message.ends_with("more errors"));
}

#[test]
fn nothing_to_draw_is_an_error() {
    assert_eq!(error_of(obj("")), "model.obj: holds no face to draw");
    assert_eq!(error_of(obj(SQUARE)), "model.obj: holds no face to draw");
    assert!(obj("l 1 2").unwrap_err().to_string().contains("hint: points and lines"));
    assert!(error_of(obj(b"\xff\xfev\0 \x000\0")).contains("UTF-16"));
}

proptest! {
    #[test]
    fn any_statements_are_a_model_or_an_error(
        lines in prop::collection::vec(
            "(v|vt|vn|f|o|usemtl|mtllib|s|l|#|curv)( (-?[0-9]{1,2}(/[0-9]?){0,3}|nan|1e39|0\\.5|m\\.mtl|\\\\)){0,6}", 0..40),
        materials in prop::collection::vec(
            "(newmtl|Kd|Ks|Ns|d|Tr|illum|map_Kd|Tf|Ni)( (-?[0-9]{1,3}|-s|-o|a\\.png|nan|1e300)){0,4}", 0..30),
    ) {
        let files = Files::new()
            .with("m.obj", format!("mtllib m.mtl\n{SQUARE}{}", lines.join("\n")))
            .with("m.mtl", materials.join("\n"));
        if let Ok(model) = files.load("m.obj") {
            assert!(model.bounds().is_finite());
            model.insert_into(&mut Scene::new("any"));
        }
    }
}
