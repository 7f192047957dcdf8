//! Scene files: what users write, as a model to solve, and the writers of what comes out.
//!
//! A scene goes text → [`SceneFile`] (as written) → [`Model`] (checked, SI, ready to solve). Everything that is wrong on the way is a
//! [`SceneError`] that points at the line and says how to mend it. Solutions leave through [`mod@write`].
//!
//! ```
//! use strands::statics::{Workspace, solve};
//! let scene = strands_scene::bundled_scene("cantilever").expect("it is bundled");
//! let scene = strands_scene::Scene::parse(scene.text, "cantilever.toml", None)?;
//! let rod = &scene.model.rods[0];
//! let solution = solve(&rod.problem, &scene.model.settings, None, &mut Workspace::default())?;
//! let answer = strands_scene::write::json(&scene.model, &[(&rod.name, &solution)], None);
//! # assert!(answer.contains("converged"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod build;
mod bundled;
pub mod check;
mod document;
mod error;
mod file;
mod model;
mod schema;
mod state_file;
mod words;
pub mod write;

pub use bundled::{Bundled, bundled, bundled_scene};
pub use error::SceneError;
pub use file::*;
pub use model::{BodyShape, MeshChoice, MeshError, Model, ModelBody, ModelRod, OUTPUT_RATE, Tied};
pub use schema::schema;
pub use state_file::{StateError, read_state, state_json};

use document::{Document, KeyPath, Value};
use std::path::Path;
use std::sync::Arc;

/// The version of the format that this crate reads.
const FORMAT: i64 = 1;

/// A scene, as written and as understood.
#[derive(Clone, Debug)]
pub struct Scene {
    /// As written.
    pub file: SceneFile,
    /// As understood.
    pub model: Model,
    /// The text, to point at.
    document: Arc<Document>,
}

impl Scene {
    /// Reads a scene from a text: JSON where `file_name` ends in `.json`, else TOML. Other files that it names are sought in `folder`.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place and a mend.
    pub fn parse(text: &str, file_name: &str, folder: Option<&Path>) -> Result<Self, SceneError> {
        let (document, file) = written(text, file_name)?;
        let model = build::model(&document, &file, folder)?;
        Ok(Self { file, model, document: Arc::new(document) })
    }

    /// Reads a scene from a file.
    ///
    /// # Errors
    /// As [`Scene::parse`], and where the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::unreadable(path, &error))?;
        Self::parse(&text, &path.display().to_string(), path.parent())
    }
}

impl SceneFile {
    /// Reads a scene as written: JSON where `file_name` ends in `.json`, else TOML. Types and keys are checked, numbers are not.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place and a mend.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneError> {
        written(text, file_name).map(|(_, file)| file)
    }

    /// The same, with the tables that the scene names read from `folder` and written into it, so that it can be read where that folder is
    /// not.
    ///
    /// # Errors
    /// As [`SceneFile::parse`], and where a table cannot be read.
    pub fn parse_with_tables(text: &str, file_name: &str, folder: Option<&Path>) -> Result<Self, SceneError> {
        let (document, mut file) = written(text, file_name)?;
        build::write_in(&document, &mut file, folder)?;
        Ok(file)
    }
}

fn written(text: &str, file_name: &str) -> Result<(Document, SceneFile), SceneError> {
    let document = Document::parse(text, file_name)?;
    check_format(&document)?;
    let file = document::from_document(&document)?;
    Ok((document, file))
}

/// Refuses another version of the format before its unknown keys are complained about.
fn check_format(document: &Document) -> Result<(), SceneError> {
    let Value::Table(entries) = &document.root.value else { return Ok(()) };
    match entries.iter().find(|entry| entry.key == "format").map(|entry| &entry.node.value) {
        Some(Value::Whole(version)) if *version != FORMAT => Err(document
            .error(&KeyPath::of("format"), format!("format {version} is not known"))
            .mend(format!("this version reads format {FORMAT}: write `format = {FORMAT}`, or use a later version of Strands"))),
        _ => Ok(()),
    }
}
