//! A way to the solution where a search from afar does not get there: a family of problems from one that is solved to the
//! one that is asked for, walked in steps that adapt.
//!
//! From rest, first the loads grow from nothing on the rod with its end free, and then the end moves from there to where it is held. From
//! a solution, the held end moves from where that solution has it. A rod pushed straight along its axis would stay on its straight,
//! unstable branch (and an inextensible one cannot even start to move); so with the loads grows a small force across the rod, which
//! bends it to one side, and it fades while the end moves.
//!
//! A step after which the rod is less stable than before has landed on another branch, and is made smaller.

use super::boundary::{EndState, meet};
use super::problem::{Problem, Support};
use super::shooting::{Inverse, Outcome, Search, Workspace};
use super::solution::{Guess, Settings, SolveReport};
use super::stability::morse_index;
use crate::math::{Mat3, Pose, Quat, Vec3, Wrench};

/// The first step of a way.
const FIRST_STEP: f64 = 0.25;
/// Iterations that a search on the way may take before the step counts as too long.
const ITERATIONS_ON_THE_WAY: usize = 12;
/// Steps after which a walk is given up: it would take many times longer than from elsewhere, or than a user waits.
pub(crate) const MOST_STEPS: usize = 300;
/// How far, in rad, one step may turn any part of the rod: more is a jump to another branch.
const LARGEST_TURN_OF_A_STEP: f64 = 1.0;
/// How many nodes are watched for that.
const SAMPLES: usize = 9;
/// The force across the rod, all along it together, over `EI/L²`: enough to bend a free rod by about a fifth of its length.
const NUDGE: f64 = 2.0;

/// Searches for a solution from a state of the end nearby, with the inverse Jacobian there if there is one.
pub(crate) type Searcher =
    fn(&Problem, &Settings, EndState, Option<Inverse>, &mut Workspace, &mut SolveReport) -> Search;

/// The unloaded rod from its start's frame: the frame of its end, and no wrench.
pub(crate) fn rest(problem: &Problem) -> Guess {
    let poses = problem.rod.rest_poses();
    let base = meet(&problem.start, &poses[0]);
    Guess::new(base.compose(&poses[0].between(&poses[poses.len() - 1])), Wrench::ZERO)
}

/// Directions for the force across the rod: along the softer and the stiffer side, to and fro.
pub(crate) fn nudges(problem: &Problem) -> [Vec3; 4] {
    let base = problem.rod.description().base.rotation;
    let c = problem.rod.points(0)[0].law.tangent(crate::math::Strain::ZERO).blocks[0][0];
    // Bending about d1 moves the rod along d2.
    let (soft, stiff) =
        if c.cols[0].x <= c.cols[1].y { (base.cols[1], base.cols[0]) } else { (base.cols[0], base.cols[1]) };
    [soft, stiff, soft * -1.0, stiff * -1.0]
}

/// What changes on a way.
#[derive(Clone, Copy)]
enum Change {
    /// The loads grow from nothing, and with them the force across the rod (N, all of it together).
    LoadsGrow(Vec3),
    /// The end moves, and the force across the rod fades.
    EndMoves(Vec3),
}

/// Walks from rest to the problem. `nudge` is the direction of the force across the rod.
pub(crate) fn from_rest(
    search: Searcher,
    problem: &Problem,
    settings: &Settings,
    nudge: Vec3,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let nudge = nudge * (NUDGE * problem.rod.scale().force);
    let from = rest(problem);
    if problem.end.fixed == [false; 6] && problem.end.grip.is_none() {
        return walk(search, problem, &from, Change::LoadsGrow(Vec3::ZERO), settings, workspace, report);
    }
    let loose = Problem { end: Support::free(from.pose), ..problem.clone() };
    let hanging = walk(search, &loose, &from, Change::LoadsGrow(nudge), settings, workspace, report);
    if hanging.outcome != Outcome::Converged {
        return hanging;
    }
    // The held end has other unknowns, and no use for the free one's Jacobian.
    let from = Guess { inverse: None, ..hanging.guess(&loose) };
    walk(search, problem, &from, Change::EndMoves(nudge), settings, workspace, report)
}

/// Walks from a solution of a problem that differs in where its end is held.
pub(crate) fn from_solution(
    search: Searcher,
    problem: &Problem,
    guess: &Guess,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    walk(search, problem, guess, Change::EndMoves(Vec3::ZERO), settings, workspace, report)
}

fn walk(
    by: Searcher,
    problem: &Problem,
    from: &Guess,
    change: Change,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let on_the_way =
        Settings { max_iterations: ITERATIONS_ON_THE_WAY.min(settings.max_iterations), ..*settings };
    let mut family = problem.clone();
    set(&mut family, problem, from, change, 0.0);
    let start = EndState::from_guess(&family, from);
    let mut search = by(&family, settings, start, from.inverse, workspace, report);
    let (mut at, mut step) = (0.0, FIRST_STEP);
    let smallest = settings.halved(FIRST_STEP);
    let mut reached = search.state;
    let mut index = morse_index(&family, workspace);
    let mut shape = sampled(workspace);
    let most = report.path_steps + MOST_STEPS;
    while search.outcome == Outcome::Converged && at < 1.0 {
        let next = f64::min(at + step, 1.0);
        set(&mut family, problem, from, change, next);
        let before = report.iterations;
        let mut tried = by(&family, &on_the_way, reached.moved(&family), search.inverse, workspace, report);
        report.path_steps += 1;
        if tried.outcome == Outcome::Converged {
            // A step that lost stability has landed on another branch, or passed a place where the rod would snap.
            let now = morse_index(&family, workspace);
            let frames = sampled(workspace);
            if now > index.max(Some(0)) || largest_turn(&shape, &frames) > LARGEST_TURN_OF_A_STEP {
                tried.outcome = Outcome::Stalled;
            } else {
                (index, shape) = (now, frames);
            }
        }
        if tried.outcome == Outcome::Converged {
            (at, reached, search) = (next, tried.state, tried);
            if report.iterations - before <= 5 {
                step *= 1.7;
            }
        } else {
            if step <= smallest {
                return tried;
            }
            step *= 0.5;
        }
        if report.path_steps >= most && at < 1.0 {
            return Search { outcome: Outcome::Stalled, ..tried };
        }
    }
    search
}

/// The orientations of some nodes along the rod, by which a jump to another branch is seen.
fn sampled(workspace: &Workspace) -> [Mat3; SAMPLES] {
    let poses = workspace.poses();
    core::array::from_fn(|i| poses[i * (poses.len() - 1) / (SAMPLES - 1)].rotation)
}

fn largest_turn(before: &[Mat3; SAMPLES], after: &[Mat3; SAMPLES]) -> f64 {
    let turn = |(a, b): (&Mat3, &Mat3)| a.turn_to(b).norm();
    before.iter().zip(after).map(turn).fold(0.0, f64::max)
}

/// Sets the family to a place on the way. Places move on a straight line, which stays within the rod's reach.
fn set(family: &mut Problem, problem: &Problem, from: &Guess, change: Change, at: f64) {
    let between = |target: &Pose| {
        if at >= 1.0 {
            return *target;
        }
        let turn = from.pose.between(target).log().angular;
        Pose {
            rotation: from.pose.rotation * Quat::from_rotation_vector(turn * at).to_matrix(),
            position: from.pose.position + (target.position - from.pose.position) * at,
        }
    };
    family.end.pose = between(&problem.end.pose);
    if let (Some(moving), Some(grip)) = (&mut family.end.grip, &problem.end.grip) {
        moving.hand = between(&grip.hand);
    }
    let (share, nudge) = match change {
        Change::LoadsGrow(nudge) => (at, nudge * at),
        Change::EndMoves(nudge) => (1.0, nudge * (1.0 - at)),
    };
    let nudge = nudge * (1.0 / problem.rod.elements() as f64);
    family.loads.set_scaled(&problem.loads, share);
    family.loads.world.iter_mut().for_each(|load| load.linear += nudge);
}
