//! Checks of single numbers, with errors at their place.

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::words;
use strands::math::Quat;

/// How far from one the length of a quaternion may be: what four decimals leave.
const UNIT_SLACK: f64 = 1e-3;

impl Document {
    /// A number greater than zero.
    pub fn positive(&self, path: &KeyPath, value: f64) -> Result<f64, SceneError> {
        self.require(path, value, value > 0.0, "must be greater than zero")
    }

    /// A number that is not negative.
    pub fn not_negative(&self, path: &KeyPath, value: f64) -> Result<f64, SceneError> {
        self.require(path, value, value >= 0.0, "must not be negative")
    }

    /// A number that meets a condition.
    pub fn require(&self, path: &KeyPath, value: f64, met: bool, must: &str) -> Result<f64, SceneError> {
        if met { Ok(value) } else { Err(self.refused(path, value, must)) }
    }

    /// The error of a number that cannot be.
    pub fn refused(&self, path: &KeyPath, value: f64, must: &str) -> SceneError {
        let key = path.last_key().unwrap_or("the value");
        let error = self.error(path, format!("{key} {must}, but is {value}"));
        match words::example(key) {
            Some(example) => error.mend(example),
            None => error,
        }
    }

    /// The error of a key that is missing, at the table that lacks it.
    pub fn missing(&self, path: &KeyPath) -> SceneError {
        let key = path.last_key().unwrap_or_default();
        let error = self.error(path, format!("`{key}` is missing"));
        match words::example(key) {
            Some(example) => error.mend(example),
            None => error,
        }
    }

    /// A unit quaternion.
    pub fn quaternion(&self, path: &KeyPath, wxyz: [f64; 4]) -> Result<Quat, SceneError> {
        let norm = wxyz.iter().map(|c| c * c).sum::<f64>().sqrt();
        match Quat::from_wxyz(wxyz) {
            Some(unit) if (norm - 1.0).abs() <= UNIT_SLACK => Ok(unit),
            Some(unit) => {
                let [w, x, y, z] = unit.to_wxyz();
                let error = self.error(
                    path,
                    format!("a quaternion [w, x, y, z] must have length 1, but this one has {norm:.4}"),
                );
                Err(error.mend(format!("if the direction is right, write [{w:.6}, {x:.6}, {y:.6}, {z:.6}]")))
            }
            None => Err(self
                .error(path, format!("a quaternion [w, x, y, z] must have length 1, but this one has {norm}"))
                .mend("no rotation is [1.0, 0.0, 0.0, 0.0]")),
        }
    }
}
