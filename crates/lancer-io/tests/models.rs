//! Model files as users have them, and as nobody should.

use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Scene, Shape, Texture};
use lancer_io::diagnostics::LoadError;
use lancer_io::limits::Limits;
use lancer_io::model::{self, Crease, Model, ModelOptions, ModelPart};
use lancer_io::resolver::Resolver;
use proptest::prelude::*;
use std::fmt::Display;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A directory with files, that of the model being `models/<name>`.
struct Files(TempDir);

impl Files {
    fn new() -> Self {
        let files = Self(TempDir::new().unwrap());
        fs::create_dir(files.0.path().join("models")).unwrap();
        files
    }

    fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        fs::write(self.path(name), bytes).unwrap();
        self
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join("models").join(name)
    }

    fn load(&self, name: &str) -> Result<Model, LoadError> {
        self.load_within(name, Limits::default())
    }

    fn load_within(&self, name: &str, limits: Limits) -> Result<Model, LoadError> {
        let path = self.path(name);
        model::load(&path, &Resolver::for_file(&path, false, limits), &ModelOptions::default())
    }
}

fn obj(text: impl AsRef<[u8]>) -> Result<Model, LoadError> {
    Files::new().with("model.obj", text).load("model.obj")
}

fn ply(bytes: impl AsRef<[u8]>) -> Result<Model, LoadError> {
    Files::new().with("model.ply", bytes).load("model.ply")
}

/// An error or a warning without the directory and the lines that follow.
fn first_line(diagnostic: impl Display + Copy) -> String {
    let text = diagnostic.to_string();
    let line = text.lines().next().unwrap();
    line.rsplit_once("/models/").map_or(line, |(_, rest)| rest).to_owned()
}

fn error_of(result: Result<Model, LoadError>) -> String {
    first_line(&result.unwrap_err())
}

fn area_of(part: &ModelPart) -> f64 {
    let double = |triangle| {
        let [a, b, c] = part.mesh.corners(triangle);
        (b - a).cross(c - a).length()
    };
    (0..part.mesh.triangle_count() as u32).map(double).sum::<f64>() * 0.5
}

fn area(model: &Model) -> f64 {
    model.parts.iter().map(area_of).sum()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Any format

#[test]
fn an_unknown_extension_is_an_error_that_lists_what_is_read() {
    let error = Files::new().with("a.3ds", "solid").load("a.3ds").unwrap_err().to_string();
    assert!(error.contains(".obj, .ply"), "{error}");
}

#[test]
fn extensions_are_read_in_any_case() {
    let model = Files::new().with("Square.OBJ", format!("{SQUARE}f 1 2 3 4\n")).load("Square.OBJ").unwrap();
    assert_eq!((model.name.as_str(), model.triangle_count()), ("Square", 2));
}

#[test]
fn a_missing_file_is_an_error_that_names_it() {
    assert_eq!(error_of(Files::new().load("a.obj")), "a.obj: cannot be read: no such file or directory");
}

// OBJ

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
fn degenerate_polygons_do_no_harm() {
    let model = obj(format!("{SQUARE}f 1 1 1 1 1\nf 1 2\nf 3\nf\nf 1 2 3 4\n")).unwrap();
    assert_eq!(model.triangle_count(), 5);
    assert_eq!(
        first_line(&model.warnings[0]),
        "model.obj:6:1: a face of fewer than 3 corners is not drawn (and 2 more)"
    );
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
    let with = |text: String, degrees: f64| {
        let files = Files::new().with("m.obj", text);
        let path = files.path("m.obj");
        let options = ModelOptions { crease: Crease::from_degrees(degrees) };
        model::load(&path, &Resolver::for_file(&path, false, Limits::default()), &options)
    };
    assert!(is_smooth(with(roof(60.0, "s off", ""), 61.0)));
    assert!(!is_smooth(with(roof(60.0, "s 1", ""), 59.0)));
    assert!(!is_smooth(with(roof(1.0, "s 1", ""), 0.0)));
    let own = roof(60.0, "vn 0 1 0", "").replace("f 1 2 3 4", "f 1//1 2//1 3//1 4//1");
    let own = with(own, 180.0).unwrap();
    assert_eq!(own.parts[0].mesh.data().normals[0], [0.0, 1.0, 0.0], "normals of the file stay");
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

#[test]
fn faces_without_normals_are_facets_beside_smooth_ones() {
    let model = obj(format!("{SQUARE}vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\nf 1//1 3 4//1\n")).unwrap();
    let normals = model.parts.iter().map(|part| part.mesh.data().normals.len()).collect::<Vec<_>>();
    assert_eq!(normals, [3, 0]);
    assert_eq!(model.parts[1].mesh.triangle_count(), 2);
}

#[test]
fn corners_are_shared_where_all_attributes_are() {
    let grid = "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n";
    let model = obj(format!("{SQUARE}{grid}")).unwrap();
    assert_eq!(model.parts[0].mesh.data().positions.len(), 5);
}

#[test]
fn far_models_keep_their_shape() {
    let far = |x: f64, y: f64| format!("v {} {} 250.5\n", 4_500_000.0 + x, 5_400_000.0 + y);
    let text = [far(0.0, 0.0), far(0.01, 0.0), far(0.01, 0.01), far(0.0, 0.01)].concat();
    let model = obj(text + "f 1 2 3\nusemtl other\nf 1 3 4\n").unwrap();
    assert!((area(&model) - 1e-4).abs() < 1e-9, "{}", area(&model));
    let shared = model.parts[0].mesh.corners(0)[0];
    assert_eq!(shared, model.parts[1].mesh.corners(0)[0], "parts share an edge exactly");

    let mut scene = Scene::new("far");
    let node = model.insert_into(&mut scene);
    let placed = node.transform.point(shared);
    assert!((placed - DVec3::new(4_500_000.0, 5_400_000.0, 250.5)).length() < 1e-8);
}

#[test]
fn a_model_becomes_a_group_of_its_parts() {
    let files = Files::new()
        .with("m.obj", format!("mtllib m.mtl\n{SQUARE}f 1 2 3\nusemtl red\nf 1 3 4\n"))
        .with("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl unused\nmap_Kd none.png\n");
    let model = files.load("m.obj").unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let mut scene = Scene::new("s");
    scene.add_material(lancer_core::scene::Material::named("before"));
    let node = model.insert_into(&mut scene);
    let group = scene.add(node);
    let children = &scene.node(group).children;
    assert_eq!(scene.node(group).name, "m");
    assert_eq!(scene.node(children[0]).material, None, "inherits");
    let red = scene.material(scene.node(children[1]).material.unwrap());
    assert_eq!((red.name.as_str(), &red.color), ("red", &Texture::Solid(Rgb::new(1.0, 0.0, 0.0))));
    assert!(matches!(scene.node(children[1]).shape, Some(Shape::Mesh(_))));
}

#[test]
fn materials_change_within_an_object_and_come_back() {
    let model =
        obj(format!("{SQUARE}o a\nusemtl x\nf 1 2 3\nusemtl Material #2\nf 1 3 4\nusemtl x\nf 1 2 4\n"))
            .unwrap();
    let parts =
        model.parts.iter().map(|part| (part.name.as_str(), part.mesh.triangle_count())).collect::<Vec<_>>();
    assert_eq!(parts, [("x", 2), ("Material #2", 1)]);
}

#[test]
fn a_polygon_too_large_to_clip_is_an_error() {
    let corners = 20_000;
    let zigzag = (0..corners).map(|i| format!("v {i} {} 0\n", i % 2)).collect::<String>();
    let face = (1..=corners).map(|i| format!(" {i}")).collect::<String>();
    assert!(error_of(obj(format!("{zigzag}f{face}\n"))).contains("has 20000 corners"));
}

#[test]
fn memory_is_bounded() {
    let obj = format!("{SQUARE}{}", "f 1 2 3 4\n".repeat(100));
    let ply = PLY_SQUARE.replace("face 1", "face 100") + &"4 0 1 2 3\n".repeat(99);
    let files = Files::new().with("m.obj", obj).with("m.ply", ply);
    let limits = |memory| Limits { memory, ..Limits::default() };
    for (name, expected) in [
        ("m.obj", ":40:1: from here on more than 5000 bytes of memory are needed"),
        ("m.ply", ": more than 5000 bytes of memory are needed"),
    ] {
        let error = files.load_within(name, limits(5000)).unwrap_err();
        assert_eq!(first_line(&error), format!("{name}{expected}"));
        assert!(error.to_string().contains("hint: --limit memory=N allows more"));
        assert!(files.load_within(name, limits(50_000)).is_ok());
    }
    let error = error_of(files.load_within("m.ply", limits(50)));
    assert_eq!(error, "m.ply: more than 50 bytes of memory are needed");
}

#[test]
fn triangles_are_bounded() {
    let files = Files::new().with("m.obj", format!("{SQUARE}{}", "f 1 2 3 4\n".repeat(10)));
    let error = error_of(files.load_within("m.obj", Limits { triangles: 9, ..Limits::default() }));
    assert_eq!(error, "m.obj:9:1: from here on there are more than 9 triangles");
}

// Material libraries and textures

/// A 24-bit BMP of one blue pixel.
fn blue_bmp() -> Vec<u8> {
    let mut bytes = b"BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0".to_vec();
    bytes.extend([0; 24]);
    bytes.extend([255, 0, 0, 0]);
    bytes
}

fn textured(mtl: &str) -> Files {
    Files::new()
        .with("m.obj", format!("mtllib m.mtl\n{SQUARE}usemtl t\nf 1 2 3\n"))
        .with("m.mtl", format!("newmtl t\nKd 0 0.5 0\nmap_Kd {mtl}\n"))
}

#[test]
fn textures_are_found_beside_the_library() {
    for name in [
        "blue sky.bmp",
        ".\\blue sky.bmp",
        "-s 1 1 1 blue sky.bmp",
        "D:\\art\\blue sky.bmp",
        "/art/blue sky.bmp",
    ] {
        let model = textured(name).with("blue sky.bmp", blue_bmp()).load("m.obj").unwrap();
        let Texture::Image(image) = &model.materials[0].color else { panic!("{name}: {:?}", model.warnings) };
        assert_eq!((image.width(), image.height()), (1, 1));
        assert_eq!(model.materials[0].diffuse, Rgb::new(0.0, 0.5, 0.0));
    }
}

#[test]
fn a_texture_of_many_names_is_one() {
    let files = Files::new()
        .with("m.obj", format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"))
        .with("m.mtl", "newmtl a\nmap_Kd blue.bmp\nnewmtl b\nmap_Kd ../models/blue.bmp\n")
        .with("blue.bmp", blue_bmp());
    let model = files.load("m.obj").unwrap();
    let images = model.materials.iter().map(|material| match &material.color {
        Texture::Image(image) => Arc::as_ptr(image),
        other => panic!("{other:?}"),
    });
    let images = images.collect::<Vec<_>>();
    assert_eq!(images.len(), 2);
    assert_eq!(images[0], images[1]);
}

#[test]
fn options_of_a_map_move_the_texture_coordinates_of_its_material_alone() {
    let files = Files::new()
        .with(
            "m.obj",
            format!("mtllib m.mtl\n{SQUARE}vt 0.5 0.25\nusemtl t\nf 1/1 2/1 3/1\nusemtl u\nf 1/1 2/1 3/1\n"),
        )
        .with("m.mtl", "newmtl t\nmap_Kd -s 2 4 -o 0.5 -1 blue.bmp\nnewmtl u\nmap_Kd blue.bmp\n")
        .with("blue.bmp", blue_bmp());
    let model = files.load("m.obj").unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!(model.parts[0].mesh.data().uvs, [[1.5, 0.0]; 3]);
    assert_eq!(model.parts[1].mesh.data().uvs, [[0.5, 0.25]; 3]);
}

#[test]
fn a_missing_texture_leaves_the_color_and_one_warning() {
    let model = textured("none.png").load("m.obj").unwrap();
    assert_eq!(model.materials[0].color, Texture::Solid(Rgb::new(0.0, 0.5, 0.0)));
    assert_eq!(model.warnings.len(), 1);
    assert!(model.warnings[0].message.contains("none.png"));
}

#[test]
fn a_missing_library_is_one_warning_that_names_it() {
    let text = format!("mtllib my lib.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    let model = obj(text).unwrap();
    assert_eq!(model.warnings.len(), 1);
    assert!(
        first_line(&model.warnings[0])
            .starts_with("model.obj:1:8: material library: cannot open `my lib.mtl`")
    );
    assert!(model.parts.iter().all(|part| part.material.is_none()));
}

#[test]
fn undefined_materials_are_one_warning_that_names_them() {
    let model = obj(format!("{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n")).unwrap();
    assert_eq!(model.warnings.len(), 1);
    assert!(model.warnings[0].message.contains("`a`, `b`"));
}

#[test]
fn nothing_outside_of_the_directory_is_opened() {
    let outside = Files::new().with("m.obj", format!("{SQUARE}usemtl t\nf 1 2 3\n"));
    let secret = outside.0.path().join("secret.mtl");
    fs::write(&secret, "newmtl t\nKd 1 0 0\n").unwrap();
    let mut references =
        vec!["../secret.mtl".to_owned(), "..\\secret.mtl".to_owned(), secret.display().to_string()];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, outside.path("link.mtl")).unwrap();
        references.push("link.mtl".to_owned());
    }
    for reference in references {
        let text = format!("mtllib {reference}\n{SQUARE}usemtl t\nf 1 2 3\n");
        fs::write(outside.path("m.obj"), text).unwrap();
        let model = outside.load("m.obj").unwrap();
        assert!(model.materials.is_empty(), "{reference}");
        assert!(model.warnings[0].message.contains("outside"), "{reference}: {:?}", model.warnings);
    }

    let texture = textured("../secret.bmp");
    fs::write(texture.0.path().join("secret.bmp"), blue_bmp()).unwrap();
    let model = texture.load("m.obj").unwrap();
    assert!(matches!(model.materials[0].color, Texture::Solid(_)));
    assert!(model.warnings[0].message.contains("outside"));
}

// PLY

const PLY_SQUARE: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n\
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
fn lying_counts_cost_neither_time_nor_memory() {
    let begun = Instant::now();
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
    assert!(begun.elapsed() < Duration::from_secs(1));
}

// Any bytes

proptest! {
    #[test]
    fn any_bytes_are_a_model_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let files = Files::new().with("a.obj", &bytes).with("a.ply", &bytes);
        let _ = (files.load("a.obj"), files.load("a.ply"));
    }

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
