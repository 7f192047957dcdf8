//! Static equilibrium.

mod problem;
mod solution;

pub use problem::{End, Problem};
pub use solution::{
    Energy, FailureReason, Guess, Jacobian, Method, Reaction, Settings, Solution, SolveFailure, SolveReport,
};

/// Scratch of the solvers: made once, reused by every solve of any rod; the only thing that allocates.
#[derive(Clone, Debug, Default)]
pub struct Workspace {}

/// Finds an equilibrium of a problem, starting from a guess (the last frame's solution) or from rest.
///
/// # Errors
/// Where none was found: why, with the nearest state.
pub fn solve(
    _problem: &Problem,
    _settings: &Settings,
    _guess: Option<&Guess>,
    _workspace: &mut Workspace,
) -> Result<Solution, SolveFailure> {
    unimplemented!()
}
