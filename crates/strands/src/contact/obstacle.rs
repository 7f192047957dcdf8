//! What stands still and is touched.

use crate::math::Vec3;

/// A thing that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape, in the world.
    pub shape: Shape,
    /// The coefficient of friction on it, where it has one of its own.
    pub friction: Option<f64>,
}

/// The shape of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// All behind a plane.
    Plane {
        /// A point on it, m.
        point: Vec3,
        /// The unit normal, away from what is behind.
        normal: Vec3,
    },
    /// All that is no further than a radius from a segment: a capsule, or a ball where its ends are the same.
    Capsule {
        /// The ends of the segment, m.
        ends: [Vec3; 2],
        /// The radius, m.
        radius: f64,
    },
}
