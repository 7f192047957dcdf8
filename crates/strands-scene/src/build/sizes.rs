//! What a shape is given by: keys that belong to it, and sizes that are there.

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::words;

/// The sizes of a shape, as written.
pub(super) struct Sizes<'a> {
    document: &'a Document,
    path: &'a KeyPath,
    needs: String,
}

impl<'a> Sizes<'a> {
    /// Of a shape with some keys, where each of those that may be `given` is or is not.
    ///
    /// # Errors
    /// Where a key is given that belongs to another shape.
    pub fn new(
        document: &'a Document,
        path: &'a KeyPath,
        (shape, keys): (&str, &[&str]),
        given: &[(&str, bool)],
    ) -> Result<Self, SceneError> {
        let needs = format!("{shape} is given by {}", words::quoted(keys));
        if let Some((key, _)) = given.iter().find(|(key, given)| *given && !keys.contains(key)) {
            let error = document.error(&path.key(key), format!("`{key}` does not belong to {shape}"));
            return Err(error.mend(needs));
        }
        Ok(Self { document, path, needs })
    }

    /// That a key is missing.
    pub fn missing(&self, key: &str) -> SceneError {
        self.document.error(&self.path.key(key), format!("`{key}` is missing")).mend(self.needs.clone())
    }

    /// The radii of a ring, of its centre line and of its wire.
    ///
    /// # Errors
    /// Where one is not there or not positive, or leaves no hole.
    pub fn ring(&self, radius: Option<f64>, wire_radius: Option<f64>) -> Result<[f64; 2], SceneError> {
        let [radius, wire] = [self.positive("radius", radius)?, self.positive("wire_radius", wire_radius)?];
        if wire < radius {
            return Ok([radius, wire]);
        }
        let message = format!("a wire of this radius leaves no hole in a ring of {radius} m");
        let error = self.document.error(&self.path.key("wire_radius"), message);
        Err(error.mend("`radius` is that of the centre line: the hole's is `radius` less `wire_radius`"))
    }

    /// A size, which has to be there and positive.
    ///
    /// # Errors
    /// Where it is not.
    pub fn positive(&self, key: &str, size: Option<f64>) -> Result<f64, SceneError> {
        self.document.positive(&self.path.key(key), size.ok_or_else(|| self.missing(key))?)
    }
}
