//! Square matrices of three rows.

use super::{Quat, Real, Vec3, Vector};
use core::ops::{Add, Mul, Sub};

/// A 3×3 matrix, kept by its columns. As an orientation its columns are the directors `d1 d2 d3`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Mat3<V = Vec3> {
    /// The columns.
    pub cols: [V; 3],
}

impl Mat3 {
    /// The identity.
    pub const IDENTITY: Self = Self::from_cols(Vec3::X, Vec3::Y, Vec3::Z);
    /// The zero matrix.
    pub const ZERO: Self = Self::from_cols(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);

    /// The same matrix in every lane.
    #[inline(always)]
    pub fn splat<V: Vector>(self) -> Mat3<V> {
        let [a, b, c] = self.cols;
        Mat3 { cols: [V::splat(a), V::splat(b), V::splat(c)] }
    }

    /// The largest entry in magnitude.
    pub fn max_abs(self) -> f64 {
        self.cols.iter().fold(0.0, |max, c| max.max(c.max_abs()))
    }

    /// Of a turn, the rotation vector, rad.
    pub fn rotation_vector(self) -> Vec3 {
        Quat::from_matrix(self).to_rotation_vector()
    }

    /// The rotation vector from one orientation to another, in the axes of either, rad.
    pub fn turn_to(&self, other: &Self) -> Vec3 {
        (self.transpose() * *other).rotation_vector()
    }

    /// Whether every entry is finite.
    pub fn is_finite(self) -> bool {
        self.cols.iter().all(|c| c.is_finite())
    }
}

impl<V> Mat3<V> {
    /// A matrix from its columns.
    #[inline(always)]
    pub const fn from_cols(a: V, b: V, c: V) -> Self {
        Self { cols: [a, b, c] }
    }
}

impl<R: Real> Mat3<Vec3<R>> {
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
}

impl<V: Vector> Mat3<V> {
    /// The product `Mᵀ v`.
    #[inline(always)]
    pub fn transpose_mul(self, v: V) -> V {
        v.dots(self.cols)
    }

    /// Each column times `k`.
    #[inline(always)]
    pub fn scaled(self, k: V::Number) -> Self {
        Self { cols: [self.cols[0] * k, self.cols[1] * k, self.cols[2] * k] }
    }
}

impl<V: Vector> Mul<V> for Mat3<V> {
    type Output = V;
    #[inline(always)]
    fn mul(self, v: V) -> V {
        let [x, y, z] = v.spread();
        self.cols[0].scale(x) + self.cols[1].scale(y) + self.cols[2].scale(z)
    }
}

impl<V: Vector> Mul for Mat3<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { cols: [self * o.cols[0], self * o.cols[1], self * o.cols[2]] }
    }
}

impl<V: Vector> Add for Mat3<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { cols: [self.cols[0] + o.cols[0], self.cols[1] + o.cols[1], self.cols[2] + o.cols[2]] }
    }
}

impl<V: Vector> Sub for Mat3<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { cols: [self.cols[0] - o.cols[0], self.cols[1] - o.cols[1], self.cols[2] - o.cols[2]] }
    }
}
