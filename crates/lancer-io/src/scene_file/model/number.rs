//! Numbers that are checked as they are read, so that nothing later has to.

use crate::model::Crease;
use lancer_core::film::Tone;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// Which finite numbers are legal.
pub(crate) trait Range {
    /// The range in words, to follow "must be".
    const WORDS: &'static str;

    /// Whether a finite number is in the range.
    fn holds(number: f64) -> bool;

    /// The range for a JSON Schema.
    fn schema() -> Schema;
}

/// Every finite number.
pub(crate) struct Finite;

/// Above 0.
pub(crate) struct Positive;

/// 0 and above.
pub(crate) struct NotNegative;

/// From 0 to 1, both included.
pub(crate) struct Fraction;

/// Between 0 and 180, both excluded.
pub(crate) struct FieldOfView;

/// From 0 to 180, both included.
pub(crate) struct CreaseAngle;

/// From -100 to 100 stops, both included: [`Tone::MAX_EXPOSURE`].
pub(crate) struct Exposure;

impl Range for Finite {
    const WORDS: &'static str = "a finite number";

    fn holds(_: f64) -> bool {
        true
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number" })
    }
}

impl Range for Positive {
    const WORDS: &'static str = "a number above 0";

    fn holds(number: f64) -> bool {
        number > 0.0
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "exclusiveMinimum": 0 })
    }
}

impl Range for NotNegative {
    const WORDS: &'static str = "a number, 0 or above";

    fn holds(number: f64) -> bool {
        number >= 0.0
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "minimum": 0 })
    }
}

impl Range for Fraction {
    const WORDS: &'static str = "a number from 0 to 1";

    fn holds(number: f64) -> bool {
        (0.0..=1.0).contains(&number)
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "minimum": 0, "maximum": 1 })
    }
}

impl Range for FieldOfView {
    const WORDS: &'static str = "a number between 0 and 180, without the ends";

    fn holds(number: f64) -> bool {
        number > 0.0 && number < 180.0
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180 })
    }
}

impl Range for CreaseAngle {
    const WORDS: &'static str = "a number from 0 to 180";

    fn holds(number: f64) -> bool {
        Crease::from_degrees(number).is_some()
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "minimum": 0, "maximum": 180 })
    }
}

impl Range for Exposure {
    const WORDS: &'static str = "a number from -100 to 100";

    fn holds(number: f64) -> bool {
        number.abs() <= Tone::MAX_EXPOSURE
    }

    fn schema() -> Schema {
        json_schema!({ "type": "number", "minimum": -Tone::MAX_EXPOSURE, "maximum": Tone::MAX_EXPOSURE })
    }
}

/// A finite number within a range.
pub(crate) struct Number<R> {
    value: f64,
    range: PhantomData<R>,
}

impl<R: Range> Number<R> {
    /// The value that an author left out.
    ///
    /// # Panics
    /// Where it is out of its range.
    pub(crate) fn default_of(value: f64) -> Self {
        Self::checked::<serde::de::value::Error>(value).expect("defaults are legal")
    }

    pub(crate) fn checked<E: Error>(value: f64) -> Result<Self, E> {
        if !value.is_finite() {
            return Err(E::invalid_value(Unexpected::Float(value), &Finite::WORDS));
        }
        if !R::holds(value) {
            return Err(E::invalid_value(Unexpected::Float(value), &R::WORDS));
        }
        Ok(Self { value, range: PhantomData })
    }

    pub(crate) fn get(&self) -> f64 {
        self.value
    }
}

impl<'de, R: Range> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(NumberVisitor(PhantomData))
    }
}

struct NumberVisitor<R>(PhantomData<R>);

impl<R: Range> Visitor<'_> for NumberVisitor<R> {
    type Value = Number<R>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(R::WORDS)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Number<R>, E> {
        Number::checked(number)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Number<R>, E> {
        Number::checked(number as f64)
    }
}

impl<R: Range> JsonSchema for Number<R> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        R::schema()
    }
}

/// A whole number from `MIN` to `MAX`, both included.
pub(crate) struct Whole<const MIN: u64, const MAX: u64>(u32);

impl<const MIN: u64, const MAX: u64> Whole<MIN, MAX> {
    /// The value that an author left out.
    pub(crate) fn default_of(value: u32) -> Self {
        debug_assert!((MIN..=MAX).contains(&u64::from(value)), "defaults are legal");
        Self(value)
    }

    pub(crate) fn get(&self) -> u32 {
        self.0
    }
}

impl<'de, const MIN: u64, const MAX: u64> Deserialize<'de> for Whole<MIN, MAX> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_u64(WholeVisitor::<MIN, MAX>)
    }
}

struct WholeVisitor<const MIN: u64, const MAX: u64>;

impl<const MIN: u64, const MAX: u64> Visitor<'_> for WholeVisitor<MIN, MAX> {
    type Value = Whole<MIN, MAX>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if MIN == MAX { write!(f, "{MIN}") } else { write!(f, "a whole number from {MIN} to {MAX}") }
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
        u64::try_from(number)
            .ok()
            .filter(|number| (MIN..=MAX).contains(number))
            .and_then(|number| u32::try_from(number).ok())
            .map(Whole)
            .ok_or_else(|| E::invalid_value(Unexpected::Signed(number), &self))
    }

    /// Some writers of JSON have no other numbers than floats.
    fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
        if number.fract() == 0.0 && number.abs() <= f64::from(u32::MAX) {
            return self.visit_i64(number as i64);
        }
        Err(E::invalid_value(Unexpected::Float(number), &self))
    }
}

impl<const MIN: u64, const MAX: u64> JsonSchema for Whole<MIN, MAX> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Whole".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": MIN, "maximum": MAX })
    }
}
