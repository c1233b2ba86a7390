//! Packed models.

use crate::common::{Files, error_of, load, mutated, mutations, warnings_of};
use crate::mtl::blue_bmp;
use flate2::Compression;
use flate2::write::GzEncoder;
use lancer_core::Rgb;
use lancer_core::geometry::DVec2;
use lancer_core::scene::Texture;
use lancer_io::limits::Limits;
use lancer_io::model::ModelOptions;
use lancer_io::resolver::Resolver;
use proptest::prelude::*;
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const OBJ: &str = "mtllib parts/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
const MTL: &str = "newmtl red\nKd 1 0 0\n";

fn gzip(bytes: impl AsRef<[u8]>) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes.as_ref()).unwrap();
    encoder.finish().unwrap()
}

pub(crate) fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

fn is_red(model: &lancer_io::model::Model) -> bool {
    model.materials[0].color == Texture::Solid(Rgb::new(1.0, 0.0, 0.0))
}

#[test]
fn gzip_files_are_read_as_what_they_hold_with_what_lies_beside_them() {
    let files = Files::new().with("a.obj.gz", gzip(OBJ)).with("parts/a.mtl", MTL);
    let model = files.load("a.obj.gz").unwrap();
    assert!(is_red(&model) && model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!(model.name, "a");
    // Several members in a row are one file.
    let halves = [gzip(&OBJ[..20]), gzip(&OBJ[20..])].concat();
    assert!(is_red(&files.with("b.OBJ.GZ", halves).load("b.OBJ.GZ").unwrap()));
}

#[test]
fn what_lies_beside_a_gzip_file_may_be_larger_than_it_may_unpack_to() {
    let padded = MTL.to_owned() + &"# padding\n".repeat(2 << 20);
    let files = Files::new().with("a.obj.gz", gzip(OBJ)).with("parts/a.mtl", padded);
    assert!(is_red(&files.load("a.obj.gz").unwrap()));
}

#[test]
fn the_format_may_be_in_the_header() {
    let mut encoder = flate2::GzBuilder::new().filename("a.off").write(Vec::new(), Compression::fast());
    encoder.write_all(b"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
    assert_eq!(load("model.gz", encoder.finish().unwrap()).unwrap().triangle_count(), 1);
    let error = load("model.gz", gzip(OBJ)).unwrap_err().to_string();
    assert!(error.contains("does not say which format it holds") && error.contains(".ply.gz"), "{error}");
}

#[test]
fn places_are_those_in_the_content_of_the_file_that_there_is() {
    assert_eq!(error_of(load("a.obj.gz", gzip("v 0 0 x\n"))), "a.obj.gz:1:7: `x` is not a finite number");
    let missing = load("a.obj.gz", gzip(OBJ)).unwrap();
    assert!(
        warnings_of(&missing)[0].starts_with("a.obj.gz:1:8: material library: "),
        "{:?}",
        missing.warnings
    );
}

#[test]
fn the_model_of_an_archive_finds_its_files_in_it() {
    let archive = zip(&[
        ("readme.txt", b"hello"),
        ("__MACOSX/._a.obj", b"x"),
        ("chair/a.obj", OBJ.as_bytes()),
        ("chair/parts/a.mtl", MTL.as_bytes()),
    ]);
    let model = load("chair.zip", archive).unwrap();
    assert!(is_red(&model) && model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!(
        error_of(load("a.zip", zip(&[("b/a.obj", b"f 1 2 3")]))),
        "a.zip/b/a.obj:1:3: vertex 1 is used, but there are none"
    );
}

#[test]
fn textures_of_one_name_in_two_archives_of_a_scene_are_two() {
    let blue = blue_bmp();
    let mut red = blue.clone();
    red[54..57].copy_from_slice(&[0, 0, 255]);
    let archive = |texture: &[u8]| {
        let mtl = b"newmtl red\nmap_Kd t.bmp\n";
        zip(&[("a.obj", OBJ.as_bytes()), ("parts/a.mtl", mtl), ("parts/t.bmp", texture)])
    };
    let files = Files::new().with("blue.zip", archive(&blue)).with("red.zip", archive(&red));
    let resolver = Resolver::for_file(&files.path("blue.zip"), false, Limits::default());
    let color = |name: &str| {
        let model = lancer_io::model::load(&files.path(name), &resolver, &ModelOptions::default()).unwrap();
        model.materials[0].color.color_at(DVec2::ZERO)
    };
    assert_eq!(color("blue.zip"), Rgb::new(0.0, 0.0, 1.0));
    assert_eq!(color("red.zip"), Rgb::new(1.0, 0.0, 0.0));
}

#[test]
fn archives_of_no_model_or_several_are_refused_with_what_they_hold() {
    assert_eq!(error_of(load("a.zip", zip(&[("readme.txt", b"")]))), "a.zip: is an archive without a model");
    let two = zip(&[("a.obj", OBJ.as_bytes()), ("b/c.stl", b"")]);
    assert_eq!(error_of(load("a.zip", two)), "a.zip: is an archive of 2 models: `a.obj`, `b/c.stl`");
    assert_eq!(
        error_of(load("a.zip", zip(&[("b.zip", b"")]))),
        "a.zip/b.zip: is packed twice, which is not read"
    );
}

#[test]
fn nothing_outside_of_an_archive_is_opened() {
    for library in ["../outside.mtl", "/etc/passwd", "..\\..\\outside.mtl", "parts/../../outside.mtl"] {
        let text = OBJ.replace("parts/a.mtl", library);
        let files = Files::new().with("outside.mtl", MTL).with("a.zip", zip(&[("a.obj", text.as_bytes())]));
        let warning = warnings_of(&files.load("a.zip").unwrap()).remove(0);
        assert!(warning.contains("lies outside of the archive"), "{warning}");
    }
    // Names that lead out are names like others: nothing is written.
    let evil = zip(&[("../../evil.obj", OBJ.as_bytes())]);
    let files = Files::new().with("a.zip", evil);
    let _ = files.load("a.zip");
    assert!(!files.path("../../evil.obj").exists() && !files.path("../evil.obj").exists());
}

#[test]
fn bombs_are_refused() {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let zeros = vec![b'#'; 1 << 20];
    (0..100).for_each(|_| encoder.write_all(&zeros).unwrap());
    let bomb = encoder.finish().unwrap();
    assert!(bomb.len() < 200_000);
    let error = error_of(load("a.obj.gz", &bomb));
    assert!(error.starts_with("a.obj.gz: unpacks to more than 16777216 bytes, from "), "{error}");
    let limits = Limits { file_bytes: 100, ..Limits::default() };
    let files = Files::new().with("a.obj.gz", gzip(OBJ.repeat(100)));
    assert!(error_of(files.load_within("a.obj.gz", limits)).contains("a.obj.gz: "));
}

#[test]
fn a_small_packed_file_has_no_right_to_a_large_model() {
    // Each unpacks to less than 16 MiB, and would be millions of triangles or nodes.
    let strip = [0, 1, 2].repeat(4 << 20);
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                  property float z\nelement tristrips 1\nproperty list uint uchar vertex_indices\nend_header\n";
    let vertices = [[0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices = vertices.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    let count = (strip.len() as u32).to_le_bytes();
    let ply = [header.as_bytes(), &vertices, &count, &strip].concat();
    let nodes = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{{}}{}]}}", ",{}".repeat(4 << 20));
    for (name, bytes) in [("a.ply", ply), ("a.gltf", nodes.into_bytes())] {
        let error = load(&format!("{name}.gz"), gzip(&bytes)).unwrap_err().to_string();
        assert!(error.contains("more than 268435456 bytes of memory are needed"), "{error}");
        assert!(error.contains("unpack it first"), "{error}");
    }
}

#[test]
fn broken_files_are_told() {
    let whole = gzip(OBJ);
    assert!(error_of(load("a.obj.gz", &whole[..whole.len() / 2])).starts_with("a.obj.gz: is broken: "));
    assert!(error_of(load("a.obj.gz", "v 0 0 0")).starts_with("a.obj.gz: is broken: "));
    assert!(error_of(load("a.zip", "v 0 0 0")).starts_with("a.zip: is no zip archive that can be read: "));
}

proptest! {
    #[test]
    fn no_change_of_bytes_makes_it_panic(mutations in mutations(), cut: bool, is_zip: bool) {
        let (name, valid) = if is_zip {
            ("a.zip", zip(&[("a.obj", OBJ.as_bytes()), ("parts/a.mtl", MTL.as_bytes())]))
        } else {
            ("a.obj.gz", gzip(OBJ))
        };
        if let Ok(model) = load(name, mutated(&valid, &mutations, cut)) {
            prop_assert!(model.triangle_count() > 0);
        }
    }
}
