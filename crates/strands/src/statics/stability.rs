//! Stability: the Morse index, the number of independent ways to lower the energy.
//!
//! The energy of the rod is a sum over elements of functions of the two frames that each joins, so its second variation is a block
//! tridiagonal form in the variations of the nodes: the matrix of the [nodal system](super::nodal) at an equilibrium. By Sylvester's law the index
//! is the number of its negative pivots. In the limit of small elements the pivots that turn negative are the conjugate points of Manning,
//! Rogers & Maddocks (1998, Proc. R. Soc. A 454:3047–3074).

use super::march::Record;
use super::problem::Problem;
use super::shooting::Workspace;
use crate::math::{Vec3, Vec6};

/// What an inextensible, unshearable rod is given for this purpose alone, over `L³/EI` and in place of no compliance: its end then yields by
/// this part of what it would yield by bending, and an eigenvalue changes its sign by that much too early.
pub(crate) const RIGID_COMPLIANCE: f64 = 1e-7;
/// An eigenvalue below this, over `EI/L³` and the [`strength`], is none: the rod may be free to turn about an axis, and then round-off decides its sign.
pub(crate) const NEUTRAL: f64 = 4e-5;

/// The Morse index of the equilibrium recorded in the workspace. `None` where follower loads or dead moments act on what can move or turn, which
/// have no potential, and where a pivot is singular.
pub(crate) fn morse_index(problem: &Problem, workspace: &mut Workspace) -> Option<usize> {
    if !has_potential(problem) {
        return None;
    }
    let Workspace { record, nodal, simd, .. } = workspace;
    nodal.linearise(problem, *simd, RIGID_COMPLIANCE, record)?;
    nodal.solve(*simd, NEUTRAL * strength(problem, record))
}

/// The forces that act and that the rod carries, over `EI/L²`, and one for its own: what stiffnesses are measured by.
pub(crate) fn strength(problem: &Problem, record: &Record) -> f64 {
    1.0 + problem.load_size() + record.largest_force() / problem.rod.scale().force
}

/// Whether the loads have one: dead forces have, the rod's own energy and springs have, and what bears on a support does no work.
pub(crate) fn has_potential(problem: &Problem) -> bool {
    let cannot_turn = |node| problem.support(node).is_some_and(|support| support.fixed[..3] == [true; 3]);
    problem.loads.body.iter().zip(&problem.loads.world).enumerate().all(|(node, (body, world))| {
        if *body == Vec6::ZERO && world.angular == Vec3::ZERO {
            return true;
        }
        // Where the node cannot turn, a moment does no work and a follower force is a dead one.
        cannot_turn(node)
    })
}
