//! The distance between two segments: where it is least, how it changes to second order, and how far segments may go without meeting.

use crate::math::{Mat3, Vec3};

/// Two segments are as good as parallel where the square of the sine between them is less.
const PARALLEL: f64 = 1e-12;

/// The ends of the first segment, then of the second. A segment may be a point.
pub(crate) type Ends = [Vec3; 4];

/// Where two segments are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// Where along each segment, from 0 to 1.
    pub at: [f64; 2],
    /// Whether the place on each would go along it as ends move, and is not at an end of it.
    slides: [bool; 2],
    /// From the place on the second to that on the first.
    pub apart: Vec3,
}

impl Nearest {
    /// Of two segments (Ericson, Real-Time Collision Detection, 2005, § 5.1.9); where they are parallel, in the middle of where they are beside each other.
    pub fn of(ends: &Ends) -> Self {
        let [a, b, c, d] = *ends;
        let (along, other, from) = (b - a, d - c, a - c);
        let (aa, bb, ab) = (along.dot(along), other.dot(other), along.dot(other));
        let (af, bf) = (along.dot(from), other.dot(from));
        let sine = aa * bb - ab * ab;
        let clamped = |x: f64| x.clamp(0.0, 1.0);
        let s = if aa == 0.0 {
            0.0
        } else if bb == 0.0 {
            clamped(-af / aa)
        } else if sine > PARALLEL * aa * bb {
            clamped((ab * bf - bb * af) / sine)
        } else {
            // Between the feet of the other's ends.
            let feet = [clamped(-af / aa), clamped((ab - af) / aa)];
            0.5 * (feet[0] + feet[1])
        };
        let t = if bb == 0.0 { 0.0 } else { (ab * s + bf) / bb };
        let (s, t) = if (0.0..=1.0).contains(&t) || aa == 0.0 {
            (s, clamped(t))
        } else {
            let t = clamped(t);
            (clamped((ab * t - af) / aa), t)
        };
        let inside = |x: f64| x > 0.0 && x < 1.0;
        Self { at: [s, t], slides: [inside(s), inside(t)], apart: from + along * s - other * t }
    }

    /// Of a point (the first two) and an endless line through two places.
    pub fn of_point_and_line(ends: &Ends) -> Self {
        let [point, _, c, d] = *ends;
        let (along, from) = (d - c, point - c);
        let t = from.dot(along) / along.dot(along);
        Self { at: [0.0, t], slides: [false, true], apart: from - along * t }
    }

    /// How much of each end the place on its segment has, less on the second.
    pub fn weights(&self) -> [f64; 4] {
        let [s, t] = self.at;
        [1.0 - s, s, t - 1.0, -t]
    }

    /// How the distance bends as ends shift: for each two ends, along the normal from the second to the first. As if segments were so far, m, from being beside each
    /// other at least.
    pub fn curvature(&self, ends: &Ends, normal: Vec3, distance: f64, beside: f64) -> [[Mat3; 4]; 4] {
        let weights = self.weights();
        let along = [ends[1] - ends[0], ends[2] - ends[3]];
        // With D half of the square of the distance, how its slopes along the segments change with each end.
        let by_place = [[-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]];
        let mixed = |k: usize, of: usize| along[of] * weights[k] + self.apart * by_place[of][k];
        let inverse = self.inverse(along, beside);
        let across = Mat3::IDENTITY - Mat3::outer(normal, normal);
        core::array::from_fn(|k| {
            core::array::from_fn(|l| {
                let mut block = across.scaled(weights[k] * weights[l]);
                for (i, row) in inverse.iter().enumerate() {
                    for (j, entry) in row.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                        block = block - Mat3::outer(mixed(k, i), mixed(l, j)).scaled(*entry);
                    }
                }
                block.scaled(1.0 / distance)
            })
        })
    }

    /// The inverse of how D bends along the segments, where the places slide.
    fn inverse(&self, along: [Vec3; 2], beside: f64) -> [[f64; 2]; 2] {
        let square = |k: usize| along[k].dot(along[k]);
        match self.slides {
            [false, false] => [[0.0; 2]; 2],
            [true, false] => [[1.0 / square(0), 0.0], [0.0; 2]],
            [false, true] => [[0.0; 2], [0.0, 1.0 / square(1)]],
            [true, true] => {
                let (a, b, c) = (square(0), square(1), along[0].dot(along[1]));
                let determinant = (a * b - c * c).max(beside * beside * a.max(b));
                [[b / determinant, -c / determinant], [-c / determinant, a / determinant]]
            }
        }
    }
}

/// How much of the gap between two segments is left at least where they are stopped.
const LEFT: f64 = 0.1;
/// So many advances at most: what slides past something near needs many. It may go on from where it is then.
const ADVANCES: usize = 2000;

/// What part of a way on which a gap changes evenly may be taken.
pub(crate) fn free_part_of_gap(before: f64, after: f64) -> f64 {
    let (nearer, most) = (before - after, (1.0 - LEFT) * before);
    if nearer <= most { 1.0 } else { (most / nearer).max(0.0) }
}

fn mean(shifts: &Ends) -> Vec3 {
    (shifts[0] + shifts[1] + shifts[2] + shifts[3]) * 0.25
}

/// By how much two segments may come nearer to each other at most as their ends shift.
pub(crate) fn fastest(shifts: &Ends) -> f64 {
    let mean = mean(shifts);
    let [a, b, c, d] = shifts.map(|shift| (shift - mean).norm());
    a.max(b) + c.max(d)
}

/// What part of their ends' shifts two segments may take so that their distance stays greater than a thickness: by steps that are sure to be short enough (additive
/// continuous collision detection, Li, Kaufman & Jiang 2021).
pub(crate) fn free_part(ends: &Ends, shifts: &Ends, thickness: f64) -> f64 {
    let fastest = fastest(shifts);
    let mean = mean(shifts);
    let relative = shifts.map(|shift| shift - mean);
    advance(ends, &relative, fastest, |ends| Nearest::of(ends).apart.norm() - thickness)
}

/// What part of points' shifts may be taken so that a gap between them, which closes by no more than `fastest` on the whole way, stays open.
pub(crate) fn advance(points: &Ends, shifts: &Ends, fastest: f64, gap: impl Fn(&Ends) -> f64) -> f64 {
    let gap_at = |part: f64| {
        let mut moved = *points;
        moved.iter_mut().zip(shifts).for_each(|(end, shift)| *end += *shift * part);
        gap(&moved)
    };
    let gap = gap_at(0.0);
    if fastest <= (1.0 - LEFT) * gap {
        return 1.0;
    }
    if gap <= 0.0 {
        return 0.0;
    }
    let (mut part, mut left) = (0.0, gap);
    for _ in 0..ADVANCES {
        part += (1.0 - LEFT) * left / fastest;
        if part >= 1.0 {
            return 1.0;
        }
        left = gap_at(part);
        if left < LEFT * gap {
            break;
        }
    }
    // A last advance may have gone as far as the gap that was left allowed: never through.
    part
}
