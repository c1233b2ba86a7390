//! What serde says of a document, in words that do not speak of the program's types.

use crate::model::text::quoted;

/// An error of the JSON or of what it says, without its place.
pub(super) fn of_error(error: &serde_json::Error) -> String {
    let words = error.to_string();
    let message = words.rsplit_once(" at line ").map_or(words.as_str(), |(message, _)| message);
    if error.is_data() {
        translated(message).unwrap_or_else(|| message.to_owned())
    } else {
        // A word that is none of the three that JSON has.
        let message = message.replace("expected ident", "expected true, false or null");
        format!("is no JSON: {}", message.replace("EOF while parsing", "the file ends within"))
    }
}

/// `None` for what the document's own types say.
fn translated(message: &str) -> Option<String> {
    let (kind, rest) = message.split_once(' ')?;
    match kind {
        "invalid" => {
            let (what, rest) = rest.split_once(' ')?;
            // What a file says may hold anything; what is expected, no comma.
            let (found, expected) = rest.rsplit_once(", expected ")?;
            let found = match what {
                "length" => format!("a list of {found}"),
                _ => value(found),
            };
            Some(format!("a value is {found}, must be {}", kind_of(expected)))
        }
        "missing" => Some(format!("{} is missing", rest.strip_prefix("field ")?)),
        "duplicate" => Some(format!("{} is there twice", rest.strip_prefix("field ")?)),
        _ => None,
    }
}

/// What was found, of what serde calls it: `type: string "x"`, say, without the first word.
fn value(found: &str) -> String {
    let bare = |text: &str| quoted(text.trim_matches('`').as_bytes()).into_owned();
    match found.split_once(' ') {
        Some(("integer" | "boolean", text)) => bare(text),
        Some(("floating", text)) => bare(text.strip_prefix("point ").unwrap_or(text)),
        Some(("string", text)) => format!("the text {}", quoted(text.as_bytes())),
        _ => match found {
            "sequence" => "a list".to_owned(),
            "map" => "an object".to_owned(),
            other => quoted(other.as_bytes()).into_owned(),
        },
    }
}

/// What is expected, of the name of a type.
fn kind_of(expected: &str) -> String {
    let length = expected.strip_prefix("an array of length ");
    match expected {
        "usize" | "u32" | "u64" => "a whole number, 0 or above".to_owned(),
        "f64" => "a number".to_owned(),
        "a string" => "text".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "a list".to_owned(),
        _ => match length {
            Some(length) => format!("a list of {length} numbers"),
            // A structure of the document, or a map.
            None => "an object".to_owned(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::Document;
    use super::*;

    fn told(json: &str) -> String {
        of_error(&serde_json::from_str::<Document>(json).unwrap_err())
    }

    #[test]
    fn faults_are_told_without_types() {
        for (json, expected) in [
            (r#"{"nodes":[{"mesh":"x"}]}"#, r#"a value is the text "x", must be a whole number, 0 or above"#),
            (
                r#"{"nodes":[{"mesh":"x, expected y"}]}"#,
                r#"a value is the text "x, expected y", must be a whole number, 0 or above"#,
            ),
            (r#"{"nodes":[{"mesh":-1}]}"#, "a value is -1, must be a whole number, 0 or above"),
            (r#"{"nodes":[{"mesh":1.5}]}"#, "a value is 1.5, must be a whole number, 0 or above"),
            (r#"{"nodes":[{"name":true}]}"#, "a value is true, must be text"),
            (r#"{"nodes":[{"scale":[1,2]}]}"#, "a value is a list of 2, must be a list of 3 numbers"),
            (r#"{"nodes":[{"scale":[1,2,null]}]}"#, "a value is null, must be a number"),
            (r#"{"nodes":[{"scale":[1,2,[]]}]}"#, "a value is a list, must be a number"),
            (r#"{"nodes":[3]}"#, "a value is 3, must be an object"),
            (r#"{"nodes":{}}"#, "a value is an object, must be a list"),
            (r#"{"meshes":[{}]}"#, "`primitives` is missing"),
            (r#"{"scene":0,"scene":0}"#, "`scene` is there twice"),
            (r#"{"accessors":[{"normalized":1}]}"#, "a value is 1, must be true or false"),
            (
                r#"{"buffers":[{"byteLength":18446744073709551616}]}"#,
                "a value is 1.8446744073709552e+19, must be a whole number, 0 or above",
            ),
            (r#"{"nodes":["#, "is no JSON: the file ends within a list"),
            (r#"{"nodes":[nul]}"#, "is no JSON: expected true, false or null"),
        ] {
            assert_eq!(told(json), expected, "{json}");
        }
    }

    #[test]
    fn long_values_are_cut_off() {
        assert!(told(&format!("{{\"nodes\":[{{\"mesh\":\"{}\"}}]}}", "x".repeat(1 << 20))).len() < 200);
    }
}
