//! Models made to do harm: each is a fault with a place, in 512 MB, and never the program's end.

use crate::sandbox::{Sandbox, text};
use std::process::Command;

/// What `check` says of a file, in an address space of 512 MB, and its exit code.
fn check(sandbox: &Sandbox, name: &str) -> (Option<i32>, String) {
    let limited = "ulimit -v 524288 && exec \"$0\" check \"$1\"";
    let output = Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_lancer"), name])
        .current_dir(sandbox.path(""))
        .env_remove("RUST_BACKTRACE")
        // Each thread's own pool of memory would be counted whole.
        .env("MALLOC_ARENA_MAX", "1")
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .unwrap();
    (output.status.code(), text(&output.stderr))
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn ply_of(encoding: &str, elements: &str, body: &[u8]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {encoding} 1.0\n{elements}end_header\n").into_bytes();
    bytes.extend(body);
    bytes
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const LIST: &str = "property list uint uint vertex_indices\n";

#[test]
fn hostile_models_are_faults_in_little_memory() {
    let sandbox = Sandbox::new();
    let zigzag = (0..20_000).map(|i| format!("v {i} {} 0\n", i % 2)).collect::<String>();
    let polygon = format!("f{}\n", (1..=20_000).map(|i| format!(" {i}")).collect::<String>());
    let three = format!("element vertex 3\n{XYZ}element face 1\n{LIST}");
    let corners = [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f32::NAN, 0.0].map(f32::to_le_bytes).concat();
    for (name, bytes, expected) in [
        ("nan.obj", format!("{SQUARE}v nan 0 0\nf 1 2 5\n").into_bytes(), "nan.obj:5:3"),
        ("infinite.obj", format!("{SQUARE}v 1e999 0 0\nf 1 2 5\n").into_bytes(), "infinite.obj:5:3"),
        ("range.obj", format!("{SQUARE}f 1 2 4000000000\n").into_bytes(), "range.obj:5:7"),
        ("negative.obj", b"f -1 -2 -3\n".to_vec(), "negative.obj:1:3"),
        ("truncated.obj", format!("{SQUARE}f 1 2 3\nv 1 2").into_bytes(), "truncated.obj:6:1"),
        ("polygons.obj", (zigzag + &polygon).into_bytes(), "is concave and has 20000 corners"),
        ("faults.obj", "f 1 2 3\nv x\n".repeat(300_000).into_bytes(), "more errors"),
        ("line.obj", vec![b'f'; 20 << 20], "ffff...` is no statement"),
        ("newlines.obj", vec![b'\n'; 20 << 20], "holds no face"),
        (
            "vertices.ply",
            ply_of("binary_little_endian", &format!("element vertex 4294967295\n{XYZ}"), &[0; 64]),
            "too short for the 4294967295 elements `vertex`",
        ),
        (
            "faces.ply",
            ply_of("binary_big_endian", &format!("element face 4294967295\n{LIST}"), &[0xff; 64]),
            "too short for the 4294967295 elements `face`",
        ),
        (
            "text.ply",
            ply_of("ascii", &format!("element vertex 99999999999\n{XYZ}"), b"0 0 0\n"),
            "too short for the 99999999999 elements `vertex`",
        ),
        (
            "list.ply",
            ply_of("binary_little_endian", &format!("element face 1\n{LIST}"), &[0xff; 64]),
            "a list cannot have 4294967295 numbers here",
        ),
        (
            "nan.ply",
            ply_of("binary_little_endian", &three, &[&corners[..], &[0; 16]].concat()),
            "NaN is not a finite number",
        ),
        ("nothing.ply", ply_of("ascii", "element nothing 18446744073709551615\n", b""), "no face to draw"),
        ("header.ply", [&b"ply\n"[..], &b"comment x\n".repeat(1 << 20)].concat(), "the header does not end"),
    ] {
        sandbox.write(name, bytes);
        let (code, told) = check(&sandbox, name);
        assert_eq!(code, Some(3), "{name}: {told}");
        assert!(told.contains(expected), "{name}: {told}");
        assert!(told.len() < 100_000, "{name}: {} bytes of messages", told.len());
    }
}

/// A glTF file of one triangle, with some text in it replaced.
fn gltf_with(old: &str, new: &str) -> Vec<u8> {
    const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    assert!(TRIANGLE.contains(old), "{old}");
    TRIANGLE.replace(old, new).into_bytes()
}

fn stl_of(count: u32, triangle: [f32; 12]) -> Vec<u8> {
    let triangle = triangle.map(f32::to_le_bytes);
    [&[0; 80][..], &count.to_le_bytes(), triangle.as_flattened(), &[0; 2]].concat()
}

#[test]
fn every_other_format_holds_as_well() {
    let sandbox = Sandbox::new();
    sandbox.write("secret.bin", [0; 36]);
    let inside = sandbox.path("inside");
    std::fs::create_dir(&inside).unwrap();
    let off = |body: &str| format!("OFF\n3 1 0\n0 0 0\n1 0 0\n{body}").into_bytes();
    let nodes = |nodes: &str| gltf_with(r#"[{"mesh":0}]"#, nodes);
    let uri = |uri: &str| gltf_with("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA", uri);
    for (name, bytes, expected) in [
        ("count.stl", stl_of(u32::MAX, [0.0; 12]), "ends after 1 of the 4294967295 triangles"),
        ("cut.stl", stl_of(1, [0.0; 12])[..100].to_vec(), "ends after 0 of the 1 triangles"),
        ("nan.stl", stl_of(1, [f32::NAN; 12]), "is not finite"),
        (
            "infinite.stl",
            b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 1e999 0".to_vec(),
            "infinite.stl:4:10: ",
        ),
        ("word.stl", [b"solid\n".to_vec(), vec![b'x'; 20 << 20]].concat(), "xxx...` is not expected here"),
        ("count.off", b"OFF\n4294967295 1 0\n".to_vec(), "too short for 4294967295 elements"),
        ("cut.off", off("0 1"), "cut.off:5:1: "),
        ("nan.off", off("0 nan 0\n3 0 1 2\n"), "nan.off:5:3: "),
        ("range.off", off("0 1 0\n3 0 1 4000000000\n"), "range.off:6:7: "),
        ("corners.off", off("0 1 0\n4000000000 0 1 2\n"), "the line ends before all corners"),
        (
            "word.off",
            [b"OFF\n".to_vec(), vec![b'1'; 20 << 20]].concat(),
            "111...` is not a number of elements",
        ),
        (
            "count.gltf",
            gltf_with(r#""count":3"#, r#""count":4294967295"#),
            "/accessors/0: 4294967295 elements",
        ),
        (
            "zeros.gltf",
            gltf_with(
                r#""bufferView":0,"componentType":5126,"count":3"#,
                r#""componentType":5126,"count":4294967295"#,
            ),
            "more than",
        ),
        (
            "length.gltf",
            gltf_with(r#""byteLength":36,"uri""#, r#""byteLength":4611686018427387904,"uri""#),
            "/buffers/0/byteLength",
        ),
        ("range.gltf", nodes(r#"[{"mesh":4000000000}]"#), "/nodes/0/mesh: is 4000000000"),
        ("cycle.gltf", nodes(r#"[{"mesh":0,"children":[1]},{"children":[0]}]"#), "the node is below itself"),
        (
            "parents.gltf",
            nodes(r#"[{"children":[2]},{"children":[2]},{"mesh":0}]"#),
            "is a child of node 0 already",
        ),
        ("nesting.gltf", [b"{\"extras\":".to_vec(), vec![b'['; 1 << 20]].concat(), "nesting.gltf:1:"),
        ("up.gltf", uri("../secret.bin"), "`../secret.bin` lies outside"),
        ("escaped.gltf", uri("%2e%2e/secret.bin"), "`../secret.bin` lies outside"),
        ("absolute.gltf", uri("/etc/passwd"), "`/etc/passwd` lies outside"),
        ("file.gltf", uri("file:///etc/passwd"), "`file:` URIs are not opened"),
        (
            "cut.glb",
            b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec(),
            "of the 4294967295 bytes that its header promises",
        ),
        ("cut.3mf", b"PK\x03\x04\0\0".to_vec(), "is no zip archive"),
        ("bomb.yaml", bomb(), "values, those of aliases included"),
        ("objects.yaml", doubled(24), "draws 16777216 objects, more than 1048576"),
        ("deep.yaml", vec![b'['; 1 << 20], "deep.yaml:1:"),
        ("texture.yaml", textured("huge.png"), "100000 x 100000 pixels are more than"),
        ("outside.yaml", textured("../secret.bin"), "`../secret.bin` lies outside"),
    ] {
        std::fs::write(inside.join("huge.png"), huge_png()).unwrap();
        std::fs::write(inside.join(name), bytes).unwrap();
        let (code, told) = check(&sandbox, &format!("inside/{name}"));
        assert_eq!(code, Some(3), "{name}: {told}");
        assert!(told.contains(expected), "{name}: {told}");
        assert!(told.len() < 100_000, "{name}: {} bytes of messages", told.len());
    }
}

/// Forty lists, each of which holds the one before it twice.
fn bomb() -> Vec<u8> {
    let lists = (1..40).map(|i| format!("a{i}: &a{i} [*a{0}, *a{0}]\n", i - 1));
    ("a0: &a0 1\n".to_owned() + &lists.collect::<String>()).into_bytes()
}

/// A cube that is placed twice as often with every level.
fn doubled(levels: u32) -> Vec<u8> {
    let asset = |i: u32| format!("  a{i}: {{children: [{{use: a{0}}}, {{use: a{0}}}]}}\n", i + 1);
    let assets = (0..levels).map(asset).collect::<String>();
    format!("format: 1\nassets:\n{assets}  a{levels}: {{shape: cube}}\nobjects: [{{use: a0}}]\n").into_bytes()
}

fn textured(image: &str) -> Vec<u8> {
    format!("format: 1\nobjects: [{{shape: cube, material: {{color: {{image: {image}}}}}}}]\n").into_bytes()
}

/// The header of a PNG of 100,000 x 100,000 pixels, and the beginning of its data.
fn huge_png() -> Vec<u8> {
    let size = 100_000_u32.to_be_bytes();
    let header = [&b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"[..], &size, &size, b"\x08\x02\0\0\0"].concat();
    [&header[..], b"\x27\x30\x9c\x9f", b"\0\0\0\x08IDAT\x78\xda\0\0\0\0\0\0\0\0\0\0"].concat()
}

#[test]
fn a_hostile_library_is_warnings() {
    let sandbox = Sandbox::new();
    sandbox.write("m.obj", format!("mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3\n"));
    for (library, expected) in [
        ("newmtl a\nKd nan 1 1\nNs 1e999\nd\nmap_Kd\n".to_owned(), "cannot be read"),
        ("Kd 1 1 1\n".repeat(500_000), "before the first newmtl"),
        ("newmtl a\nmap_Kd ../../../../etc/passwd\n".to_owned(), "outside"),
        ("newmtl a\nmap_Kd m.obj\n".to_owned(), "m.obj"),
    ] {
        sandbox.write("a.mtl", library);
        let (code, told) = check(&sandbox, "m.obj");
        assert_eq!(code, Some(0), "{told}");
        assert!(told.contains(expected), "{told}");
    }
}
