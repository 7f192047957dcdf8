//! The linear system of multiple shooting: almost block diagonal, factored as it comes.
//!
//! Six equations hold at the rod's start, in the twelve unknowns of its first joint; twelve at each joint, in its own twelve unknowns and those of
//! the next; and the last joint, the rod's end, has six unknowns:
//!
//! ```text
//! S₁                     x₁     r₀
//! A₁  B₁                 x₂  =  r₁
//!     A₂  B₂             x₃     r₂
//! ```
//!
//! Six rows that are left over from the joint before are stacked on the twelve of a joint, and Gauss's elimination with row interchange among all
//! eighteen leaves six for the next (Ascher, Mattheij & Russell 1995, section 7.2). Because a row is chosen from both sides, growing and decaying
//! solutions are told apart on the way, and no segment's matrix is ever multiplied by another one's: what the segments keep of their digits
//! is kept. The cost is linear in the number of joints.

use crate::math::{Kernel, Lanes, Lu, Real, SimdLevel, dispatch, lu};

/// How many unknowns a joint has.
pub(crate) const JOINT: usize = 12;
/// How many of them the rod's end has, and how many equations its start.
pub(crate) const END: usize = 6;
const STACK: usize = END + JOINT;
/// Columns of a joint and the next one.
type Row = [Lanes<8>; 3];

/// Twelve rows or unknowns.
pub(crate) type Twelve = [f64; JOINT];

/// The eliminated rows of a joint.
#[derive(Clone, Debug)]
struct Block {
    /// The rows in the order of their pivots, and the six that are left over.
    rows: [Row; STACK],
    /// By step: what of the pivot's row each row below it was less.
    factors: [[f64; STACK]; JOINT],
    /// By step: the row that was interchanged with the pivot's.
    chosen: [usize; JOINT],
}

/// The system, factored.
#[derive(Clone, Debug, Default)]
pub(crate) struct AlmostBlockDiagonal {
    blocks: Vec<Block>,
    used: usize,
    left_over: [Twelve; END],
    last: Option<Lu<END>>,
    /// How many joints have been eliminated so far, in all systems together.
    #[cfg(test)]
    pub eliminated: usize,
}

impl AlmostBlockDiagonal {
    /// Begins with the rows of the start.
    pub fn begin(&mut self, start: &[Twelve; END]) {
        self.used = 0;
        self.last = None;
        self.left_over = *start;
    }

    /// Takes a joint's rows, in its own unknowns and in those of the next joint. `None` where they are singular.
    pub fn push(&mut self, level: SimdLevel, own: &[Twelve; JOINT], next: &[Twelve; JOINT]) -> Option<()> {
        if self.used == self.blocks.len() {
            let rows = [[Lanes::zero(); 3]; STACK];
            self.blocks.push(Block { rows, factors: [[0.0; STACK]; JOINT], chosen: [0; JOINT] });
        }
        let block = &mut self.blocks[self.used];
        self.used += 1;
        for (row, own) in block.rows.iter_mut().zip(&self.left_over) {
            *row = joined(own, &[0.0; JOINT]);
        }
        for ((row, own), next) in block.rows[END..].iter_mut().zip(own).zip(next) {
            *row = joined(own, next);
        }
        #[cfg(test)]
        {
            self.eliminated += 1;
        }
        dispatch(level, Eliminate { block })?;
        for (row, left) in block.rows[JOINT..].iter().zip(&mut self.left_over) {
            *left = core::array::from_fn(|c| entry(row, JOINT + c));
        }
        Some(())
    }

    /// Ends with the six unknowns of the end. `None` where the whole is singular.
    pub fn end(&mut self) -> Option<()> {
        self.last = lu(core::array::from_fn(|r| core::array::from_fn(|c| self.left_over[r][c])));
        self.last.as_ref().map(|_| ())
    }

    /// Solves for right-hand sides at the start and at the joints. The unknowns replace those of the joints, and the end's, six of them, come
    /// after them.
    pub fn solve(&self, start: &[f64; END], unknowns: &mut [Twelve]) {
        let Some(last) = &self.last else { return };
        let (end, joints) = unknowns.split_last_mut().unwrap_or_else(|| unreachable!("a rod has an end"));
        let mut left_over = *start;
        for (block, values) in self.blocks.iter().zip(joints.iter_mut()) {
            let mut stack = [0.0; STACK];
            stack[..END].copy_from_slice(&left_over);
            stack[END..].copy_from_slice(values);
            for k in 0..JOINT {
                stack.swap(k, block.chosen[k]);
                let pivot = stack[k];
                for (value, factor) in stack.iter_mut().zip(&block.factors[k]) {
                    *value -= factor * pivot;
                }
            }
            values.copy_from_slice(&stack[..JOINT]);
            left_over.copy_from_slice(&stack[JOINT..]);
        }
        *end = [0.0; JOINT];
        end[..END].copy_from_slice(&last.solve(&left_over));
        let mut next = *end;
        for (block, values) in self.blocks.iter().zip(joints.iter_mut()).rev() {
            let mut known = joined(&[0.0; JOINT], &next);
            for k in (0..JOINT).rev() {
                let row = &block.rows[k];
                let sum = row[0] * known[0] + row[1] * known[1] + row[2] * known[2];
                let sum = sum.0.iter().sum::<f64>();
                known[k / 8].0[k % 8] = (values[k] - sum) / entry(row, k);
            }
            *values = core::array::from_fn(|k| entry(&known, k));
            next = *values;
        }
    }
}

fn joined(own: &Twelve, next: &Twelve) -> Row {
    core::array::from_fn(|lane| {
        Lanes::from_fn(|i| {
            let c = 8 * lane + i;
            if c < JOINT { own[c] } else { next[c - JOINT] }
        })
    })
}

#[inline(always)]
fn entry(row: &Row, column: usize) -> f64 {
    row[column / 8].0[column % 8]
}

/// Eliminates a joint's own unknowns from its stack.
struct Eliminate<'a> {
    block: &'a mut Block,
}

impl Kernel for Eliminate<'_> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(self) -> Option<()> {
        let Block { rows, factors, chosen } = self.block;
        for k in 0..JOINT {
            let size = |row: &Row| entry(row, k).abs();
            let best =
                (k..STACK).fold(k, |best, i| if size(&rows[i]) > size(&rows[best]) { i } else { best });
            let pivot = entry(&rows[best], k);
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return None;
            }
            rows.swap(k, best);
            chosen[k] = best;
            let (above, below) = rows.split_at_mut(k + 1);
            let pivot_row = &above[k];
            factors[k] = [0.0; STACK];
            for (row, factor) in below.iter_mut().zip(&mut factors[k][k + 1..]) {
                *factor = entry(row, k) / pivot;
                let times = Lanes::splat(*factor);
                for (part, pivot) in row.iter_mut().zip(pivot_row) {
                    *part -= *pivot * times;
                }
            }
        }
        Some(())
    }
}
