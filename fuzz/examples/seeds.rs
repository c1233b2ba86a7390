//! Writes a small valid file or more for each fuzz target: `cargo run --release --example seeds -- DIRECTORY`.
//!
//! They are where the fuzzers start from; what they find they keep beside them.

use flate2::Compression;
use flate2::write::GzEncoder;
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use lancer_core::film::{Image, Tone};
use lancer_io::image::{ImageFormat as PictureFormat, Metadata, encode};
use std::error::Error;
use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

type Failure = Box<dyn Error>;

fn main() -> Result<(), Failure> {
    let directory = std::env::args().nth(1).ok_or("usage: seeds DIRECTORY")?;
    let directory = Path::new(&directory);
    let put = |target: &str, name: &str, bytes: &[u8]| -> Result<(), Failure> {
        fs::create_dir_all(directory.join(target))?;
        Ok(fs::write(directory.join(target).join(name), bytes)?)
    };
    for (target, name, text) in TEXTS {
        put(target, name, text.as_bytes())?;
    }
    put("ply", "little-endian", &ply("binary_little_endian", |x| x.to_le_bytes(), |i| i.to_le_bytes()))?;
    put("ply", "big-endian", &ply("binary_big_endian", |x| x.to_be_bytes(), |i| i.to_be_bytes()))?;
    put("stl", "binary", &binary_stl())?;
    put("gltf", "binary", &glb())?;
    put(
        "gltf",
        "buffer",
        &[GLTF.replace("BYTES", &square().len().to_string()).as_bytes(), b"\n%%\n", &square()].concat(),
    )?;

    let text = |target: &str| {
        TEXTS.iter().find(|text| text.0 == target).map(|text| text.2.as_bytes()).unwrap_or_default()
    };
    put("archive", "gzip", &gzip("", text("ply"))?)?;
    put("archive", "gzip-named", &gzip("model.ply", text("ply"))?)?;
    put("archive", "zip", &zip(&[("chair/model.ply", text("ply")), ("readme.txt", b"a chair")])?)?;
    put("archive", "three-mf", &zip(&[("3D/3dmodel.model", text("three_mf"))])?)?;

    let checker = |x: u32, y: u32| Rgba([x as u8 * 40, y as u8 * 60, 200, if x == y { 100 } else { 255 }]);
    let rgba = DynamicImage::from(RgbaImage::from_fn(6, 4, checker));
    let rgb = DynamicImage::from(rgba.to_rgb8());
    let kinds = [("rgba", rgba.clone()), ("rgb", rgb.clone()), ("grey", rgba.to_luma8().into())];
    for (kind, picture) in &kinds {
        put("image", &format!("png-{kind}"), &encoded(picture, ImageFormat::Png)?)?;
        put("image", &format!("tga-{kind}"), &encoded(picture, ImageFormat::Tga)?)?;
        put("image", &format!("bmp-{kind}"), &encoded(picture, ImageFormat::Bmp)?)?;
    }
    put("image", "png-16", &encoded(&rgba.to_rgb16().into(), ImageFormat::Png)?)?;
    put("image", "webp-rgba", &encoded(&rgba, ImageFormat::WebP)?)?;
    put("image", "tiff-rgb", &encoded(&rgb, ImageFormat::Tiff)?)?;
    put("image", "jpeg-rgb", &encoded(&rgb, ImageFormat::Jpeg)?)?;
    put("image", "jpeg-grey", &encoded(&rgba.to_luma8().into(), ImageFormat::Jpeg)?)?;
    pictures(&put)
}

/// A picture of every format that Lancer writes.
fn pictures(put: impl Fn(&str, &str, &[u8]) -> Result<(), Failure>) -> Result<(), Failure> {
    let mut picture = Image::black(5, 3);
    picture.put(0, 1, 5, &[[0.1, 0.5, 0.9], [2.0, 0.0, 0.2], [0.0; 3], [1.0; 3], [0.3, 0.3, 0.7]]);
    let metadata = Metadata { provenance: Some("{}".to_owned()), ..Metadata::default() };
    for format in PictureFormat::ALL {
        let mut bytes = Cursor::new(Vec::new());
        encode::write(format, &picture, Tone::default(), &metadata, &mut bytes)?;
        put("picture", &format!("{format:?}").to_lowercase(), &bytes.into_inner())?;
    }
    Ok(())
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Result<Vec<u8>, Failure> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format)?;
    Ok(bytes.into_inner())
}

fn gzip(name: &str, bytes: &[u8]) -> Result<Vec<u8>, Failure> {
    let builder = flate2::GzBuilder::new();
    let builder = if name.is_empty() { builder } else { builder.filename(name) };
    let mut encoder: GzEncoder<Vec<u8>> = builder.write(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?)
}

fn zip(files: &[(&str, &[u8])]) -> Result<Vec<u8>, Failure> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        archive.start_file(*name, SimpleFileOptions::default())?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

fn ply(format: &str, float: fn(f32) -> [u8; 4], int: fn(i32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for [x, y] in [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]] {
        bytes.extend([x, y, 0.5].into_iter().flat_map(float));
        bytes.extend([255, 128, 0]);
    }
    bytes.push(4);
    bytes.extend([0, 1, 2, 3].into_iter().flat_map(int));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(2_u32.to_le_bytes());
    for last in [[0.0_f32, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let corners = [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], last];
        bytes.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

/// A square: positions, texture coordinates, indices of 16 bits.
fn square() -> Vec<u8> {
    let positions = [[0.0_f32, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let uvs = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut bytes = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    bytes.extend(uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

fn glb() -> Vec<u8> {
    let buffer = square();
    let mut json =
        GLTF.replace("\"uri\":\"b.bin\",", "").replace("BYTES", &buffer.len().to_string()).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk =
        |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), &kind[..], bytes].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &buffer)].concat();
    [b"glTF", &2_u32.to_le_bytes()[..], &(chunks.len() as u32 + 12).to_le_bytes(), &chunks].concat()
}

const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"extensionsUsed":["KHR_lights_punctual","KHR_materials_ior","KHR_materials_transmission","KHR_texture_transform"],
"nodes":[{"mesh":0,"translation":[1,0,0],"rotation":[0,0.6,0,0.8],"scale":[1,2,1],"children":[3]},{"camera":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]},{"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":0}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"aspectRatio":1.5}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,1,1],"intensity":100}]}},
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0},{"attributes":{"POSITION":3},"mode":5}]}],
"materials":[{"name":"a","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.2,1],"metallicFactor":0.5,"roughnessFactor":0.3,"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,2],"offset":[0.5,0],"rotation":0.3}}}},"alphaMode":"BLEND","extensions":{"KHR_materials_ior":{"ior":1.4},"KHR_materials_transmission":{"transmissionFactor":0.5}}}],
"textures":[{"source":0,"sampler":0}],"images":[{"uri":"t.bmp"}],"samplers":[{"wrapS":33071}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"},{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":2,"byteOffset":2,"componentType":5123},"values":{"bufferView":0}}}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,"byteLength":12}],
"buffers":[{"uri":"b.bin","byteLength":BYTES}]}"#;

/// Target, name and content.
const TEXTS: [(&str, &str, &str); 12] = [
    ("scene", "small", include_str!("../../scenes/first.yaml")),
    ("scene", "lens", include_str!("../../scenes/lens.yaml")),
    (
        "scene",
        "overridden",
        "format: 1\ncamera: {eye: [0, 1, 5], target: [0, 0, 0], fov: 40}\nmaterials:\n  m: &m {color: {image: t.bmp}, specular: 0.1}\n\
         lights: [{position: [1, 2, 3], intensity: 50}]\nobjects:\n  - {mesh: model.obj, material: m, name: a}\n  - {shape: sphere, transform: [{scale: 2}]}\n\
         %%\nmaterials.m.specular=0.2\nrender.depth=3\ncamera.fov=50\n",
    ),
    (
        "obj",
        "square",
        "# a square and a line\nmtllib model.mtl\no thing\ng one two\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n\
         vn 0 0 1\ns 1\nusemtl a\nf 1/1/1 2/2/1 3//1 4\nusemtl b\nf -1/-1 -2 \\\n-3\nl 1 2\n%%\nnewmtl a\nKd 1 0 0\nmap_Kd -s 2 2 t.bmp\n\
         newmtl b\nd 0.5\nillum 7\nNs 10\n",
    ),
    (
        "obj",
        "concave",
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\ncstype bezier\ncurv 0 1 1 2\nend\n",
    ),
    (
        "mtl",
        "materials",
        "newmtl a\nKa 0.1 0.1 0.1\nKd 0.8 0.2 0.2\nKs 0.5 0.5 0.5\nNs 50\nNi 1.5\nillum 7\nTf 1 1 1\nnewmtl b\nTr 0.4\nillum 4\n\
         map_Kd -s 2 2 2 -o 0.5 0 0 -clamp on t.bmp\nmap_Ks t.bmp\nbump -bm 0.5 t.bmp\nnewmtl c\nd -halo 0.5\nKe 1 1 1\nmap_d missing.png\n",
    ),
    (
        "ply",
        "text",
        "ply\nformat ascii 1.0\ncomment seed\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 2\n\
         property list uchar uint vertex_index\nelement edge 1\nproperty int a\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n\
         1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n3 0 1 2\n4 0 1 2 3\n7\n",
    ),
    (
        "ply",
        "strips",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n\
         property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 1 2 -1 3\n",
    ),
    (
        "stl",
        "text",
        "solid thing\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid thing\n",
    ),
    (
        "off",
        "plain",
        "OFF\n# a seed\n4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n4 0 1 2 3 0.5 0.5 0.5 1\n",
    ),
    (
        "off",
        "colours",
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255 0 0\n1 0 0 0 0 1 0 255 0 255 1 0\n0 1 0 0 0 1 0 0 255 255 0 1\n3 0 1 2\n",
    ),
    (
        "three_mf",
        "model",
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">\
         <resources><basematerials id=\"5\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials><m:colorgroup id=\"6\"><m:color color=\"#00FF00FF\"/></m:colorgroup>\
         <object id=\"1\" type=\"model\" pid=\"5\" pindex=\"0\" name=\"t\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"2\" y=\"0\" z=\"0\"/>\
         <vertex x=\"0\" y=\"2\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"6\" p1=\"0\"/></triangles></mesh></object>\
         <object id=\"2\"><components><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/></components></object></resources>\
         <build><item objectid=\"2\"/><item objectid=\"1\" p:path=\"/3D/part.model\"/></build></model>\n%%\n<model/>",
    ),
];
