//! The standard boundary value problem with loads that follow the rod: two sweeps and nothing to iterate (paper, section 3).
//!
//! The wrench at the end is given in the end's own frame, so the first sweep, from the end to the start, finds every strain without
//! knowing where the rod is. It lays the frames out from an arbitrary one; the second sweep, from the start on, moves
//! them all to where the start is held.

use super::boundary::EndState;
use super::march::{Record, march};
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace};
use super::solution::{Guess, Settings, SolveReport};
use crate::element::PointStrains;
use crate::math::{Pose, Wrench, larger};
use crate::rod::Rod;

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
    let missed =
        larger(gap.rotation.rotation_vector().max_abs(), gap.position.max_abs() / problem.rod.length());
    report.residual = larger(missed, f64::EPSILON * largest_turn(&problem.rod, &workspace.record));
    report.residual_history.push(report.residual);
    let outcome = match report.residual {
        residual if residual <= settings.tolerance => Outcome::Converged,
        residual if residual.is_finite() => Outcome::Stalled,
        _ => Outcome::NotFinite,
    };
    Search { state, start, outcome, inverse: None }
}

/// By how much an element turns at most, rad: of a turn of so many times round, the last digits are lost, and with them where the rod points.
fn largest_turn(rod: &Rod, record: &Record) -> f64 {
    let turn = |(e, strains): (usize, &PointStrains)| {
        let points = strains.iter().take(rod.points(e).len());
        points.map(|strain| strain.angular.norm()).fold(0.0, larger) * rod.element_length(e)
    };
    record.strains.iter().enumerate().map(turn).fold(0.0, larger)
}
