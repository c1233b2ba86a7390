//! Vectors and transforms.

use super::number::{Finite, Number};
use crate::scene_file::deserialize::{Forms, Spanned, deserialize_by_forms};
use lancer_core::geometry::{DVec3, Transform};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Unexpected};
use std::borrow::Cow;

/// x, y and z.
#[derive(Deserialize, JsonSchema)]
#[serde(from = "[Number<Finite>; 3]")]
#[schemars(with = "[Number<Finite>; 3]", inline)]
pub(crate) struct Vector(pub(crate) DVec3);

impl From<[Number<Finite>; 3]> for Vector {
    fn from(coordinates: [Number<Finite>; 3]) -> Self {
        Self(coordinates.map(|coordinate| coordinate.get()).into())
    }
}

/// One step of a transform.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Step {
    /// Scales by one factor, or by one for each axis; negative ones mirror.
    Scale(Factors),
    /// Turns about an axis through the origin.
    Rotate(Rotation),
    /// Moves.
    Translate(Vector),
    /// A 4 x 4 matrix, row by row, that is applied to column vectors; its last row is 0, 0, 0, 1.
    Matrix(Matrix),
}

/// A turn, counter-clockwise where the axis points at the viewer.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rotation {
    /// `x`, `y`, `z`, or a direction.
    axis: Axis,
    /// In degrees.
    angle: Number<Finite>,
}

/// One factor an axis.
pub(crate) struct Factors(DVec3);

impl Forms for Factors {
    const FORMS: &'static str = "a number or a list of three";

    fn from_number<E: Error>(number: f64) -> Result<Self, E> {
        Number::<Finite>::checked(number).map(|factor| Self(DVec3::splat(factor.get())))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        Vector::deserialize(SeqAccessDeserializer::new(list)).map(|factors| Self(factors.0))
    }
}

/// A direction whose greatest coordinate is 1.
pub(crate) struct Axis(DVec3);

impl Axis {
    const NOT_ZERO: &'static str = "x, y, z or a direction other than [0, 0, 0]";
}

impl Forms for Axis {
    const FORMS: &'static str = "x, y, z or a list of three numbers";

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        match text {
            "x" => Ok(Self(DVec3::X)),
            "y" => Ok(Self(DVec3::Y)),
            "z" => Ok(Self(DVec3::Z)),
            _ => Err(E::invalid_value(Unexpected::Str(text), &Self::FORMS)),
        }
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let Vector(direction) = Vector::deserialize(SeqAccessDeserializer::new(list))?;
        let greatest = direction.abs().max_element();
        if greatest == 0.0 {
            return Err(A::Error::invalid_value(Unexpected::Other("[0, 0, 0]"), &Self::NOT_ZERO));
        }
        // Scaled first, so that the square of its length neither overflows nor vanishes.
        Ok(Self(direction / greatest))
    }
}

/// The rows of an affine map.
#[derive(Deserialize, JsonSchema)]
#[serde(try_from = "[Number<Finite>; 16]")]
#[schemars(with = "[Number<Finite>; 16]", inline)]
pub(crate) struct Matrix([[f64; 4]; 4]);

impl TryFrom<[Number<Finite>; 16]> for Matrix {
    type Error = &'static str;

    fn try_from(numbers: [Number<Finite>; 16]) -> Result<Self, Self::Error> {
        let rows = std::array::from_fn(|row| std::array::from_fn(|column| numbers[4 * row + column].get()));
        if rows[3] != [0.0, 0.0, 0.0, 1.0] {
            return Err("the last four numbers of the matrix must be 0, 0, 0, 1: it is written row by row");
        }
        Ok(Self(rows))
    }
}

impl Step {
    pub(crate) fn to_transform(&self) -> Transform {
        match self {
            Self::Scale(factors) => Transform::scale(factors.0),
            Self::Rotate(Rotation { axis, angle }) => Transform::rotate(axis.0, angle.get()),
            Self::Translate(offset) => Transform::translate(offset.0),
            Self::Matrix(Matrix(rows)) => {
                let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
                Transform::from_columns(column(0), column(1), column(2), column(3))
            }
        }
    }
}

/// The steps one after another.
pub(crate) fn transform_of(steps: &[Spanned<Step>]) -> Transform {
    steps.iter().fold(Transform::IDENTITY, |before, step| before.then(step.value.to_transform()))
}

deserialize_by_forms!(Factors, Axis);

impl JsonSchema for Factors {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Factors".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, Vector::json_schema(generator)] })
    }
}

impl JsonSchema for Axis {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Axis".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "enum": ["x", "y", "z"] }, Vector::json_schema(generator)] })
    }
}
