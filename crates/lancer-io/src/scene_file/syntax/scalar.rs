//! Scalars by the core schema of YAML 1.2 (chapter 10.3), of which JSON's is a part.

use std::rc::Rc;

/// The value of a scalar.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Scalar {
    Null,
    Bool(bool),
    Integer(i64),
    Float(f64),
    Text(Rc<str>),
}

impl Scalar {
    pub(crate) fn text(text: &str) -> Self {
        Self::Text(text.into())
    }

    /// The value of a scalar that is written without quotes.
    pub(crate) fn from_plain(text: &str) -> Self {
        match text {
            "" | "~" | "null" | "Null" | "NULL" => Self::Null,
            "true" | "True" | "TRUE" => Self::Bool(true),
            "false" | "False" | "FALSE" => Self::Bool(false),
            ".nan" | ".NaN" | ".NAN" => Self::Float(f64::NAN),
            _ => number(text).unwrap_or_else(|| Self::text(text)),
        }
    }
}

/// Whether two scalars mean the same to every reader: numbers do by value, whether written whole or not.
pub(crate) fn same_scalar(a: &Scalar, b: &Scalar) -> bool {
    let number = |scalar: &Scalar| match scalar {
        Scalar::Integer(value) => Some(*value as f64),
        Scalar::Float(value) => Some(*value),
        _ => None,
    };
    match (number(a), number(b)) {
        (Some(x), Some(y)) => x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan()),
        _ => a == b,
    }
}

fn number(text: &str) -> Option<Scalar> {
    if let Some(digits) = text.strip_prefix("0x") {
        return in_radix(digits, 16);
    }
    if let Some(digits) = text.strip_prefix("0o") {
        return in_radix(digits, 8);
    }
    let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text);
    if matches!(unsigned, ".inf" | ".Inf" | ".INF") {
        let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
        return Some(Scalar::Float(sign * f64::INFINITY));
    }
    // Rust also reads `inf`, `nan` and `infinity`, which here are words.
    if !unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return None;
    }
    text.parse().map(Scalar::Integer).or_else(|_| text.parse().map(Scalar::Float)).ok()
}

fn in_radix(digits: &str, radix: u32) -> Option<Scalar> {
    // A sign is legal for Rust after the prefix, and for YAML not.
    digits
        .chars()
        .all(|c| c.is_digit(radix))
        .then(|| i64::from_str_radix(digits, radix).ok().map(Scalar::Integer))?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_scalars_follow_the_core_schema() {
        for (text, value) in [
            ("", Scalar::Null),
            ("~", Scalar::Null),
            ("True", Scalar::Bool(true)),
            ("-12", Scalar::Integer(-12)),
            ("+7", Scalar::Integer(7)),
            ("0x1F", Scalar::Integer(31)),
            ("0o17", Scalar::Integer(15)),
            ("1e3", Scalar::Float(1000.0)),
            (".5", Scalar::Float(0.5)),
            ("-1.", Scalar::Float(-1.0)),
            ("-.inf", Scalar::Float(f64::NEG_INFINITY)),
            ("99999999999999999999", Scalar::Float(1e20)),
        ] {
            assert_eq!(Scalar::from_plain(text), value, "{text}");
        }
        assert!(matches!(Scalar::from_plain(".nan"), Scalar::Float(x) if x.is_nan()));
    }

    #[test]
    fn words_that_other_schemas_read_as_values_are_text() {
        for text in
            ["y", "yes", "no", "on", "inf", "nan", "infinity", "0x", "0x-1", "1_000", "12:30", "-", ".", "1e"]
        {
            assert_eq!(Scalar::from_plain(text), Scalar::text(text));
        }
    }
}
