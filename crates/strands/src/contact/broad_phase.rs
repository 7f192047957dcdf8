//! Which of many boxes overlap.

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
        let each =
            |f: fn(f64, f64) -> f64, a: Vec3, b: Vec3| Vec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z));
        Self {
            least: each(f64::min, self.least, other.least),
            greatest: each(f64::max, self.greatest, other.greatest),
        }
    }

    fn middle(&self) -> Vec3 {
        (self.least + self.greatest) * 0.5
    }

    fn overlaps(&self, other: &Self) -> bool {
        let before = |a: Vec3, b: Vec3| a.x <= b.x && a.y <= b.y && a.z <= b.z;
        before(self.least, other.greatest) && before(other.least, self.greatest)
    }
}

/// All pairs of boxes that overlap, the lesser number first, by a sweep along the axis in which their middles are spread most (Baraff & Witkin 1992).
pub(crate) fn overlapping(boxes: &[Aabb], mut found: impl FnMut(usize, usize)) {
    let sum = boxes.iter().fold(Vec3::ZERO, |sum, aabb| sum + aabb.middle());
    let mean = sum * (1.0 / boxes.len() as f64);
    let spread = boxes.iter().fold(Vec3::ZERO, |sum, aabb| {
        let from = aabb.middle() - mean;
        sum + from.scale(from)
    });
    let axis = |v: Vec3| match (spread.x >= spread.y && spread.x >= spread.z, spread.y >= spread.z) {
        (true, _) => v.x,
        (false, true) => v.y,
        (false, false) => v.z,
    };
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_unstable_by(|a, b| axis(boxes[*a].least).total_cmp(&axis(boxes[*b].least)));
    let mut open: Vec<usize> = Vec::new();
    for next in order {
        let begin = axis(boxes[next].least);
        open.retain(|other| axis(boxes[*other].greatest) >= begin);
        for &other in open.iter().filter(|other| boxes[**other].overlaps(&boxes[next])) {
            found(other.min(next), other.max(next));
        }
        open.push(next);
    }
}
