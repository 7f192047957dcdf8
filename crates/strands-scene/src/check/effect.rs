//! What has no effect: wind without drag, velocities where motion starts at rest, loads that go straight into a support, rods that
//! nothing loads.

use super::{Remarks, View, metres};
use crate::document::KeyPath;
use crate::file::SceneFile;
use crate::model::Model;
use strands::assembly::Drag;
use strands::math::Vec6;

/// How far a support may be from where the unloaded rod is, as a part of the length and in rad, and still leave it as it is.
const AS_IT_IS: f64 = 1e-9;

/// Looks at the keys for wind and velocities.
pub(super) fn look(remarks: &mut Remarks<'_>, file: &SceneFile, model: &Model) {
    if file.contact.is_some() {
        remarks.note(
            &KeyPath::of("contact"),
            "a static solve does not know of `[contact]`: in it rods pass through all".to_owned(),
            "`strands simulate` with `start = \"equilibrium\"` finds where they rest",
        );
    }
    if file.wind.is_some() && model.rods.iter().all(|rod| rod.drag == Drag::default()) {
        remarks.note(
            &KeyPath::of("wind"),
            "`[wind]` has no effect: no rod has drag".to_owned(),
            "give a rod `[rods.thread.drag]` with `linear` or `quadratic`",
        );
    }
    let start = model.dynamics.start.as_deref();
    for (name, _) in file.rods.iter().filter(|(_, rod)| rod.initial.is_some() && start != Some("initial")) {
        remarks.note(
            &KeyPath::of("rods").key(name).key("initial"),
            "the motion does not start from the initial shape".to_owned(),
            "write `start = \"initial\"` in `[dynamics]`",
        );
    }
    if matches!(start, Some("rest" | "initial")) {
        return;
    }
    for (i, body) in file.bodies.iter().enumerate() {
        let given = [("velocity", body.velocity), ("angular_velocity", body.angular_velocity)];
        if let Some((key, _)) = given.into_iter().find(|(_, velocity)| velocity.is_some()) {
            remarks.note(
                &KeyPath::of("bodies").index(i).key(key),
                format!("`{key}` has no effect: the motion does not start from \"rest\""),
                "write `start = \"rest\"` in `[dynamics]`",
            );
        }
    }
}

/// Looks at a rod's loads.
pub(super) fn look_at_rod(remarks: &mut Remarks<'_>, view: &View<'_>) {
    let problem = &view.rod.problem;
    let (loads, length) = (&problem.loads, problem.rod.length());
    for (i, load) in view.file.loads.iter().enumerate() {
        let Some(at) = load.at.map(|at| at.metres(length)) else { continue };
        let clamped = problem.rod.mesh().node_at(at).and_then(|node| problem.support(node));
        if clamped.is_some_and(|support| support.fixed == [true; 6]) {
            remarks.note(
                &view.path.key("loads").index(i).key("at"),
                format!(
                    "the load at s = {} acts where the rod is clamped, and goes straight into the support",
                    metres(at)
                ),
                "move it, or the support, if it is to bend the rod",
            );
        }
    }
    let rest = problem.rod.rest_poses();
    let moved = problem.supports().filter(|(_, support)| support.holds_anything()).any(|(node, support)| {
        let by = rest[node].between(&support.pose).log();
        by.angular.max_abs().max(by.linear.max_abs() / length) > AS_IT_IS
    });
    let loaded =
        loads.world.iter().chain(&loads.body).any(|load| *load != Vec6::ZERO) || !loads.pulls().is_empty();
    if !moved && !loaded && view.rod.hand.is_none() && !view.rod.is_tied() {
        remarks.note(
            &view.path,
            "nothing loads the rod: it keeps its rest shape".to_owned(),
            "add a load, gravity and a density, or a support that holds it elsewhere",
        );
    }
}
