//! One rod: its description, its mesh, its problem.

use super::{Context, hold, initial, joint, load, profile, rest};
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{DragFile, KinematicsName, MassMatrixName, RodFile};
use crate::model::{MAX_ELEMENTS, MeshChoice, ModelRod, breaks};
use strands::assembly::{Drag, MassMatrix};
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
    let points = initial::points(context, &path, file)?;
    let unloaded = rest::unloaded(context, &path, file, points.as_ref().map(|points| points.length))?;
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
    let ties = joint::places(context, name, length)?;
    let supports = hold::supports(context, &path, file, length, !ties.is_empty())?;
    let breaks = breaks(&loads, &supports, &ties);
    let mesh = mesh_choice(context, &path, file, total)?;
    if matches!(mesh, MeshChoice::Tolerance(_)) && !ties.is_empty() {
        let error = document.error(
            &path.key("tolerance"),
            "the mesh of a rod that joints tie to others cannot be chosen for a tolerance",
        );
        return Err(error.mend(format!("write `elements = {DEFAULT_ELEMENTS}` in its place")));
    }
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
    let initial = initial::initial(context, &path, file, points, &rod)?;
    let problem = loads
        .problem(rod, &supports, initial.as_ref())
        .map_err(|error| document.error(&path.key("loads"), error.to_string()))?;
    let material = file.material.as_ref().and_then(|name| context.file.materials.get(name));
    let damping = material.and_then(|material| material.damping).unwrap_or(0.0);
    let drag = file
        .drag
        .as_ref()
        .map_or(Ok(Drag::default()), |written| drag(context, &path.key("drag"), written))?;
    let mass_matrix = match file.mass_matrix {
        Some(MassMatrixName::Consistent) => MassMatrix::Consistent,
        Some(MassMatrixName::Lumped) | None => MassMatrix::Lumped,
    };
    Ok(ModelRod {
        name: name.to_owned(),
        problem,
        hand: None,
        mesh,
        damping,
        drag,
        mass_matrix,
        loads,
        initial,
        supports,
        ties,
    })
}

fn drag(context: &Context, path: &KeyPath, written: &DragFile) -> Result<Drag, SceneError> {
    let document = context.document;
    if written.linear.is_none() && written.quadratic.is_none() {
        let error = document.error(path, "the drag is empty");
        return Err(error.mend("give `linear` in N·s/m², `quadratic` in N·s²/m³, or both"));
    }
    let number = |key: &str, value: Option<f64>| document.not_negative(&path.key(key), value.unwrap_or(0.0));
    Ok(Drag { linear: number("linear", written.linear)?, quadratic: number("quadratic", written.quadratic)? })
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
