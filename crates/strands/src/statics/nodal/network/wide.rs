//! Blocks whose rows are as wide as a register.

use crate::statics::nodal::elimination::Square;

/// Six rows of a block, each as wide as a register.
#[repr(align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Wide(pub [[f64; 8]; 6]);

impl Wide {
    pub const NONE: Self = Self([[0.0; 8]; 6]);

    #[inline(always)]
    pub fn add(&mut self, block: &Square<f64>) {
        for (row, block) in self.0.iter_mut().zip(block) {
            row.iter_mut().zip(block).for_each(|(x, block)| *x += block);
        }
    }

    /// Subtracts the product of two.
    #[inline(always)]
    pub fn subtract_product(&mut self, a: &Self, b: &Self) {
        for (row, a) in self.0.iter_mut().zip(&a.0) {
            for (c, x) in row.iter_mut().enumerate() {
                let term = |k: usize| b.0[k][c] * a[k];
                *x -= (term(0) + term(1)) + (term(2) + term(3)) + (term(4) + term(5));
            }
        }
    }

    /// Its six columns.
    #[inline(always)]
    pub fn square(&self) -> Square<f64> {
        self.0.map(|[a, b, c, d, e, f, ..]| [a, b, c, d, e, f])
    }
}
