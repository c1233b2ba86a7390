//! Buffers, accessors and primitives.

use super::{data_uri, glb, gltf, square, square_bytes, with};
use crate::common::{Files, error_of, load, warnings_of};
use lancer_core::geometry::DVec3;
use lancer_io::model::UpAxis;
use serde_json::json;

#[test]
fn buffers_in_uris_in_files_and_in_glb_give_one_mesh() {
    let inline = gltf(&square()).unwrap();
    let bytes = square_bytes();
    let in_file = with(square(), "/buffers/0/uri", json!("my%20square.bin"));
    let in_file =
        Files::new().with("my square.bin", &bytes).with("a.gltf", in_file.to_string()).load("a.gltf");
    let in_glb = with(square(), "/buffers/0", json!({"byteLength": bytes.len()}));
    let in_glb = load("a.glb", glb(&in_glb, Some(&bytes))).unwrap();
    for model in [&inline, &in_file.unwrap(), &in_glb] {
        assert_eq!(model.parts[0].mesh, inline.parts[0].mesh);
        assert_eq!((model.triangle_count(), model.up), (2, UpAxis::Y));
        assert!(model.parts[0].mesh.data().normals.is_empty(), "flat, as the specification asks");
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    }
    assert_eq!(inline.bounds().max, DVec3::new(2.0, 2.0, 0.0));
}

#[test]
fn strips_and_fans_are_wound_as_triangles_are() {
    let fan = with(square(), "/meshes/0/primitives/0", json!({"attributes": {"POSITION": 0}, "mode": 6}));
    let fan = gltf(&fan).unwrap();
    assert_eq!(fan.parts[0].mesh.data().positions[0], [2.0, 0.0, 0.0]);
    let order = [0_u8, 1, 3, 2];
    let strip = with(square(), "/buffers/", json!({"uri": data_uri(&order), "byteLength": 4}));
    let strip = with(strip, "/bufferViews/", json!({"buffer": 1, "byteLength": 4}));
    let strip = with(
        strip,
        "/accessors/",
        json!({"bufferView": 3, "componentType": 5121, "count": 4, "type": "SCALAR"}),
    );
    let primitive = json!({"attributes": {"POSITION": 0}, "indices": 3, "mode": 5});
    let strip = gltf(&with(strip, "/meshes/0/primitives/0", primitive)).unwrap();
    for model in [fan, strip] {
        let mesh = &model.parts[0].mesh;
        assert_eq!(mesh.triangle_count(), 2);
        for triangle in 0..2 {
            let [a, b, c] = mesh.corners(triangle);
            assert_eq!((b - a).cross(c - a), DVec3::Z * 4.0);
        }
    }
}

#[test]
fn points_lines_and_odd_corners_are_told() {
    let primitives = json!([
        {"attributes": {"POSITION": 0}, "mode": 0},
        {"attributes": {"POSITION": 0}, "mode": 1},
        {"attributes": {"POSITION": 0}},
        {"attributes": {"NORMAL": 0}},
    ]);
    let model = gltf(&with(square(), "/meshes/0/primitives", primitives)).unwrap();
    assert_eq!(model.triangle_count(), 1);
    assert_eq!(
        warnings_of(&model),
        [
            "a.gltf: /meshes/0/primitives/0: points and lines are not drawn (and 1 more)",
            "a.gltf: /meshes/0/primitives/2: the last corners are fewer than a triangle's three",
            "a.gltf: /meshes/0/primitives/3: a primitive without POSITION is not drawn",
        ]
    );
}

#[test]
fn sparse_and_quantised_accessors_are_read() {
    // Vertex 2 is moved to (3, 3, 3), by way of an index of 8 bits.
    let mut bytes = vec![2, 0, 0, 0];
    bytes.extend([3.0_f32; 3].iter().flat_map(|x| x.to_le_bytes()));
    let sparse = with(square(), "/buffers/", json!({"uri": data_uri(&bytes), "byteLength": 16}));
    let sparse = with(sparse, "/bufferViews/", json!({"buffer": 1, "byteLength": 4}));
    let sparse = with(sparse, "/bufferViews/", json!({"buffer": 1, "byteOffset": 4, "byteLength": 12}));
    let replaced =
        json!({"count": 1, "indices": {"bufferView": 3, "componentType": 5121}, "values": {"bufferView": 4}});
    let moved = gltf(&with(sparse.clone(), "/accessors/0/sparse", replaced.clone())).unwrap();
    assert_eq!(moved.bounds().max, DVec3::splat(3.0));
    // Without a view all else is zero.
    let accessor = json!({"componentType": 5126, "count": 4, "type": "VEC3", "sparse": replaced});
    let zero = gltf(&with(sparse, "/accessors/0", accessor)).unwrap();
    assert_eq!(zero.parts[0].mesh.data().positions[1], [0.0; 3]);
    assert_eq!(zero.bounds().max, DVec3::splat(3.0));

    // Signed normalised bytes, four bytes apart.
    let bytes = [0, 0, 0, 9, 127, 0, 0, 9, 127, 127, 0, 9, 0x80, 127, 0, 9];
    let quantised = with(square(), "/buffers/", json!({"uri": data_uri(&bytes), "byteLength": 16}));
    let quantised = with(quantised, "/bufferViews/", json!({"buffer": 1, "byteLength": 16, "byteStride": 4}));
    let accessor =
        json!({"bufferView": 3, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"});
    let quantised = with(quantised, "/accessors/0", accessor);
    let quantised = with(quantised, "/extensionsRequired", json!(["KHR_mesh_quantization"]));
    let model = gltf(&quantised).unwrap();
    assert_eq!(
        (model.bounds().min, model.bounds().max),
        (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0))
    );
}

#[test]
fn colors_of_vertices_are_linear_and_normalised() {
    let bytes = [255, 0, 51, 255].repeat(4);
    let colored = with(square(), "/buffers/", json!({"uri": data_uri(&bytes), "byteLength": 16}));
    let colored = with(colored, "/bufferViews/", json!({"buffer": 1, "byteLength": 16}));
    let accessor =
        json!({"bufferView": 3, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"});
    let colored = with(colored, "/accessors/", accessor);
    let model = gltf(&with(colored, "/meshes/0/primitives/0/attributes/COLOR_0", json!(3))).unwrap();
    assert_eq!(model.parts[0].mesh.data().colors, [[1.0, 0.0, 0.2]; 4]);
}

#[test]
fn normals_of_no_direction_leave_facets() {
    let primitive = json!({"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 2});
    let model = gltf(&with(square(), "/meshes/0/primitives/0", primitive)).unwrap();
    assert!(model.parts[0].mesh.data().normals.is_empty());
    assert_eq!(
        warnings_of(&model),
        ["a.gltf: /accessors/0: has a normal that is zero or not finite; facets are drawn"]
    );
}

#[test]
fn smooth_normals_come_on_request() {
    let files = Files::new().with("a.gltf", square().to_string());
    // Two triangles in one plane are flat, whatever is asked.
    assert!(files.load_smoothed("a.gltf", 180.0).unwrap().parts[0].mesh.data().normals.is_empty());
    let bent = json!({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
        "sparse": {"count": 1, "indices": {"bufferView": 3, "componentType": 5121}, "values": {"bufferView": 4}}});
    let mut bytes = vec![3, 0, 0, 0];
    bytes.extend([0.0_f32, 2.0, 1.0].iter().flat_map(|x| x.to_le_bytes()));
    let document = with(square(), "/buffers/", json!({"uri": data_uri(&bytes), "byteLength": 16}));
    let document = with(document, "/bufferViews/", json!({"buffer": 1, "byteLength": 4}));
    let document = with(document, "/bufferViews/", json!({"buffer": 1, "byteOffset": 4, "byteLength": 12}));
    let files = Files::new().with("a.gltf", with(document, "/accessors/0", bent).to_string());
    assert_eq!(files.load_smoothed("a.gltf", 180.0).unwrap().parts[0].mesh.data().normals.len(), 4);
    assert!(files.load_smoothed("a.gltf", 10.0).unwrap().parts[0].mesh.data().normals.is_empty());
}

#[test]
fn numbers_in_buffers_are_checked() {
    let faulty = |offset: usize, bytes: &[u8]| {
        let mut all = square_bytes();
        all[offset..offset + bytes.len()].copy_from_slice(bytes);
        error_of(gltf(&with(square(), "/buffers/0/uri", json!(data_uri(&all)))))
    };
    assert_eq!(
        faulty(12, &f32::NAN.to_le_bytes()),
        "a.gltf: /accessors/0: the position of vertex 1 is not finite"
    );
    assert_eq!(
        faulty(4, &f32::INFINITY.to_le_bytes()),
        "a.gltf: /accessors/0: the position of vertex 0 is not finite"
    );
    assert_eq!(
        faulty(82, &[9, 0]),
        "a.gltf: /meshes/0/primitives/0/indices: entry 1 is 9, but there are only 4 vertices"
    );
}
