//! The elimination of the nodal system: node by node from the start to the end, each a block of six, whose pivots give the inertia.

use super::second_variation::TURNING;
use super::{Hold, Link, Nodal, Row};
use crate::math::{Kernel, Mat3, Mat6, Real, Vec3, Vec6, Wrench};

/// A pivot below this part of the largest entry is none.
const SMALLEST_PIVOT: f64 = 1e-15;

/// Six rows of a block: six columns, and two for what acts.
pub(super) type Block = [Row; 6];
/// The column of what acts, and that of another right-hand side.
const COLUMNS: [usize; 2] = [6, 7];

/// Eliminates the nodes from the first to the last, and puts the step back together.
pub(super) struct Eliminate<'a> {
    pub nodal: &'a mut Nodal,
    pub drag: f64,
}

impl Kernel for Eliminate<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn run(self) -> Option<usize> {
        let Self { nodal, drag } = self;
        let n = nodal.links.len();
        nodal.follows.resize(n + 1, [Row::zero(); 6]);
        nodal.steps.clear();
        nodal.steps.resize(n + 1, Vec6::ZERO);
        let mut negative = 0;
        // What the nodes before add to the pivot, and in column 6 to what acts.
        let mut earlier = [Row::zero(); 6];
        let (mut holds, mut slopes) = (0, 0);
        for i in 0..=n {
            let mut pivot = earlier;
            add_drag(&mut pivot, nodal.places[i], drag);
            let acting = nodal.imbalance(i);
            for (row, force) in pivot.iter_mut().zip(acting.to_array()) {
                row.0[6] += force;
            }
            if let Some(other) = nodal.others.get(i) {
                for (row, force) in pivot.iter_mut().zip(other.to_array()) {
                    row.0[7] += force;
                }
            }
            let mut upper = [Row::zero(); 6];
            if let Some(after) = nodal.links.get(i) {
                upper = on_far(after);
                add(&mut pivot, &after.stiffness);
                add_column(&mut pivot, after.pull, 1.0);
            }
            if i > 0 {
                let before = &nodal.links[i - 1];
                add(&mut pivot, &on_far(before));
                add_column(&mut pivot, before.pull, -1.0);
            }
            while nodal.load_slopes.get(slopes).is_some_and(|(node, _)| *node == i) {
                for (row, slope) in pivot.iter_mut().zip(nodal.load_slopes[slopes].1.to_rows()) {
                    (0..6).for_each(|k| row.0[k] -= slope[k]);
                }
                slopes += 1;
            }
            let hold = nodal.holds.get(holds).filter(|hold| hold.node == i);
            if let Some(hold) = hold {
                holds += 1;
                (pivot, upper) = restrict(hold, &pivot, &upper);
            }
            for r in 0..6 {
                COLUMNS.iter().for_each(|c| upper[r].0[*c] = pivot[r].0[*c]);
            }
            let follow = &mut nodal.follows[i];
            *follow = upper;
            negative += reduce(&mut pivot, follow)?;
            if let Some(hold) = hold {
                *follow = expand(hold, follow);
            }
            if let Some(after) = nodal.links.get(i) {
                // −L D⁻¹ U to the next pivot, and L D⁻¹ b to what acts.
                earlier = product(&after.stiffness, follow);
                for row in &mut earlier {
                    (0..6).for_each(|k| row.0[k] = -row.0[k]);
                }
            }
        }
        put_together(&nodal.follows, COLUMNS[0], &mut nodal.steps);
        nodal.other_steps.clear();
        if !nodal.others.is_empty() {
            nodal.other_steps.resize(n + 1, Vec6::ZERO);
            put_together(&nodal.follows, COLUMNS[1], &mut nodal.other_steps);
        }
        Some(negative)
    }
}

/// Each node's step from that of the one after it.
#[inline(always)]
fn put_together(follows: &[Block], column: usize, steps: &mut [Vec6]) {
    let mut after = [0.0; 6];
    for (follow, step) in follows.iter().zip(steps).rev() {
        let x = after;
        let mut next = [0.0; 6];
        for (next, row) in next.iter_mut().zip(follow) {
            let row = &row.0;
            *next = row[column]
                + ((row[0] * x[0] + row[1] * x[1]) + (row[2] * x[2] + row[3] * x[3]))
                + (row[4] * x[4] + row[5] * x[5]);
        }
        *step = Vec6::from(next);
        after = next;
    }
}

#[inline(always)]
fn add(to: &mut Block, block: &Block) {
    for (row, other) in to.iter_mut().zip(block) {
        *row += *other;
    }
}

#[inline(always)]
fn add_column(to: &mut Block, column: Wrench, sign: f64) {
    for (row, value) in to.iter_mut().zip(column.to_array()) {
        row.0[6] += sign * value;
    }
}

/// `F + A`: how what the element exerts on its far node changes with that node.
#[inline(always)]
fn on_far(link: &Link) -> Block {
    let mut block = link.stiffness;
    let (m, n) = (link.carried.angular, link.carried.linear);
    let mut minus_hat = |r: usize, c: usize, v: Vec3| {
        block[r].0[c + 1] += v.z;
        block[r].0[c + 2] -= v.y;
        block[r + 1].0[c] -= v.z;
        block[r + 1].0[c + 2] += v.x;
        block[r + 2].0[c] += v.y;
        block[r + 2].0[c + 1] -= v.x;
    };
    minus_hat(0, 0, m);
    minus_hat(0, 3, n);
    minus_hat(3, 0, n);
    block
}

/// The drag on a node that turns and shifts: `|η + θ × p|² + TURNING |θ|²`.
#[inline(always)]
fn add_drag(pivot: &mut Block, p: Vec3, drag: f64) {
    let arm = Mat3::hat(p);
    let turning = Mat3::IDENTITY.scaled(TURNING) - arm * arm;
    for r in 0..3 {
        for c in 0..3 {
            pivot[r].0[c] += drag * turning.cols[c][r];
            pivot[r].0[3 + c] += drag * arm.cols[c][r];
            pivot[3 + r].0[c] -= drag * arm.cols[c][r];
        }
        pivot[3 + r].0[3 + r] += drag;
    }
}

/// Solves the six equations for seven right-hand sides, in place, without interchange: the signs of the pivots are wanted, and where all are
/// positive it is not needed. `None` where a pivot vanishes.
#[inline(always)]
fn reduce(left: &mut Block, right: &mut Block) -> Option<usize> {
    let mut size = 0.0_f64;
    for row in left.iter() {
        for x in &row.0[..6] {
            size = size.max(x.abs());
        }
    }
    let mut negative = 0;
    for k in 0..6 {
        let pivot = left[k].0[k];
        if !(pivot.abs() > SMALLEST_PIVOT * size && pivot.is_finite()) {
            return None;
        }
        negative += usize::from(pivot < 0.0);
        let scale = 1.0 / pivot;
        let (mut l, mut r) = (left[k].0, right[k].0);
        for c in 0..8 {
            l[c] *= scale;
            r[c] *= scale;
        }
        (left[k].0, right[k].0) = (l, r);
        for i in 0..6 {
            if i == k {
                continue;
            }
            let factor = left[i].0[k];
            for c in 0..8 {
                left[i].0[c] -= l[c] * factor;
                right[i].0[c] -= r[c] * factor;
            }
        }
    }
    Some(negative)
}

/// The product of six columns of a block with a block.
#[inline(always)]
fn product(a: &Block, b: &Block) -> Block {
    let mut out = [Row::zero(); 6];
    for (out, a) in out.iter_mut().zip(a) {
        for c in 0..8 {
            let term = |k: usize| b[k].0[c] * a.0[k];
            out.0[c] = (term(0) + term(1)) + (term(2) + term(3)) + (term(4) + term(5));
        }
    }
    out
}

fn matrix(block: &Block) -> Mat6 {
    Mat6::from_rows(&core::array::from_fn(|r| core::array::from_fn(|c| block[r].0[c])))
}

fn columns(block: &Block) -> [Vec6; 2] {
    COLUMNS.map(|c| Vec6::from(core::array::from_fn::<f64, 6, _>(|r| block[r].0[c])))
}

fn block(matrix: &Mat6, columns: [Vec6; 2]) -> Block {
    let (rows, columns) = (matrix.to_rows(), columns.map(|column| column.to_array()));
    core::array::from_fn(|r| {
        let mut row = Row::zero();
        row.0[..6].copy_from_slice(&rows[r]);
        COLUMNS.iter().zip(columns).for_each(|(c, column)| row.0[*c] = column[r]);
        row
    })
}

/// A held node's equations in its free displacements; those that are fixed are zero.
#[inline(never)]
fn restrict(hold: &Hold, pivot: &Block, upper: &Block) -> (Block, Block) {
    let t = hold.free.transpose();
    let fixed = Mat6::diagonal(Vec6::from(hold.fixed.map(f64::from)));
    let restricted = t.mul(&matrix(pivot)).mul(&hold.free).add(&hold.curved).add(&fixed);
    let acting = columns(pivot).map(|column| t.mul_vec(column));
    (block(&restricted, acting), block(&t.mul(&matrix(upper)), [Vec6::ZERO; 2]))
}

/// From the free displacements of a held node to the variation of its frame.
#[inline(never)]
fn expand(hold: &Hold, follow: &Block) -> Block {
    block(&hold.free.mul(&matrix(follow)), columns(follow).map(|column| hold.free.mul_vec(column)))
}
