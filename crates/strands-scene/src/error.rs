//! What is wrong with a scene: where, what, and how to mend it.

use crate::document::{Source, Span};
use annotate_snippets::{AnnotationKind, Element, Level, Renderer, Snippet};
use std::fmt;

/// An error in a scene, at its line, column and key.
///
/// [`Display`](fmt::Display) shows the line with a marker under the place and the mend below it; [`render`](SceneError::render) does
/// so in colour.
#[derive(Clone)]
pub struct SceneError(Box<Details>);

#[derive(Clone)]
struct Details {
    source: Option<Source>,
    file: String,
    span: Span,
    key: String,
    message: String,
    mends: Vec<String>,
}

impl SceneError {
    pub(crate) fn new(source: &Source, span: Span, key: String, message: String) -> Self {
        let (file, source) = (source.file.to_string(), Some(source.clone()));
        Self(Box::new(Details { source, file, span, key, message, mends: Vec::new() }))
    }

    /// A scene file that cannot be read at all.
    pub(crate) fn unreadable(file: &std::path::Path, error: &std::io::Error) -> Self {
        let (file, message) =
            (file.display().to_string(), format!("cannot read {}: {error}", file.display()));
        Self(Box::new(Details {
            source: None,
            file,
            span: 0..0,
            key: String::new(),
            message,
            mends: Vec::new(),
        }))
    }

    /// This error with one more advice.
    #[must_use]
    pub(crate) fn mend(mut self, mend: impl Into<String>) -> Self {
        self.0.mends.push(mend.into());
        self
    }

    /// The file's name, as it was given.
    pub fn file(&self) -> &str {
        &self.0.file
    }

    /// The line, counted from 1; 0 where the file could not be read.
    pub fn line(&self) -> usize {
        self.before().map_or(0, |before| before.matches('\n').count() + 1)
    }

    /// The column in characters, counted from 1; 0 where the file could not be read.
    pub fn column(&self) -> usize {
        self.before().map_or(0, |before| before.chars().rev().take_while(|c| *c != '\n').count() + 1)
    }

    /// The path of the key, as `rods.thread.section.radius`; empty for the scene as a whole.
    pub fn key(&self) -> &str {
        &self.0.key
    }

    /// What is wrong, in one sentence without the place.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// What to do about it.
    pub fn mends(&self) -> &[String] {
        &self.0.mends
    }

    /// The error as text for a terminal, with its line marked.
    pub fn render(&self, colour: bool) -> String {
        self.render_as(Level::ERROR, colour)
    }

    /// The same under another title than "error".
    pub(crate) fn render_as(&self, level: Level<'static>, colour: bool) -> String {
        let Details { source, file, span, key, message, mends } = &*self.0;
        let mut elements: Vec<Element<'_>> = Vec::with_capacity(1 + mends.len());
        if let Some(source) = source {
            let mark =
                AnnotationKind::Primary.span(span.clone()).label((!key.is_empty()).then_some(key.as_str()));
            elements.push(Snippet::source(&*source.text).path(file.as_str()).annotation(mark).into());
        }
        elements.extend(mends.iter().map(|mend| Element::from(Level::HELP.message(mend.as_str()))));
        let group = level.primary_title(message.as_str()).elements(elements);
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[group])
    }

    fn before(&self) -> Option<&str> {
        let source = self.0.source.as_ref()?;
        source.text.get(..self.0.span.start.min(source.text.len()))
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}
