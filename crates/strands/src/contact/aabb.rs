//! Boxes about what may touch.

use crate::math::Vec3;

/// A box along the axes, from its least to its greatest corner, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub least: Vec3,
    pub greatest: Vec3,
}

impl Aabb {
    /// About a ball.
    fn of_ball(middle: Vec3, radius: f64) -> Self {
        let around = Vec3::new(radius, radius, radius);
        Self { least: middle - around, greatest: middle + around }
    }

    /// About two balls and all between.
    pub fn of_segment(a: Vec3, b: Vec3, radius: f64) -> Self {
        Self::of_ball(a, radius).with(&Self::of_ball(b, radius))
    }

    /// The least box about both.
    pub fn with(&self, other: &Self) -> Self {
        Self { least: self.least.min(other.least), greatest: self.greatest.max(other.greatest) }
    }

    pub fn middle(&self) -> Vec3 {
        (self.least + self.greatest) * 0.5
    }

    pub fn overlaps(&self, other: &Self) -> bool {
        let before = |a: Vec3, b: Vec3| a.x <= b.x && a.y <= b.y && a.z <= b.z;
        before(self.least, other.greatest) && before(other.least, self.greatest)
    }
}
