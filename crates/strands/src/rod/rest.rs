//! The shape that a rod takes when nothing acts on it, as its rest curvature and twist along `s`.

use super::RodError;
use crate::math::{Mat3, Pose, Quat, Vec3};
use core::f64::consts::TAU;

/// Rest curvature and twist `û(s) = (κ̂1, κ̂2, τ̂)` in the material frame, 1/m.
#[derive(Clone, Debug, PartialEq)]
pub enum RestShape {
    /// The same everywhere; zero for a straight rod.
    Constant(Vec3),
    /// Values at growing `s`, linear between, constant beyond the ends. Two values at the same `s` make a jump.
    Samples(Vec<(f64, Vec3)>),
}

impl Default for RestShape {
    fn default() -> Self {
        Self::Constant(Vec3::ZERO)
    }
}

/// A rest shape that was read off a curve in space.
#[derive(Clone, Debug)]
pub struct RestCurve {
    /// Its curvature and twist.
    pub shape: RestShape,
    /// Its length, m.
    pub length: f64,
    /// The frame of its first point, with `d3` along the curve.
    pub start: Pose,
}

impl RestShape {
    /// A helix of the given radius and pitch (m per turn, negative for a left-handed one): `û = (0, κ, τ)`, so that `d1`
    /// points to its axis.
    ///
    /// # Errors
    /// Where the radius is negative or a number is not finite, or both are zero.
    pub fn helix(radius: f64, pitch: f64) -> Result<Self, RodError> {
        RodError::not_negative("radius", radius)?;
        let rise = pitch / TAU;
        let square = radius * radius + rise * rise;
        if !(square > 0.0 && square.is_finite()) {
            return Err(RodError::OutOfRange {
                quantity: "pitch",
                value: pitch,
                expected: "a finite number, not zero",
            });
        }
        Ok(Self::Constant(Vec3::new(0.0, radius / square, rise / square)))
    }

    /// Values at given places.
    ///
    /// # Errors
    /// Where there is none, one is not finite, or the places do not grow.
    pub fn samples(samples: Vec<(f64, Vec3)>) -> Result<Self, RodError> {
        let shape = Self::Samples(samples);
        shape.validate()?;
        Ok(shape)
    }

    /// Checks that every number is finite, and that samples are there and their places do not fall.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), RodError> {
        let samples = match self {
            Self::Constant(curvature) if curvature.is_finite() => return Ok(()),
            Self::Constant(_) => return Err(RodError::NotFinite { what: "rest curvature", index: 0 }),
            Self::Samples(samples) => samples,
        };
        if samples.is_empty() {
            return Err(RodError::TooFewPoints { what: "rest samples", needed: 1, got: 0 });
        }
        for (i, (s, curvature)) in samples.iter().enumerate() {
            if !(s.is_finite() && curvature.is_finite()) {
                return Err(RodError::NotFinite { what: "rest sample", index: i });
            }
            if i > 0 && *s < samples[i - 1].0 {
                return Err(RodError::NotIncreasing { what: "rest samples", index: i });
            }
        }
        Ok(())
    }

    /// Follows a polyline: curvature from the turn at each vertex over the mean length of its two sides, without twist
    /// (the frame is carried along without turning about the tangent; Bishop 1975). A side has the curve's direction at its middle, so the
    /// frame of the first point lies half a side's bend before the first side. Second order in the spacing.
    ///
    /// # Errors
    /// Where there are fewer than two points, one is not finite, two neighbours coincide, or the line folds back on itself.
    pub fn polyline(points: &[Vec3]) -> Result<RestCurve, RodError> {
        let what = "points";
        if points.len() < 2 {
            return Err(RodError::TooFewPoints { what, needed: 2, got: points.len() });
        }
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            return Err(RodError::NotFinite { what: "point", index });
        }
        let mut sides = Vec::with_capacity(points.len() - 1);
        for (index, pair) in points.windows(2).enumerate() {
            let side = pair[1] - pair[0];
            let tangent = side.normalized().ok_or(RodError::PointsCoincide { index: index + 1 })?;
            sides.push((side.norm(), tangent));
        }
        let first = sides[0].1;
        let mut d1 = first.any_orthonormal();
        let of_first_side = Mat3::from_cols(d1, first.cross(d1), first);
        let mut samples: Vec<(f64, Vec3)> = Vec::with_capacity(points.len());
        let mut s = 0.0;
        for (index, pair) in sides.windows(2).enumerate() {
            let ((before, t0), (after, t1)) = (pair[0], pair[1]);
            s += before;
            let axis = t0.cross(t1);
            let (sine, cosine) = (axis.norm(), t0.dot(t1));
            if cosine < -0.999_999 {
                return Err(RodError::FoldsBack { index: index + 1 });
            }
            let angle = libm::atan2(sine, cosine);
            let turn = if sine > 0.0 { axis * (angle / sine) } else { Vec3::ZERO };
            // The turn is about an axis across both tangents, so its components are the same in both frames.
            let curvature = turn * (2.0 / (before + after));
            samples.push((s, Vec3::new(curvature.dot(d1), curvature.dot(t0.cross(d1)), 0.0)));
            d1 = Quat::from_rotation_vector(turn).to_matrix() * d1;
        }
        // The curvature goes on as it is beyond the first and the last vertex.
        let bend = samples.first().map_or(Vec3::ZERO, |sample| sample.1 * (0.5 * sides[0].0));
        let back = Quat::from_rotation_vector(-bend).to_matrix();
        let start = Pose { rotation: of_first_side * back, position: points[0] };
        let length = s + sides[sides.len() - 1].0;
        let shape = if samples.is_empty() { Self::default() } else { Self::Samples(samples) };
        Ok(RestCurve { shape, length, start })
    }

    /// `û` at `s`; at a jump, the value on the side of `towards`.
    pub fn curvature(&self, s: f64, towards: f64) -> Vec3 {
        match self {
            Self::Constant(curvature) => *curvature,
            Self::Samples(samples) => {
                let after = if towards < s {
                    samples.partition_point(|sample| sample.0 < s)
                } else {
                    samples.partition_point(|sample| sample.0 <= s)
                };
                let (Some(&(s1, u1)), Some(&(s0, u0))) =
                    (samples.get(after), after.checked_sub(1).and_then(|i| samples.get(i)))
                else {
                    return samples[after.min(samples.len() - 1)].1;
                };
                let x = if s1 > s0 { (s - s0) / (s1 - s0) } else { 0.0 };
                u0 + (u1 - u0) * x
            }
        }
    }

    /// Where the curvature jumps or has a kink that the mesh should respect: every jump.
    pub(super) fn jumps(&self) -> Vec<f64> {
        match self {
            Self::Constant(_) => Vec::new(),
            Self::Samples(samples) => {
                samples.windows(2).filter(|p| p[0].0 == p[1].0 && p[0].1 != p[1].1).map(|p| p[0].0).collect()
            }
        }
    }
}
