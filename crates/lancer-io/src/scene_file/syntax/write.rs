//! Trees to text.
//!
//! In: a [`Node`]. Out: YAML on one line, which may stand wherever a value may, or JSON. It reads back as the same
//! tree, numbers to the last bit.

use super::{Entry, Node, Scalar, Value};
use std::fmt::Write;

/// Which of the two languages is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Language {
    /// Words stand without quotes where they can.
    Yaml,
    Json,
}

/// A value on one line, in flow style.
pub(crate) fn flow(node: &Node, language: Language) -> String {
    let mut out = String::new();
    write_value(node, language, &mut out);
    out
}

/// A key as it stands before its colon.
pub(crate) fn flow_key(key: &str, language: Language) -> String {
    let mut out = String::new();
    write_text(key, language, &mut out);
    out
}

/// A mapping as YAML for people: its entries by lines, and whatever fits on one line on one.
pub(crate) fn block(root: &Node) -> String {
    let mut out = String::new();
    write_block(root, 0, &mut out);
    out.push('\n');
    out
}

/// The width that lines of [`block`] keep to where they can: a narrow window's. Untuned.
const WIDTH: usize = 100;

/// Writes a value that begins at this column, as will its further lines.
fn write_block(node: &Node, column: usize, out: &mut String) {
    let next_line = |out: &mut String, column| {
        out.push('\n');
        out.extend(std::iter::repeat_n(' ', column));
    };
    match &node.value {
        Value::Mapping(entries) => {
            for (index, Entry { key, value, .. }) in entries.iter().enumerate() {
                if index > 0 {
                    next_line(out, column);
                }
                let key = flow_key(key, Language::Yaml);
                out.push_str(&key);
                out.push(':');
                match on_one_line(value, WIDTH.saturating_sub(column + key.len() + 2)) {
                    Some(line) => out.extend([" ", &line]),
                    None => {
                        next_line(out, column + 2);
                        write_block(value, column + 2, out);
                    }
                }
            }
        }
        Value::Sequence(items) => {
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    next_line(out, column);
                }
                out.push_str("- ");
                match on_one_line(item, WIDTH.saturating_sub(column + 2)) {
                    Some(line) => out.push_str(&line),
                    None => write_block(item, column + 2, out),
                }
            }
        }
        Value::Scalar(scalar) => write_scalar(scalar, Language::Yaml, out),
    }
}

/// A value in flow style, if it is no wider, or if nothing in it could be parted.
fn on_one_line(node: &Node, width: usize) -> Option<String> {
    let is_scalar = |node: &Node| matches!(node.value, Value::Scalar(_));
    let is_flat = match &node.value {
        Value::Scalar(_) => true,
        Value::Sequence(items) => items.iter().all(|item| is_scalar(item)),
        Value::Mapping(entries) => entries.is_empty(),
    };
    let line = flow(node, Language::Yaml);
    (is_flat || line.chars().count() <= width).then_some(line)
}

/// Recurses as deep as the tree is, which [`Limits::nesting`](crate::limits::Limits::nesting) bounds.
fn write_value(node: &Node, language: Language, out: &mut String) {
    match &node.value {
        Value::Scalar(scalar) => write_scalar(scalar, language, out),
        Value::Sequence(items) => {
            out.push('[');
            for (index, item) in items.iter().enumerate() {
                out.push_str(if index > 0 { ", " } else { "" });
                write_value(item, language, out);
            }
            out.push(']');
        }
        Value::Mapping(entries) => {
            out.push('{');
            for (index, Entry { key, value, .. }) in entries.iter().enumerate() {
                out.push_str(if index > 0 { ", " } else { "" });
                write_text(key, language, out);
                out.push_str(": ");
                write_value(value, language, out);
            }
            out.push('}');
        }
    }
}

fn write_scalar(scalar: &Scalar, language: Language, out: &mut String) {
    match scalar {
        Scalar::Null => out.push_str("null"),
        Scalar::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
        Scalar::Integer(value) => write!(out, "{value}").expect("memory can be written"),
        Scalar::Float(value) => out.push_str(&number(*value)),
        Scalar::Text(text) => write_text(text, language, out),
    }
}

/// The shortest text that reads back as the number, bit by bit but for the kinds of NaN.
pub(crate) fn number(value: f64) -> String {
    /// Whole numbers up to here are written as such; all of them are exact, and none is longer than a float.
    const WHOLE: f64 = 1e15;
    if value.is_nan() {
        return ".nan".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { ".inf".into() } else { "-.inf".into() };
    }
    let is_negative_zero = value == 0.0 && value.is_sign_negative();
    if value.fract() == 0.0 && value.abs() < WHOLE && !is_negative_zero {
        return format!("{}", value as i64);
    }
    // Unlike `Display`, it turns to exponents where they are shorter.
    format!("{value:?}")
}

fn write_text(text: &str, language: Language, out: &mut String) {
    if language == Language::Yaml && is_plain(text) {
        out.push_str(text);
        return;
    }
    out.push('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => out.extend(['\\', character]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            // Those that an editor may take for the end of a line, or a mark of byte order, among them.
            '\u{2028}' | '\u{2029}' | '\u{feff}' => escape(character, out),
            _ if character.is_control() => escape(character, out),
            _ => out.push(character),
        }
    }
    out.push('"');
}

fn escape(character: char, out: &mut String) {
    write!(out, "\\u{:04x}", u32::from(character)).expect("memory can be written");
}

/// Whether a text may stand without quotes anywhere: words, paths, and little more.
fn is_plain(text: &str) -> bool {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/' | ' ');
    text.starts_with(char::is_alphabetic)
        && !text.ends_with(' ')
        && text.chars().all(is_plain)
        && matches!(Scalar::from_plain(text), Scalar::Text(_))
}

#[cfg(test)]
mod tests {
    use super::super::{Origin, parse};
    use super::*;
    use crate::limits::Limits;
    use proptest::prelude::*;

    fn read(text: &str) -> Scalar {
        let parsed = parse(text, Origin::File, &Limits::default()).ok().and_then(|parsed| parsed.root);
        match &parsed.unwrap_or_else(|| panic!("{text}")).value {
            Value::Scalar(scalar) => scalar.clone(),
            other => panic!("{text} is {other:?}"),
        }
    }

    fn written(scalar: Scalar, language: Language) -> String {
        flow(&Node::new(super::super::Place::start_of(Origin::File), Value::Scalar(scalar)), language)
    }

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, -0.0, 4.0, -12.5, 0.1, 1e-7, 1e15, 1e300, f64::NEG_INFINITY].map(number);
        assert_eq!(texts, ["0", "-0.0", "4", "-12.5", "0.1", "1e-7", "1000000000000000.0", "1e300", "-.inf"]);
    }

    #[test]
    fn words_stand_without_quotes_in_yaml_alone() {
        for (text, yaml) in [
            ("glass", "glass"),
            ("Material.001", "Material.001"),
            ("two words", "two words"),
            ("models/über-hase.ply", "models/über-hase.ply"),
            ("", r#""""#),
            ("no: 1", r#""no: 1""#),
            ("null", r#""null""#),
            ("1.5", r#""1.5""#),
            ("#fff", r##""#fff""##),
            ("a\n\"b\"\\\u{1}", r#""a\n\"b\"\\\u0001""#),
        ] {
            assert_eq!(written(Scalar::text(text), Language::Yaml), yaml);
            let json = written(Scalar::text(text), Language::Json);
            assert_eq!(serde_json::from_str::<String>(&json).unwrap(), text);
        }
    }

    #[test]
    fn what_fits_on_a_line_is_on_one() {
        let long = format!("[{}]", ["123456"; 20].join(", "));
        let text = format!(
            "a: 1\nb: [{{c: 1}}, {{c: 2}}]\nd:\n  - matrix: {long}\n  - e:\n      f: {long}\n      g: []\nh: {{}}\n"
        );
        let parsed = parse(&text, Origin::File, &Limits::default()).ok().and_then(|parsed| parsed.root);
        assert_eq!(block(&parsed.unwrap()), text);
    }

    proptest! {
        #[test]
        fn every_number_reads_back_bit_by_bit(bits: u64) {
            let value = f64::from_bits(bits);
            let found = match read(&number(value)) {
                Scalar::Integer(value) => value as f64,
                Scalar::Float(value) => value,
                other => panic!("{other:?}"),
            };
            prop_assert!(found.to_bits() == bits || (found.is_nan() && value.is_nan()));
        }

        #[test]
        fn every_text_reads_back(text: String) {
            let value = Scalar::text(&text);
            prop_assert_eq!(read(&written(value.clone(), Language::Yaml)), value.clone());
            prop_assert_eq!(read(&written(value.clone(), Language::Json)), value);
        }
    }
}
