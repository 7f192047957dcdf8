//! Stability: the Morse index, the number of independent ways to lower the energy.
//!
//! The energy of the rod is a sum over elements of functions of the two frames that each joins, so its second variation is a block
//! tridiagonal form in the variations `η` of the nodes. Eliminating the nodes one after the other from the rod's end keeps, at the node
//! reached, the stiffness `S` of all that lies beyond; by Sylvester's law the index is the number of negative eigenvalues of the 6×6 pivots.
//!
//! With `G` the flexibility of an element (`ξ = G δw`), `w` the wrench that it carries and `A η = ad*(η) w`, all in fixed axes, the march's
//! linearisation `η_a = η_b − ξ`, `δw_a = δw_b + A ξ` is a symmetric form in the canonical wrenches `δw + ½ A η`:
//!
//! ```text
//! pivot  D = S_b + K,    S_a = K − (K + ½A) D⁻¹ (K − ½A),    K = sym G⁻¹,    G⁻¹ = K − ½A
//! ```
//!
//! At the end `S` follows from how the end is held, and only its free displacements are eliminated; a dead load adds the second variation of
//! its own potential. In the limit of small elements the pivots that turn negative are the conjugate points of Manning, Rogers & Maddocks
//! (1998, Proc. R. Soc. A 454:3047–3074).

use super::boundary::{EndState, unknown_scale};
use super::problem::Problem;
use super::shooting::Workspace;
use crate::element::{self, coadjoint_by_strain};
use crate::math::{Mat3, Mat6, Pose, Vec3, Vec6, Wrench, lu};
use crate::rod::{Kinematics, Order};

/// Eigenvalues of this part of the largest entry are round-off and have no sign.
const ROUND_OFF: f64 = 1e-14;
/// What an inextensible, unshearable rod is given for this purpose alone, over its length and in place of no compliance: its end then yields by
/// this part of what it would yield by bending, and an eigenvalue changes its sign by that much too early.
const RIGID_COMPLIANCE: f64 = 1e-9;

/// The Morse index of the equilibrium recorded in the workspace. `None` where the start is not clamped, or follower loads or dead
/// moments act, which have no potential, and where a pivot is singular.
pub(crate) fn morse_index(problem: &Problem, state: &EndState, workspace: &Workspace) -> Option<usize> {
    let follows = problem.loads.body.iter().any(|load| *load != Vec6::ZERO);
    let turns = problem.loads.world.iter().any(|load| load.angular != Vec3::ZERO);
    if follows || turns || problem.start.fixed != [true; 6] {
        return None;
    }
    let last = problem.rod.elements() - 1;
    let axes = Axes::new(problem, workspace);
    let (displacements, stiffness) = end(problem, state, &axes, workspace.record.wrenches[last]);
    let (mut stiff, mut cross) = axes.element(problem, workspace, last)?;
    // A fixed freedom has no displacement: its row and column are zero, and its pivot one.
    cross = displacements.transpose().mul(&cross);
    let fixed = Vec6::from(problem.end.fixed.map(|fixed| f64::from(u8::from(fixed))));
    let mut pivot =
        displacements.transpose().mul(&stiff).mul(&displacements).add(&stiffness).add(&Mat6::diagonal(fixed));
    let mut index = negative(&pivot);
    for e in (0..last).rev() {
        let load =
            load_stiffness(axes.at(workspace.record.poses[e + 1].position), axes.force(problem, e + 1));
        let beyond = beyond(&stiff, &pivot, &cross)?.add(&load.scaled(-1.0));
        (stiff, cross) = axes.element(problem, workspace, e)?;
        pivot = symmetric(&beyond.add(&stiff));
        index += negative(&pivot);
    }
    Some(index)
}

/// `K − (K + ½A) D⁻¹ (K − ½A)`, from `D` and `K − ½A`.
fn beyond(stiff: &Mat6, pivot: &Mat6, cross: &Mat6) -> Option<Mat6> {
    let factors = lu::<6>(pivot.to_rows())?;
    let columns = cross.transpose().to_rows().map(|column| factors.solve(&column));
    let through = cross.transpose().mul(&Mat6::from_rows(&columns).transpose());
    Some(symmetric(&stiff.add(&through.scaled(-1.0))))
}

/// Fixed axes about the rod's start, in which lengths, forces and moments are numbers of order one.
struct Axes {
    origin: Vec3,
    length: f64,
    force: f64,
    moment: f64,
}

impl Axes {
    fn new(problem: &Problem, workspace: &Workspace) -> Self {
        let scale = problem.rod.scale();
        let origin = workspace.record.poses[0].position;
        Self { origin, length: scale.length, force: scale.force, moment: scale.moment }
    }

    fn at(&self, position: Vec3) -> Vec3 {
        (position - self.origin) * (1.0 / self.length)
    }

    fn frame(&self, pose: &Pose) -> Pose {
        Pose { rotation: pose.rotation, position: self.at(pose.position) }
    }

    fn wrench(&self, wrench: Wrench) -> Wrench {
        Wrench::new(wrench.angular * (1.0 / self.moment), wrench.linear * (1.0 / self.force))
    }

    fn force(&self, problem: &Problem, node: usize) -> Vec3 {
        problem.loads.world[node].linear * (1.0 / self.force)
    }

    /// `K` and `K − ½A` of an element. `None` where its law is singular there.
    fn element(&self, problem: &Problem, workspace: &Workspace, e: usize) -> Option<(Mat6, Mat6)> {
        let (rod, record) = (&problem.rod, &workspace.record);
        // Euler's scheme derives from no energy: its shape is judged by the element that does.
        let order = if rod.order() == Order::First { Order::Second } else { rod.order() };
        let wrench = record.wrenches[e];
        let mut g = element::flexibility_of(rod, e, wrench, &record.strains[e], order)?;
        let scales = [[self.moment, self.force], [self.moment / self.length, self.force / self.length]];
        for (blocks, scales) in g.blocks.iter_mut().zip(scales) {
            for (block, scale) in blocks.iter_mut().zip(scales) {
                *block = block.scaled(scale);
            }
        }
        if rod.kinematics() == Kinematics::Kirchhoff {
            let share = rod.element_length(e) / self.length;
            g = g.add(&Mat6::diagonal(Vec6::new(
                Vec3::ZERO,
                Vec3::new(1.0, 1.0, 1.0) * (RIGID_COMPLIANCE * share),
            )));
        }
        let factors = lu::<6>(g.to_rows())?;
        let columns = Mat6::IDENTITY.to_rows().map(|column| factors.solve(&column));
        let stiff = symmetric(&Mat6::from_rows(&columns));
        let cross = stiff.add(&coadjoint_by_strain(self.wrench(wrench)).scaled(-0.5));
        // From the far frame to the fixed axes.
        let turned = self.frame(&record.poses[e + 1]).inverse().adjoint_matrix();
        let seen = |m: &Mat6| turned.transpose().mul(m).mul(&turned);
        Some((seen(&stiff), seen(&cross)))
    }
}

/// The free displacements of the rod's end, one a column, and the stiffness against them of what holds and loads the end.
fn end(problem: &Problem, state: &EndState, axes: &Axes, wrench: Wrench) -> (Mat6, Mat6) {
    let unknowns = unknown_scale(&problem.end, &problem.rod.scale());
    let pose = axes.frame(&state.pose);
    let carried = coadjoint_by_strain(pose.carry_wrench(axes.wrench(wrench)));
    let (mut displacements, mut answers) = ([[0.0; 6]; 6], [[0.0; 6]; 6]);
    for (k, column) in state.columns(problem).iter().enumerate().filter(|(k, _)| !problem.end.fixed[*k]) {
        let frame = Vec6::new(column.frame.angular, column.frame.linear * (1.0 / axes.length)) * unknowns[k];
        let frame = pose.adjoint(frame);
        let change = pose.carry_wrench(axes.wrench(column.wrench * unknowns[k]));
        displacements[k] = frame.to_array();
        answers[k] = (change + carried.mul_vec(frame) * 0.5).to_array();
    }
    let (displacements, answers) = (Mat6::from_rows(&displacements), Mat6::from_rows(&answers));
    (displacements.transpose(), symmetric(&displacements.mul(&answers.transpose()).scaled(-1.0)))
}

/// The second variation of the potential of a dead force at a place, as a change of the canonical wrench that is carried on.
fn load_stiffness(at: Vec3, force: Vec3) -> Mat6 {
    let (p, l) = (Mat3::hat(at), Mat3::hat(force));
    let turn = (p * l + l * p).scaled(0.5);
    Mat6 { blocks: [[turn, l.scaled(-0.5)], [l.scaled(0.5), Mat3::ZERO]] }
}

fn symmetric(m: &Mat6) -> Mat6 {
    m.add(&m.transpose()).scaled(0.5)
}

/// How many eigenvalues of a symmetric matrix are negative, by the signs of the pivots of its symmetric factorisation, largest pivots first.
fn negative(matrix: &Mat6) -> usize {
    let mut m = matrix.to_rows();
    let size = m.iter().flatten().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
    let mut alive = [true; 6];
    let mut count = 0;
    loop {
        // Bunch's choice: the largest entry left, on the diagonal as a pivot, off it as a pair, which has one negative eigenvalue.
        let mut best = (0.0, 0, 0);
        for i in (0..6).filter(|i| alive[*i]) {
            for k in (i..6).filter(|k| alive[*k]) {
                // A diagonal pivot is preferred unless an entry beside it is much larger.
                let weight = if i == k { m[i][k].abs() } else { 0.6 * m[i][k].abs() };
                if weight > best.0 {
                    best = (weight, i, k);
                }
            }
        }
        let (weight, i, k) = best;
        if weight <= ROUND_OFF * size {
            return count;
        }
        if i == k {
            count += usize::from(m[i][i] < 0.0);
            alive[i] = false;
            let pivot = m[i];
            for r in (0..6).filter(|r| alive[*r]) {
                let factor = pivot[r] / pivot[i];
                (0..6).for_each(|c| m[r][c] -= factor * pivot[c]);
            }
        } else {
            let (a, b, c) = (m[i][i], m[i][k], m[k][k]);
            let determinant = a * c - b * b;
            count += if determinant < 0.0 {
                1
            } else if a + c < 0.0 {
                2
            } else {
                0
            };
            alive[i] = false;
            alive[k] = false;
            let (row_i, row_k) = (m[i], m[k]);
            for r in (0..6).filter(|r| alive[*r]) {
                let (p, q) = (row_i[r], row_k[r]);
                let (x, y) = ((c * p - b * q) / determinant, (a * q - b * p) / determinant);
                (0..6).for_each(|s| m[r][s] -= x * row_i[s] + y * row_k[s]);
            }
        }
    }
}
