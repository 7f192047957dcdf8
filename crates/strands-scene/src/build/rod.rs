//! One rod: its description, its mesh, its problem.

use super::{Context, hold, load, profile, rest};
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{KinematicsName, RodFile};
use crate::model::{MAX_ELEMENTS, MeshChoice, ModelRod, breaks};
use strands::math::Pose;
use strands::rod::{Kinematics, Rod, RodDescription, RodError};

/// Elements of a rod that says neither `elements` nor `tolerance`.
const DEFAULT_ELEMENTS: usize = 100;

/// Builds a rod; `total` counts the elements of the scene.
pub(super) fn rod(
    context: &Context,
    name: &str,
    file: &RodFile,
    total: &mut usize,
) -> Result<ModelRod, SceneError> {
    let document = context.document;
    let path = KeyPath::of("rods").key(name);
    let unloaded = rest::unloaded(context, &path, file)?;
    let length = unloaded.length;
    let description = RodDescription {
        length,
        kinematics: match file.kinematics {
            Some(KinematicsName::Kirchhoff) => Kinematics::Kirchhoff,
            Some(KinematicsName::Cosserat) | None => Kinematics::Cosserat,
        },
        profile: profile::profile(context, &path, file, length)?,
        rest: unloaded.shape,
        base: base(context, &path, file, unloaded.start)?,
    };
    let loads = load::loads(context, &path, file, length)?;
    let supports = hold::supports(context, &path, file, length)?;
    let breaks = breaks(&loads, &supports);
    let mesh = mesh_choice(context, &path, file, total)?;
    let elements = match mesh {
        MeshChoice::Elements(elements) => elements,
        MeshChoice::Tolerance(_) => DEFAULT_ELEMENTS.max(2 * (description.breaks().len() + breaks.len() + 1)),
    };
    let rod =
        Rod::with_elements(description, elements, &breaks, context.order).map_err(|error| match error {
            RodError::TooFewElements { needed, .. } => document
                .error(&path.key("elements"), error.to_string())
                .mend(format!("write `elements = {needed}` or more")),
            _ => document.error(&path, error.to_string()),
        })?;
    let problem = loads
        .problem(rod, &supports)
        .map_err(|error| document.error(&path.key("loads"), error.to_string()))?;
    let material = file.material.as_ref().and_then(|name| context.file.materials.get(name));
    let damping = material.and_then(|material| material.damping).unwrap_or(0.0);
    Ok(ModelRod { name: name.to_owned(), problem, hand: None, mesh, damping, loads, supports })
}

/// The frame of the rod's start.
fn base(context: &Context, path: &KeyPath, file: &RodFile, start: Option<Pose>) -> Result<Pose, SceneError> {
    let mut base = start.unwrap_or(Pose::IDENTITY);
    if let Some(position) = file.position {
        base.position = position.into();
    }
    if let Some(orientation) = file.orientation {
        base.rotation = context.document.quaternion(&path.key("orientation"), orientation)?.to_matrix();
    }
    Ok(base)
}

fn mesh_choice(
    context: &Context,
    path: &KeyPath,
    file: &RodFile,
    total: &mut usize,
) -> Result<MeshChoice, SceneError> {
    let document = context.document;
    let place = path.key("elements");
    let elements = match (file.elements, file.tolerance) {
        (Some(_), Some(_)) => {
            let error = document.error(&path.key("tolerance"), "both `elements` and `tolerance` are given");
            return Err(
                error.mend("keep `elements` for a mesh of that size, or `tolerance` for one that is chosen")
            );
        }
        (None, Some(tolerance)) => {
            let place = path.key("tolerance");
            let small = tolerance > 0.0 && tolerance < 1.0;
            document.require(&place, tolerance, small, "must lie between 0 and 1")?;
            return Ok(MeshChoice::Tolerance(tolerance));
        }
        (Some(0), None) => {
            return Err(document
                .error(&place, "a rod needs at least one element")
                .mend("100 is a good number to begin with"));
        }
        (elements, None) => elements.unwrap_or(DEFAULT_ELEMENTS),
    };
    *total = total.saturating_add(elements);
    if *total > MAX_ELEMENTS {
        let error = document.error(&place, format!("the scene has more than {MAX_ELEMENTS} elements"));
        return Err(
            error.mend("a few hundred elements a rod are plenty; `order = 4` in [solver] needs fewer still")
        );
    }
    Ok(MeshChoice::Elements(elements))
}
