//! Joints between rods and bodies.

use super::{Context, load};
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{JointEndFile, JointFile, JointName};
use crate::model::Model;
use crate::words;
use strands::assembly::{Assembly, AssemblyError, Joint, JointKind, Member};
use strands::math::{Pose, Vec3};

/// Makes sure that joints name rods and bodies that there are.
pub(super) fn check_names(context: &Context) -> Result<(), SceneError> {
    let (document, file) = (context.document, context.file);
    for (path, end) in ends(context) {
        let (place, what, mend) = match (&end.rod, &end.body) {
            (Some(rod), None) if !file.rods.contains_key(rod) => {
                let mend = words::choices("the rods here", rod, file.rods.keys());
                (path.key("rod"), format!("there is no rod `{rod}`"), mend)
            }
            (None, Some(body)) if file.bodies.iter().all(|known| known.name != *body) => {
                let mend = words::choices("the bodies here", body, file.bodies.iter().map(|body| &body.name));
                (path.key("body"), format!("there is no body `{body}`"), mend)
            }
            (None, Some(_)) if end.at.is_some() => {
                let mend = "remove it: a joint is where the rod is, or at its own `position`";
                (path.key("at"), "`at` is a place of a rod, and a body has none".into(), mend.into())
            }
            (Some(_), None) | (None, Some(_)) => continue,
            (rod, _) => {
                let (place, what) = match rod {
                    Some(_) => (path.key("body"), "both `rod` and `body` are given"),
                    None => (path, "it names neither a `rod` nor a `body`"),
                };
                let mend = "give `{ rod = \"thread\", at = \"end\" }`, or `{ body = \"needle\" }`";
                (place, what.into(), mend.into())
            }
        };
        return Err(document.error(&place, what).mend(mend));
    }
    Ok(())
}

/// Where joints tie a rod of a name and a length, m from its start.
pub(super) fn places(context: &Context, name: &str, length: f64) -> Result<Vec<f64>, SceneError> {
    let of_rod = ends(context).filter(|(_, end)| end.rod.as_deref() == Some(name));
    of_rod.map(|(path, end)| place(context, &path, end, length)).collect()
}

/// The joints of a scene, whose rods and bodies are those of a model.
pub(super) fn joints(context: &Context, model: &Model) -> Result<Vec<Joint>, SceneError> {
    let (mut assembly, shape) = (model.assembly(), model.starts());
    for (i, written) in context.file.joints.iter().enumerate() {
        let path = path(i);
        let end = |end: usize| member(context, &path.key("between").index(end), &written.between[end], model);
        let members = [end(0)?, end(1)?];
        let position = position(context, &path, written, &members)?;
        let (kind, axis) = kind(context, &path, written)?;
        let joint = Joint::in_shape(&assembly, &shape, kind, members, position, axis)
            .map_err(|error| refused(context, error, i, (&assembly, &shape), members))?;
        assembly.joints.push(joint);
    }
    if let Err(error) = assembly.check_in_shape(&shape) {
        // The first joint that does not go with those before it.
        let joints = core::mem::take(&mut assembly.joints);
        let numbers: Vec<usize> = (1..joints.len()).collect();
        let first = numbers.partition_point(|many| {
            assembly.joints = joints[..*many].to_vec();
            assembly.check_in_shape(&shape).is_ok()
        });
        assembly.joints = joints[..=first].to_vec();
        let error = assembly.check_in_shape(&shape).err().unwrap_or(error);
        let members = joints[first].between.map(|attachment| attachment.member);
        return Err(refused(context, error, first, (&assembly, &shape), members));
    }
    Ok(assembly.joints)
}

/// What joints tie, with the places in the file.
fn ends<'a>(context: &'a Context) -> impl Iterator<Item = (KeyPath, &'a JointEndFile)> {
    context.file.joints.iter().enumerate().flat_map(|(i, joint)| {
        let path = path(i).key("between");
        joint.between.iter().enumerate().map(move |(end, written)| (path.index(end), written))
    })
}

fn path(joint: usize) -> KeyPath {
    KeyPath::of("joints").index(joint)
}

/// A place of a rod, m from its start.
fn place(context: &Context, path: &KeyPath, end: &JointEndFile, length: f64) -> Result<f64, SceneError> {
    let at = end.at.ok_or_else(|| context.document.missing(&path.key("at")))?;
    load::place(context, &path.key("at"), at, length)
}

/// What a joint ties at one of its ends, whose name is known.
fn member(
    context: &Context,
    path: &KeyPath,
    end: &JointEndFile,
    model: &Model,
) -> Result<Member, SceneError> {
    let rod = model.rods.iter().enumerate().find(|(_, rod)| end.rod.as_ref() == Some(&rod.name));
    let Some((number, rod)) = rod else {
        let body = model.bodies.iter().position(|body| end.body.as_ref() == Some(&body.name));
        return Ok(Member::Body(
            body.unwrap_or_else(|| unreachable!("the names of joints have been checked")),
        ));
    };
    let rod = &rod.problem.rod;
    let node = rod.mesh().node_at(place(context, path, end, rod.length())?);
    let node = node.unwrap_or_else(|| unreachable!("the places of joints are among the mesh's breaks"));
    Ok(Member::Node { rod: number, node })
}

/// Where a joint is, where that is not the place of a rod.
fn position(
    context: &Context,
    path: &KeyPath,
    written: &JointFile,
    members: &[Member; 2],
) -> Result<Option<Vec3>, SceneError> {
    let between_bodies = members.iter().all(|member| matches!(member, Member::Body(_)));
    match written.position {
        Some(_) if !between_bodies => {
            let error = context.document.error(&path.key("position"), "the joint is at a place of a rod");
            Err(error.mend("remove `position`: it is for joints between two bodies"))
        }
        None if between_bodies => {
            let error = context.document.error(path, "a joint between two bodies does not say where it is");
            Err(error.mend("give its place in metres, as `position = [0.0, 0.0, 0.1]`"))
        }
        position => Ok(position.map(Vec3::from)),
    }
}

/// What a joint leaves free, and about which axis.
fn kind(context: &Context, path: &KeyPath, written: &JointFile) -> Result<(JointKind, Vec3), SceneError> {
    let document = context.document;
    let kind = match written.kind {
        JointName::Rigid => JointKind::Rigid,
        JointName::Ball => JointKind::Ball,
        JointName::Hinge => JointKind::Hinge,
    };
    let axis = written.axis.map(Vec3::from);
    match (kind, axis) {
        (JointKind::Hinge, Some(axis)) if axis.norm() > 0.0 => Ok((kind, axis)),
        (JointKind::Hinge, Some(_)) => {
            let error = document.error(&path.key("axis"), "the axis has no direction");
            Err(error.mend("give a direction in world axes, as `axis = [0.0, 1.0, 0.0]`"))
        }
        (JointKind::Hinge, None) => Err(document.missing(&path.key("axis"))),
        (_, Some(_)) => {
            let error = document.error(&path.key("axis"), "only a hinge has an axis");
            Err(error.mend("write `kind = \"hinge\"`, or remove `axis`"))
        }
        (_, None) => Ok((kind, Vec3::ZERO)),
    }
}

/// The error of a joint of two members that does not go with those before it.
fn refused(
    context: &Context,
    error: AssemblyError,
    joint: usize,
    (assembly, shape): (&Assembly, &[Pose]),
    members: [Member; 2],
) -> SceneError {
    let document = context.document;
    match error {
        AssemblyError::Apart { apart, .. } => {
            let at = members.map(|member| {
                let [x, y, z] =
                    assembly.frame(member).map_or([0.0; 3], |frame| shape[frame].position.to_array());
                format!("[{x:.9}, {y:.9}, {z:.9}]")
            });
            let message =
                format!("what the joint ties together is {apart:.2e} m apart where nothing acts on it");
            let error = document.error(&path(joint), message);
            error.mend(format!(
                "the first is at {}, the second at {}: give one rod a `position` by which they meet",
                at[0], at[1]
            ))
        }
        AssemblyError::HeldTwice { .. } => {
            let error = document.error(&path(joint), "the joint ties together two places that are both held");
            error.mend("take the support of one away: the joint holds it by the other. Places that other joints tie to them count too")
        }
        AssemblyError::Ring(_) => {
            let error =
                document.error(&path(joint), "the joint ties together what joints tie together already");
            error.mend("remove it: what others tie needs no joint of its own, and a ring needs a rod in it")
        }
        AssemblyError::Missing { .. } => document.error(&path(joint), error.to_string()),
    }
}
