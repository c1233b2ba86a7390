//! glTF 2.0 and GLB.

mod faults;
mod materials;
mod meshes;
mod nodes;

use crate::common::load;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lancer_io::model::Model;
use serde_json::{Value, json};

/// A square of two triangles in the plane z = 0, from 0 to 2: positions, texture coordinates, indices of 16 bits.
pub(super) fn square_bytes() -> Vec<u8> {
    let positions = [[0.0_f32, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let uvs = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut bytes = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    bytes.extend(uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

pub(super) fn data_uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes))
}

/// A document of one node with a square.
pub(super) fn square() -> Value {
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
pub(super) fn with(mut document: Value, pointer: &str, value: Value) -> Value {
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

pub(super) fn gltf(document: &Value) -> Result<Model, lancer_io::diagnostics::LoadError> {
    load("a.gltf", document.to_string())
}

pub(super) fn glb(document: &Value, binary: Option<&[u8]>) -> Vec<u8> {
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
