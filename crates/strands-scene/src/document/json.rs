//! JSON into the tree.
//!
//! serde_json reads it one level at a time into raw values, which are slices of the text: where a slice lies in the text
//! is where the value stands.

use super::{Entry, KeyPath, Node, Source, Span, Value};
use crate::error::SceneError;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;

pub(super) fn parse(source: &Source) -> Result<Node, SceneError> {
    let raw: &RawValue = serde_json::from_str(&source.text).map_err(|error| {
        let at = offset(&source.text, error.line(), error.column());
        let said = error.to_string();
        let message = said.split(" at line ").next().unwrap_or(&said);
        let width = source.text[at..].chars().next().map_or(0, char::len_utf8);
        let error = source.error(&KeyPath::default(), at..at + width, message);
        error.mend("JSON has double quotes around every key, no comma after the last entry, and no comments")
    })?;
    let mut root = Reader(source).node(raw, &KeyPath::default())?;
    if !matches!(root.value, Value::Table(_)) {
        return Err(source
            .error(&KeyPath::default(), root.span, "a scene in JSON is an object")
            .mend("begin with { \"format\": 1, \"name\": …"));
    }
    root.span = 0..0;
    Ok(root)
}

/// What every number is refused with that is infinite, not a number, or too large.
pub(super) fn not_finite(source: &Source, path: &KeyPath, span: &Span) -> SceneError {
    source
        .error(path, span.clone(), "not a finite number")
        .mend("every quantity must be finite: leave the key out where it has no bound")
}

struct Reader<'a>(&'a Source);

impl Reader<'_> {
    fn node(&self, raw: &RawValue, path: &KeyPath) -> Result<Node, SceneError> {
        let (text, span) = (raw.get(), self.span(raw));
        let value = match text.as_bytes().first() {
            Some(b'{') => self.table(text, path, &span)?,
            Some(b'[') => {
                let raws: Vec<&RawValue> = self.read(text, path, &span)?;
                let nodes = raws.into_iter().enumerate().map(|(i, raw)| self.node(raw, &path.index(i)));
                Value::List(nodes.collect::<Result<_, _>>()?)
            }
            Some(b'"') => Value::Text(self.read(text, path, &span)?),
            Some(b't' | b'f') => Value::Truth(text == "true"),
            Some(b'n') => {
                let error = self.0.error(path, span, "null is no value");
                return Err(error.mend("leave the key out to take its default"));
            }
            _ => match (text.parse::<i64>(), text.parse::<f64>()) {
                (Ok(whole), _) => Value::Whole(whole),
                (_, Ok(number)) if number.is_finite() => Value::Number(number),
                _ => return Err(not_finite(self.0, path, &span)),
            },
        };
        Ok(Node { span, value })
    }

    fn table(&self, text: &str, path: &KeyPath, span: &Span) -> Result<Value, SceneError> {
        let RawTable(raws) = self.read(text, path, span)?;
        let mut entries: Vec<Entry> = Vec::with_capacity(raws.len());
        let mut seen = std::collections::HashSet::new();
        for (raw_key, raw) in raws {
            let key_span = self.span(raw_key);
            let key: String = self.read(raw_key.get(), path, &key_span)?;
            let path = path.key(&key);
            if !seen.insert(key.clone()) {
                let error = self.0.error(&path, key_span, format!("duplicate key `{key}`"));
                return Err(error.mend("keep one of the two"));
            }
            let node = self.node(raw, &path)?;
            entries.push(Entry { key, key_span, node });
        }
        Ok(Value::Table(entries))
    }

    fn read<'t, T: Deserialize<'t>>(
        &self,
        text: &'t str,
        path: &KeyPath,
        span: &Span,
    ) -> Result<T, SceneError> {
        serde_json::from_str(text).map_err(|error| self.0.error(path, span.clone(), error.to_string()))
    }

    /// Where a raw value lies in the text it was read from.
    fn span(&self, raw: &RawValue) -> Span {
        let start = raw.get().as_ptr().addr() - self.0.text.as_ptr().addr();
        start..start + raw.get().len()
    }
}

/// The entries of an object, as written.
struct RawTable<'t>(Vec<(&'t RawValue, &'t RawValue)>);

impl<'t> Deserialize<'t> for RawTable<'t> {
    fn deserialize<D: Deserializer<'t>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'t> Visitor<'t> for Entries {
            type Value = RawTable<'t>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'t>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(RawTable(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

/// The byte at a line and column, both counted from 1 and the column in bytes, as serde_json gives them.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let mut at = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
