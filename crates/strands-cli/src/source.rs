//! Where a scene comes from: a file, standard input, or the scenes that this program brings.

use std::io::Read;
use std::path::{Path, PathBuf};

use strands_scene::{Scene, SceneError, SceneFile};

use crate::{Failure, colour_err};

/// A scene's text and what it takes to read it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The text.
    pub text: String,
    /// What to call it where something is wrong with it. Its ending tells TOML from JSON.
    pub file_name: String,
    /// Where the files that it names lie.
    folder: Option<PathBuf>,
}

impl Source {
    /// The same source with another text.
    pub fn with_text(&self, text: String) -> Self {
        Self { text, ..self.clone() }
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// What is wrong, with the line, the key and a mend.
    pub fn parse(&self) -> Result<Scene, Failure> {
        Scene::parse(&self.text, &self.file_name, self.folder.as_deref())
            .map_err(|error| Failure::Bad(error.render(colour_err())))
    }

    /// Reads a scene of which each rod can be solved by itself.
    ///
    /// # Errors
    /// As [`Source::parse`], and where joints tie its rods.
    pub fn parse_alone(&self) -> Result<Scene, Failure> {
        let scene = self.parse()?;
        scene.model.each_alone().map_err(Failure::bad)?;
        Ok(scene)
    }

    /// The text for a reader who has not the scene's folder: with the tables that it names written in. Without any it is as it was.
    ///
    /// # Errors
    /// What is wrong, with the line, the key and a mend.
    pub fn self_contained(&self) -> Result<String, Failure> {
        let bad = |error: SceneError| Failure::Bad(error.render(colour_err()));
        let as_written = SceneFile::parse(&self.text, &self.file_name).map_err(bad)?;
        let folder = self.folder.as_deref();
        let whole = SceneFile::parse_with_tables(&self.text, &self.file_name, folder).map_err(bad)?;
        Ok(match whole == as_written {
            true => self.text.clone(),
            false if self.is_json() => whole.to_json(),
            false => whole.to_toml(),
        })
    }

    /// Where a file is that the scene names.
    pub fn beside(&self, path: &str) -> PathBuf {
        self.folder.as_deref().map_or_else(|| PathBuf::from(path), |folder| folder.join(path))
    }

    /// Whether the text is JSON.
    pub fn is_json(&self) -> bool {
        Path::new(&self.file_name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
    }

    /// The path under which the page finds the scene.
    pub fn served_as(&self) -> &'static str {
        if self.is_json() { "scene.json" } else { "scene.toml" }
    }
}

/// Finds the scene that an argument means.
///
/// # Errors
/// Where there is none.
pub fn read(argument: &str) -> Result<Source, Failure> {
    if argument == "-" {
        let mut text = String::new();
        std::io::stdin()
            .read_to_string(&mut text)
            .map_err(|error| Failure::file("standard input", &error))?;
        let file_name = if text.trim_start().starts_with('{') { "stdin.json" } else { "stdin.toml" };
        return Ok(Source { text, file_name: file_name.to_owned(), folder: Some(PathBuf::from(".")) });
    }
    let path = Path::new(argument);
    let bare = path.extension().is_none() && path.components().count() == 1;
    if bare && !path.exists() {
        return bundled(argument);
    }
    let text = std::fs::read_to_string(path).map_err(|error| Failure::file(argument, &error))?;
    let folder = path.parent().map(Path::to_path_buf);
    Ok(Source { text, file_name: argument.to_owned(), folder })
}

/// A scene that this program brings.
///
/// # Errors
/// Where there is none of that name: those there are, and the nearest.
pub fn bundled(name: &str) -> Result<Source, Failure> {
    if let Some(scene) = strands_scene::bundled_scene(name) {
        return Ok(Source { text: scene.text.to_owned(), file_name: format!("{name}.toml"), folder: None });
    }
    let names: Vec<&str> = strands_scene::bundled().iter().map(|scene| scene.name).collect();
    let distance = |other: &&&str| strsim::damerau_levenshtein(name, other);
    let nearest = names.iter().min_by_key(distance).filter(|other| distance(other) <= 1 + other.len() / 3);
    let hint = nearest.map_or_else(String::new, |other| format!("; did you mean `{other}`?"));
    Err(Failure::bad(format!(
        "there is no file and no bundled scene named `{name}`{hint}\nBundled scenes: {}",
        names.join(", ")
    )))
}

/// The JSON Schema of scene files.
pub fn schema() -> String {
    format!("{:#}", strands_scene::schema())
}
