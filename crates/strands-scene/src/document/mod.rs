//! A scene's text as a tree in which every key and value knows where it stands.
//!
//! TOML and JSON are read into the same tree, so that everything after it (types, checks, errors) exists once.

mod json;
mod path;
mod read;
mod toml;

pub(crate) use path::{KeyPath, Step};
pub(crate) use read::from_document;

use crate::error::SceneError;
use std::ops::Range;
use std::sync::Arc;

/// Bytes of the text.
pub(crate) type Span = Range<usize>;

/// A value and where it stands.
#[derive(Debug)]
pub(crate) struct Node {
    pub span: Span,
    pub value: Value,
}

/// What a scene file is made of.
#[derive(Debug)]
pub(crate) enum Value {
    Text(String),
    Whole(i64),
    Number(f64),
    Truth(bool),
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key of a table with its value.
#[derive(Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub node: Node,
}

/// The text of a scene and its tree.
#[derive(Debug)]
pub(crate) struct Document {
    pub source: Source,
    pub root: Node,
}

/// The text of a scene and the file's name, which errors show.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub file: Arc<str>,
    pub text: Arc<str>,
}

impl Document {
    /// Reads a text, as JSON where the file's name ends in `.json`, else as TOML.
    pub fn parse(text: &str, file: &str) -> Result<Self, SceneError> {
        let source = Source { file: file.into(), text: text.into() };
        let json =
            std::path::Path::new(file).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let root = if json { json::parse(&source)? } else { toml::parse(&source)? };
        Ok(Self { source, root })
    }

    /// An error at a path: at its value, or where the path has nothing written, at the nearest table around it.
    pub fn error(&self, path: &KeyPath, message: impl Into<String>) -> SceneError {
        self.source.error(path, self.span(path), message)
    }

    fn span(&self, path: &KeyPath) -> Span {
        let (mut node, mut span) = (&self.root, self.root.span.clone());
        for step in path.steps() {
            let found = match (&node.value, step) {
                (Value::Table(entries), Step::Key(key)) => {
                    entries.iter().find(|e| e.key == *key).map(|e| (&e.node, e.place()))
                }
                (Value::List(nodes), Step::Index(i)) => nodes.get(*i).map(|node| (node, node.span.clone())),
                _ => None,
            };
            let Some((inner, place)) = found else { break };
            (node, span) = (inner, place);
        }
        span
    }
}

impl Entry {
    /// Where to point to for this entry: a table by its key, anything else by its value.
    pub fn place(&self) -> Span {
        match self.node.value {
            Value::Table(_) => self.key_span.clone(),
            _ => self.node.span.clone(),
        }
    }
}

impl Source {
    pub fn error(&self, path: &KeyPath, span: Span, message: impl Into<String>) -> SceneError {
        SceneError::new(self, span, path.to_string(), message.into())
    }
}
