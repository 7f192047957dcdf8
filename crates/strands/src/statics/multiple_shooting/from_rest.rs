//! From rest to a solution by [multiple shooting](super): from the rod laid out between its supports, arched where it is longer than they are apart;
//! where that leads nowhere, along a way from its rest shape.

use super::super::boundary::{EndState, meet};
use super::super::equilibrium::{Mild, bend_from_rest, by_degrees, found, lay_out, put_between_supports};
use super::super::march::Record;
use super::super::path;
use super::super::problem::Problem;
use super::super::shooting::{Inverse, Outcome, Search, Workspace};
use super::super::solution::{Method, Settings, SolveReport};
use super::super::stability::morse_index;
use super::{LONGEST_FROM_AFAR, newton};
use crate::math::{Vec3, Wrench};
use crate::rod::Kinematics;

/// The longest segment, over the rod: from rest frames in between lead to a solution.
const LONGEST_FROM_REST: f64 = 0.1;

/// The axes, in the rod's own, about which it is bent where it is longer than its ends are apart.
const SIDES: [Vec3; 4] = [
    Vec3::new(1.0, 0.1, 0.05),
    Vec3::new(-1.0, 0.1, 0.05),
    Vec3::new(0.1, 1.0, -0.05),
    Vec3::new(0.1, -1.0, 0.05),
];
/// How far the rod may be bent for that, rad, and in how many steps that is looked for.
const MOST_BENT: f64 = 6.0;
const STEPS_OF_BENDING: u32 = 12;

/// Searches from the rod laid out between its supports.
pub(crate) fn from_rest(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    report.method = Method::MultipleShooting;
    let mild = Mild::new(problem);
    let laid_out = |problem: &Problem, workspace: &mut Workspace, report: &mut SolveReport| {
        from_laid_out(problem, settings, workspace, report)
    };
    let on = |problem: &Problem, workspace: &mut Workspace, report: &mut SolveReport| {
        put_between_supports(problem, &mut workspace.record.poses);
        newton(problem, settings, LONGEST_FROM_AFAR, workspace, report)
    };
    let outcome = by_degrees(problem, &mild, settings, laid_out, on, workspace, report);
    found(problem, outcome, workspace)
}

/// Tries ways to lay the rod out, one after the other, and then ways to walk from rest, bent to either side of either axis first, until what is
/// found is stable; else it is the first equilibrium that was found.
fn from_laid_out(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    let mut unstable = None;
    let mut enough = |outcome: Outcome, workspace: &mut Workspace| {
        let found = outcome == Outcome::Converged;
        let stable = found && morse_index(problem, workspace).unwrap_or(0) == 0;
        if found && !stable {
            unstable.get_or_insert_with(|| workspace.record.clone());
        }
        stable
    };
    for side in SIDES {
        let record = &mut workspace.record;
        let bend = side * (arch(problem, side, record) / problem.rod.length());
        lay_out(problem, |_| bend, record);
        carry_what_bends(problem, record);
        let outcome = newton(problem, settings, LONGEST_FROM_REST, workspace, report);
        if enough(outcome, workspace) {
            return outcome;
        }
    }
    if problem.between.is_empty() {
        for nudge in path::nudges(problem) {
            let kept = &mut workspace.multiple.kept;
            bend_from_rest(problem, |_| Vec3::ZERO, kept);
            let moved = meet(&problem.start, &kept.poses[0]).compose(&kept.poses[0].inverse());
            kept.poses.iter_mut().for_each(|pose| *pose = moved.compose(pose));
            let search = path::from_rest(on_the_way, problem, settings, nudge, workspace, report);
            if enough(search.outcome, workspace) {
                return search.outcome;
            }
        }
    }
    let Some(record) = unstable else { return Outcome::Stalled };
    workspace.record = record;
    newton(problem, settings, LONGEST_FROM_AFAR, workspace, report)
}

/// Searches from the last state on the way that was a solution.
fn on_the_way(
    problem: &Problem,
    settings: &Settings,
    _: EndState,
    _: Option<Inverse>,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    workspace.record.clone_from(&workspace.multiple.kept);
    let outcome = newton(problem, settings, LONGEST_FROM_AFAR, workspace, report);
    if outcome == Outcome::Converged {
        workspace.multiple.kept.clone_from(&workspace.record);
    }
    found(problem, outcome, workspace)
}

/// By how much the rod has to be bent to one side for its ends to be as far apart as their supports, rad.
fn arch(problem: &Problem, side: Vec3, record: &mut Record) -> f64 {
    if !(problem.start.holds_position() && problem.end.holds_position()) {
        return 0.0;
    }
    let apart = (problem.end.pose.position - problem.start.pose.position).norm();
    let last = problem.rod.elements();
    let mut miss = |bent: f64| {
        bend_from_rest(problem, |_| side * (bent / problem.rod.length()), record);
        ((record.poses[last].position - record.poses[0].position).norm() - apart).abs()
    };
    let mut best = (miss(0.0), 0.0);
    for step in 1..=STEPS_OF_BENDING {
        let bent = MOST_BENT * f64::from(step) / f64::from(STEPS_OF_BENDING);
        let miss = miss(bent);
        if miss < best.0 {
            best = (miss, bent);
        }
    }
    best.1
}

/// Gives the elements the moments that bend them as they are laid out, and what is known of their forces: the loads beyond, where the end is free to
/// move, and elsewhere the tension that stretches them.
fn carry_what_bends(problem: &Problem, record: &mut Record) {
    let rod = &problem.rod;
    let loose = !problem.end.fixed[3..].contains(&true) && problem.between.is_empty();
    let mut force = Vec3::ZERO;
    for e in (0..rod.elements()).rev() {
        let far = &record.poses[e + 1];
        let strain = record.poses[e].between(far).log() * (1.0 / rod.element_length(e));
        let point = &rod.points(e)[0];
        let mut elastic = strain - point.rest;
        elastic.linear = Vec3::Z * elastic.linear.z.max(0.0);
        let stress = point.law.stress(elastic);
        force += problem.loads.world[e + 1].linear + far.rotation * problem.loads.body[e + 1].linear;
        let linear = if loose {
            far.rotation.transpose_mul(force)
        } else if rod.kinematics() == Kinematics::Cosserat {
            stress.linear
        } else {
            Vec3::ZERO
        };
        record.wrenches[e] = Wrench::new(stress.angular, linear);
    }
}
