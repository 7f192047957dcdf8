//! Symmetric matrices factored as `L D Lᵀ`, the blocks of `D` of one or two rows, whose signs are those of the eigenvalues.
//!
//! With complete interchange, which no matrix upsets: Bunch & Parlett (1971, SIAM J. Numer. Anal. 8:639–655).

/// A factorisation of a symmetric matrix of `N` rows.
#[derive(Clone, Debug)]
pub(crate) struct Ldl<const N: usize> {
    /// The blocks of `D` on the diagonal, `L` below it.
    factors: [[f64; N]; N],
    rows: [usize; N],
    /// Whether a row and the next are a block of two.
    paired: [bool; N],
    negative: usize,
}

/// What a single pivot must be of the largest entry beside the diagonal: it grows no more than a pair of them does.
const LARGE_ENOUGH: f64 = 0.640_388;

/// Factors a symmetric matrix, of which the lower triangle is read; `None` where it is singular or not finite.
pub(crate) fn ldl<const N: usize>(mut a: [[f64; N]; N]) -> Option<Ldl<N>> {
    let mut rows: [usize; N] = core::array::from_fn(|i| i);
    let (mut paired, mut negative) = ([false; N], 0);
    let mut k = 0;
    while k < N {
        let (mut single, mut pair) = (k, (k, k));
        let (mut on, mut off) = (a[k][k].abs(), 0.0);
        for i in k + 1..N {
            if a[i][i].abs() > on {
                (single, on) = (i, a[i][i].abs());
            }
            for j in k..i {
                if a[i][j].abs() > off {
                    (pair, off) = ((j, i), a[i][j].abs());
                }
            }
        }
        if !(on.max(off) > 0.0 && (on + off).is_finite()) {
            return None;
        }
        let mut interchange = |i: usize, j: usize| {
            swap(&mut a, i, j);
            rows.swap(i, j);
        };
        if on >= LARGE_ENOUGH * off {
            interchange(k, single);
            let pivot = a[k][k];
            negative += usize::from(pivot < 0.0);
            for i in k + 1..N {
                let factor = a[i][k] / pivot;
                // Those above have been divided already.
                for j in k + 1..i {
                    a[i][j] -= a[i][k] * a[j][k];
                }
                a[i][i] -= factor * a[i][k];
                a[i][k] = factor;
            }
            k += 1;
        } else {
            interchange(k, pair.0);
            interchange(k + 1, pair.1);
            paired[k] = true;
            // Of two signs: beside the diagonal it is larger than on it.
            negative += 1;
            let (above, beside, below) = (a[k][k], a[k + 1][k], a[k + 1][k + 1]);
            let determinant = above * below - beside * beside;
            for i in k + 2..N {
                let (x, y) = (a[i][k], a[i][k + 1]);
                let factors =
                    [(x * below - y * beside) / determinant, (y * above - x * beside) / determinant];
                for j in k + 2..i {
                    a[i][j] -= x * a[j][k] + y * a[j][k + 1];
                }
                a[i][i] -= factors[0] * x + factors[1] * y;
                (a[i][k], a[i][k + 1]) = (factors[0], factors[1]);
            }
            k += 2;
        }
    }
    Some(Ldl { factors: a, rows, paired, negative })
}

/// Interchanges two rows and the same two columns, of a matrix known by its lower triangle.
fn swap<const N: usize>(a: &mut [[f64; N]; N], i: usize, j: usize) {
    let (i, j) = (i.min(j), i.max(j));
    if i == j {
        return;
    }
    for k in 0..i {
        (a[i][k], a[j][k]) = (a[j][k], a[i][k]);
    }
    for k in i + 1..j {
        (a[k][i], a[j][k]) = (a[j][k], a[k][i]);
    }
    for k in j + 1..N {
        (a[k][i], a[k][j]) = (a[k][j], a[k][i]);
    }
    (a[i][i], a[j][j]) = (a[j][j], a[i][i]);
}

impl<const N: usize> Ldl<N> {
    /// How many eigenvalues are negative.
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// Solves `A x = b`.
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let a = &self.factors;
        let mut y: [f64; N] = core::array::from_fn(|i| b[self.rows[i]]);
        let pair_of = |i: usize| i > 0 && self.paired[i - 1];
        for i in 0..N {
            // The entry beside a pair's diagonal is of D.
            let to = if pair_of(i) { i - 1 } else { i };
            for j in 0..to {
                y[i] -= a[i][j] * y[j];
            }
        }
        let mut k = 0;
        while k < N {
            if self.paired[k] {
                let (above, beside, below) = (a[k][k], a[k + 1][k], a[k + 1][k + 1]);
                let determinant = above * below - beside * beside;
                let (x, z) = (y[k], y[k + 1]);
                y[k] = (x * below - z * beside) / determinant;
                y[k + 1] = (z * above - x * beside) / determinant;
                k += 2;
            } else {
                y[k] /= a[k][k];
                k += 1;
            }
        }
        for i in (0..N).rev() {
            let from = if self.paired[i] { i + 2 } else { i + 1 };
            for j in from..N {
                y[i] -= a[j][i] * y[j];
            }
        }
        let mut x = [0.0; N];
        self.rows.iter().zip(y).for_each(|(row, y)| x[*row] = y);
        x
    }
}
