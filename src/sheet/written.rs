//! Reading of values that a file can write in more than one form: as a word, a number, a list or a table.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserializer;
use serde::de::{Error, MapAccess, SeqAccess, Unexpected, Visitor};

/// A value with more than one written form. A form that the value does not have is refused, with the forms that it has.
pub(crate) trait Written: Sized {
    /// The forms, as they stand after "expected" in messages.
    const FORMS: &'static str;

    /// Reads a text in quotes.
    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        Err(E::invalid_type(Unexpected::Str(word), &Self::FORMS))
    }

    /// Reads a number; `written` is what messages name.
    fn from_number<E: Error>(_: f64, written: Unexpected<'_>) -> Result<Self, E> {
        Err(E::invalid_type(written, &Self::FORMS))
    }

    /// Reads a number without a decimal point and an exponent.
    fn from_whole<E: Error>(number: i64) -> Result<Self, E> {
        Self::from_number(number as f64, Unexpected::Signed(number))
    }

    /// Reads a number without a sign, as JSON has it; in TOML only those that are too large for an `i64`.
    fn from_unsigned<E: Error>(number: u64) -> Result<Self, E> {
        Err(E::invalid_type(Unexpected::Unsigned(number), &Self::FORMS))
    }

    /// Reads a list in brackets.
    fn from_list<'de, A: SeqAccess<'de>>(_: A) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Seq, &Self::FORMS))
    }

    /// Reads a table.
    fn from_table<'de, A: MapAccess<'de>>(_: A) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Map, &Self::FORMS))
    }
}

/// Reads a value in the form in which it is written.
pub(crate) fn read<'de, T: Written, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    deserializer.deserialize_any(AnyForm(PhantomData))
}

/// Implements `Deserialize` by the forms of a value.
macro_rules! read_as_written {
    ($($type:ty),+) => {$(
        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::sheet::written::read(deserializer)
            }
        }
    )+};
}
pub(crate) use read_as_written;

/// Implements the schema "any of these forms" for a type, to match the visitor that reads the forms.
macro_rules! schema_any_of {
    ($type:ident as $name:literal, $generator:ident, $forms:tt) => {
        impl schemars::JsonSchema for $type {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                $name.into()
            }

            fn json_schema($generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({ "anyOf": $forms })
            }
        }
    };
}
pub(crate) use schema_any_of;

struct AnyForm<T>(PhantomData<T>);

impl<'de, T: Written> Visitor<'de> for AnyForm<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(T::FORMS)
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<T, E> {
        T::from_word(word)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<T, E> {
        T::from_number(number, Unexpected::Float(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<T, E> {
        T::from_whole(number)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<T, E> {
        T::from_unsigned(number)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<T, A::Error> {
        T::from_list(list)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<T, A::Error> {
        T::from_table(table)
    }
}
