//! Where pieces of two surfaces meet, and how far they may go without passing through each other.

use super::distance::{Ends, Nearest, advance, free_part, free_part_of_gap};
use crate::math::{Mat3, Vec3};

/// What two pieces are, by four points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Two segments: two points each. Either may be a point.
    Segments,
    /// A segment, and one that is met only between its ends.
    Between,
    /// A node (twice), a point of a plane, and where its normal leads from there.
    Plane,
    /// A node (twice), and two points of the axis of a bore, a unit apart.
    Bore,
    /// A node, and the corners of a triangle.
    Face,
}

/// Where they are nearest to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// How much of each point the places that meet have, less than nothing on the second side.
    pub weights: [f64; 4],
    /// From the second to the first.
    pub normal: Vec3,
    /// How far they are apart, m. In a bore that is less than nothing, and so is the radius of its side.
    pub distance: f64,
    /// The places that meet.
    pub places: [Vec3; 2],
    nearest: Option<Nearest>,
}

impl Kind {
    /// So many of the points are of the first side.
    pub fn first_points(self) -> usize {
        if self == Self::Face { 1 } else { 2 }
    }

    /// Where they meet, if they do.
    pub fn meet(self, points: &Ends) -> Option<Meeting> {
        match self {
            Self::Segments | Self::Between => {
                let nearest = Nearest::of(points);
                let [s, t] = nearest.at;
                if self == Self::Between && (t <= 0.0 || t >= 1.0) {
                    return None;
                }
                let distance = nearest.apart.norm();
                let places = [along(points[0], points[1], s), along(points[2], points[3], t)];
                let normal = nearest.apart * (1.0 / distance);
                let weights = nearest.weights();
                Some(Meeting { weights, normal, distance, places, nearest: Some(nearest) })
            }
            Self::Plane => {
                let normal = points[3] - points[2];
                let distance = (points[0] - points[2]).dot(normal);
                let places = [points[0], points[0] - normal * distance];
                Some(Meeting { weights: [1.0, 0.0, -1.0, 0.0], normal, distance, places, nearest: None })
            }
            Self::Bore => {
                let nearest = Nearest::of_point_and_line(points);
                let away = nearest.apart.norm();
                // On the axis it is as far from the wall on every side.
                let normal = if away > 0.0 { nearest.apart * (-1.0 / away) } else { Vec3::ZERO };
                let places = [points[0], along(points[2], points[3], nearest.at[1])];
                let weights = nearest.weights();
                Some(Meeting { weights, normal, distance: -away, places, nearest: Some(nearest) })
            }
            Self::Face => {
                let [node, a, b, c] = *points;
                let [u, v] = foot(points).filter(|[u, v]| *u >= 0.0 && *v >= 0.0 && u + v <= 1.0)?;
                let place = a + (b - a) * u + (c - a) * v;
                let apart = node - place;
                let distance = apart.norm();
                let weights = [1.0, u + v - 1.0, -u, -v];
                let normal = apart * (1.0 / distance);
                Some(Meeting { weights, normal, distance, places: [node, place], nearest: None })
            }
        }
    }

    /// What part of the points' shifts they may take so that they stay further apart than so much. The radius is that of the second side.
    pub fn free_part(self, points: &Ends, shifts: &Ends, apart: f64, radius: f64) -> f64 {
        match self {
            Self::Segments => free_part(points, shifts, apart),
            Self::Between => {
                // What is inside of the cylinder, with round ends.
                let length = (points[3] - points[2]).norm();
                let round = radius.min(0.5 * length);
                let inset = round / length;
                let inner = |of: &Ends| {
                    let (c, d) = (of[2], of[3]);
                    [of[0], of[1], along(c, d, inset), along(d, c, inset)]
                };
                free_part(&inner(points), &inner(shifts), apart + round - radius)
            }
            Self::Plane | Self::Bore => {
                let moved: Ends = core::array::from_fn(|k| points[k] + shifts[k]);
                let gap = |points: &Ends| self.meet(points).map_or(f64::INFINITY, |m| m.distance - apart);
                free_part_of_gap(gap(points), gap(&moved))
            }
            Self::Face => {
                let mean = (shifts[0] + shifts[1] + shifts[2] + shifts[3]) * 0.25;
                let relative = shifts.map(|shift| shift - mean);
                let triangle = relative[1..].iter().map(|shift| shift.norm()).fold(0.0, f64::max);
                advance(points, &relative, relative[0].norm() + triangle, |points| {
                    from_triangle(points) - apart
                })
            }
        }
    }
}

impl Meeting {
    /// How the distance bends as points shift, for each two of them, where it does. As if segments were so far, m, from being beside each other at least.
    pub fn curvature(&self, points: &Ends, beside: f64) -> Option<[[Mat3; 4]; 4]> {
        self.nearest.map(|nearest| nearest.curvature(points, self.normal, self.distance, beside))
    }
}

fn along(from: Vec3, to: Vec3, part: f64) -> Vec3 {
    from + (to - from) * part
}

/// Where the foot of a point on the plane of a triangle is, along its two sides from the first corner.
fn foot([node, a, b, c]: &Ends) -> Option<[f64; 2]> {
    let (one, other, from) = (*b - *a, *c - *a, *node - *a);
    let normal = one.cross(other);
    let square = normal.dot(normal);
    (square > 0.0).then(|| [from.cross(other).dot(normal) / square, one.cross(from).dot(normal) / square])
}

/// How far a point is from a triangle.
pub(super) fn from_triangle(points: &Ends) -> f64 {
    let [node, a, b, c] = *points;
    if let Some(meeting) = Kind::Face.meet(points) {
        return meeting.distance;
    }
    let from_edge = |a: Vec3, b: Vec3| Nearest::of(&[node, node, a, b]).apart.norm();
    from_edge(a, b).min(from_edge(b, c)).min(from_edge(c, a))
}
