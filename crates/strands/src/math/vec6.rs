//! Pairs of an angular and a linear part: strains `(u, v)`, stresses `(m, n)`, wrenches, and variations of a frame.

use super::{Mat3, Vec3, Vector};
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// An angular and a linear vector, angular part first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Vec6<V = Vec3> {
    /// Curvature and twist `u`, moment `m`, or turn.
    pub angular: V,
    /// Stretch and shear `v`, force `n`, or shift.
    pub linear: V,
}

/// Strain `ε = (u, v)` in the material frame: `u = (κ1, κ2, τ)` in 1/m, `v` dimensionless.
pub type Strain<V = Vec3> = Vec6<V>;
/// Stress `σ = (m, n)` in the material frame, N·m and N: what the part beyond exerts on the part before.
pub type Stress<V = Vec3> = Vec6<V>;
/// A moment and a force, N·m and N.
pub type Wrench<V = Vec3> = Vec6<V>;

impl Vec6 {
    /// All zero.
    pub const ZERO: Self = Self::new(Vec3::ZERO, Vec3::ZERO);

    /// The same in every lane.
    #[inline(always)]
    pub fn splat<V: Vector>(self) -> Vec6<V> {
        Vec6::new(V::splat(self.angular), V::splat(self.linear))
    }

    /// The components, angular first.
    pub const fn to_array(self) -> [f64; 6] {
        [self.angular.x, self.angular.y, self.angular.z, self.linear.x, self.linear.y, self.linear.z]
    }

    /// The largest component in magnitude.
    pub fn max_abs(self) -> f64 {
        self.angular.max_abs().max(self.linear.max_abs())
    }

    /// Whether every component is finite.
    pub fn is_finite(self) -> bool {
        self.angular.is_finite() && self.linear.is_finite()
    }
}

impl From<[f64; 6]> for Vec6 {
    fn from(a: [f64; 6]) -> Self {
        Self::new(Vec3::new(a[0], a[1], a[2]), Vec3::new(a[3], a[4], a[5]))
    }
}

impl<V> Vec6<V> {
    /// A pair from its parts.
    #[inline(always)]
    pub const fn new(angular: V, linear: V) -> Self {
        Self { angular, linear }
    }
}

impl<V: Vector> Vec6<V> {
    /// All zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(V::zero(), V::zero())
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> V::Number {
        self.angular.dot(o.angular) + self.linear.dot(o.linear)
    }

    /// Component by component product.
    #[inline(always)]
    pub fn scale(self, o: Self) -> Self {
        Self::new(self.angular.scale(o.angular), self.linear.scale(o.linear))
    }

    /// Both parts turned, out of the axes of a frame.
    #[inline(always)]
    pub fn turned_by(self, rotation: &Mat3<V>) -> Self {
        Self::new(*rotation * self.angular, *rotation * self.linear)
    }

    /// Both parts turned back, into the axes of a frame.
    #[inline(always)]
    pub fn turned_back_by(self, rotation: &Mat3<V>) -> Self {
        Self::new(rotation.transpose_mul(self.angular), rotation.transpose_mul(self.linear))
    }

    /// A wrench about a place `arm` further on, about here.
    #[inline(always)]
    pub fn wrench_from(self, arm: V) -> Self {
        Self::new(self.angular + arm.cross(self.linear), self.linear)
    }

    /// `ad_self other`, the Lie bracket of se(3).
    #[inline(always)]
    pub fn bracket(self, o: Self) -> Self {
        Self::new(self.angular.cross(o.angular), self.linear.cross(o.angular) + self.angular.cross(o.linear))
    }

    /// `−ad_selfᵀ wrench = (u×m + v×n, u×n)`: how fast a wrench changes in the material frame when it is carried
    /// backwards along the strain `self` (the homogeneous part of the balance equations, (5) of the paper).
    #[inline(always)]
    pub fn coadjoint(self, wrench: Self) -> Self {
        Self::new(
            self.angular.cross(wrench.angular) + self.linear.cross(wrench.linear),
            self.angular.cross(wrench.linear),
        )
    }
}

impl<V: Vector> Add for Vec6<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.angular + o.angular, self.linear + o.linear)
    }
}

impl<V: Vector> Sub for Vec6<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.angular - o.angular, self.linear - o.linear)
    }
}

impl<V: Vector> Mul<V::Number> for Vec6<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: V::Number) -> Self {
        Self::new(self.angular * k, self.linear * k)
    }
}

impl<V: Vector> Neg for Vec6<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.angular, -self.linear)
    }
}

impl<V: Vector> AddAssign for Vec6<V> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<V: Vector> SubAssign for Vec6<V> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}
