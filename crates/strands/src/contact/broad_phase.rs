//! Which of many boxes overlap.

use crate::math::Vec3;

/// A box along the axes, from its least to its greatest corner, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub least: Vec3,
    pub greatest: Vec3,
}

impl Aabb {
    /// About two balls and all between.
    pub fn of_segment(a: Vec3, b: Vec3, radius: f64) -> Self {
        let around = Vec3::new(radius, radius, radius);
        let each = |f: fn(f64, f64) -> f64| Vec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z));
        Self { least: each(f64::min) - around, greatest: each(f64::max) + around }
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

    fn overlaps(&self, other: &Self) -> bool {
        let before = |a: Vec3, b: Vec3| a.x <= b.x && a.y <= b.y && a.z <= b.z;
        before(self.least, other.greatest) && before(other.least, self.greatest)
    }
}

/// All pairs of boxes that overlap, the lesser number first, by a sweep along the axis in which their middles are spread most (Baraff & Witkin 1992).
pub(crate) fn overlapping(boxes: &[Aabb], mut found: impl FnMut(usize, usize)) {
    let middle = |aabb: &Aabb| (aabb.least + aabb.greatest) * (0.5 / boxes.len() as f64);
    let mean = boxes.iter().fold(Vec3::ZERO, |sum, aabb| sum + middle(aabb));
    let spread = boxes.iter().fold(Vec3::ZERO, |sum, aabb| {
        let from = middle(aabb) * boxes.len() as f64 - mean;
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
