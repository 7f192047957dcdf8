//! The standard boundary value problem with loads that follow the rod: two sweeps and nothing to iterate (paper, section 3).
//!
//! The wrench at the end is given in the end's own frame, so the first sweep, from the end to the start, finds every strain without
//! knowing where the rod is. It lays the frames out from an arbitrary one; the second sweep, from the start on, moves
//! them all to where the start is held.

use super::boundary::EndState;
use super::march::march;
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace};
use super::solution::{Guess, Settings, SolveReport};
use crate::math::{Pose, Quat, Wrench};

/// Why a problem is not the standard one; `None` where it is.
pub(crate) fn not_standard(problem: &Problem) -> Option<&'static str> {
    if problem.start.fixed != [true; 6] {
        return Some("the start is not clamped");
    }
    if problem.end.fixed != [false; 6] {
        return Some("the end is held");
    }
    if !problem.between.is_empty() {
        return Some("it is held between its ends");
    }
    if !problem.loads.pulls().is_empty() {
        return Some("a load pulls towards a point");
    }
    if problem.end.grip.is_some() {
        return Some("a hand holds the end through a coupling");
    }
    None
}

/// Solves it.
pub(crate) fn two_sweeps(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let anywhere = Guess::new(Pose::IDENTITY, Wrench::ZERO);
    let end = EndState::from_guess(problem, &anywhere).section(problem);
    let mut start =
        march(workspace.simd, &problem.rod, settings.scheme, &problem.loads, end, &mut workspace.record);
    report.sweeps += 1;
    let base = problem.start.pose;
    let correction = base.compose(&start.pose.inverse());
    for pose in &mut workspace.record.poses {
        *pose = correction.compose(pose);
    }
    start.pose = workspace.record.poses[0];
    let tip = workspace.record.poses[problem.rod.elements()];
    let state = EndState::from_guess(problem, &Guess::new(tip, Wrench::ZERO));
    let gap = base.between(&start.pose);
    report.residual = Quat::from_matrix(gap.rotation)
        .to_rotation_vector()
        .max_abs()
        .max(gap.position.max_abs() / problem.rod.length());
    report.residual_history.push(report.residual);
    let outcome = if report.residual.is_finite() { Outcome::Converged } else { Outcome::NotFinite };
    Search { state, start, outcome, inverse: None }
}
