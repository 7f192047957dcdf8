//! A vector of three in one register of four numbers.
//!
//! One rod alone leaves vector instructions idle: its elements follow from one another. But a component of most of what they compute
//! looks like the next, so three of four lanes can be kept busy. A cross product is six instructions in place of nine, a product with a number
//! one in place of three.

use super::{Vec3, Vector};
use core::arch::x86_64::{
    __m256d, _mm_add_pd, _mm_add_sd, _mm_cvtsd_f64, _mm_unpackhi_pd, _mm256_add_pd, _mm256_andnot_pd,
    _mm256_castpd128_pd256, _mm256_castpd256_pd128, _mm256_extractf128_pd, _mm256_insertf128_pd,
    _mm256_mul_pd, _mm256_permute4x64_pd, _mm256_set1_pd, _mm256_setr_pd, _mm256_sub_pd, _mm256_unpackhi_pd,
    _mm256_unpacklo_pd, _mm256_xor_pd,
};
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector of three numbers in an AVX register; the fourth is never read. To be used inside a kernel that
/// [`with_avx2`](super::with_avx2) runs, and nowhere else: there its functions become single instructions.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Packed(__m256d);

// SAFETY, for every `unsafe` below: the only danger of these instructions is a machine without AVX2, and packed vectors are made only
// inside kernels that `with_avx2` runs. (The functions cannot be marked as needing it: anyone may call a trait's method.)
// `packed_vectors_give_the_bits_of_single_numbers` tests each.
macro_rules! each {
    ($trait:ident, $method:ident, $instruction:ident) => {
        #[allow(unsafe_code)]
        impl $trait for Packed {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}
each!(Add, add, _mm256_add_pd);
each!(Sub, sub, _mm256_sub_pd);

#[allow(unsafe_code)]
impl Mul<f64> for Packed {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        Self(unsafe { _mm256_mul_pd(self.0, _mm256_set1_pd(k)) })
    }
}

#[allow(unsafe_code)]
impl Neg for Packed {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

impl AddAssign for Packed {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Packed {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[allow(unsafe_code)]
impl Packed {
    /// `(y, z, x)`.
    #[inline(always)]
    fn turned(self) -> Self {
        Self(unsafe { _mm256_permute4x64_pd::<0b11_00_10_01>(self.0) })
    }

    /// `(x + y) + z`.
    #[inline(always)]
    fn sum(self) -> f64 {
        unsafe {
            let low = _mm256_castpd256_pd128(self.0);
            let z = _mm256_extractf128_pd::<1>(self.0);
            _mm_cvtsd_f64(_mm_add_sd(_mm_add_sd(low, _mm_unpackhi_pd(low, low)), z))
        }
    }
}

#[allow(unsafe_code)]
impl Vector for Packed {
    type Number = f64;

    #[inline(always)]
    fn new(x: f64, y: f64, z: f64) -> Self {
        Self(unsafe { _mm256_setr_pd(x, y, z, 0.0) })
    }
    #[inline(always)]
    fn parts(self) -> [f64; 3] {
        unsafe {
            let low = _mm256_castpd256_pd128(self.0);
            let z = _mm256_extractf128_pd::<1>(self.0);
            [_mm_cvtsd_f64(low), _mm_cvtsd_f64(_mm_unpackhi_pd(low, low)), _mm_cvtsd_f64(z)]
        }
    }
    #[inline(always)]
    fn splat(v: Vec3) -> Self {
        Self::new(v.x, v.y, v.z)
    }
    #[inline(always)]
    fn zero() -> Self {
        Self(unsafe { _mm256_set1_pd(0.0) })
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        self.scale(other).sum()
    }
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        (self.scale(other.turned()) - self.turned().scale(other)).turned()
    }
    #[inline(always)]
    fn scale(self, other: Self) -> Self {
        Self(unsafe { _mm256_mul_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn size(self) -> f64 {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) }).sum()
    }
    #[inline(always)]
    fn spread(self) -> [Self; 3] {
        unsafe {
            [
                Self(_mm256_permute4x64_pd::<0b00_00_00_00>(self.0)),
                Self(_mm256_permute4x64_pd::<0b01_01_01_01>(self.0)),
                Self(_mm256_permute4x64_pd::<0b10_10_10_10>(self.0)),
            ]
        }
    }
    #[inline(always)]
    fn dots(self, [a, b, c]: [Self; 3]) -> Self {
        let (a, b, c) = (a.scale(self), b.scale(self), c.scale(self));
        unsafe {
            // Sums `(x + y) + z` of the first two side by side.
            let xy = _mm256_add_pd(_mm256_unpacklo_pd(a.0, b.0), _mm256_unpackhi_pd(a.0, b.0));
            let z = _mm256_extractf128_pd::<1>(_mm256_unpacklo_pd(a.0, b.0));
            let both = _mm_add_pd(_mm256_castpd256_pd128(xy), z);
            let third = _mm256_castpd256_pd128(_mm256_set1_pd(c.sum()));
            Self(_mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(both), third))
        }
    }
}
