//! Multiple shooting: Newton's method on the frame and wrench at several joints along the rod.
//!
//! Single shooting loses a factor `exp(L/ℓ)` of its digits under a tension `T` that bends the rod over `ℓ = √(EI/T)`. Cut into segments of a few `ℓ`
//! ([`Chain`]), each loses a factor of ten, however long the rod; the joints' unknowns are solved for together, by a [structured
//! elimination](super::almost_block_diagonal) that never multiplies two segments' derivatives. It finds equilibria whether stable or not.
//!
//! The damping is Deuflhard's (2004, *Newton Methods for Nonlinear Problems*, section 3.3, algorithm NLEQ-ERR): a step is judged by the step that
//! would follow it with the same derivative, so that neither the units of the equations nor their growth along the segments matter.

mod from_rest;

pub(crate) use from_rest::from_rest;

use super::almost_block_diagonal::{AlmostBlockDiagonal, Twelve};
use super::chain::{Chain, units};
use super::equilibrium::{balance, found, is_known, put_guess};
use super::march::Record;
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace};
use super::solution::{Guess, Method, Settings, SolveReport};
use crate::math::larger;
use crate::rod::Scale;

/// The longest segment, over the rod, where the state is far from a solution.
const LONGEST_FROM_AFAR: f64 = 0.25;
/// The largest turn of a joint in one step, rad.
const LARGEST_TURN: f64 = 1.0;
/// A step that has to be damped below this has failed.
const LEAST_DAMPING: f64 = 1.0 / 4096.0;
/// A step of which the size is round-off where the tension of a thread hangs on the last digits of its length.
const TINY: f64 = 1e-7;
/// A full step that leaves less than this of itself to correct keeps its derivative for the next.
const WORTHWHILE: f64 = 0.1;
/// Scratch of the search.
#[derive(Clone, Debug, Default)]
pub(crate) struct MultipleShooting {
    chain: Chain,
    trial: Chain,
    pub(crate) system: AlmostBlockDiagonal,
    step: Vec<Twelve>,
    /// The step that would follow with the same derivative.
    correction: Vec<Twelve>,
    /// Their difference, as the damping has it.
    difference: Vec<Twelve>,
    /// The last solution on a way.
    kept: Record,
}

/// Searches from a solution nearby: from the state in the workspace where that is it, and elsewhere from what a march from its end makes of it.
pub(crate) fn from_guess(
    problem: &Problem,
    settings: &Settings,
    guess: &Guess,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    report.method = Method::MultipleShooting;
    if !is_known(guess, problem, workspace) {
        return from_rest(problem, settings, workspace, report);
    }
    put_guess(guess, problem, workspace, report);
    let outcome = newton(problem, settings, 1.0, workspace, report);
    found(problem, outcome, workspace)
}

/// Searches for the equilibrium nearest to the state in the workspace, stable or not; soon given up where none is near.
pub(crate) fn nearest(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    newton(problem, settings, LONGEST_FROM_AFAR, workspace, report)
}

/// What is left of a step after it was made.
struct Left {
    /// The size of the step.
    step: f64,
    /// The size of the one that would follow.
    correction: f64,
    damping: f64,
}

/// Newton's method from the state in the workspace, no segment longer than a part of the rod.
fn newton(
    problem: &Problem,
    settings: &Settings,
    longest: f64,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    let (mut units, mut reuse, mut last) = (units(problem, &workspace.record), false, None);
    workspace.multiple.chain.cut(problem, &workspace.record, longest);
    evaluate(problem, &units, workspace, report);
    note(workspace.multiple.chain.residual, report);
    for _ in 0..settings.max_iterations {
        let residual = report.residual;
        if !residual.is_finite() {
            return Outcome::NotFinite;
        }
        if residual <= settings.tolerance {
            break;
        }
        if !reuse {
            let Workspace { record, simd, multiple, .. } = &mut *workspace;
            let MultipleShooting { chain, system, step, .. } = multiple;
            report.factorisations += 1;
            if chain.linearise(problem, *simd, &units, record, system).is_none() {
                return Outcome::Singular;
            }
            chain.step(system, step);
        }
        match damped(problem, &units, last.take(), reuse, workspace, report) {
            Some(left) => {
                report.iterations += 1;
                let multiple = &mut workspace.multiple;
                core::mem::swap(&mut multiple.chain, &mut multiple.trial);
                reuse = left.damping >= 1.0 && left.correction <= WORTHWHILE * left.step;
                if reuse {
                    core::mem::swap(&mut multiple.step, &mut multiple.correction);
                } else {
                    last = Some(left);
                }
                note(multiple.chain.residual, report);
                if multiple.chain.too_long(problem, &workspace.record) {
                    units = self::units(problem, &workspace.record);
                    multiple.chain.cut(problem, &workspace.record, longest);
                    (reuse, last) = (false, None);
                    evaluate(problem, &units, workspace, report);
                }
            }
            None if reuse => {
                // The derivative has served its time: the state is marched again, and gets its own.
                reuse = false;
                evaluate(problem, &units, workspace, report);
            }
            None => {
                evaluate(problem, &units, workspace, report);
                return Outcome::Stalled;
            }
        }
    }
    if larger(report.residual, settings.tolerance) != settings.tolerance {
        return Outcome::Stalled;
    }
    if last.is_some_and(|left: Left| left.damping >= 1.0) {
        let multiple = &mut workspace.multiple;
        core::mem::swap(&mut multiple.step, &mut multiple.correction);
        reuse = true;
    }
    if reuse {
        polish(problem, &units, workspace, report);
    }
    if workspace.multiple.chain.segments() > 1 {
        balance(problem, &mut workspace.record);
    }
    Outcome::Converged
}

fn note(residual: f64, report: &mut SolveReport) {
    report.residual = residual;
    report.residual_history.push(residual);
}

fn evaluate(problem: &Problem, units: &Scale, workspace: &mut Workspace, report: &mut SolveReport) {
    let Workspace { record, simd, multiple, .. } = workspace;
    multiple.chain.evaluate(problem, *simd, units, record);
    report.sweeps += 1;
}

/// Makes the step, or as much of it as leaves less to correct than there was. Leaves the state after it in the trial, and the correction.
/// `None` where there is no such part; a kept derivative has to serve whole.
fn damped(
    problem: &Problem,
    units: &Scale,
    last: Option<Left>,
    reused: bool,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Option<Left> {
    let Workspace { record, simd, multiple, .. } = workspace;
    let MultipleShooting { chain, trial, system, step, correction, difference, .. } = multiple;
    let (size, turn) = chain.size(problem, units, step);
    let most = (LARGEST_TURN / turn).min(1.0);
    let mut damping: f64 = match last {
        // By how much the last correction was off the step that then followed from a derivative of its own.
        Some(last) => {
            subtract(difference, correction, step, 1.0);
            let off = chain.size(problem, units, difference).0;
            last.damping * (last.step * last.correction) / (off * size)
        }
        None => 1.0,
    };
    damping = damping.min(most);
    let mut raised = false;
    while damping >= LEAST_DAMPING {
        trial.stepped(chain, problem, units, step, damping);
        trial.evaluate(problem, *simd, units, record);
        report.sweeps += 1;
        let mut theta = f64::INFINITY;
        let mut next = 0.1 * damping;
        let mut left = f64::INFINITY;
        if trial.residual.is_finite() {
            trial.step(system, correction);
            left = trial.size(problem, units, correction).0;
            theta = left / size;
            subtract(difference, correction, step, 1.0 - damping);
            let off = trial.size(problem, units, difference).0;
            next = (0.5 * size * damping * damping / off).min(most);
        }
        // So near to the solution the corrections are round-off, and only the residual still tells.
        let nearer = size <= TINY && trial.residual <= 0.5 * chain.residual;
        if !(theta < 1.0 || nearer) {
            if reused {
                return None;
            }
            report.line_search_cuts += 1;
            damping = next.min(0.5 * damping);
            raised = true;
        } else if reused && theta > 0.5 && !nearer {
            return None;
        } else if next >= 4.0 * damping && !raised {
            // It was damped too much.
            damping = next;
            raised = true;
        } else {
            return Some(Left { step: size, correction: left, damping });
        }
    }
    None
}

/// Takes the step that is left with the derivative at hand, if it leaves less than there is: down to round-off.
fn polish(problem: &Problem, units: &Scale, workspace: &mut Workspace, report: &mut SolveReport) {
    let Workspace { record, simd, multiple, .. } = workspace;
    let MultipleShooting { chain, trial, step, .. } = multiple;
    trial.stepped(chain, problem, units, step, 1.0);
    trial.evaluate(problem, *simd, units, record);
    report.sweeps += 1;
    if larger(trial.residual, chain.residual) == chain.residual {
        core::mem::swap(chain, trial);
        report.residual = chain.residual;
    } else {
        chain.evaluate(problem, *simd, units, record);
        report.sweeps += 1;
    }
}

fn subtract(difference: &mut Vec<Twelve>, a: &[Twelve], b: &[Twelve], times: f64) {
    difference.clear();
    difference.extend(a.iter().zip(b).map(|(a, b)| core::array::from_fn(|k| a[k] - times * b[k])));
}

/// By how much what is wrong after a part of the first step from the state in the workspace differs from what is foretold, over that part of what was
/// wrong at first: for the test of the derivative.
#[cfg(test)]
pub(crate) fn misjudged(problem: &Problem, part: f64, longest: f64, workspace: &mut Workspace) -> f64 {
    let units = units(problem, &workspace.record);
    workspace.multiple.chain.cut(problem, &workspace.record, longest);
    evaluate(problem, &units, workspace, &mut SolveReport::default());
    let Workspace { record, simd, multiple, .. } = workspace;
    let MultipleShooting { chain, trial, system, step, .. } = multiple;
    chain.linearise(problem, *simd, &units, record, system).unwrap();
    chain.step(system, step);
    trial.stepped(chain, problem, &units, step, part);
    trial.evaluate(problem, *simd, &units, record);
    let (before, after) = (chain.wrong(), trial.wrong());
    let size = before.iter().fold(0.0, |max: f64, x| max.max(x.abs()));
    let off = before.iter().zip(after).map(|(before, after)| (after - (1.0 - part) * before).abs());
    off.fold(0.0, f64::max) / (part * size)
}
