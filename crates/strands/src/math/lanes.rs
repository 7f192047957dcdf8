//! Several numbers side by side, one a SIMD lane.
//!
//! Plain arrays and loops: inside a `#[target_feature]` function the compiler turns each operation into one vector
//! instruction of the widest kind that the feature allows, and elsewhere into as many narrow ones as it takes. The
//! arithmetic is the same in either case, so the results are the same bits.

use super::{Mat3, Pose, Real, Vec3, Vec6, Wide};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `N` numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Default for Lanes<N> {
    fn default() -> Self {
        Self([0.0; N])
    }
}

impl<const N: usize> Lanes<N> {
    /// Builds the lanes from their index.
    #[inline(always)]
    pub fn from_fn(lane: impl FnMut(usize) -> f64) -> Self {
        Self(core::array::from_fn(lane))
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut out = self;
                for i in 0..N {
                    out.0[i] = self.0[i] $op other.0[i];
                }
                out
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = self;
        for i in 0..N {
            out.0[i] = -self.0[i];
        }
        out
    }
}

impl<const N: usize> AddAssign for Lanes<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Lanes<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> Wide for Lanes<N> {
    #[inline(always)]
    fn put_number(&mut self, lane: usize, value: f64) {
        self.0[lane] = value;
    }
    #[inline(always)]
    fn number(&self, lane: usize) -> f64 {
        self.0[lane]
    }
}

impl<const N: usize> Real for Lanes<N> {
    type Mask = [bool; N];

    const LANES: usize = N;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::from_fn(|i| self.0[i].abs())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::from_fn(|i| self.0[i].sqrt())
    }
    #[inline(always)]
    fn at_most(self, bound: f64) -> [bool; N] {
        core::array::from_fn(|i| self.0[i] <= bound)
    }
    #[inline(always)]
    fn and(a: [bool; N], b: [bool; N]) -> [bool; N] {
        core::array::from_fn(|i| a[i] & b[i])
    }
    #[inline(always)]
    fn all(mask: [bool; N]) -> bool {
        mask.iter().fold(true, |all, &lane| all & lane)
    }
    #[inline(always)]
    fn select(mask: [bool; N], yes: Self, no: Self) -> Self {
        Self::from_fn(|i| if mask[i] { yes.0[i] } else { no.0[i] })
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        Self::from_fn(|i| function(self.0[i]).0)
    }
}

#[allow(private_bounds)]
impl<R: Wide> Vec3<R> {
    /// Puts a vector into one lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, i: usize, v: Vec3) {
        self.x.put_number(i, v.x);
        self.y.put_number(i, v.y);
        self.z.put_number(i, v.z);
    }

    /// The vector in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Vec3 {
        Vec3::new(self.x.number(i), self.y.number(i), self.z.number(i))
    }
}

#[allow(private_bounds)]
impl<R: Wide> Vec6<Vec3<R>> {
    /// Puts a pair into one lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, i: usize, v: Vec6) {
        self.angular.put(i, v.angular);
        self.linear.put(i, v.linear);
    }

    /// The pair in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Vec6 {
        Vec6::new(self.angular.lane(i), self.linear.lane(i))
    }
}

#[allow(private_bounds)]
impl<R: Wide> Mat3<Vec3<R>> {
    /// Puts a matrix into one lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, i: usize, m: &Mat3) {
        for k in 0..3 {
            self.cols[k].put(i, m.cols[k]);
        }
    }

    /// The matrix in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Mat3 {
        let [a, b, c] = &self.cols;
        Mat3::from_cols(a.lane(i), b.lane(i), c.lane(i))
    }
}

#[allow(private_bounds)]
impl<R: Wide> Pose<Vec3<R>> {
    /// Puts a pose into one lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, i: usize, pose: &Pose) {
        self.rotation.put(i, &pose.rotation);
        self.position.put(i, pose.position);
    }

    /// The pose in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Pose {
        Pose { rotation: self.rotation.lane(i), position: self.position.lane(i) }
    }
}
