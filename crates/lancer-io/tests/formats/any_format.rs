//! What holds for every format: names of files, bounds, and how a model becomes part of a scene.

use crate::common::{Files, area, error_of, first_line};
use crate::obj::{SQUARE, obj};
use crate::ply::PLY_SQUARE;
use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Scene, Shape, Texture};
use lancer_io::limits::Limits;
use proptest::prelude::*;

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

proptest! {
    #[test]
    fn any_bytes_are_a_model_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let files = Files::new().with("a.obj", &bytes).with("a.ply", &bytes);
        let _ = (files.load("a.obj"), files.load("a.ply"));
    }
}
