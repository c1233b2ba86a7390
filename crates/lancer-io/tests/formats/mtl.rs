//! MTL: libraries of materials and their textures.

use crate::common::{Files, first_line};
use crate::obj::{SQUARE, obj};
use lancer_core::Rgb;
use lancer_core::scene::{Texture, Wrap};
use std::fs;
use std::sync::Arc;

/// A 24-bit BMP of one blue pixel.
pub(crate) fn blue_bmp() -> Vec<u8> {
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
fn materials_change_within_an_object_and_come_back() {
    let model =
        obj(format!("{SQUARE}o a\nusemtl x\nf 1 2 3\nusemtl Material #2\nf 1 3 4\nusemtl x\nf 1 2 4\n"))
            .unwrap();
    let parts =
        model.parts.iter().map(|part| (part.name.as_str(), part.mesh.triangle_count())).collect::<Vec<_>>();
    assert_eq!(parts, [("x", 2), ("Material #2", 1)]);
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
        let Texture::Image { image, .. } = &model.materials[0].color else {
            panic!("{name}: {:?}", model.warnings)
        };
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
        Texture::Image { image, .. } => Arc::as_ptr(image),
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
fn a_clamped_map_ends_in_its_outermost_pixels() {
    let wrap_of = |map: &str| {
        let model = textured(map).with("blue.bmp", blue_bmp()).load("m.obj").unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let Texture::Image { wrap, .. } = model.materials[0].color else { panic!("{map}") };
        wrap
    };
    assert_eq!(wrap_of("-clamp on blue.bmp"), [Wrap::Clamp; 2]);
    assert_eq!(wrap_of("-clamp off blue.bmp"), [Wrap::Repeat; 2]);
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
    let files = Files::new().with("m.obj", format!("{SQUARE}usemtl t\nf 1 2 3\n"));
    let secret = files.outside("secret.mtl");
    fs::write(&secret, "newmtl t\nKd 1 0 0\n").unwrap();
    let mut references =
        vec!["../secret.mtl".to_owned(), "..\\secret.mtl".to_owned(), secret.display().to_string()];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, files.path("link.mtl")).unwrap();
        references.push("link.mtl".to_owned());
    }
    for reference in references {
        let text = format!("mtllib {reference}\n{SQUARE}usemtl t\nf 1 2 3\n");
        fs::write(files.path("m.obj"), text).unwrap();
        let model = files.load("m.obj").unwrap();
        assert!(model.materials.is_empty(), "{reference}");
        assert!(model.warnings[0].message.contains("outside"), "{reference}: {:?}", model.warnings);
    }

    let texture = textured("../secret.bmp");
    fs::write(texture.outside("secret.bmp"), blue_bmp()).unwrap();
    let model = texture.load("m.obj").unwrap();
    assert!(matches!(model.materials[0].color, Texture::Solid(_)));
    assert!(model.warnings[0].message.contains("outside"));
}
