//! Small fixed-size algebra: vectors, orientations, poses in SE(3), and the coefficients of their exponential.
//!
//! Ours rather than a library's because one set of formulas serves a single rod with a vector to a register and rods side by side in SIMD
//! lanes, and because the tangent of the SE(3) exponential and its derivatives are the heart of the rod.

mod lanes;
mod ldl;
mod mat3;
mod mat6;
#[cfg(target_arch = "x86_64")]
mod packed;
mod pose;
mod quat;
mod real;
#[cfg(target_arch = "x86_64")]
mod registers;
mod series;
mod simd;
mod vec3;
mod vec6;
mod vector;

pub use lanes::Lanes;
pub(crate) use ldl::{Ldl, ldl};
pub use mat3::Mat3;
pub use mat6::{Lu, Mat6, lu};
#[cfg(target_arch = "x86_64")]
pub(crate) use packed::Packed;
pub use pose::{Pose, tangent, tangent_inverse};
pub(crate) use pose::{logs, so3_tangent, so3_tangent_inverse, turns};
pub use quat::Quat;
pub use real::Real;
pub(crate) use real::{Register, Wide};
#[cfg(target_arch = "x86_64")]
pub(crate) use registers::{Eight, Four};
pub use series::{ExpCoefficients, exp_coefficients, exp_coefficients_second};
pub use simd::SimdLevel;
#[cfg(target_arch = "x86_64")]
pub(crate) use simd::with_avx2;
pub(crate) use simd::{Kernel, dispatch};
pub use vec3::Vec3;
pub use vec6::{Strain, Stress, Vec6, Wrench};
pub use vector::Vector;

/// The larger of two numbers, lane by lane; NaN where either is, which [`f64::max`] would pass over.
#[inline(always)]
pub(crate) fn larger<R: Real>(a: R, b: R) -> R {
    let larger = R::select((b - a).at_most(0.0), a, b);
    R::select(a.at_most(f64::INFINITY), larger, a)
}

/// The largest magnitude; NaN where any is.
#[inline(always)]
pub(crate) fn largest<R: Real>(values: &[R; 6]) -> R {
    let mut most = R::zero();
    for value in values {
        most = larger(most, value.abs());
    }
    most
}

#[cfg(test)]
mod tests;
