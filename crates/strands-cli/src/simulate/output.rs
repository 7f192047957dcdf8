//! The files that a simulation is written to.

use std::path::Path;

use strands_scene::Model;
use strands_scene::write::{
    Frame, Ran, motion_csv, motion_glb, motion_json, motion_npz, motion_pvd, motion_usda,
};

use crate::Failure;
use crate::ending::format_of;

/// What frames can be written as.
#[derive(Clone, Copy, Debug)]
pub enum Format {
    Json,
    Csv,
    Npz,
    Pvd,
    Usda,
    Glb,
}

impl Format {
    const ALL: [(&str, Self); 6] = [
        ("json", Self::Json),
        ("csv", Self::Csv),
        ("npz", Self::Npz),
        ("pvd", Self::Pvd),
        ("usda", Self::Usda),
        ("glb", Self::Glb),
    ];

    /// The format that a file's ending asks for.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        format_of(path, "frames are written", &Self::ALL)
    }

    /// Writes the frames.
    pub fn write(self, path: &Path, model: &Model, frames: &[Frame], ran: &Ran) -> Result<(), Failure> {
        let bytes = match self {
            Self::Json => motion_json(model, frames, ran).into_bytes(),
            Self::Csv => motion_csv(model, frames).into_bytes(),
            Self::Npz => motion_npz(model, frames),
            Self::Pvd => return write_collection(path, model, frames),
            Self::Usda => motion_usda(model, frames).into_bytes(),
            Self::Glb => motion_glb(model, frames).map_err(Failure::bad)?,
        };
        write_file(path, bytes)
    }
}

/// Writes a collection, and its files into a folder beside it with its name.
fn write_collection(path: &Path, model: &Model, frames: &[Frame]) -> Result<(), Failure> {
    let folder = path.with_extension("");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file(folder.display(), &error))?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let (collection, parts) = motion_pvd(model, frames, &name);
    for (part, text) in parts {
        write_file(&folder.join(part), text)?;
    }
    write_file(path, collection)
}

fn write_file(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    std::fs::write(path, bytes).map_err(|error| Failure::file(path.display(), &error))
}
