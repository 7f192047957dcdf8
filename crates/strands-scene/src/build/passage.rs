//! What rods pass through.

use super::{Context, load};
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{EyeletFile, TissueFile};
use crate::model::Model;
use crate::words;
use strands::contact::{Eyelet, Hold, Tissue};
use strands::math::Vec3;

/// An eyelet is by default so many times as stiff as `EI` over the cube of an element: as one that is held at its ends and pushed in its middle.
const AS_AN_ELEMENT: f64 = 48.0;

/// The eyelets of a scene, whose rods and bodies are those of a model.
pub(super) fn eyelets(context: &Context, model: &Model) -> Result<Vec<Eyelet>, SceneError> {
    let path = KeyPath::of("eyelets");
    if context.file.contact.is_none() && !context.file.eyelets.is_empty() {
        let error = context.document.error(&path, "there are eyelets, and nothing touches");
        return Err(error.mend("add `[contact]`, with `friction = 0.3` or whatever it is"));
    }
    let written = context.file.eyelets.iter().enumerate();
    written.map(|(i, written)| eyelet(context, &path.index(i), written, model)).collect()
}

fn eyelet(
    context: &Context,
    path: &KeyPath,
    written: &EyeletFile,
    model: &Model,
) -> Result<Eyelet, SceneError> {
    let document = context.document;
    let rod = model.rods.iter().position(|rod| rod.name == written.rod).ok_or_else(|| {
        let error = document.error(&path.key("rod"), format!("there is no rod `{}`", written.rod));
        let rods = model.rods.iter().map(|rod| &rod.name);
        error.mend(words::choices("the rods here", &written.rod, rods))
    })?;
    let of = &model.rods[rod].problem.rod;
    let at = load::place(context, &path.key("at"), written.at, of.length())?;
    if at <= 0.0 || at >= of.length() {
        let error = document.error(&path.key("at"), "an eyelet at an end of a rod holds nothing");
        return Err(error.mend(format!("put it between 0 and {} m", of.length())));
    }
    let element = of.length() / of.elements() as f64;
    let nodes = of.mesh().nodes();
    let far = nodes.partition_point(|s| *s < at).clamp(1, nodes.len() - 1);
    let part = (at - nodes[far - 1]) / (nodes[far] - nodes[far - 1]);
    let starts = model.rods[rod].starts();
    let [a, b] = [far - 1, far].map(|node| starts[node].position);
    let there = a + (b - a) * part;
    let place = written.position.map_or(there, Vec3::from);
    let apart = (place - there).norm();
    if apart > element {
        let message = format!("the eyelet is {apart:.2e} m from where the rod is {at} m from its start");
        let error = document.error(&path.key("position"), message);
        return Err(error.mend("put it there, change `at`, or leave `position` out"));
    }
    let (body, place) = match &written.body {
        None => (None, place),
        Some(name) => {
            let body = model.bodies.iter().position(|body| body.name == *name).ok_or_else(|| {
                let error = document.error(&path.key("body"), format!("there is no body `{name}`"));
                error.mend(words::choices(
                    "the bodies here",
                    name,
                    model.bodies.iter().map(|body| &body.name),
                ))
            })?;
            let pose = &model.bodies[body].body.pose;
            (Some(body), pose.rotation.transpose() * (place - pose.position))
        }
    };
    let bending = of.scale().moment * of.length();
    let stiffness = written.stiffness.unwrap_or(AS_AN_ELEMENT * bending / element.powi(3));
    let hold = hold(context, path, stiffness, (written.friction, written.grip))?;
    Ok(Eyelet { rod, at, place, body, hold })
}

/// The tissue that an obstacle or a body is.
pub(super) fn tissue(context: &Context, path: &KeyPath, written: &TissueFile) -> Result<Tissue, SceneError> {
    let path = path.key("tissue");
    let pierced_by = context.document.not_negative(&path.key("pierced_by"), written.pierced_by)?;
    let hold = hold(context, &path, written.stiffness, (written.friction, written.grip))?;
    Ok(Tissue { pierced_by, hold })
}

fn hold(
    context: &Context,
    path: &KeyPath,
    stiffness: f64,
    (friction, grip): (Option<f64>, Option<f64>),
) -> Result<Hold, SceneError> {
    let document = context.document;
    let of_contact = context.file.contact.as_ref().and_then(|contact| contact.friction);
    let friction = friction.or(of_contact).unwrap_or(0.0);
    Ok(Hold {
        stiffness: document.positive(&path.key("stiffness"), stiffness)?,
        friction: document.not_negative(&path.key("friction"), friction)?,
        grip: document.not_negative(&path.key("grip"), grip.unwrap_or(0.0))?,
    })
}
