//! What a rod is made of.

use super::RodError;

/// An isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus `E`, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus `G`, Pa.
    pub shear_modulus: f64,
    /// Density `ρ`, kg/m³.
    pub density: f64,
}

impl Material {
    /// From Young's modulus (Pa), Poisson's ratio and density (kg/m³); `G = E / (2 (1 + ν))`.
    ///
    /// # Errors
    /// Where `E ≤ 0`, `ν ∉ (−1, ½]`, `ρ < 0`, or a number is not finite.
    pub fn from_poisson(youngs_modulus: f64, poisson_ratio: f64, density: f64) -> Result<Self, RodError> {
        if !(poisson_ratio > -1.0 && poisson_ratio <= 0.5) {
            return Err(RodError::OutOfRange {
                quantity: "poisson_ratio",
                value: poisson_ratio,
                expected: "more than -1 and at most 0.5",
            });
        }
        Self::new(youngs_modulus, youngs_modulus / (2.0 * (1.0 + poisson_ratio)), density)
    }

    /// From Young's and the shear modulus (Pa) and density (kg/m³).
    ///
    /// # Errors
    /// Where a modulus is not positive, the density is negative, or a number is not finite.
    pub fn new(youngs_modulus: f64, shear_modulus: f64, density: f64) -> Result<Self, RodError> {
        let material = Self { youngs_modulus, shear_modulus, density };
        material.validate()?;
        Ok(material)
    }

    /// Checks that the moduli are positive, the density is not negative, and all are finite.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), RodError> {
        RodError::positive("youngs_modulus", self.youngs_modulus)?;
        RodError::positive("shear_modulus", self.shear_modulus)?;
        RodError::not_negative("density", self.density)
    }

    /// Poisson's ratio `ν = E/(2G) − 1`.
    pub fn poisson_ratio(&self) -> f64 {
        self.youngs_modulus / (2.0 * self.shear_modulus) - 1.0
    }
}
