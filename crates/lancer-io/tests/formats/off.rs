//! OFF.

use crate::common::{Files, area, error_of, load, mutated, mutations, warnings_of};
use lancer_core::Rgb;
use lancer_core::scene::Texture;
use lancer_io::limits::Limits;
use lancer_io::showcase::scene_of_model;
use proptest::prelude::*;

const SQUARE: &str = "OFF\n# a square\n4 1 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n";

#[test]
fn polygons_are_triangulated() {
    let model = load("a.off", SQUARE).unwrap();
    assert_eq!((model.triangle_count(), area(&model)), (2, 4.0));
    let dart = "OFF 4 1\n0 0 5\n4 0 5\n4 4 5\n3 1 5\n\n4 2 3 0 1\n";
    assert_eq!(area(&load("a.off", dart).unwrap()), 4.0);
}

#[test]
fn the_keyword_may_be_missing_and_counts_may_follow_it() {
    for text in [
        SQUARE.to_owned(),
        SQUARE.replace("OFF\n# a square\n", ""),
        SQUARE.replace("OFF\n# a square\n", "OFF "),
    ] {
        assert_eq!(load("a.off", text).unwrap().triangle_count(), 2);
    }
}

#[test]
fn prefixes_say_what_vertices_have() {
    let vertex = |x, y, rest: &str| format!("{x} {y} 0 0 0 2 {rest}\n");
    for (colors, prefix) in [("", "STN"), ("255 0 0 255", "STCN"), ("1 0 0", "STCN")] {
        let rest = |u, v| format!("{colors} {u} {v}");
        let vertices =
            [vertex(0, 0, &rest(0.0, 0.25)), vertex(1, 0, &rest(1.0, 0.25)), vertex(0, 1, &rest(0.0, 0.75))];
        let model = load("a.off", format!("{prefix}OFF 3 1 3\n{}3 0 1 2\n", vertices.concat())).unwrap();
        let data = model.parts[0].mesh.data();
        assert_eq!(data.colors, if colors.is_empty() { vec![] } else { vec![[1.0, 0.0, 0.0]; 3] });
        assert_eq!(data.normals, [[0.0, 0.0, 1.0]; 3]);
        assert_eq!(data.uvs, [[0.0, 0.25], [1.0, 0.25], [0.0, 0.75]]);
    }
}

#[test]
fn colors_of_faces_win_over_those_of_vertices_and_their_corners_are_split() {
    let vertex = |x, y| format!("{x} {y} 0 0 0 255\n");
    let vertices = [vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)].concat();
    let model =
        load("a.off", format!("COFF 4 3 0\n{vertices}3 0 1 2 255 0 0\n3 0 2 3 188 188 188 9\n3 0 1 3 5\n"));
    let model = model.unwrap();
    let data = model.parts[0].mesh.data();
    let color_of = |triangle: usize| data.indices[triangle].map(|index| data.colors[index as usize]);
    assert_eq!(color_of(0), [[1.0, 0.0, 0.0]; 3]);
    assert!(color_of(1).as_flattened().iter().all(|x| (x - 0.5029).abs() < 1e-4), "188 is half of white");
    assert_eq!(color_of(2), [[0.0, 0.0, 1.0]; 3]);
    let scene = scene_of_model(model);
    let painted = scene.materials().iter().find(|material| material.name == "painted plaster").unwrap();
    assert_eq!(painted.color, Texture::Solid(Rgb::WHITE), "nothing tints the file's own colours");
}

#[test]
fn faces_of_fewer_than_three_corners_are_told() {
    let model = load("a.off", SQUARE.replace("4 1 0", "4 3 0") + "2 0 1\n1 2\n").unwrap();
    assert_eq!(warnings_of(&model), ["a.off:9:1: a face of fewer than 3 corners is not drawn (and 1 more)"]);
}

#[test]
fn faults_are_told_with_their_places() {
    for (from, to, expected) in [
        ("OFF\n", "OFF BINARY\n", "1:5: is a binary OFF file, which is not read"),
        ("OFF\n", "4OFF\n", "1:1: `4OFF` has vertices of other than three dimensions"),
        ("OFF\n", "nOFF\n", "1:1: `nOFF` has vertices of other than three dimensions"),
        ("OFF\n", "XOFF\n", "1:1: `XOFF` is no keyword of OFF files"),
        ("OFF\n", "solid\n", "1:1: `solid` is not a number of elements"),
        ("OFF\n", "COFF\n", "4:1: this vertex lacks a colour of three or four numbers"),
        ("4 1 0", "-4 1 0", "3:1: `-4` is not a number of elements"),
        ("4 1 0", "4 4000000000 0", "3:3: the file is too short for 4000000000 elements"),
        ("4 1 0", "18446744073709551615 1 0", "3:1: the file is too short for 18446744073709551615 elements"),
        ("4 1 0", "4 5 0", "3:1: the file ends after 1 of 5 faces"),
        ("4 1 0", "9 1 0", "3:1: the file ends after 5 of 9 vertices"),
        ("2 0 0", "2 0", "5:1: the line ends before all numbers of this vertex"),
        ("2 0 0", "2 nan 0", "5:3: `nan` is not a finite number"),
        ("4 0 1 2 3", "4 0 1 2 4", "8:9: `4` is no vertex of the 4 that there are, from 0"),
        ("4 0 1 2 3", "4 0 1 2 -1", "8:9: `-1` is no vertex of the 4 that there are, from 0"),
        ("4 0 1 2 3", "5 0 1 2 3", "8:1: the line ends before all corners of this face"),
        ("4 0 1 2 3", "x 0 1 2 3", "8:1: `x` is not a number of corners"),
    ] {
        assert_eq!(error_of(load("a.off", SQUARE.replacen(from, to, 1))), format!("a.off:{expected}"));
    }
    assert_eq!(error_of(load("a.off", "OFF 0 0 0\n")), "a.off: holds no face to draw");
    assert_eq!(error_of(load("a.off", "")), "a.off: holds no numbers of vertices and faces");
}

#[test]
fn more_triangles_than_allowed_are_refused() {
    let limits = Limits { triangles: 1, ..Limits::default() };
    assert_eq!(
        error_of(Files::new().with("a.off", SQUARE).load_within("a.off", limits)),
        "a.off:8:1: from here on there are more than 1 triangles"
    );
}

proptest! {
    #[test]
    fn no_change_of_bytes_makes_it_panic(mutations in mutations(), cut: bool) {
        if let Ok(model) = load("a.off", mutated(SQUARE.as_bytes(), &mutations, cut)) {
            prop_assert!(model.triangle_count() > 0);
        }
    }
}
