//! Stability by conjugate points.
//!
//! The six columns of the variational sweep are the equilibria next to this one that share what is held at the rod's end.
//! Where their frames are linearly dependent, some neighbour meets the rod there again: a conjugate point. For a rod that is
//! clamped at its start and loaded by forces that have a potential, the number of conjugate points between is the number of
//! independent ways to lower the energy, the Morse index (Manning, Rogers & Maddocks 1998, Proc. R. Soc. A 454:3047–3074).
//! They are counted as changes of sign of the determinant from node to node.

use super::boundary::EndState;
use super::problem::Problem;
use super::shooting::Workspace;
use super::variation::{Variation, WatchColumns, sweep};
use crate::math::{Lanes, Vec3, Vec6, lu};

/// Below this ratio of pivots the sign of a determinant is round-off.
const TRUSTED_PIVOT_RATIO: f64 = 1e-13;

/// The Morse index of the equilibrium recorded in the workspace. `None` where the start is not clamped, or follower loads or dead
/// moments act, which have no potential.
pub(crate) fn morse_index(problem: &Problem, state: &EndState, workspace: &Workspace) -> Option<usize> {
    let follows = problem.loads.body.iter().any(|load| *load != Vec6::ZERO);
    let turns = problem.loads.world.iter().any(|load| load.angular != Vec3::ZERO);
    if follows || turns || problem.start.fixed != [true; 6] {
        return None;
    }
    let scale = problem.rod.scale();
    let columns = state.columns(problem);
    // Columns by their own scale, so that the determinant's entries are of one size.
    let unknowns = super::boundary::unknown_scale(&problem.end, &scale);
    let lane = |pick: &dyn Fn(&Variation) -> f64| {
        Lanes::<8>::from_fn(|i| if i < 6 { pick(&columns[i]) * unknowns[i] } else { 0.0 })
    };
    let vector =
        |pick: &dyn Fn(&Variation) -> Vec3| Vec3::new(lane(&|v| pick(v).x), lane(&|v| pick(v).y), lane(&|v| pick(v).z));
    let packed = Variation {
        frame: Vec6::new(vector(&|v| v.frame.angular), vector(&|v| v.frame.linear)),
        wrench: Vec6::new(vector(&|v| v.wrench.angular), vector(&|v| v.wrench.linear)),
    };
    let mut signs = Signs { length: scale.length, last: None, changes: 0 };
    sweep::<Lanes<8>>(workspace.simd, &problem.rod, &problem.loads, &workspace.record, packed, &mut signs)?;
    Some(signs.changes)
}

struct Signs {
    length: f64,
    last: Option<bool>,
    changes: usize,
}

impl WatchColumns<Lanes<8>> for Signs {
    fn node(&mut self, _: usize, columns: &Variation<Lanes<8>>) {
        let (a, l) = (columns.frame.angular, columns.frame.linear);
        let rows = [a.x, a.y, a.z, l.x, l.y, l.z];
        let mut matrix: [[f64; 6]; 6] = core::array::from_fn(|i| {
            let scale = if i < 3 { 1.0 } else { 1.0 / self.length };
            core::array::from_fn(|k| rows[i].0[k] * scale)
        });
        // Each column by its own size: near the end some have hardly grown.
        for k in 0..6 {
            let size = (0..6).fold(0.0_f64, |max, i| max.max(matrix[i][k].abs()));
            if size > 0.0 {
                (0..6).for_each(|i| matrix[i][k] /= size);
            }
        }
        let Some(factors) = lu(matrix) else {
            return;
        };
        if factors.pivot_ratio() < TRUSTED_PIVOT_RATIO {
            return;
        }
        let negative = factors.determinant_is_negative();
        if self.last.is_some_and(|last| last != negative) {
            self.changes += 1;
        }
        self.last = Some(negative);
    }
}
