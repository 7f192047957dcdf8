//! Which way a solve takes first, and why: asked by [`solve`](super::solve) itself, so that the answer is what happens.

use super::problem::Problem;
use super::solution::{Guess, Method, Settings};
use super::{all_at_once, has_energy, is_held, sweep};

/// The way that a solve tries first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The solver. [`Method::Auto`] only ever leads to one of the others. Another may still find the solution where this one fails.
    pub method: Method,
    /// Why this one, in a sentence.
    pub why: &'static str,
    pub(super) way: Way,
}

/// The ways that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Two sweeps, and nothing to iterate.
    TwoSweeps,
    /// Shooting from a guess.
    Shoot,
    /// All frames at once, from a guess.
    Move,
    /// Shooting, from rest along a path.
    Walk,
    /// All frames at once, from rest.
    Settle,
    /// Multiple shooting, from a guess or from rest.
    Segments,
}

const PULLED: &str =
    "a load pulls towards a point, and so turns with where the rod is, which shooting does not follow";

/// The way that [`solve`](super::solve) tries first with these settings, from a guess or from rest.
pub fn plan(problem: &Problem, settings: &Settings, guess: Option<&Guess>) -> Plan {
    let auto = settings.method == Method::Auto;
    let standard = sweep::not_standard(problem).is_none();
    let swept = standard && (auto || settings.method == Method::Sweep);
    let sweeps_or_shooting = if swept { Method::Sweep } else { Method::Shooting };
    if swept && !problem.loads.any_in_world() {
        let why = "its start is clamped, its end free, and the loads follow it: two sweeps give the answer without a search";
        return Plan { method: Method::Sweep, why, way: Way::TwoSweeps };
    }
    if settings.method == Method::MultipleShooting {
        return Plan { method: Method::MultipleShooting, why: "it was asked for", way: Way::Segments };
    }
    if let Some(guess) = guess {
        if !all_at_once(problem, settings, guess) {
            let why = "there is a solution to start from, and the rod is not too taut for shooting";
            return Plan { method: sweeps_or_shooting, why, way: Way::Shoot };
        }
        let way = if has_energy(problem, settings) { Way::Move } else { Way::Settle };
        let why = match settings.method {
            Method::Equilibrium => "it was asked for",
            _ if !problem.between.is_empty() => "the rod is held between its ends, which shooting cannot do",
            _ if !problem.loads.pulls().is_empty() => PULLED,
            _ => "the rod is too taut for shooting, which loses a factor exp(L/ℓ) of accuracy",
        };
        return Plan { method: Method::Equilibrium, why, way };
    }
    if settings.method == Method::Equilibrium {
        return Plan { method: Method::Equilibrium, why: "it was asked for", way: Way::Settle };
    }
    if !auto {
        return Plan { method: sweeps_or_shooting, why: "it was asked for", way: Way::Walk };
    }
    if is_held(problem) {
        let why =
            "the rod is held by more than a clamp at its start, so all frames move at once to where it rests";
        return Plan { method: Method::Equilibrium, why, way: Way::Settle };
    }
    if !problem.loads.pulls().is_empty() {
        return Plan { method: Method::Equilibrium, why: PULLED, way: Way::Settle };
    }
    let why = if standard {
        "its start is clamped and its end free, and the loads keep their directions: sweeps, repeated until the end's angle is right, as the \
         loads grow from nothing"
    } else {
        "its start is clamped and its end free or in a hand: a search at the end, as the loads grow from nothing"
    };
    Plan { method: sweeps_or_shooting, why, way: Way::Walk }
}
