//! Stability by conjugate points.
//!
//! The six columns of the variational sweep are the equilibria next to this one that share what is held at the rod's end.
//! Where their frames are linearly dependent, some neighbour meets the rod there again: a conjugate point. For a rod that is
//! clamped at its start and loaded by forces that have a potential, the number of conjugate points between is the number of
//! independent ways to lower the energy, the Morse index (Manning, Rogers & Maddocks 1998, Proc. R. Soc. A 454:3047–3074).
//!
//! With `Y` the columns' frames and `W` their wrenches, `M = −Wᵀ Y` is symmetric (in canonical coordinates, which add half the bracket with the
//! wrench). Past an element of flexibility `G`, `Y` becomes `Y − G W` and `M` grows by `Wᵀ G W`; each eigenvalue of `M` that it
//! takes from below to above zero is a conjugate point. So they are counted with their multiplicity, element by element. The
//! columns are made orthonormal now and then: only the space that they span matters.

use super::boundary::{EndState, unknown_scale};
use super::problem::Problem;
use super::shooting::Workspace;
use super::variation::{Columns, Variation, carry};
use crate::element;
use crate::math::{Vec3, Vec6, Wrench};
use crate::rod::{Order, Scale};

/// Pivots below this part of the largest frame times the largest wrench are round-off and have no sign.
const ROUND_OFF: f64 = 1e-12;
/// How many elements are passed before the columns are made orthonormal.
const ELEMENTS_BETWEEN: usize = 4;

/// The Morse index of the equilibrium recorded in the workspace. `None` where the start is not clamped, or follower loads or dead
/// moments act, which have no potential.
pub(crate) fn morse_index(problem: &Problem, state: &EndState, workspace: &Workspace) -> Option<usize> {
    let follows = problem.loads.body.iter().any(|load| *load != Vec6::ZERO);
    let turns = problem.loads.world.iter().any(|load| load.angular != Vec3::ZERO);
    if follows || turns || problem.start.fixed != [true; 6] {
        return None;
    }
    let (rod, record) = (&problem.rod, &workspace.record);
    // Euler's scheme derives from no energy, and its flexibility is not symmetric: its shape is judged by the element that does.
    let order = if rod.order() == Order::First { Order::Second } else { rod.order() };
    let scale = rod.scale();
    let unknowns = unknown_scale(&problem.end, &scale);
    let mut columns = state.columns(problem);
    for (column, unknown) in columns.iter_mut().zip(unknowns) {
        column.frame = column.frame * unknown;
        column.wrench = column.wrench * unknown;
    }
    let mut index = 0;
    for e in (0..rod.elements()).rev() {
        let wrench = record.wrenches[e];
        let flexibility = element::flexibility_of(rod, e, wrench, &record.strains[e], order)?;
        let yields: [Vec6; 6] = core::array::from_fn(|k| flexibility.mul_vec(columns[k].wrench));
        let canonical: [Wrench; 6] =
            core::array::from_fn(|k| columns[k].wrench + columns[k].frame.coadjoint(wrench) * 0.5);
        let before = negative(&canonical, &columns.map(|column| column.frame), &scale);
        let after: [Vec6; 6] = core::array::from_fn(|k| columns[k].frame - yields[k]);
        // The start's node is held: a conjugate point on it is not an instability.
        if e > 0 {
            index += before.saturating_sub(negative(&canonical, &after, &scale));
        }
        for (column, yielded) in columns.iter_mut().zip(yields) {
            *column = carry(record, &problem.loads, e, wrench, *column, yielded);
        }
        if e % ELEMENTS_BETWEEN == 0 {
            orthonormalise(&mut columns, &scale);
        }
    }
    Some(index)
}

/// How many eigenvalues of `−Wᵀ Y` are negative, by the signs of the pivots of its symmetric factorisation, largest pivots first.
fn negative(wrenches: &[Wrench; 6], frames: &[Vec6; 6], scale: &Scale) -> usize {
    let largest = |sizes: [f64; 6]| sizes.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let size = largest(frames.map(|frame| frame_size(&frame, scale)))
        * largest(wrenches.map(|wrench| wrench_size(&wrench, scale)))
        * scale.moment;
    let mut m: [[f64; 6]; 6] = core::array::from_fn(|i| {
        core::array::from_fn(|k| -0.5 * (wrenches[i].dot(frames[k]) + wrenches[k].dot(frames[i])) / size)
    });
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
        if weight <= ROUND_OFF {
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

fn frame_size(x: &Vec6, scale: &Scale) -> f64 {
    x.angular.max_abs().max(x.linear.max_abs() / scale.length)
}

fn wrench_size(x: &Wrench, scale: &Scale) -> f64 {
    (x.angular.max_abs() / scale.moment).max(x.linear.max_abs() / scale.force)
}

/// Gram and Schmidt, over frames and wrenches together, each by its scale.
fn orthonormalise(columns: &mut Columns, scale: &Scale) {
    let product = |a: &Variation, b: &Variation| {
        a.frame.angular.dot(b.frame.angular)
            + a.frame.linear.dot(b.frame.linear) / (scale.length * scale.length)
            + a.wrench.angular.dot(b.wrench.angular) / (scale.moment * scale.moment)
            + a.wrench.linear.dot(b.wrench.linear) / (scale.force * scale.force)
    };
    for k in 0..6 {
        for j in 0..k {
            let part = product(&columns[j], &columns[k]);
            let other = columns[j];
            columns[k].frame -= other.frame * part;
            columns[k].wrench -= other.wrench * part;
        }
        let size = product(&columns[k], &columns[k]).sqrt();
        if size > 0.0 {
            columns[k].frame = columns[k].frame * (1.0 / size);
            columns[k].wrench = columns[k].wrench * (1.0 / size);
        }
    }
}
