//! TOML into the tree.

use super::{Entry, KeyPath, Node, Source, Span, Value};
use crate::error::SceneError;
use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue};

pub(super) fn parse(source: &Source) -> Result<Node, SceneError> {
    let table = DeTable::parse(&source.text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let message = error.message().trim_end();
        let mend = if message.contains("duplicate key") {
            "keep one of the two"
        } else {
            "in TOML a line is `key = value`: text in quotes, numbers without a unit, lists in [ ], tables in { }"
        };
        source.error(&KeyPath::default(), span, message).mend(mend)
    })?;
    let span = 0..0;
    Ok(Node { span, value: Reader(source).table(table.into_inner(), &KeyPath::default())? })
}

struct Reader<'a>(&'a Source);

impl Reader<'_> {
    fn table(&self, table: DeTable, path: &KeyPath) -> Result<Value, SceneError> {
        let entries = table.into_iter().map(|(key, value)| {
            let (key_span, key) = (key.span(), key.into_inner().into_owned());
            let node = self.node(value, &path.key(&key))?;
            Ok(Entry { key, key_span, node })
        });
        Ok(Value::Table(entries.collect::<Result<_, _>>()?))
    }

    fn node(&self, value: Spanned<DeValue>, path: &KeyPath) -> Result<Node, SceneError> {
        let span = value.span();
        let value = match value.into_inner() {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Integer(whole) => {
                let parsed = i64::from_str_radix(whole.as_str(), whole.radix());
                Value::Whole(
                    parsed.map_err(|_| self.0.error(path, span.clone(), "the whole number is too large"))?,
                )
            }
            DeValue::Float(number) => Value::Number(self.number(number.as_str(), path, &span)?),
            DeValue::Boolean(truth) => Value::Truth(truth),
            DeValue::Datetime(_) => {
                return Err(self
                    .0
                    .error(path, span, "a date has no meaning in a scene")
                    .mend("write text in quotes, or a number"));
            }
            DeValue::Array(list) => {
                let nodes = list.into_iter().enumerate().map(|(i, value)| self.node(value, &path.index(i)));
                Value::List(nodes.collect::<Result<_, _>>()?)
            }
            DeValue::Table(table) => self.table(table, path)?,
        };
        Ok(Node { span, value })
    }

    fn number(&self, text: &str, path: &KeyPath, span: &Span) -> Result<f64, SceneError> {
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(super::json::not_finite(self.0, path, span)),
        }
    }
}
