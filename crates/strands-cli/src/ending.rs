//! What a file is written as: its ending says so.

use std::path::Path;

use crate::Failure;

/// Which of the formats, each with its ending, the file's ending asks for. `what` is what is to be written.
///
/// # Errors
/// Where it is none of them.
pub fn format_of<T: Copy>(path: &Path, what: &str, formats: &[(&str, T)]) -> Result<T, Failure> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let found = formats.iter().find(|(name, _)| ending.as_deref() == Some(*name));
    found.map(|(_, format)| *format).ok_or_else(|| {
        let known: Vec<String> = formats.iter().map(|(name, _)| format!(".{name}")).collect();
        Failure::bad(format!("{}: {what} by the file's ending, one of {}", path.display(), known.join(" ")))
    })
}
