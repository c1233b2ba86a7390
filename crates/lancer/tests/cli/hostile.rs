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
