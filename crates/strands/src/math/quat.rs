//! Unit quaternions `[w, x, y, z]`: an orientation as files and people write it.

use super::{Mat3, Vec3};

/// A unit quaternion, active rotation from the body to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quat {
    /// Scalar part.
    pub w: f64,
    /// First component of the vector part.
    pub x: f64,
    /// Second component of the vector part.
    pub y: f64,
    /// Third component of the vector part.
    pub z: f64,
}

impl Quat {
    /// No rotation.
    pub const IDENTITY: Self = Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 };

    /// The unit quaternion along `[w, x, y, z]`, or `None` where that has no length or is not finite.
    pub fn from_wxyz([w, x, y, z]: [f64; 4]) -> Option<Self> {
        let norm = (w * w + x * x + y * y + z * z).sqrt();
        (norm > 0.0 && norm.is_finite()).then(|| Self { w: w / norm, x: x / norm, y: y / norm, z: z / norm })
    }

    /// The rotation by the vector `φ` (axis times angle, rad).
    pub fn from_rotation_vector(phi: Vec3) -> Self {
        let half = 0.5 * phi.norm();
        let scale = if half < 1e-4 { 0.5 * (1.0 - half * half / 6.0) } else { 0.5 * libm::sin(half) / half };
        Self { w: libm::cos(half), x: phi.x * scale, y: phi.y * scale, z: phi.z * scale }
    }

    /// The rotation vector of length at most π. Accurate to round-off at every angle, since it divides by the vector part
    /// only where that is not small.
    pub fn to_rotation_vector(self) -> Vec3 {
        let sign = if self.w < 0.0 { -1.0 } else { 1.0 };
        let (w, v) = (sign * self.w, Vec3::new(self.x, self.y, self.z) * sign);
        let sine = v.norm();
        // atan2(s, w)/s → (1/w)(1 − s²/(3w²)) as s → 0.
        let scale = if sine < 1e-4 {
            2.0 / w * (1.0 - sine * sine / (3.0 * w * w))
        } else {
            2.0 * libm::atan2(sine, w) / sine
        };
        v * scale
    }

    /// The orientation matrix, its columns the directors.
    pub fn to_matrix(self) -> Mat3 {
        let Self { w, x, y, z } = self;
        Mat3::from_cols(
            Vec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            Vec3::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
            Vec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
        )
    }

    /// The quaternion of an orientation matrix, by the largest of the four (Shepperd 1978), so that no half turn is special.
    pub fn from_matrix(r: Mat3) -> Self {
        let (a, b, c) = (r.cols[0], r.cols[1], r.cols[2]);
        let four =
            [1.0 + a.x + b.y + c.z, 1.0 + a.x - b.y - c.z, 1.0 - a.x + b.y - c.z, 1.0 - a.x - b.y + c.z];
        let largest = (0..4).fold(0, |best, i| if four[i] > four[best] { i } else { best });
        let q = match largest {
            0 => [four[0], b.z - c.y, c.x - a.z, a.y - b.x],
            1 => [b.z - c.y, four[1], a.y + b.x, c.x + a.z],
            2 => [c.x - a.z, a.y + b.x, four[2], b.z + c.y],
            _ => [a.y - b.x, c.x + a.z, b.z + c.y, four[3]],
        };
        Self::from_wxyz(q).unwrap_or(Self::IDENTITY)
    }

    /// The product: first `other`, then `self`.
    pub fn compose(self, o: Self) -> Self {
        Self {
            w: self.w * o.w - self.x * o.x - self.y * o.y - self.z * o.z,
            x: self.w * o.x + self.x * o.w + self.y * o.z - self.z * o.y,
            y: self.w * o.y - self.x * o.z + self.y * o.w + self.z * o.x,
            z: self.w * o.z + self.x * o.y - self.y * o.x + self.z * o.w,
        }
    }

    /// The components `[w, x, y, z]`.
    pub const fn to_wxyz(self) -> [f64; 4] {
        [self.w, self.x, self.y, self.z]
    }
}
