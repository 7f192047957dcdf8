//! How stress follows from strain.

use super::{Kinematics, RodError};
use crate::element::free_strains;
use crate::math::{Mat6, Strain, Stress, Vec3, Vec6};
use std::fmt::Debug;
use std::sync::Arc;

/// The stiffnesses of a section, when its law is diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Bending stiffness about `d1` and `d2`, `EI1` and `EI2`, N·m².
    pub bending: [f64; 2],
    /// Torsional stiffness `GJ`, N·m².
    pub torsion: f64,
    /// Axial stiffness `EA`, N.
    pub axial: f64,
    /// Shear stiffness along `d1` and `d2`, `k1·GA` and `k2·GA`, N.
    pub shear: [f64; 2],
}

impl Stiffness {
    /// `diag(EI1, EI2, GJ, k1·GA, k2·GA, EA)`.
    pub const fn to_diagonal(&self) -> Vec6 {
        Vec6::new(
            Vec3::new(self.bending[0], self.bending[1], self.torsion),
            Vec3::new(self.shear[0], self.shear[1], self.axial),
        )
    }

    /// Checks that each is positive and finite.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), RodError> {
        RodError::positive("bending", self.bending[0])?;
        RodError::positive("bending", self.bending[1])?;
        RodError::positive("torsion", self.torsion)?;
        RodError::positive("axial", self.axial)?;
        RodError::positive("shear", self.shear[0])?;
        RodError::positive("shear", self.shear[1])
    }
}

/// A stored energy per unit rest length, `W(e)`, of the elastic strain `e = ε − ε̂`, J/m.
///
/// Supply one to model what no stiffness matrix does: a tendon that stiffens, a rope that locks. `stress` must be the
/// gradient of `energy` and `tangent` the Hessian; [`check_derivatives`](StoredEnergy::check_derivatives) measures both.
pub trait StoredEnergy: Debug + Send + Sync {
    /// `W(e)`, J/m.
    fn energy(&self, elastic_strain: Strain) -> f64;
    /// `σ = ∂W/∂e`.
    fn stress(&self, elastic_strain: Strain) -> Stress;
    /// `∂²W/∂e²`, symmetric; positive definite wherever a solution is sought.
    fn tangent(&self, elastic_strain: Strain) -> Mat6;

    /// The largest relative difference of `stress` and `tangent` from central differences of what they derive from, about `at`.
    fn check_derivatives(&self, at: Strain) -> f64 {
        let (stress, tangent) = (self.stress(at).to_array(), self.tangent(at).to_rows());
        let scale = |a: &[f64; 6]| a.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        let mut worst = 0.0_f64;
        for i in 0..6 {
            let part = if i < 3 { at.angular } else { at.linear };
            let step = 1e-4 * at.to_array()[i].abs().max(0.1 * part.max_abs()).max(1e-9);
            let shifted = |sign: f64| {
                let mut e = at.to_array();
                e[i] += sign * step;
                Strain::from(e)
            };
            let slope = (self.energy(shifted(1.0)) - self.energy(shifted(-1.0))) / (2.0 * step);
            worst = worst.max((slope - stress[i]).abs() / scale(&stress));
            let change = (self.stress(shifted(1.0)) - self.stress(shifted(-1.0))) * (0.5 / step);
            for (j, slope) in change.to_array().iter().enumerate() {
                worst = worst.max((slope - tangent[j][i]).abs() / scale(&tangent[j]));
            }
        }
        worst
    }
}

/// A constitutive law `σ(ε − ε̂)`.
#[derive(Clone, Debug)]
pub enum Law {
    /// `σ = C (ε − ε̂)` with a diagonal `C`.
    Diagonal(Stiffness),
    /// `σ = C (ε − ε̂)` with a symmetric positive definite 6×6 `C`, angular part first.
    Full(Box<Mat6>),
    /// The gradient of a stored energy.
    Hyperelastic(Arc<dyn StoredEnergy>),
}

impl Law {
    /// A full law from its matrix.
    ///
    /// # Errors
    /// Where the matrix is not finite, not symmetric to 1e-12 of its diagonal, or not positive definite.
    pub fn full(stiffness: [[f64; 6]; 6]) -> Result<Self, RodError> {
        for i in 0..6 {
            for j in 0..6 {
                let scale = (stiffness[i][i] * stiffness[j][j]).abs().sqrt();
                let off = (stiffness[i][j] - stiffness[j][i]).abs();
                if off.is_nan() || off > 1e-12 * scale {
                    return Err(RodError::NotSymmetric { row: i, column: j });
                }
            }
        }
        positive_definite(stiffness, 6)?;
        Ok(Self::Full(Box::new(Mat6::from_rows(&stiffness))))
    }

    /// Checks that stress grows with strain: of a stored energy, at rest and for the strains that are free.
    ///
    /// # Errors
    /// Where a stiffness is not positive and finite, or a matrix not symmetric and positive definite.
    pub fn validate(&self, kinematics: Kinematics) -> Result<(), RodError> {
        match self {
            Self::Diagonal(stiffness) => stiffness.validate(),
            Self::Full(matrix) => Self::full(matrix.to_rows()).map(|_| ()),
            Self::Hyperelastic(energy) => {
                positive_definite(energy.tangent(Strain::ZERO).to_rows(), free_strains(kinematics))
            }
        }
    }

    /// Stored energy per unit rest length of an elastic strain, J/m.
    pub fn energy(&self, e: Strain) -> f64 {
        match self {
            Self::Hyperelastic(energy) => energy.energy(e),
            _ => 0.5 * self.stress(e).dot(e),
        }
    }

    /// Stress of an elastic strain.
    pub fn stress(&self, e: Strain) -> Stress {
        match self {
            Self::Diagonal(stiffness) => stiffness.to_diagonal().scale(e),
            Self::Full(c) => c.mul_vec(e),
            Self::Hyperelastic(energy) => energy.stress(e),
        }
    }

    /// Tangent stiffness at an elastic strain.
    pub fn tangent(&self, e: Strain) -> Mat6 {
        match self {
            Self::Diagonal(stiffness) => Mat6::diagonal(stiffness.to_diagonal()),
            Self::Full(c) => **c,
            Self::Hyperelastic(energy) => energy.tangent(e),
        }
    }
}

/// Checks the first `size` rows and columns of a symmetric matrix, by the pivots of its Cholesky factorisation.
fn positive_definite(mut a: [[f64; 6]; 6], size: usize) -> Result<(), RodError> {
    for k in 0..size {
        if !(a[k][k] > 0.0 && a[k][k].is_finite()) {
            return Err(RodError::NotPositiveDefinite { row: k });
        }
        for i in k + 1..size {
            let factor = a[i][k] / a[k][k];
            for j in k..size {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    Ok(())
}

/// A rod that stiffens as it deforms: `W = ½ Σ Cᵢ eᵢ² (1 + ½ (eᵢ/aᵢ)²)`, so that at `eᵢ = aᵢ` the secant stiffness has
/// doubled. The shipped example of a [`StoredEnergy`].
#[derive(Clone, Copy, Debug)]
pub struct StiffeningEnergy {
    /// The stiffnesses at small strain.
    pub stiffness: Stiffness,
    /// The elastic strains `a` at which the secant stiffness has doubled; 1/m for the first three.
    pub doubling_strain: Strain,
}

impl StoredEnergy for StiffeningEnergy {
    fn energy(&self, e: Strain) -> f64 {
        self.each(e, |c, e, a| 0.5 * c * e * e * (1.0 + 0.5 * (e / a).powi(2))).iter().sum()
    }

    fn stress(&self, e: Strain) -> Stress {
        self.each(e, |c, e, a| c * e * (1.0 + (e / a).powi(2))).into()
    }

    fn tangent(&self, e: Strain) -> Mat6 {
        Mat6::diagonal(self.each(e, |c, e, a| c * (1.0 + 3.0 * (e / a).powi(2))).into())
    }
}

impl StiffeningEnergy {
    fn each(&self, e: Strain, f: impl Fn(f64, f64, f64) -> f64) -> [f64; 6] {
        let (c, e, a) =
            (self.stiffness.to_diagonal().to_array(), e.to_array(), self.doubling_strain.to_array());
        core::array::from_fn(|i| f(c[i], e[i], a[i]))
    }
}
