//! Square matrices of three rows.

use super::{Real, Vec3};
use core::ops::{Add, Mul, Sub};

/// A 3×3 matrix, kept by its columns. As an orientation its columns are the directors `d1 d2 d3`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Mat3<R = f64> {
    /// The columns.
    pub cols: [Vec3<R>; 3],
}

impl Mat3<f64> {
    /// The identity.
    pub const IDENTITY: Self = Self::from_cols(Vec3::X, Vec3::Y, Vec3::Z);
    /// The zero matrix.
    pub const ZERO: Self = Self::from_cols(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);

    /// The same matrix in every lane.
    #[inline(always)]
    pub fn splat<R: Real>(self) -> Mat3<R> {
        Mat3 { cols: [self.cols[0].splat(), self.cols[1].splat(), self.cols[2].splat()] }
    }

    /// The largest entry in magnitude.
    pub fn max_abs(self) -> f64 {
        self.cols.iter().fold(0.0, |max, c| max.max(c.max_abs()))
    }

    /// Whether every entry is finite.
    pub fn is_finite(self) -> bool {
        self.cols.iter().all(|c| c.is_finite())
    }
}

impl<R> Mat3<R> {
    /// A matrix from its columns.
    #[inline(always)]
    pub const fn from_cols(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>) -> Self {
        Self { cols: [a, b, c] }
    }
}

impl<R: Real> Mat3<R> {
    /// The diagonal matrix `diag(d)`.
    #[inline(always)]
    pub fn diagonal(d: Vec3<R>) -> Self {
        let o = R::zero();
        Self::from_cols(Vec3::new(d.x, o, o), Vec3::new(o, d.y, o), Vec3::new(o, o, d.z))
    }

    /// The matrix `v^` of the vector product: `v^ a = v × a`.
    #[inline(always)]
    pub fn hat(v: Vec3<R>) -> Self {
        let o = R::zero();
        Self::from_cols(Vec3::new(o, v.z, -v.y), Vec3::new(-v.z, o, v.x), Vec3::new(v.y, -v.x, o))
    }

    /// The matrix `a bᵀ`.
    #[inline(always)]
    pub fn outer(a: Vec3<R>, b: Vec3<R>) -> Self {
        Self::from_cols(a * b.x, a * b.y, a * b.z)
    }

    /// The transpose.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [a, b, c] = self.cols;
        Self::from_cols(Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z))
    }

    /// The product `Mᵀ v`.
    #[inline(always)]
    pub fn transpose_mul(self, v: Vec3<R>) -> Vec3<R> {
        Vec3::new(self.cols[0].dot(v), self.cols[1].dot(v), self.cols[2].dot(v))
    }

    /// The determinant.
    #[inline(always)]
    pub fn determinant(self) -> R {
        let [a, b, c] = self.cols;
        a.dot(b.cross(c))
    }

    /// The inverse by cofactors. Where the determinant is zero the entries are not finite.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let [a, b, c] = self.cols;
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let scale = R::one() / a.dot(bc);
        Self::from_cols(bc * scale, ca * scale, ab * scale).transpose()
    }

    /// Each column times `k`.
    #[inline(always)]
    pub fn scaled(self, k: R) -> Self {
        Self { cols: [self.cols[0] * k, self.cols[1] * k, self.cols[2] * k] }
    }
}

impl<R: Real> Mul<Vec3<R>> for Mat3<R> {
    type Output = Vec3<R>;
    #[inline(always)]
    fn mul(self, v: Vec3<R>) -> Vec3<R> {
        self.cols[0] * v.x + self.cols[1] * v.y + self.cols[2] * v.z
    }
}

impl<R: Real> Mul for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { cols: [self * o.cols[0], self * o.cols[1], self * o.cols[2]] }
    }
}

impl<R: Real> Add for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { cols: [self.cols[0] + o.cols[0], self.cols[1] + o.cols[1], self.cols[2] + o.cols[2]] }
    }
}

impl<R: Real> Sub for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { cols: [self.cols[0] - o.cols[0], self.cols[1] - o.cols[1], self.cols[2] - o.cols[2]] }
    }
}
