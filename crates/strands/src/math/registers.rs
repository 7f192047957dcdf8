//! Four or eight numbers in one register.
//!
//! What [`Lanes`](super::Lanes) says with arrays, said with instructions: of a kernel as large as the elimination of a rod's nodes the compiler
//! makes something else of the arrays than one instruction an operation, and takes minutes over it.

use super::simd::{Kernel, avx2, avx512};
use super::{Real, Register, SimdLevel, Wide};
use core::arch::x86_64::{
    __m256d, __m512d, _CMP_LE_OQ, _mm256_add_pd, _mm256_and_pd, _mm256_andnot_pd, _mm256_blendv_pd,
    _mm256_cmp_pd, _mm256_div_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_set1_pd, _mm256_sqrt_pd,
    _mm256_sub_pd, _mm256_xor_pd, _mm512_abs_pd, _mm512_add_pd, _mm512_cmp_pd_mask, _mm512_div_pd,
    _mm512_mask_blend_pd, _mm512_mul_pd, _mm512_set1_pd, _mm512_sqrt_pd, _mm512_sub_pd, _mm512_xor_pd,
};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Eight numbers in an AVX-512 register. To be computed with inside a kernel that [`Register::run`] runs: there its functions become single
/// instructions, and elsewhere each is a call.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Eight(__m512d);

/// Four numbers in an AVX register, to be used in the same way.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Four(__m256d);

// SAFETY, for every `unsafe` below: the only danger of these instructions is a machine without them, and rods are put side by side in registers
// only where `SimdLevel::detect` has found them. (The functions cannot be marked as needing them: anyone may call a trait's method.)
// `numbers_in_registers_give_the_bits_of_single_numbers` tests each.
macro_rules! each {
    ($kind:ident, $trait:ident, $method:ident, $instruction:ident) => {
        #[allow(unsafe_code)]
        impl $trait for $kind {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}
each!(Eight, Add, add, _mm512_add_pd);
each!(Eight, Sub, sub, _mm512_sub_pd);
each!(Eight, Mul, mul, _mm512_mul_pd);
each!(Eight, Div, div, _mm512_div_pd);
each!(Four, Add, add, _mm256_add_pd);
each!(Four, Sub, sub, _mm256_sub_pd);
each!(Four, Mul, mul, _mm256_mul_pd);
each!(Four, Div, div, _mm256_div_pd);

macro_rules! both {
    ($kind:ident, $lanes:literal, $level:ident, $run:ident, $set:ident, $xor:ident) => {
        #[allow(unsafe_code)]
        impl Neg for $kind {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(unsafe { $xor(self.0, $set(-0.0)) })
            }
        }

        impl AddAssign for $kind {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl SubAssign for $kind {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }

        #[allow(unsafe_code)]
        impl Wide for $kind {
            #[inline(always)]
            fn put_number(&mut self, lane: usize, value: f64) {
                assert!(lane < $lanes);
                // SAFETY: the register is so many numbers one after the other.
                unsafe { *core::ptr::from_mut(self).cast::<f64>().add(lane) = value }
            }
            #[inline(always)]
            fn number(&self, lane: usize) -> f64 {
                assert!(lane < $lanes);
                // SAFETY: as above.
                unsafe { *core::ptr::from_ref(self).cast::<f64>().add(lane) }
            }
        }

        #[allow(unsafe_code)]
        impl Register for $kind {
            #[inline]
            fn run<K: Kernel>(kernel: K) -> K::Output {
                // Detection is a load from a cache.
                assert!(SimdLevel::detect() >= SimdLevel::$level);
                // SAFETY: it has just been found.
                unsafe { $run(kernel) }
            }
        }
    };
}
both!(Eight, 8, Avx512, avx512, _mm512_set1_pd, _mm512_xor_pd);
both!(Four, 4, Avx2, avx2, _mm256_set1_pd, _mm256_xor_pd);

#[allow(unsafe_code)]
impl Real for Eight {
    type Mask = u8;

    const LANES: usize = 8;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn at_most(self, bound: f64) -> u8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, _mm512_set1_pd(bound)) }
    }
    #[inline(always)]
    fn and(a: u8, b: u8) -> u8 {
        a & b
    }
    #[inline(always)]
    fn all(mask: u8) -> bool {
        mask == u8::MAX
    }
    #[inline(always)]
    fn select(mask: u8, yes: Self, no: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        Self::from_lanes(|lane| function(self.number(lane)).0)
    }
}

#[allow(unsafe_code)]
impl Real for Four {
    type Mask = Self;

    const LANES: usize = 4;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn at_most(self, bound: f64) -> Self {
        Self(unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, _mm256_set1_pd(bound)) })
    }
    #[inline(always)]
    fn and(a: Self, b: Self) -> Self {
        Self(unsafe { _mm256_and_pd(a.0, b.0) })
    }
    #[inline(always)]
    fn all(mask: Self) -> bool {
        unsafe { _mm256_movemask_pd(mask.0) == 0b1111 }
    }
    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        Self(unsafe { _mm256_blendv_pd(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        Self::from_lanes(|lane| function(self.number(lane)).0)
    }
}
