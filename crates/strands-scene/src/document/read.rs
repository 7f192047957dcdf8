//! From the tree to the types, by serde, with every error at its key or value.
//!
//! serde's derived code tells what is wrong in pieces (which field is unknown, which are known); they are kept as pieces until the
//! place is known, and then put into words.

use super::{Document, Entry, KeyPath, Node, Span, Step, Value};
use crate::error::SceneError;
use crate::words;
use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected, IntoDeserializer,
    MapAccess, SeqAccess, Unexpected, VariantAccess, Visitor,
};
use std::fmt;

/// Reads a value of a type from a whole document.
pub(crate) fn from_document<'de, T: Deserialize<'de>>(document: &'de Document) -> Result<T, SceneError> {
    T::deserialize(&document.root).map_err(|error| {
        let path = KeyPath::from_innermost(error.steps);
        let located = document.source.error(&path, error.span.unwrap_or(0..0), error.message);
        if error.mends.is_empty() {
            let example = path.last_key().and_then(words::example);
            return located.mend(example.unwrap_or("`strands schema` lists every key and what it takes"));
        }
        error.mends.into_iter().fold(located, SceneError::mend)
    })
}

/// What serde found wrong, with its place as far as it is known: the steps from the innermost outwards.
#[derive(Debug)]
pub(crate) struct ReadError {
    message: String,
    mends: Vec<String>,
    steps: Vec<Step>,
    span: Option<Span>,
}

impl ReadError {
    fn new(message: String) -> Self {
        Self { message, mends: Vec::new(), steps: Vec::new(), span: None }
    }

    fn mend(mut self, mend: impl Into<String>) -> Self {
        self.mends.push(mend.into());
        self
    }

    fn within(mut self, step: Step, span: Span) -> Self {
        self.steps.push(step);
        self.span.get_or_insert(span);
        self
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}

impl serde::de::Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(message.to_string())
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::new(format!(
            "expected {}, found {}",
            words::expected(&expected.to_string()),
            words::found(&found)
        ))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::new(format!("expected {}, found {length}", words::expected(&expected.to_string())))
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        if let Some(later) = words::later(variant) {
            return Self::new(format!("`{variant}` is not in this version")).mend(later);
        }
        Self::new(format!("unknown value `{variant}`")).mend(words::choices(
            "possible values",
            variant,
            expected,
        ))
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        if let Some(later) = words::later(field) {
            return Self::new(format!("`{field}` is not in this version")).mend(later);
        }
        Self::new(format!("unknown key `{field}`")).mend(words::choices("the keys here", field, expected))
    }

    fn missing_field(field: &'static str) -> Self {
        let mut error = Self::new(format!("`{field}` is missing"));
        error.steps.push(Step::Key(field.to_owned()));
        error
    }

    fn duplicate_field(field: &'static str) -> Self {
        Self::new(format!("duplicate key `{field}`")).mend("keep one of the two")
    }
}

impl<'de> Deserializer<'de> for &'de Node {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.value {
            Value::Text(text) => visitor.visit_borrowed_str(text),
            Value::Whole(whole) => visitor.visit_i64(*whole),
            Value::Number(number) => visitor.visit_f64(*number),
            Value::Truth(truth) => visitor.visit_bool(*truth),
            Value::List(nodes) => {
                let expected = (&visitor as &dyn Expected).to_string();
                let mut items = Items { nodes, next: 0 };
                let value = visitor.visit_seq(&mut items)?;
                if items.next < nodes.len() {
                    return Err(ReadError::invalid_length(nodes.len(), &expected.as_str()));
                }
                Ok(value)
            }
            Value::Table(entries) => visitor.visit_map(Entries { entries, next: 0 }),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match &self.value {
            Value::Text(text) => visitor.visit_enum(Name(text)),
            _ => {
                let found = match &self.value {
                    Value::Whole(whole) => Unexpected::Signed(*whole),
                    Value::Number(number) => Unexpected::Float(*number),
                    Value::Truth(truth) => Unexpected::Bool(*truth),
                    Value::List(_) => Unexpected::Seq,
                    Value::Text(_) | Value::Table(_) => Unexpected::Map,
                };
                Err(ReadError::new(format!(
                    "expected one of {}, found {}",
                    words::quoted(variants),
                    words::found(&found)
                )))
            }
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}

impl<'de> IntoDeserializer<'de, ReadError> for &'de Node {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

struct Items<'de> {
    nodes: &'de [Node],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        let Some(node) = self.nodes.get(self.next) else { return Ok(None) };
        let step = Step::Index(self.next);
        self.next += 1;
        seed.deserialize(node).map(Some).map_err(|error| error.within(step, node.span.clone()))
    }
}

struct Entries<'de> {
    entries: &'de [Entry],
    next: usize,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some(entry) = self.entries.get(self.next) else { return Ok(None) };
        let key: StrDeserializer<'_, ReadError> = entry.key.as_str().into_deserializer();
        seed.deserialize(key)
            .map(Some)
            .map_err(|error| error.within(Step::Key(entry.key.clone()), entry.key_span.clone()))
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, ReadError> {
        let Some(entry) = self.entries.get(self.next) else {
            return Err(ReadError::custom("a value was asked for before its key"));
        };
        self.next += 1;
        seed.deserialize(&entry.node)
            .map_err(|error| error.within(Step::Key(entry.key.clone()), entry.place()))
    }
}

/// A word that names a variant.
struct Name<'de>(&'de str);

impl<'de> EnumAccess<'de> for Name<'de> {
    type Error = ReadError;
    type Variant = Self;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self), ReadError> {
        let name: StrDeserializer<'_, ReadError> = self.0.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> VariantAccess<'de> for Name<'de> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, _: T) -> Result<T::Value, ReadError> {
        Err(ReadError::custom(format!("`{}` is not a single word", self.0)))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, ReadError> {
        Err(ReadError::custom(format!("`{}` is not a single word", self.0)))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, ReadError> {
        Err(ReadError::custom(format!("`{}` is not a single word", self.0)))
    }
}
