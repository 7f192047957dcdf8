//! Stability: the Morse index, the number of independent ways to lower the energy, and the way that lowers it most.
//!
//! The energy of the rod is a sum over elements of functions of the two frames that each joins, so its second variation is a block
//! tridiagonal form in the variations of the nodes: the matrix of the [nodal system](super::nodal) at an equilibrium. By Sylvester's law the index
//! is the number of its negative pivots. In the limit of small elements the pivots that turn negative are the conjugate points of Manning,
//! Rogers & Maddocks (1998, Proc. R. Soc. A 454:3047–3074).
//!
//! Where as many pivots are negative when every eigenvalue is moved by more than their errors, either way, their count is right. Elsewhere the
//! [second variation](SecondVariation) is eliminated once more, at about eight times the cost, in a way that loses no digits to stiffness.

use super::march::Record;
use super::nodal::{Nodal, SecondVariation};
use super::problem::Problem;
use super::shooting::Workspace;
use super::solution::Solution;
use crate::math::{Pose, SimdLevel, Vec3, Vec6, larger};

/// What is lent to a rod's compliance against shifts for this purpose alone, over `L³/EI` and the root of the [`strength`], and to its supports, over
/// the strength.
const RIGID_COMPLIANCE: f64 = 1e-7;
/// By what is lent, over `L³/EI`, and the square of the strength, an eigenvalue may be too low: a column's is by `π²` times.
const TOO_LOW: f64 = 10.0;
/// An eigenvalue below this, over `EI/L³` and the [`strength`], is none: the rod may be free to turn about an axis, and then round-off decides its sign.
const NEUTRAL: f64 = 1e-6;

/// The Morse index of the equilibrium recorded in the workspace. `None` where follower loads or dead moments act on what can move or turn, which
/// have no potential, where a pivot vanishes, and where an element is so long for what it carries that a way down may be its own.
pub(crate) fn morse_index(problem: &Problem, workspace: &mut Workspace) -> Option<usize> {
    if !has_potential(problem) {
        return None;
    }
    let Workspace { record, nodal, variation, simd, .. } = workspace;
    let strength = strength(problem, record);
    let lent = rigid_compliance(strength);
    nodal.linearise(problem, *simd, lent, record)?;
    let clear = clear_of_round_off(nodal.round_off(), strength).max(TOO_LOW * lent * strength * strength);
    let below = nodal.solve(*simd, -clear);
    if below == Some(0) {
        return below;
    }
    let sure = below.filter(|below| nodal.solve(*simd, clear) == Some(*below));
    variation.take(problem, nodal, stiff(strength), record)?;
    let index = sure.or_else(|| variation.factor(NEUTRAL * strength))?;
    (index == 0 || variation.elements_resist()).then_some(index)
}

/// What is lent to a rod's compliance against shifts where its eigenvalues are wanted, over `L³/EI`.
pub(crate) fn rigid_compliance(strength: f64) -> f64 {
    RIGID_COMPLIANCE / strength.sqrt()
}

/// How stiff (over `EI/L³`) the supports are in the second variation. Were they softer beside the square of what they bear, a free turn could use
/// that they yield.
fn stiff(strength: f64) -> f64 {
    strength / RIGID_COMPLIANCE
}

/// The drag (over `EI/L³`) that round-off in the pivots of a linearised rod does not outweigh, nor a freedom to turn.
pub(crate) fn clear_of_round_off(round_off: f64, strength: f64) -> f64 {
    round_off.max(NEUTRAL * strength)
}

/// The way down from an equilibrium that is not stable: the motion along which the energy falls most.
pub(crate) struct WayDown {
    /// The second derivative of the energy along it, negative, over `EI/L³`, for a motion of measure one (the mean square over the length of shifts,
    /// over it, and turns, these counted little).
    pub slope: f64,
    /// How the nodes move, each in its own frame, shifts over the length.
    pub motion: Vec<Vec6>,
}

/// The way down from the equilibrium recorded. `None` where there is none, that is stable, and where it may be that of an element by itself.
pub(crate) fn way_down(
    problem: &Problem,
    level: SimdLevel,
    nodal: &mut Nodal,
    variation: &mut SecondVariation,
    record: &mut Record,
) -> Option<WayDown> {
    let strength = strength(problem, record);
    let lent = rigid_compliance(strength);
    nodal.linearise(problem, level, lent, record)?;
    variation.take(problem, nodal, stiff(strength), record)?;
    if !variation.elements_resist() {
        return None;
    }
    let (slope, motion) = variation.steepest(NEUTRAL * strength)?;
    Some(WayDown { slope, motion })
}

/// The mode in which an unstable equilibrium falls.
#[derive(Clone, Debug, PartialEq)]
pub struct UnstableMode {
    /// How each node turns, a rotation vector in world axes, rad.
    pub rotation: Vec<Vec3>,
    /// How each node shifts, in world axes, m.
    pub displacement: Vec<Vec3>,
    /// The second derivative of the energy along it, J: where the rod has moved by `a` times the mode, the energy is lower by `½ |curvature| a²`.
    pub curvature: f64,
}

/// The mode of an unstable equilibrium, a solution of the problem: of all motions that its supports leave free, the one along which the energy falls
/// most for its size, `∫ |shift|² + 0.02 L² |turn|² ds` (the first eigenvector of the second variation in that measure).
///
/// It is scaled so that the largest turn (rad) or shift (over the rod's length) of a node is one, and of its two directions the one is given in
/// which the largest component is positive. `None` where the equilibrium is stable, where it is not known whether it is, and where the solution is
/// of another rod.
pub fn unstable_mode(
    problem: &Problem,
    solution: &Solution,
    workspace: &mut Workspace,
) -> Option<UnstableMode> {
    let unstable = solution.report.morse_index.is_some_and(|index| index > 0);
    if !unstable || !super::recall(problem, solution, workspace) {
        return None;
    }
    let Workspace { record, nodal, variation, simd, .. } = workspace;
    let WayDown { slope, mut motion } = way_down(problem, *simd, nodal, variation, record)?;
    nodal.keep_to_holds(record, &mut motion);
    let in_world = |(pose, m): (&Pose, &Vec6)| m.turned_by(&pose.rotation);
    let moved: Vec<Vec6> = record.poses.iter().zip(&motion).map(in_world).collect();
    let size = moved.iter().map(|m| larger(m.angular.norm(), m.linear.norm())).fold(0.0, larger);
    let largest = moved
        .iter()
        .flat_map(|m| m.to_array())
        .fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
    let part = (1.0 / size).copysign(largest);
    let scale = problem.rod.scale();
    Some(UnstableMode {
        rotation: moved.iter().map(|m| m.angular * part).collect(),
        displacement: moved.iter().map(|m| m.linear * (part * scale.length)).collect(),
        curvature: slope * part * part * scale.moment,
    })
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
