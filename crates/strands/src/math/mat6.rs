//! Square matrices of six rows, by their 3×3 blocks, and a small dense LU.

use super::{Mat3, Vec3, Vec6};

/// A 6×6 matrix acting on angular and linear parts: `blocks[row][column]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat6 {
    /// The four 3×3 blocks.
    pub blocks: [[Mat3; 2]; 2],
}

impl Mat6 {
    /// The zero matrix.
    pub const ZERO: Self = Self { blocks: [[Mat3::ZERO; 2]; 2] };
    /// The identity.
    pub const IDENTITY: Self = Self { blocks: [[Mat3::IDENTITY, Mat3::ZERO], [Mat3::ZERO, Mat3::IDENTITY]] };

    /// The diagonal matrix.
    pub fn diagonal(d: Vec6) -> Self {
        Self { blocks: [[Mat3::diagonal(d.angular), Mat3::ZERO], [Mat3::ZERO, Mat3::diagonal(d.linear)]] }
    }

    /// From rows of numbers.
    pub fn from_rows(rows: &[[f64; 6]; 6]) -> Self {
        let block = |i: usize, j: usize| {
            let column = |k: usize| Vec3::new(rows[i][j + k], rows[i + 1][j + k], rows[i + 2][j + k]);
            Mat3::from_cols(column(0), column(1), column(2))
        };
        Self { blocks: [[block(0, 0), block(0, 3)], [block(3, 0), block(3, 3)]] }
    }

    /// As rows of numbers.
    #[inline]
    pub fn to_rows(&self) -> [[f64; 6]; 6] {
        let mut rows = [[0.0; 6]; 6];
        for (r, blocks) in self.blocks.iter().enumerate() {
            for (c, block) in blocks.iter().enumerate() {
                for (k, column) in block.cols.iter().enumerate() {
                    rows[3 * r][3 * c + k] = column.x;
                    rows[3 * r + 1][3 * c + k] = column.y;
                    rows[3 * r + 2][3 * c + k] = column.z;
                }
            }
        }
        rows
    }

    /// The transpose.
    pub fn transpose(&self) -> Self {
        let [[a, b], [c, d]] = self.blocks;
        Self { blocks: [[a.transpose(), c.transpose()], [b.transpose(), d.transpose()]] }
    }

    /// The product with a vector.
    pub fn mul_vec(&self, x: Vec6) -> Vec6 {
        let [[a, b], [c, d]] = self.blocks;
        Vec6::new(a * x.angular + b * x.linear, c * x.angular + d * x.linear)
    }

    /// The product with a matrix.
    pub fn mul(&self, o: &Self) -> Self {
        let p = &self.blocks;
        let q = &o.blocks;
        let entry = |i: usize, j: usize| p[i][0] * q[0][j] + p[i][1] * q[1][j];
        Self { blocks: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]] }
    }

    /// The sum.
    pub fn add(&self, o: &Self) -> Self {
        let entry = |i: usize, j: usize| self.blocks[i][j] + o.blocks[i][j];
        Self { blocks: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]] }
    }

    /// Each entry times `k`.
    pub fn scaled(&self, k: f64) -> Self {
        let entry = |i: usize, j: usize| self.blocks[i][j].scaled(k);
        Self { blocks: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]] }
    }
}

/// An LU factorisation with row interchange of a dense matrix of `N` rows.
#[derive(Clone, Debug)]
pub struct Lu<const N: usize> {
    factors: [[f64; N]; N],
    rows: [usize; N],
}

/// Factors a matrix; `None` where a pivot is zero or not finite.
pub fn lu<const N: usize>(mut a: [[f64; N]; N]) -> Option<Lu<N>> {
    let mut rows: [usize; N] = core::array::from_fn(|i| i);
    for k in 0..N {
        let pivot = (k..N).fold(k, |best, i| if a[i][k].abs() > a[best][k].abs() { i } else { best });
        if !(a[pivot][k].abs() > 0.0 && a[pivot][k].is_finite()) {
            return None;
        }
        if pivot != k {
            a.swap(pivot, k);
            rows.swap(pivot, k);
        }
        let scale = 1.0 / a[k][k];
        for i in k + 1..N {
            a[i][k] *= scale;
            let factor = a[i][k];
            for j in k + 1..N {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    Some(Lu { factors: a, rows })
}

impl<const N: usize> Lu<N> {
    /// Solves `A x = b`.
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let mut x: [f64; N] = core::array::from_fn(|i| b[self.rows[i]]);
        for i in 0..N {
            for j in 0..i {
                x[i] -= self.factors[i][j] * x[j];
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                x[i] -= self.factors[i][j] * x[j];
            }
            x[i] /= self.factors[i][i];
        }
        x
    }
}
