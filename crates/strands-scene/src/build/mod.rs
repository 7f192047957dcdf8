//! From a scene as written to a model: every number checked, every default filled in.

mod body;
mod check;
mod contact;
mod hold;
mod initial;
mod joint;
mod load;
mod mesh;
mod passage;
mod profile;
mod rest;
mod rod;
mod settings;
mod sizes;
mod table;

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::SceneFile;
use crate::model::Model;
use indexmap::IndexMap;
use std::path::Path;
use strands::math::Vec3;
use strands::rod::{Material, Order};

/// What the parts of a scene need to know of the whole.
struct Context<'a> {
    document: &'a Document,
    file: &'a SceneFile,
    folder: Option<&'a Path>,
    gravity: Vec3,
    materials: IndexMap<&'a str, Material>,
    order: Order,
}

/// Puts the tables and meshes that a scene names into it, in place of their names.
pub(crate) fn write_in(
    document: &Document,
    file: &mut SceneFile,
    folder: Option<&Path>,
) -> Result<(), SceneError> {
    table::write_in(document, file, folder)?;
    contact::write_in(document, file, folder)
}

/// Builds the model of a scene.
pub(crate) fn model(
    document: &Document,
    file: &SceneFile,
    folder: Option<&Path>,
) -> Result<Model, SceneError> {
    if file.name.trim().is_empty() {
        let error = document.error(&KeyPath::of("name"), "the scene's name is empty");
        return Err(error.mend("give it a name, as `name = \"suture\"`"));
    }
    let context = Context {
        document,
        file,
        folder,
        gravity: Vec3::from(file.gravity.unwrap_or_default()),
        materials: settings::materials(document, file)?,
        order: settings::order(document, file)?,
    };
    let settings = settings::solver(document, file)?;
    settings::check_motion(document, file)?;
    initial::check_start(document, file)?;
    let dynamics = file.dynamics.clone().unwrap_or_default();
    let mut rods = Vec::with_capacity(file.rods.len());
    if file.rods.is_empty() {
        return Err(document.error(&KeyPath::of("rods"), "there is no rod").mend("add one: `[rods.thread]`"));
    }
    joint::check_names(&context)?;
    let mut elements = 0;
    for (name, rod) in &file.rods {
        rods.push(rod::rod(&context, name, rod, &mut elements)?);
    }
    if let Some(coupling) = &file.coupling {
        hold::hand(document, &coupling.hand, &mut rods)?;
    }
    let mut model = Model {
        name: file.name.clone(),
        gravity: context.gravity,
        rods,
        bodies: body::bodies(&context)?,
        joints: Vec::new(),
        wind: file.wind.as_ref().map_or(Vec3::ZERO, |wind| wind.velocity.into()),
        surfaces: contact::surfaces(&context)?,
        obstacles: contact::obstacles(&context)?,
        eyelets: Vec::new(),
        settings,
        dynamics,
    };
    contact::check_rings(document, &model)?;
    model.joints = joint::joints(&context, &model)?;
    model.eyelets = passage::eyelets(&context, &model)?;
    Ok(model)
}
