//! The JSON Schema accepts what the reader accepts.

use crate::common::load_bytes;
use crate::whole::EXAMPLE_IN_JSON;
use lancer_io::scene_file::json_schema;
use serde_json::{Value, json};

/// Checks a value against the part of JSON Schema that the scene schema is written in; any other keyword panics.
fn accepts(root: &Value, schema: &Value, value: &Value) -> bool {
    schema
        .as_object()
        .unwrap()
        .iter()
        .all(|(keyword, rule)| keyword_accepts(root, schema, keyword, rule, value))
}

fn keyword_accepts(root: &Value, schema: &Value, keyword: &str, rule: &Value, value: &Value) -> bool {
    let each =
        |rules: &Value| rules.as_array().unwrap().iter().filter(|rule| accepts(root, rule, value)).count();
    let against =
        |holds: fn(f64, f64) -> bool| value.as_f64().is_none_or(|x| holds(x, rule.as_f64().unwrap()));
    let length = value.as_array().map(Vec::len);
    match keyword {
        "$schema" | "$defs" | "title" | "description" | "default" => true,
        "$ref" => accepts(root, root.pointer(&rule.as_str().unwrap()[1..]).unwrap(), value),
        "type" => match rule {
            Value::Array(types) => types.iter().any(|name| has_type(value, name.as_str().unwrap())),
            name => has_type(value, name.as_str().unwrap()),
        },
        "anyOf" => each(rule) > 0,
        "oneOf" => each(rule) == 1,
        "enum" => rule.as_array().unwrap().contains(value),
        "const" => rule == value,
        "minimum" => against(|x, limit| x >= limit),
        "maximum" => against(|x, limit| x <= limit),
        "exclusiveMinimum" => against(|x, limit| x > limit),
        "exclusiveMaximum" => against(|x, limit| x < limit),
        "minItems" => length.is_none_or(|length| length >= rule.as_u64().unwrap() as usize),
        "maxItems" => length.is_none_or(|length| length <= rule.as_u64().unwrap() as usize),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| accepts(root, rule, item))),
        "required" => value.as_object().is_none_or(|map| {
            rule.as_array().unwrap().iter().all(|key| map.contains_key(key.as_str().unwrap()))
        }),
        "properties" => value.as_object().is_none_or(|map| {
            map.iter().all(|(key, value)| rule.get(key).is_none_or(|rule| accepts(root, rule, value)))
        }),
        "additionalProperties" => {
            value.as_object().is_none_or(|map| {
                map.iter()
                    .filter(|(key, _)| schema.get("properties").and_then(|known| known.get(key)).is_none())
                    .all(|(_, value)| {
                        if rule.is_boolean() {
                            rule == &Value::Bool(true)
                        } else {
                            accepts(root, rule, value)
                        }
                    })
            })
        }
        "pattern" => value.as_str().is_none_or(|text| {
            assert_eq!(rule, "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$");
            matches!(text.len(), 4 | 7)
                && text.starts_with('#')
                && text[1..].chars().all(|digit| digit.is_ascii_hexdigit())
        }),
        other => panic!("this check does not know `{other}`"),
    }
}

fn has_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("this check does not know the type `{other}`"),
    }
}

fn both_say(expected: bool, document: &Value) {
    let schema: Value = serde_json::from_str(&json_schema()).unwrap();
    assert_eq!(accepts(&schema, &schema, document), expected, "the schema, of {document}");
    let read = load_bytes(document.to_string().as_bytes(), &[]);
    assert_eq!(read.is_ok(), expected, "the reader, of {document}: {read:?}");
}

fn with_object(object: &Value) -> Value {
    json!({ "format": 1, "objects": [object] })
}

fn with_material(material: &Value) -> Value {
    json!({ "format": 1, "materials": { "m": material }, "objects": [{ "shape": "cube", "material": "m" }] })
}

#[test]
fn the_example_is_accepted() {
    both_say(true, &serde_json::from_str(EXAMPLE_IN_JSON).unwrap());
}

#[test]
fn every_form_is_accepted_by_both() {
    for object in [
        json!({ "shape": "cylinder" }),
        json!({ "shape": { "cylinder": { "capped": false } } }),
        json!({ "shape": { "cylinder": {} } }),
        json!({ "shape": { "mesh": "bunny.obj" }, "use": null, "material": null, "transform": null }),
        json!({ "shape": { "mesh": { "file": "bunny.obj" } } }),
        json!({ "shape": { "mesh": { "file": "bunny.obj", "crease": 40 } } }),
        json!({ "shape": "plane", "material": { "color": { "image": "wood.png" } } }),
        json!({ "shape": "plane", "children": [{ "shape": "cube" }] }),
        json!({ "shape": "cube", "transform": [{ "scale": 2 }, { "scale": [1, 2, 3] }] }),
        json!({ "shape": "cube", "transform": [{ "rotate": { "axis": [1, 0, 0], "angle": -3.5 } }] }),
        json!({ "shape": "cube", "transform": [{ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }] }),
    ] {
        both_say(true, &with_object(&object));
    }
    for material in [
        json!({}),
        json!({ "color": "#abc", "ambient": [0, 0.5, 1], "fresnel": true }),
        json!({ "color": [0, 1, 2], "ior": 0.5 }),
        json!({ "color": { "checker": { "even": 0, "odd": "#ffffff" } } }),
    ] {
        both_say(true, &with_material(&material));
    }
}

#[test]
fn what_one_refuses_the_other_refuses() {
    both_say(false, &json!({ "objects": [{ "shape": "cube" }] }));
    both_say(false, &json!({ "format": 2, "objects": [{ "shape": "cube" }] }));
    for object in [
        json!({}),
        json!({ "name": "x" }),
        json!({ "shape": "torus" }),
        json!({ "shape": { "mesh": "bunny.obj", "cylinder": {} } }),
        json!({ "shape": { "mesh": { "crease": 40 } } }),
        json!({ "shape": { "mesh": { "file": "bunny.obj", "crease": 180.5 } } }),
        json!({ "shape": { "mesh": { "file": "bunny.obj", "smooth": true } } }),
        json!({ "shape": "cube", "transform": [{ "scale": 1, "translate": [0, 0, 0] }] }),
        json!({ "shape": "cube", "transform": [{ "translate": [0, 0] }] }),
        json!({ "shape": "cube", "color": 1 }),
    ] {
        both_say(false, &with_object(&object));
    }
    for material in [
        json!({ "color": "red" }),
        json!({ "ior": 0 }),
        json!({ "diffuse": -1 }),
        json!({ "metallic": 1.5 }),
        json!({ "color": { "image": "wood.png", "checker": { "even": 0, "odd": 1 } } }),
    ] {
        both_say(false, &with_material(&material));
    }
}
