//! What is refused or told: faults and their places, lies, files outside.

use super::{data_uri, glb, gltf, square, square_bytes, with};
use crate::common::{Files, error_of, load, mutated, mutations, warnings_of};
use lancer_io::limits::Limits;
use proptest::prelude::*;
use serde_json::{Value, json};

#[test]
fn what_is_not_done_is_told_by_name() {
    let document = with(square(), "/extensionsUsed", json!(["KHR_materials_sheen", "KHR_texture_transform"]));
    let document = with(document, "/animations", json!([{}]));
    let document = with(document, "/nodes/0/skin", json!(0));
    let document = with(document, "/meshes/0/primitives/0/targets", json!([{"POSITION": 0}]));
    let document = with(document, "/meshes/0/primitives/0/material", json!(0));
    let document =
        with(document, "/materials", json!([{"emissiveFactor": [1, 0, 0], "normalTexture": {"index": 0}}]));
    let document = with(document, "/scenes/", json!({"nodes": []}));
    assert_eq!(
        warnings_of(&gltf(&document).unwrap()),
        [
            "a.gltf: /extensionsUsed/0: `KHR_materials_sheen` is passed over",
            "a.gltf: /scenes: of 2 scenes only 0 is drawn",
            "a.gltf: /animations: animations are not applied",
            "a.gltf: /nodes/0/skin: skins are not applied: the mesh is drawn as it is stored",
            "a.gltf: /materials/0: its emission is not drawn",
            "a.gltf: /materials/0: its normalTexture is not used",
            "a.gltf: /meshes/0/primitives/0/targets: morph targets are not applied",
        ]
    );
}

#[test]
fn what_draws_nothing_is_an_error_that_says_why() {
    let lines = with(square(), "/meshes/0/primitives/0/mode", json!(1));
    let error = gltf(&lines).unwrap_err().to_string();
    assert!(error.contains("holds no node with a mesh to draw"), "{error}");
    assert!(error.contains("points and lines are not drawn"), "{error}");
    assert!(
        error_of(gltf(&json!({"asset": {"version": "2.0"}}))).ends_with("holds no node with a mesh to draw")
    );
}

#[test]
fn faults_are_told_with_their_places_in_the_document() {
    let square = square();
    let huge = 4_000_000_000_u64;
    let view = json!({"buffer": 0, "byteOffset": u64::MAX, "byteLength": 48});
    let stride = json!({"buffer": 0, "byteLength": 48, "byteStride": 4});
    let sparse =
        json!({"count": 5, "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}});
    for (pointer, value, expected) in [
        ("/asset/version", json!("1.0"), "/asset/version: is `1.0`; 2.0 is read"),
        ("/asset", json!({}), "/asset/version: is missing, so this is no glTF file"),
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            "/extensionsRequired/0: the file requires `KHR_draco_mesh_compression`, which is not read",
        ),
        (
            "/extensionsRequired",
            json!(["EXT_meshopt_compression"]),
            "/extensionsRequired/0: the file requires `EXT_meshopt_compression`, which is not read",
        ),
        ("/scene", json!(3), "/scene: is 3, but there are only 1 scenes"),
        ("/scenes/0/nodes/0", json!(3), "/scenes/0/nodes/0: is 3, but there are only 1 nodes"),
        ("/scenes/0/nodes", json!([0, 0]), "/scenes/0/nodes/1: node 0 is in the list twice"),
        ("/nodes/0/mesh", json!(1), "/nodes/0/mesh: is 1, but there are only 1 meshes"),
        ("/nodes/0/children", json!([9]), "/nodes/0/children/0: is 9, but there are only 1 nodes"),
        ("/nodes/0/children", json!([0]), "/nodes/0/children: the node is below itself"),
        ("/nodes/0/rotation", json!([0, 0, 0, 0]), "/nodes/0/rotation: is no quaternion of a rotation"),
        (
            "/nodes/0/matrix",
            json!(vec![1; 16]),
            "/nodes/0/matrix: its last row is not 0, 0, 0, 1, so it is no affine transform",
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(7),
            "/meshes/0/primitives/0/attributes/POSITION: is 7, but there are only 3 accessors",
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(1),
            "/meshes/0/primitives/0/attributes/POSITION: has 2 numbers for a vertex",
        ),
        (
            "/meshes/0/primitives/0/attributes/NORMAL",
            json!(2),
            "/meshes/0/primitives/0/attributes/NORMAL: has 1 numbers for a vertex",
        ),
        (
            "/meshes/0/primitives/0/indices",
            json!(0),
            "/meshes/0/primitives/0/indices: indices are unsigned whole numbers, one by one",
        ),
        ("/meshes/0/primitives/0/mode", json!(7), "/meshes/0/primitives/0/mode: 7 is no mode of primitives"),
        (
            "/meshes/0/primitives/0/material",
            json!(0),
            "/meshes/0/primitives/0/material: is 0, but there are no materials",
        ),
        ("/meshes/0/primitives/0/extensions", json!({"KHR_draco_mesh_compression": {}}), ""),
        (
            "/accessors/0/count",
            json!(huge),
            "/accessors/0: 4000000000 elements from byte 0 on are not within the view's 48 bytes",
        ),
        (
            "/accessors/0/count",
            json!(u64::MAX),
            "/accessors/0: 18446744073709551615 elements from byte 0 on are not within the view's 48 bytes",
        ),
        (
            "/accessors/0/count",
            json!(3),
            "/meshes/0/primitives/0/indices: entry 5 is 3, but there are only 3 vertices",
        ),
        (
            "/accessors/0/byteOffset",
            json!(1),
            "/accessors/0: 4 elements from byte 1 on are not within the view's 48 bytes",
        ),
        ("/accessors/0/componentType", json!(5124), "/accessors/0/componentType: 5124 is no type of numbers"),
        ("/accessors/0/type", json!("MAT4"), "/accessors/0/type: `MAT4` is not read here"),
        ("/accessors/0/sparse", sparse, "/accessors/0/sparse: replaces 5 of 4 elements"),
        ("/bufferViews/0/buffer", json!(1), "/bufferViews/0/buffer: is 1, but there are only 1 buffers"),
        (
            "/bufferViews/0/byteLength",
            json!(999),
            "/bufferViews/0: 999 bytes from 0 on are not within the buffer's 92",
        ),
        (
            "/bufferViews/0",
            view,
            "/bufferViews/0: 48 bytes from 18446744073709551615 on are not within the buffer's 92",
        ),
        ("/bufferViews/0", stride, "/accessors/0: elements of 12 bytes are only 4 bytes apart"),
        (
            "/bufferViews/0/extensions",
            json!({"EXT_meshopt_compression": {}}),
            "/bufferViews/0: is compressed with EXT_meshopt_compression, which is not read",
        ),
        ("/buffers/0/byteLength", json!(93), "/buffers/0/byteLength: is 93 long, but there are 92 bytes"),
        (
            "/buffers/0/uri",
            json!("gone.bin"),
            "/buffers/0/uri: cannot open `gone.bin`: no such file or directory",
        ),
        ("/buffers/0/uri", json!("file:///etc/passwd"), "/buffers/0/uri: `file:` URIs are not opened"),
        ("/buffers/0/uri", json!("data:,"), "/buffers/0/byteLength: is 92 long, but there are 0 bytes"),
        (
            "/buffers/0",
            json!({"byteLength": 92}),
            "/buffers/0: has no uri, and the file has no binary chunk for it",
        ),
    ] {
        let result = gltf(&with(square.clone(), pointer, value));
        if expected.is_empty() {
            assert_eq!(result.unwrap().warnings.len(), 1, "{pointer}");
            continue;
        }
        assert_eq!(error_of(result), format!("a.gltf: {expected}"), "{pointer}");
    }
}

#[test]
fn json_faults_are_told_by_line_and_column() {
    let error =
        load("a.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"nodes\": [{\"mesh\": \"x\"}]}").unwrap_err();
    assert!(error.to_string().contains("a.gltf:2:"), "{error}");
    let told = "a value is the text \"x\", must be a whole number, 0 or above";
    assert!(error.to_string().contains(told), "{error}");
    let deep = format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"extras\": {}", "[".repeat(100_000));
    assert!(error_of(load("a.gltf", deep)).starts_with("a.gltf:1:"));
    assert!(error_of(load("a.gltf", "{")).contains("is no JSON: the file ends within an object"));
}

#[test]
fn older_documents_are_refused_by_their_version_however_it_is_written() {
    let version = |version: Value| error_of(gltf(&with(square(), "/asset/version", version)));
    assert_eq!(version(json!("1.0")), "a.gltf: /asset/version: is `1.0`; 2.0 is read");
    assert_eq!(version(json!(1)), "a.gltf: /asset/version: is `1`; 2.0 is read");
    assert_eq!(version(json!(1.1)), "a.gltf: /asset/version: is `1.1`; 2.0 is read");
    assert!(
        version(json!([2])).ends_with(": the version must be text, as \"2.0\""),
        "{}",
        version(json!([2]))
    );
    assert_eq!(
        version(json!("x".repeat(1000))).len(),
        "a.gltf: /asset/version: is ``; 2.0 is read".len() + 83
    );
}

#[test]
fn glb_files_with_false_lengths_are_refused() {
    let whole = glb(&square(), None);
    let changed = |at: usize, bytes: [u8; 4]| {
        let mut file = whole.clone();
        file[at..at + 4].copy_from_slice(&bytes);
        error_of(load("a.glb", file))
    };
    let all = whole.len();
    assert_eq!(changed(4, 1_u32.to_le_bytes()), "a.glb: is a GLB file of version 1; 2 is read");
    assert_eq!(
        changed(8, u32::MAX.to_le_bytes()),
        format!("a.glb: has {all} of the 4294967295 bytes that its header promises")
    );
    assert_eq!(
        changed(12, u32::MAX.to_le_bytes()),
        format!("a.glb: the chunk at byte 12 is 4294967295 bytes long, but only {} follow", all - 20)
    );
    assert_eq!(changed(16, *b"BIN\0"), "a.glb: has no JSON chunk");
    assert_eq!(error_of(load("a.glb", &whole[..9])), "a.glb: ends in the header of a GLB file");
}

#[test]
fn small_files_do_not_fill_the_memory() {
    // A thousand primitives of one array, each with other coordinates lest they be one mesh: 100 MB of triangles
    // from 100 kB.
    let count = 100_000_usize;
    let bytes = vec![0_u8; count];
    let document = with(square(), "/buffers/", json!({"uri": data_uri(&bytes), "byteLength": count}));
    let document = with(document, "/bufferViews/", json!({"buffer": 1, "byteLength": count}));
    let accessor = json!({"bufferView": 3, "componentType": 5121, "count": count, "type": "SCALAR"});
    let document = with(
        document,
        "/accessors",
        json!(
            std::iter::once(square()["accessors"][0].clone())
                .chain(std::iter::repeat_n(accessor, 1000))
                .collect::<Vec<_>>()
        ),
    );
    let primitives =
        (1..=1000).map(|index| json!({"attributes": {"POSITION": 0}, "indices": index, "mode": 5}));
    let document = with(document, "/meshes/0/primitives", Value::Array(primitives.collect()));
    let error = error_of(gltf(&document));
    assert!(error.ends_with("from here on more triangles are drawn than the file has bytes for"), "{error}");

    // An array of four thousand million zeros that no bytes stand for.
    let accessor = json!({"componentType": 5126, "count": 4_000_000_000_u64, "type": "VEC3"});
    let zeros = with(square(), "/accessors/0", accessor);
    let zeros = with(zeros, "/meshes/0/primitives/0", json!({"attributes": {"POSITION": 0}}));
    let error = error_of(gltf(&zeros));
    assert!(error.contains("more than") || error.contains("than the file has bytes for"), "{error}");
}

#[test]
fn buffers_are_bounded_in_all_and_a_file_of_several_is_held_once() {
    let bytes = [square_bytes(), vec![0; 5000]].concat();
    let buffer = |uri: &str| json!({"uri": uri, "byteLength": bytes.len()});
    let load = |uris: [&str; 3], file_bytes: usize| {
        let document = with(square(), "/buffers", json!(uris.map(buffer)));
        let document = with(document, "/bufferViews/1/buffer", json!(1));
        let document = with(document, "/bufferViews/2/buffer", json!(2)).to_string();
        let files =
            ["b.bin", "c.bin", "d.bin"].iter().fold(Files::new(), |files, name| files.with(name, &bytes));
        let limits = Limits { file_bytes: file_bytes as u64, ..Limits::default() };
        files.with("a.gltf", document).load_within("a.gltf", limits)
    };
    let three = ["b.bin", "c.bin", "d.bin"];
    assert_eq!(load(three, 3 * bytes.len()).unwrap().triangle_count(), 2);
    assert_eq!(load(["b.bin", "./b.bin", "../models/b.bin"], bytes.len()).unwrap().triangle_count(), 2);
    let most = 2 * bytes.len();
    let error = error_of(load(three, most));
    assert_eq!(error, format!("a.gltf: /buffers/2/uri: the buffers are longer than {most} bytes in all"));
}

#[test]
fn the_triangles_of_strips_are_held_against_the_memory_limit() {
    let bytes = [square_bytes(), vec![0; 60_000]].concat();
    let document = with(square(), "/buffers/0", json!({"uri": data_uri(&bytes), "byteLength": bytes.len()}));
    let document = with(document, "/bufferViews/2/byteLength", json!(60_000));
    let document = with(
        document,
        "/accessors/2",
        json!({"bufferView": 2, "componentType": 5121, "count": 60_000, "type": "SCALAR"}),
    );
    let document = with(document, "/meshes/0/primitives/0/mode", json!(5)).to_string();
    let within = |memory: u64| {
        let limits = Limits { memory, ..Limits::default() };
        Files::new().with("a.gltf", &document).load_within("a.gltf", limits)
    };
    assert!(within(6_000_000).is_ok());
    let error = error_of(within(5_000_000));
    let told = "a.gltf: /meshes/0/primitives/0: from here on more than 5000000 bytes of memory are needed";
    assert_eq!(error, told);
}

#[test]
fn files_outside_are_not_opened() {
    let inside = with(square(), "/buffers/0/uri", json!("../outside.bin"));
    let files = Files::new().with("../outside.bin", square_bytes()).with("a.gltf", inside.to_string());
    let error = error_of(files.load("a.gltf"));
    assert!(error.contains("`../outside.bin` lies outside of the scene's directory"), "{error}");
    for uri in ["%2e%2e/outside.bin", "..%5Coutside.bin", "/etc/passwd"] {
        let document = with(square(), "/buffers/0/uri", json!(uri));
        let files = files.path("b.gltf");
        std::fs::write(&files, document.to_string()).unwrap();
        let resolver = lancer_io::resolver::Resolver::for_file(&files, false, Limits::default());
        let error = lancer_io::model::load(&files, &resolver, &Default::default()).unwrap_err().to_string();
        assert!(error.contains("/buffers/0/uri: ") && error.contains("outside of"), "{error}");
    }
}

#[test]
#[cfg(unix)]
fn links_out_of_the_directory_are_not_followed() {
    let linked = with(square(), "/buffers/0/uri", json!("link.bin"));
    let files = Files::new().with("../outside.bin", square_bytes()).with("a.gltf", linked.to_string());
    std::os::unix::fs::symlink(files.path("../outside.bin"), files.path("link.bin")).unwrap();
    assert!(error_of(files.load("a.gltf")).contains("`link.bin` lies outside of the scene's directory"));
}

proptest! {
    #[test]
    fn no_change_of_bytes_makes_it_panic(mutations in mutations(), cut: bool, is_binary: bool) {
        let document = with(square(), "/materials", json!([{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}}]));
        let document = with(document, "/meshes/0/primitives/0/material", json!(0));
        let bytes = if is_binary {
            let square = square_bytes();
            glb(&with(document, "/buffers/0", json!({"byteLength": square.len()})), Some(&square))
        } else {
            document.to_string().into_bytes()
        };
        if let Ok(model) = load("a.gltf", mutated(&bytes, &mutations, cut)) {
            prop_assert!(model.triangle_count() > 0);
        }
    }
}
