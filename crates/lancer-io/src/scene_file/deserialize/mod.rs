//! serde's side of a syntax tree: any `Deserialize` type from a [`Node`], with places.
//!
//! In: a tree. Out: a value, and all of the problems that kept parts of the tree from being part of it. It knows
//! nothing of scenes.
//!
//! Two types of its own go beyond serde: [`Spanned`] learns where it stands, and [`OneOf`] reads values that may
//! take several forms.

mod error;
mod one_of;
mod spanned;

pub(crate) use one_of::{Forms, OneOf, deserialize_by_forms};
pub(crate) use spanned::Spanned;

use super::syntax::{Entry, Node, Problem, Scalar, Value};
use error::Error;
use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, Unexpected, VariantAccess,
    Visitor,
};
use serde::forward_to_deserialize_any;
use std::marker::PhantomData;
use std::rc::Rc;
use std::slice;

/// Reads a `T` from all that is sound in the document, and tells the rest.
///
/// serde stops at the first error. So the node at fault is taken out, and the document read again, until nothing
/// is wrong any more or `most` problems are found. What then is wrong only because a part of it was taken out is
/// taken out in its turn, silently. `None` where nothing is left, or too much is wrong.
pub(crate) fn read<'de, T: Deserialize<'de>>(root: &'de Node, most: usize) -> (Option<T>, Vec<Problem>) {
    let mut problems = Vec::new();
    let mut readings = 0;
    while problems.len() < most && readings < READINGS_PER_PROBLEM * most && !root.removed.get() {
        readings += 1;
        match read_node(root, PhantomData::<T>) {
            Ok(value) => return (Some(value), problems),
            Err(error) => problems.extend(error.into_problem(root)),
        }
    }
    (None, problems)
}

/// How often a document is read, at most, for each problem that may be told: its own reading, and those that
/// take out what it makes unreadable around it, a level each. Fewer may keep problems back; more lets a hostile
/// file take more time.
const READINGS_PER_PROBLEM: usize = 8;

/// Reads a value from a node, so that every error within has a place.
fn read_node<'de, T: DeserializeSeed<'de>>(node: &'de Node, seed: T) -> Result<T::Value, Error> {
    seed.deserialize(NodeDeserializer { node }).map_err(|error| error.of_node(node))
}

/// Reads a node.
#[derive(Clone, Copy)]
struct NodeDeserializer<'de> {
    node: &'de Node,
}

impl<'de> NodeDeserializer<'de> {
    fn visit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.value {
            Value::Scalar(scalar) => visit_scalar(scalar, visitor),
            Value::Sequence(items) => {
                let mut rest = Items { items: items.iter(), taken: 0 };
                let value = visitor.visit_seq(&mut rest)?;
                if rest.items.any(|item| !item.removed.get()) {
                    let expected = format!("a list of length {}", rest.taken);
                    return Err(Error::mismatch(format!("a list of {}", items.len()), expected));
                }
                Ok(value)
            }
            Value::Mapping(entries) => visitor.visit_map(Entries { entries: entries.iter(), current: None }),
        }
    }

    fn in_words(self) -> String {
        match &self.node.value {
            Value::Scalar(scalar) => error::in_words(unexpected(scalar)),
            Value::Sequence(_) => "a list".into(),
            Value::Mapping(_) => "a mapping".into(),
        }
    }
}

fn unexpected(scalar: &Scalar) -> Unexpected<'_> {
    match scalar {
        Scalar::Null => Unexpected::Unit,
        Scalar::Bool(value) => Unexpected::Bool(*value),
        Scalar::Integer(value) => Unexpected::Signed(*value),
        Scalar::Float(value) => Unexpected::Float(*value),
        Scalar::Text(text) => Unexpected::Str(text),
    }
}

fn visit_scalar<'de, V: Visitor<'de>>(scalar: &Scalar, visitor: V) -> Result<V::Value, Error> {
    match scalar {
        Scalar::Null => visitor.visit_unit(),
        Scalar::Bool(value) => visitor.visit_bool(*value),
        Scalar::Integer(value) => visitor.visit_i64(*value),
        Scalar::Float(value) => visitor.visit_f64(*value),
        Scalar::Text(text) => visitor.visit_str(text),
    }
}

impl<'de> Deserializer<'de> for NodeDeserializer<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.visit(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.node.value {
            Value::Scalar(Scalar::Null) => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        match (name, &self.node.value) {
            (spanned::NAME, _) => visitor.visit_seq(spanned::Parts::of(self)),
            (one_of::NAME, Value::Scalar(_) | Value::Sequence(_)) => self.visit(visitor),
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let present =
            self.node.entries().iter().filter(|entry| !entry.value.removed.get()).collect::<Vec<_>>();
        if let [entry] = present.as_slice() {
            return visitor.visit_enum(Variant { entry });
        }
        let keys = variants.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let found = match self.node.value {
            Value::Mapping(_) => format!("a mapping of {}", present.len()),
            _ => self.in_words(),
        };
        Err(Error::mismatch(found, format!("a mapping of one key out of {keys}")))
    }

    /// serde's own would also take a list of the fields' values in order, which no author means.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.node.value {
            Value::Mapping(_) => self.visit(visitor),
            _ => Err(Error::mismatch(self.in_words(), "a mapping")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq
        tuple tuple_struct map identifier ignored_any
    }
}

/// The items of a list that were not taken out.
struct Items<'de> {
    items: slice::Iter<'de, Rc<Node>>,
    taken: usize,
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some(node) = self.items.find(|item| !item.removed.get()) else { return Ok(None) };
        let index = self.taken;
        self.taken += 1;
        read_node(node, seed).map(Some).map_err(|error| error.in_item(index))
    }
}

/// The entries of a mapping that were not taken out.
struct Entries<'de> {
    entries: slice::Iter<'de, Entry>,
    current: Option<&'de Entry>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.current = self.entries.find(|entry| !entry.value.removed.get());
        let Some(entry) = self.current else { return Ok(None) };
        let key = seed.deserialize(KeyDeserializer { entry });
        key.map(Some).map_err(|error| error.of_key(entry.key_place, &entry.value))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let entry = self.current.expect("serde asks for the key first");
        read_value(entry, seed)
    }
}

fn read_value<'de, V: DeserializeSeed<'de>>(entry: &'de Entry, seed: V) -> Result<V::Value, Error> {
    read_node(&entry.value, seed).map_err(|error| error.in_key(&entry.key))
}

/// Reads a key.
struct KeyDeserializer<'de> {
    entry: &'de Entry,
}

impl<'de> Deserializer<'de> for KeyDeserializer<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_str(&self.entry.key)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        match name {
            spanned::NAME => visitor.visit_seq(spanned::Parts::new(self.entry.key_place, true, self)),
            _ => visitor.visit_newtype_struct(self),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

/// A variant written as a mapping of one key.
struct Variant<'de> {
    entry: &'de Entry,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Error> {
        let name = StrDeserializer::<Error>::new(&self.entry.key);
        match seed.deserialize(name) {
            Ok(value) => Ok((value, self)),
            Err(error) => Err(error.of_key(self.entry.key_place, &self.entry.value)),
        }
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Err(Error::mismatch("a mapping", format!("the word `{}` alone", self.entry.key)))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        read_value(self.entry, seed)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.content().deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.content().deserialize_any(visitor)
    }
}

impl<'de> Variant<'de> {
    fn content(&self) -> NodeDeserializer<'de> {
        NodeDeserializer { node: &self.entry.value }
    }
}
