//! Values that may be written in several forms, such as a colour: a number, a list, or a word.

use serde::de::{Deserializer, Error, SeqAccess, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The forms that a value may take; those that are not implemented are not legal.
pub(crate) trait Forms: Sized {
    /// All of the forms in words, to follow "must be".
    const FORMS: &'static str;

    fn from_number<E: Error>(number: f64) -> Result<Self, E> {
        Err(E::invalid_type(Unexpected::Float(number), &Self::FORMS))
    }

    fn from_text<E: Error>(text: &str) -> Result<Self, E> {
        Err(E::invalid_type(Unexpected::Str(text), &Self::FORMS))
    }

    fn from_list<'de, A: SeqAccess<'de>>(_: A) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Seq, &Self::FORMS))
    }

    fn from_mapping<'de, D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::invalid_type(Unexpected::Map, &Self::FORMS))
    }
}

/// Reads the form that is there; to implement `Deserialize` by.
pub(crate) struct OneOf<T>(PhantomData<T>);

/// The name by which [`OneOf`] asks the deserialiser, as a newtype, to hand on a mapping unread; no such type
/// exists.
pub(crate) const NAME: &str = "$lancer::OneOf";

impl<T: Forms> OneOf<T> {
    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
        deserializer.deserialize_newtype_struct(NAME, Self(PhantomData))
    }
}

/// Reads types in their [`Forms`].
macro_rules! deserialize_by_forms {
    ($($type:ty),+) => {$(
        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::scene_file::deserialize::OneOf::deserialize(deserializer)
            }
        }
    )+};
}
pub(crate) use deserialize_by_forms;

impl<'de, T: Forms> Visitor<'de> for OneOf<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::FORMS)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<T, E> {
        T::from_number(number)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<T, E> {
        T::from_number(number as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        T::from_text(text)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<T, A::Error> {
        T::from_list(list)
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, mapping: D) -> Result<T, D::Error> {
        T::from_mapping(mapping)
    }
}
