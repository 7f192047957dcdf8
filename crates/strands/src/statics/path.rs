//! A way to the solution where a search from afar does not get there: a family of problems from one that is solved to the
//! one that is asked for, walked in steps that adapt.
//!
//! From rest, the loads grow from nothing and the held end moves from where the unloaded rod has it; from a solution, the
//! held end moves from where that solution has it. A rod pushed straight along its axis would stay on its straight,
//! unstable branch; so on the way from rest a small force across the rod comes and goes, and the rod buckles to its side.

use super::boundary::{EndState, meet};
use super::march::{Section, march};
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace, shoot};
use super::solution::{Guess, Scheme, Settings, SolveReport};
use crate::load::NodalLoads;
use crate::math::{Pose, Vec3, Wrench};

/// The first step of a way.
const FIRST_STEP: f64 = 0.25;
/// Iterations that a search on the way may take before the step counts as too long.
const ITERATIONS_ON_THE_WAY: usize = 12;
/// The force across the rod that comes and goes, all along it together, over `EI/L²` (the rod buckles between clamps at 39.5).
const NUDGE: f64 = 3.0;

/// The unloaded rod from its start's frame: the frame of its end, and no wrench.
pub(crate) fn rest(problem: &Problem, workspace: &mut Workspace) -> Guess {
    let unloaded = NodalLoads::none(&problem.rod);
    let end = Section { pose: Pose::IDENTITY, wrench: Wrench::ZERO };
    let start = march(workspace.simd, &problem.rod, Scheme::Element, &unloaded, end, &mut workspace.record);
    let base = meet(&problem.start, &problem.rod.description().base);
    Guess { pose: base.compose(&start.pose.inverse()), wrench: Wrench::ZERO }
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

/// Walks from rest to the problem. `nudge` is the direction of the force that comes and goes.
pub(crate) fn from_rest(
    problem: &Problem,
    settings: &Settings,
    nudge: Option<Vec3>,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let rest = rest(problem, workspace);
    let total = nudge.map_or(Vec3::ZERO, |direction| direction * (NUDGE * problem.rod.scale().force));
    walk(problem, &rest, true, total, settings, workspace, report)
}

/// Walks from a solution of a problem that differs in where its end is held.
pub(crate) fn from_solution(
    problem: &Problem,
    guess: &Guess,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    walk(problem, guess, false, Vec3::ZERO, settings, workspace, report)
}

fn walk(
    problem: &Problem,
    from: &Guess,
    loads_grow: bool,
    nudge: Vec3,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let on_the_way = Settings { max_iterations: ITERATIONS_ON_THE_WAY, ..*settings };
    let mut family = problem.clone();
    set(&mut family, problem, from, loads_grow, nudge, 0.0);
    let start = EndState::from_guess(&family, from);
    let mut search = shoot(&family, settings, start, workspace, report);
    let (mut at, mut step) = (0.0, FIRST_STEP);
    let smallest = 0.5_f64.powi(i32::try_from(settings.max_halvings).unwrap_or(i32::MAX)) * FIRST_STEP;
    let mut reached = search.state;
    while search.outcome == Outcome::Converged && at < 1.0 {
        let next = f64::min(at + step, 1.0);
        set(&mut family, problem, from, loads_grow, nudge, next);
        let before = report.iterations;
        let tried = shoot(&family, &on_the_way, reached.moved(&family), workspace, report);
        report.path_steps += 1;
        if tried.outcome == Outcome::Converged {
            (at, reached, search) = (next, tried.state, tried);
            if report.iterations - before <= 5 {
                step *= 1.7;
            }
        } else if step <= smallest {
            return tried;
        } else {
            step *= 0.5;
        }
    }
    search
}

/// Sets the family to a place on the way.
fn set(family: &mut Problem, problem: &Problem, from: &Guess, loads_grow: bool, nudge: Vec3, at: f64) {
    let between = |target: &Pose| {
        let way = from.pose.between(target).log();
        from.pose.compose(&Pose::exp(way * at))
    };
    family.end.pose = if at >= 1.0 { problem.end.pose } else { between(&problem.end.pose) };
    if let (Some(moving), Some(grip)) = (&mut family.end.grip, &problem.end.grip) {
        moving.hand = if at >= 1.0 { grip.hand } else { between(&grip.hand) };
    }
    if loads_grow {
        let nudge_now = nudge * (4.0 * at * (1.0 - at) / problem.rod.elements() as f64);
        for (now, whole) in family.loads.world.iter_mut().zip(&problem.loads.world) {
            *now = *whole * at + Wrench::new(Vec3::ZERO, nudge_now);
        }
        for (now, whole) in family.loads.body.iter_mut().zip(&problem.loads.body) {
            *now = *whole * at;
        }
    }
}
