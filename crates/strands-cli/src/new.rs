//! `strands new`: a scene file to start from.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

use toml_edit::DocumentMut;

use crate::args::New;
use crate::{Failure, say, source};

/// Writes the template under a new name, its comments kept.
///
/// # Errors
/// Where there is no such template, the name is no file's name, or the file is there already.
pub fn run(options: &New) -> Result<(), Failure> {
    let name = options.name.strip_suffix(".toml").unwrap_or(&options.name);
    if name.is_empty() || name.contains(['/', '\\']) || name.starts_with(['.', '-']) {
        return Err(Failure::bad(format!(
            "`{}` is no name for a scene: it becomes the file NAME.toml here",
            options.name
        )));
    }
    let template = source::bundled(&options.template)?;
    let mut scene: DocumentMut = template.text.parse().map_err(Failure::bad)?;
    if let Some(value) = scene.get_mut("name").and_then(toml_edit::Item::as_value_mut) {
        let decor = value.decor().clone();
        *value = name.into();
        *value.decor_mut() = decor;
    }
    let path = PathBuf::from(format!("{name}.toml"));
    let mut file = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&path)
        .map_err(|error| Failure::file(path.display(), &error))?;
    file.write_all(scene.to_string().as_bytes()).map_err(Failure::bad)?;
    say(&format!(
        "{} written; `strands solve {}` solves it, `strands view {}` shows it",
        path.display(),
        path.display(),
        path.display()
    ))
}
