//! The scalar that the hot kernels are written in: one number, or several side by side.
//!
//! A kernel generic over [`Real`] runs one rod on `f64`, several rods (or one rod with several perturbed
//! boundary values) on [`Lanes`](super::Lanes), and carries derivatives on the dual numbers of the tests. Every operation is a
//! plain IEEE operation or a polynomial, so all widths give the same bits, lane by lane, on every target.

use super::Kernel;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A scalar of the hot kernels: a number with the field operations and lane-wise selection.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Send
    + Sync
    + 'static
{
    /// What a comparison gives: one truth value a lane.
    type Mask: Copy;

    /// How many numbers stand side by side.
    const LANES: usize = 1;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// One in every lane.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }

    /// Absolute value (of the value part, for a dual number).
    fn abs(self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// Where `self <= bound`, lane by lane. NaN compares false.
    fn at_most(self, bound: f64) -> Self::Mask;

    /// Both masks, lane by lane.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;

    /// Whether every lane is set.
    fn all(mask: Self::Mask) -> bool;

    /// `yes` where the mask is set, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Applies a function of one number with its derivative, lane by lane: `function(x) = (f(x), f'(x))`.
    fn map(self, function: impl Fn(f64) -> (f64, f64)) -> Self;
}

/// Numbers side by side that can be set and read one by one, of rods side by side.
pub(crate) trait Wide: Real {
    /// Sets the number in one lane.
    fn put_number(&mut self, lane: usize, value: f64);

    /// The number in one lane.
    fn number(&self, lane: usize) -> f64;

    /// From the number of each lane.
    #[inline(always)]
    fn from_lanes(mut number: impl FnMut(usize) -> f64) -> Self {
        let mut out = Self::zero();
        for lane in 0..Self::LANES {
            out.put_number(lane, number(lane));
        }
        out
    }
}

/// Numbers that fill a register.
pub(crate) trait Register: Wide {
    /// Runs a kernel with the instructions that these numbers are made for.
    fn run<K: Kernel>(kernel: K) -> K::Output;
}

/// A rod alone, where registers hold no more.
impl Register for f64 {
    #[inline(never)]
    fn run<K: Kernel>(kernel: K) -> K::Output {
        kernel.run()
    }
}

impl Wide for f64 {
    #[inline(always)]
    fn put_number(&mut self, _: usize, value: f64) {
        *self = value;
    }
    #[inline(always)]
    fn number(&self, _: usize) -> f64 {
        *self
    }
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn at_most(self, bound: f64) -> bool {
        self <= bound
    }
    #[inline(always)]
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn all(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        function(self).0
    }
}
