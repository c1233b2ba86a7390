//! Values that know where they stand.

use super::{Error, NodeDeserializer};
use crate::scene_file::syntax::{Origin, Place};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::U64Deserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error as _, IntoDeserializer, SeqAccess, Visitor,
};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// A value, its place, and whether all of it could be read. Read by this module's deserialiser alone; in the schema it is the bare value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spanned<T> {
    pub(crate) place: Place,
    /// Whether nothing directly in it was at fault and taken out.
    pub(crate) is_whole: bool,
    pub(crate) value: T,
}

/// The name by which [`Spanned`] asks the deserialiser for its place, as a newtype; no such type exists.
pub(crate) const NAME: &str = "$lancer::Spanned";

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Spanned<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(NAME, PartsVisitor(PhantomData))
    }
}

struct PartsVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for PartsVisitor<T> {
    type Value = Spanned<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value with its place")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Spanned<T>, A::Error> {
        let mut number =
            || parts.next_element::<u64>()?.ok_or_else(|| A::Error::custom("a number is missing"));
        let (place, is_whole) = unpack([number()?, number()?, number()?, number()?]);
        let value = parts.next_element()?.ok_or_else(|| A::Error::custom("the value is missing"))?;
        Ok(Spanned { place, is_whole, value })
    }
}

/// All but the value as numbers, then the value, as a sequence.
pub(crate) struct Parts<D> {
    numbers: std::array::IntoIter<u64, 4>,
    value: Option<D>,
}

impl<D> Parts<D> {
    pub(crate) fn new(place: Place, is_whole: bool, value: D) -> Self {
        Self { numbers: pack(place, is_whole).into_iter(), value: Some(value) }
    }
}

impl<'de> Parts<NodeDeserializer<'de>> {
    pub(crate) fn of(node: NodeDeserializer<'de>) -> Self {
        Self::new(node.node.place, !node.node.lost_a_part(), node)
    }
}

impl<'de, D: Deserializer<'de, Error = Error>> SeqAccess<'de> for Parts<D> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if let Some(number) = self.numbers.next() {
            let number: U64Deserializer<Error> = number.into_deserializer();
            return seed.deserialize(number).map(Some);
        }
        self.value.take().map(|value| seed.deserialize(value)).transpose()
    }
}

fn pack(place: Place, is_whole: bool) -> [u64; 4] {
    let origin = match place.origin {
        Origin::File => 0,
        Origin::Override(index) => u64::from(index) + 1,
    };
    [origin, place.line.into(), place.column.into(), is_whole.into()]
}

fn unpack([origin, line, column, is_whole]: [u64; 4]) -> (Place, bool) {
    let origin = match origin.checked_sub(1) {
        None => Origin::File,
        Some(index) => Origin::Override(index as u32),
    };
    (Place { origin, line: line as u32, column: column as u32 }, is_whole != 0)
}

impl<T: JsonSchema> JsonSchema for Spanned<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
