//! glTF 2.0 and GLB.

use crate::common::{Files, error_of, load, mutated, mutations, warnings_of};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::{Scene, Shape, Texture};
use lancer_core::world::{CompileOptions, World};
use lancer_io::limits::Limits;
use lancer_io::model::{Model, UpAxis};
use lancer_io::showcase::scene_of_model;
use proptest::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};
use std::fmt::Write;

/// A square of two triangles in the plane z = 0, from 0 to 2: positions, texture coordinates, indices of 16 bits.
fn square_bytes() -> Vec<u8> {
    let positions = [[0.0_f32, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let uvs = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut bytes = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    bytes.extend(uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

fn data_uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes))
}

/// A document of one node with a square.
fn square() -> Value {
    let bytes = square_bytes();
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12},
        ],
        "buffers": [{"uri": data_uri(&bytes), "byteLength": bytes.len()}],
    })
}

/// The document with a value at a JSON pointer, whose last part may be new.
fn with(mut document: Value, pointer: &str, value: Value) -> Value {
    let (parent, last) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Object(members) => {
            members.insert(last.to_owned(), value);
        }
        Value::Array(entries) => match last.parse::<usize>() {
            Ok(index) if index < entries.len() => entries[index] = value,
            _ => entries.push(value),
        },
        _ => panic!("{pointer}"),
    }
    document
}

fn gltf(document: &Value) -> Result<Model, lancer_io::diagnostics::LoadError> {
    load("a.gltf", document.to_string())
}

fn glb(document: &Value, binary: Option<&[u8]>) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut body = Vec::new();
    body.extend((json.len() as u32).to_le_bytes());
    body.extend(b"JSON");
    body.extend(json);
    if let Some(binary) = binary {
        body.extend((binary.len() as u32).to_le_bytes());
        body.extend(b"BIN\0");
        body.extend(binary);
    }
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((body.len() as u32 + 12).to_le_bytes());
    file.extend(body);
    file
}

/// The material of the square, as the scene gets it.
#[allow(clippy::needless_pass_by_value, reason = "callers make the value in place")]
fn material(written: Value) -> lancer_core::scene::Material {
    let document = with(square(), "/materials", json!([written]));
    let document = with(document, "/meshes/0/primitives/0/material", json!(0));
    gltf(&document).unwrap().materials.remove(0)
}

fn red_png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let image = lancer_core::scene::ImageTexture::new(2, 1, vec![[255, 0, 0], [255, 255, 0]]).unwrap();
    lancer_io::image::encode::write_texture(&image, &mut bytes).unwrap();
    bytes
}

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
fn a_mesh_of_many_nodes_is_one_and_transforms_multiply() {
    let nodes = json!([
        {"name": "top", "children": [1, 2], "translation": [10, 0, 0]},
        {"name": "turned", "mesh": 0, "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "scale": [1, 3, 1]},
        {"name": "moved", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]},
    ]);
    let model = gltf(&with(square(), "/nodes", nodes)).unwrap();
    assert_eq!((model.parts.len(), model.triangle_count()), (1, 4));
    let bounds = model.bounds();
    // Scaled to 2 x 6, turned by a right angle to -6..0 x 0..2.
    assert!((bounds.min - DVec3::new(4.0, 0.0, 0.0)).length() < 1e-12, "{bounds:?}");
    assert!((bounds.max - DVec3::new(12.0, 2.0, 5.0)).length() < 1e-12, "{bounds:?}");
    let mut scene = Scene::new("scene");
    let node = model.insert_into(&mut scene);
    scene.add(node);
    let meshes = scene.nodes().iter().filter(|node| matches!(node.shape, Some(Shape::Mesh(_))));
    assert_eq!(meshes.map(|node| node.name.as_str()).collect::<Vec<_>>(), ["turned", "moved"]);
    assert_eq!(World::compile(&scene, &CompileOptions::default()).unwrap().statistics().meshes, 1);
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
fn plastic_has_a_lambertian_surface_and_a_highlight_of_a_quarter_of_its_reflectance() {
    let written = json!({"name": "p", "pbrMetallicRoughness":
        {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0, "roughnessFactor": 0.5}});
    let plastic = material(written);
    assert_eq!(
        (plastic.name.as_str(), plastic.color.clone()),
        ("p", Texture::Solid(Rgb::new(0.5, 0.25, 0.125)))
    );
    assert!((plastic.diffuse.r - 0.96).abs() < 1e-15 && plastic.ambient == plastic.diffuse);
    // alpha = 0.25, of which the highlight has what is not wide.
    assert!((plastic.specular.g - 0.75 * 0.04 / 4.0).abs() < 1e-15);
    assert_eq!((plastic.metallic, plastic.shininess), (Rgb::BLACK, 2.0 / 0.0625 - 2.0));
    assert!(plastic.reflect.is_black() && plastic.transmit.is_black());
    let shiny = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}}));
    assert!(shiny.fresnel && shiny.reflect == Rgb::WHITE && shiny.ior == 1.5);
}

#[test]
fn metal_reflects_in_its_color() {
    let color = [0.9, 0.6, 0.3, 1.0];
    let gold = material(json!({"pbrMetallicRoughness": {"baseColorFactor": color, "roughnessFactor": 0}}));
    assert!(gold.diffuse.is_black() && gold.ambient.is_black());
    assert_eq!((gold.metallic, gold.specular), (Rgb::WHITE, Rgb::grey(0.25)));
    assert_eq!((gold.reflect, gold.fresnel), (Rgb::new(0.9, 0.6, 0.3), false));
    assert_eq!(gold.shininess, 1e6);
    // The default: as rough as can be.
    let rough = material(json!({"pbrMetallicRoughness": {"baseColorFactor": color}}));
    assert_eq!((rough.diffuse, rough.ambient), (Rgb::WHITE, Rgb::WHITE));
    assert!(rough.specular.is_black() && rough.reflect.is_black());
    // Half a metal: F0 (1 - M) + C M, and the part of it that is S.
    let half = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0}}));
    assert!((half.specular.r - (0.02 + 0.5) / 4.0).abs() < 1e-15);
    assert!((half.metallic.r - 0.5 / 0.52).abs() < 1e-15);
}

#[test]
fn transmission_is_thin_unless_the_material_says_its_ior_or_a_thickness() {
    let glass = |extensions: Value| {
        material(json!({"extensions": extensions,
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0, "roughnessFactor": 0}}))
    };
    let thin = glass(json!({"KHR_materials_transmission": {"transmissionFactor": 0.5}}));
    assert_eq!((thin.transmit, thin.ior, thin.fresnel), (Rgb::new(0.5, 0.25, 0.0), 1.0, false));
    assert!((thin.diffuse.r - 0.48).abs() < 1e-15 && (thin.reflect.r - 0.04).abs() < 1e-15);
    for (extension, value, ior) in [
        ("KHR_materials_ior", json!({"ior": 1.33}), 1.33),
        ("KHR_materials_volume", json!({"thicknessFactor": 0.1}), 1.5),
    ] {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
        extensions[extension] = value;
        let thick = glass(extensions);
        assert_eq!((thick.ior, thick.fresnel, thick.reflect), (ior, true, Rgb::WHITE), "{extension}");
        assert!(thick.diffuse.is_black());
    }
}

#[test]
fn blended_materials_are_seen_through_straight() {
    let written = |mode: &str| {
        json!({"alphaMode": mode, "pbrMetallicRoughness":
        {"baseColorFactor": [1, 1, 1, 0.25], "metallicFactor": 0}})
    };
    let blend = material(written("BLEND"));
    assert_eq!((blend.transmit, blend.ior), (Rgb::grey(0.75), 1.0));
    assert!((blend.diffuse.r - 0.24).abs() < 1e-15);
    assert!(material(written("OPAQUE")).transmit.is_black());
    assert_eq!(material(written("MASK")).transmit, Rgb::WHITE);
}

#[test]
fn textures_come_from_uris_views_and_files_and_are_transformed() {
    let png = red_png();
    let info = json!({"index": 0, "extensions": {"KHR_texture_transform": {
        "offset": [0.5, 0.25], "rotation": FRAC_PI_2, "scale": [2, 4]}}});
    let textured = with(
        square(),
        "/materials",
        json!([{"pbrMetallicRoughness":
        {"baseColorTexture": info, "baseColorFactor": [0.5, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1}}]),
    );
    let textured = with(textured, "/meshes/0/primitives/0/material", json!(0));
    let textured = with(textured, "/textures", json!([{"source": 0}]));
    let textured = with(textured, "/extensionsUsed", json!(["KHR_texture_transform"]));
    let in_uri = with(textured.clone(), "/images", json!([{"uri": data_uri(&png)}]));
    let in_view = with(textured.clone(), "/images", json!([{"bufferView": 3, "mimeType": "image/png"}]));
    let in_view = with(in_view, "/buffers/", json!({"uri": data_uri(&png), "byteLength": png.len()}));
    let in_view = with(in_view, "/bufferViews/", json!({"buffer": 1, "byteLength": png.len()}));
    let in_file = with(textured, "/images", json!([{"uri": "im%61ge.png"}]));
    let files = Files::new().with("image.png", &png).with("a.gltf", in_file.to_string());
    for model in [gltf(&in_uri), gltf(&in_view), files.load("a.gltf")] {
        let model = model.unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let Texture::Image(image) = &model.materials[0].color else { panic!() };
        assert_eq!(image.texels(), [[255, 0, 0], [255, 255, 0]]);
        assert!((model.materials[0].diffuse.r - 0.48).abs() < 1e-15);
        // (0, 1) is scaled to (0, 4), turned to (4, 0), moved to (4.5, 0.25); v is then counted upward.
        let [u, v] = model.parts[0].mesh.data().uvs[0];
        assert!((u - 4.5).abs() < 1e-6 && (v - 0.75).abs() < 1e-6, "{u} {v}");
    }
}

#[test]
fn what_a_texture_lacks_is_told_and_the_factor_stays() {
    let textured = with(
        square(),
        "/materials",
        json!([{"pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1]}}]),
    );
    let textured = with(textured, "/meshes/0/primitives/0/material", json!(0));
    let textured = with(textured, "/textures", json!([{"source": 0}]));
    for (image, expected) in [
        (
            json!({"uri": "gone.png"}),
            "/images/0/uri: cannot open `gone.png`: no such file or directory; the texture is left out",
        ),
        (json!({"uri": "../../secret.png"}), "/images/0/uri: "),
        (
            json!({"uri": "file:///etc/passwd"}),
            "/images/0/uri: `file:` URIs are not opened; the texture is left out",
        ),
        (
            json!({"uri": "https://example.org/a.png"}),
            "/images/0/uri: `https:` URIs are not opened; the texture is left out",
        ),
        (
            json!({"uri": "data:image/png;base64,AAAA"}),
            "/images/0: is not an image of a format that is read; the texture is left out",
        ),
        (json!({"uri": "data:image/png;base64,??"}), "/images/0/uri: is no base64: "),
        (
            json!({"bufferView": 9}),
            "/images/0/bufferView: is 9, but there are only 3 bufferViews; the texture is left out",
        ),
        (json!({}), "/images/0: has neither a uri nor a bufferView; the texture is left out"),
    ] {
        let model = gltf(&with(textured.clone(), "/images", json!([image]))).unwrap();
        let [warning] = &warnings_of(&model)[..] else { panic!("{:?}", model.warnings) };
        assert!(warning.starts_with(&format!("a.gltf: {expected}")), "{warning}");
        assert_eq!(model.materials[0].color, Texture::Solid(Rgb::new(0.5, 1.0, 1.0)));
    }
}

#[test]
fn cameras_and_lights_stand_where_their_nodes_do() {
    let nodes = json!([
        {"mesh": 0},
        {"translation": [1, 1, 0], "children": [2, 3, 4]},
        {"name": "eye", "camera": 0, "translation": [0, 0, 8]},
        {"name": "lamp", "translation": [0, 3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"name": "sun", "rotation": [1, 0, 0, 0], "extensions": {"KHR_lights_punctual": {"light": 1}}},
    ]);
    let document = with(with(square(), "/nodes", nodes), "/scenes/0/nodes", json!([0, 1]));
    let perspective = json!({"yfov": PI / 3.0, "aspectRatio": 2, "znear": 0.1});
    let document = with(document, "/cameras", json!([{"type": "perspective", "perspective": perspective}]));
    let lights = json!([
        {"type": "point", "color": [1, 0.5, 0], "intensity": 40},
        {"type": "directional", "intensity": 2},
    ]);
    let document = with(document, "/extensions", json!({"KHR_lights_punctual": {"lights": lights}}));
    let model = gltf(&document).unwrap();
    let camera = &model.cameras[0];
    assert_eq!((camera.name.as_str(), camera.aspect), ("eye", Some(2.0)));
    assert!((camera.camera.fov - 60.0).abs() < 1e-12);
    assert_eq!(
        (camera.camera.eye, camera.camera.target),
        (DVec3::new(1.0, 1.0, 8.0), DVec3::new(1.0, 1.0, 0.0))
    );
    assert_eq!(model.lights[0].position, DVec3::new(1.0, 4.0, 0.0));
    assert_eq!(model.lights[0].intensity, Rgb::new(40.0, 20.0, 0.0));
    // A sun turned about x by 180 degrees shines toward +z, from -z, and gives 2 lux wherever the model is.
    let sun = &model.lights[1];
    let from = sun.position - model.bounds().center();
    assert!(from.normalize().dot(DVec3::NEG_Z) > 1.0 - 1e-12);
    assert!((sun.intensity.r / from.length_squared() - 2.0).abs() < 1e-12);
    assert_eq!(
        warnings_of(&model),
        [
            "a.gltf: /extensions/KHR_lights_punctual/lights/1: a directional light is drawn as a point light far away"
        ]
    );

    let scene = scene_of_model(model);
    assert_eq!((scene.settings.width, scene.settings.height), (1200, 600));
    assert_eq!((scene.camera.eye.z, scene.cameras[0].0.as_str()), (8.0, "eye"));
    assert_eq!((scene.lights.len(), scene.roots().len()), (2, 1), "no ground under a scene");
}

#[test]
fn lights_in_candela_are_exposed_for() {
    let light = |intensity: f64| {
        let node =
            json!({"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 3]});
        let document = with(square(), "/nodes/0", node);
        let lights = json!([{"type": "point", "intensity": intensity}]);
        let document = with(document, "/extensions", json!({"KHR_lights_punctual": {"lights": lights}}));
        scene_of_model(gltf(&document).unwrap())
    };
    assert_eq!(light(5.0).tone.exposure, 0.0);
    let bright = light(54_351.0);
    assert!(bright.tone.exposure < -10.0);
    let shown = bright.ambient.g * f64::from(bright.tone.factor());
    assert!((shown - light(5.0).ambient.g).abs() < 1e-6, "ambient light looks as ever");
}

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
fn nodes_that_are_flattened_are_left_out_and_told() {
    let nodes = json!([{"mesh": 0, "children": [1]}, {"mesh": 0, "scale": [0, 0, 0]}]);
    let model = gltf(&with(square(), "/nodes", nodes)).unwrap();
    assert_eq!(model.triangle_count(), 2);
    assert_eq!(warnings_of(&model), ["a.gltf: /nodes/1: is not drawn: its transform flattens it"]);
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
fn two_parents_and_cycles_are_refused() {
    let nodes = |nodes: Value, roots: Value| {
        error_of(gltf(&with(with(square(), "/nodes", nodes), "/scenes/0/nodes", roots)))
    };
    assert_eq!(
        nodes(json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}]), json!([0, 1])),
        "a.gltf: /nodes/1/children/0: node 2 is a child of node 0 already"
    );
    assert_eq!(
        nodes(json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), json!([0])),
        "a.gltf: /nodes/1/children: the node is below itself"
    );
    assert_eq!(
        nodes(json!([{"children": [1]}, {"mesh": 0}]), json!([1])),
        "a.gltf: /scenes/0/nodes/0: node 1 is no root: it is a child of node 0"
    );
}

#[test]
fn chains_of_a_hundred_thousand_nodes_are_drawn() {
    let depth = 100_000;
    let mut document = square().to_string();
    let mut nodes = String::from("[");
    for next in 1..depth {
        write!(nodes, "{{\"children\":[{next}]}},").unwrap();
    }
    nodes.push_str("{\"mesh\":0}]");
    document = document.replace("[{\"mesh\":0}]", &nodes);
    let model = load("a.gltf", document).unwrap();
    assert_eq!((model.triangle_count(), model.bounds().max), (2, DVec3::new(2.0, 2.0, 0.0)));
    let scene = scene_of_model(model);
    World::compile(&scene, &CompileOptions::default()).unwrap();
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
fn transforms_that_mirror_keep_their_normals() {
    let model = gltf(&with(square(), "/nodes/0/scale", json!([-1, 1, 1]))).unwrap();
    let transform = model.tree.as_ref().unwrap().nodes()[0].transform;
    assert_eq!(transform, Transform::scale(DVec3::new(-1.0, 1.0, 1.0)));
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
fn long_names_are_cut_off() {
    let document = with(square(), "/meshes/0/name", json!("é".repeat(300)));
    let model = gltf(&document).unwrap();
    assert_eq!(model.parts[0].name, "é".repeat(255));
    assert_eq!(model.tree.unwrap().nodes()[0].name, "é".repeat(255));
}
