//! What the hot kernels ask of a vector of three components, so that one text of them serves single numbers, lanes of numbers, and
//! vectors packed into a register each.

use super::{Real, Vec3};
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector of three components. All implementations do the same operations in the same order, so their results are the same bits.
pub trait Vector:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Mul<Self::Number, Output = Self>
    + Send
    + Sync
    + 'static
{
    /// What a component is.
    type Number: Real;

    /// A vector from its components.
    fn new(x: Self::Number, y: Self::Number, z: Self::Number) -> Self;
    /// The components.
    fn parts(self) -> [Self::Number; 3];
    /// The same vector in every lane.
    fn splat(v: Vec3) -> Self;
    /// The zero vector.
    fn zero() -> Self;
    /// Scalar product.
    fn dot(self, other: Self) -> Self::Number;
    /// Vector product `self × other`.
    fn cross(self, other: Self) -> Self;
    /// Component by component product.
    fn scale(self, other: Self) -> Self;
    /// `|x| + |y| + |z|`.
    fn size(self) -> Self::Number;
    /// `[(x, x, x), (y, y, y), (z, z, z)]`.
    fn spread(self) -> [Self; 3];
    /// `(a·self, b·self, c·self)`.
    fn dots(self, vectors: [Self; 3]) -> Self;
}

impl<R: Real> Vector for Vec3<R> {
    type Number = R;

    #[inline(always)]
    fn new(x: R, y: R, z: R) -> Self {
        Vec3 { x, y, z }
    }
    #[inline(always)]
    fn parts(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }
    #[inline(always)]
    fn splat(v: Vec3) -> Self {
        Vec3 { x: R::splat(v.x), y: R::splat(v.y), z: R::splat(v.z) }
    }
    #[inline(always)]
    fn zero() -> Self {
        Vec3::zero()
    }
    #[inline(always)]
    fn dot(self, other: Self) -> R {
        Vec3::dot(self, other)
    }
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        Vec3::cross(self, other)
    }
    #[inline(always)]
    fn scale(self, other: Self) -> Self {
        Vec3::scale(self, other)
    }
    #[inline(always)]
    fn size(self) -> R {
        self.x.abs() + self.y.abs() + self.z.abs()
    }
    #[inline(always)]
    fn spread(self) -> [Self; 3] {
        [self.x, self.y, self.z].map(|part| Vec3 { x: part, y: part, z: part })
    }
    #[inline(always)]
    fn dots(self, [a, b, c]: [Self; 3]) -> Self {
        Vec3 { x: a.dot(self), y: b.dot(self), z: c.dot(self) }
    }
}
