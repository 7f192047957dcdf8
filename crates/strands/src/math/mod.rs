//! Small fixed-size algebra: vectors, orientations, poses in SE(3), and the coefficients of their exponential.
//!
//! Ours rather than a library's because one set of formulas serves a single rod, rods side by side in SIMD lanes and the
//! dual numbers of the tests, and because the tangent of the SE(3) exponential and its derivatives are the heart of the rod.

mod lanes;
mod mat3;
mod mat6;
mod pose;
mod quat;
mod real;
mod series;
mod simd;
mod vec3;
mod vec6;

pub use lanes::Lanes;
pub use mat3::Mat3;
pub use mat6::{Lu, Mat6, lu};
pub(crate) use pose::exp_rotation;
pub use pose::{Pose, tangent, tangent_inverse};
pub use quat::Quat;
pub use real::Real;
pub use series::{ExpCoefficients, exp_coefficients, exp_coefficients_second};
pub use simd::SimdLevel;
pub(crate) use simd::{Kernel, dispatch};
pub use vec3::Vec3;
pub use vec6::{Strain, Stress, Vec6, Wrench};

#[cfg(test)]
mod tests;
