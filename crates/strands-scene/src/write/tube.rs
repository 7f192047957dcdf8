//! The surface of a rod: its true section, swept along its frames.

use super::Shape;
use std::f64::consts::TAU;
use strands::math::{Pose, Vec3};
use strands::rod::{Profile, Section};

/// Points around a round section.
const SIDES: usize = 24;

/// Triangles with a normal at each vertex, which belongs to a node of the rod.
#[derive(Default)]
pub(super) struct Tube {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub nodes: Vec<usize>,
    pub triangles: Vec<[usize; 3]>,
}

/// A section's outline in its plane, counter-clockwise: along `d1` and `d2`, points (m) with normals, and the sides between them.
struct Outline {
    points: Vec<([f64; 2], [f64; 2])>,
    sides: Vec<[usize; 2]>,
}

impl Tube {
    /// Sweeps a rod, stretch by stretch between the steps of its section.
    pub fn of(shape: &Shape<'_>) -> Self {
        let mut tube = Self::default();
        let mesh = shape.rod.problem.rod.mesh();
        for span in mesh.spans() {
            let middle = 0.5 * (mesh.nodes()[span.start] + mesh.nodes()[span.end]);
            let ring = |node: usize| outline(shape, mesh.nodes()[node], middle);
            let first = tube.positions.len();
            for node in span.start..=span.end {
                tube.ring(&ring(node), &shape.poses[node], node);
            }
            let Outline { points, sides } = ring(span.start);
            for turn in 0..span.len() {
                let (near, far) = (first + turn * points.len(), first + (turn + 1) * points.len());
                for [i, j] in &sides {
                    tube.triangles.push([near + i, near + j, far + j]);
                    tube.triangles.push([near + i, far + j, far + i]);
                }
            }
            for (node, ahead) in [(span.start, false), (span.end, true)] {
                let here = ring(node);
                let beyond = if ahead {
                    mesh.nodes().get(node + 1)
                } else {
                    node.checked_sub(1).map(|i| &mesh.nodes()[i])
                };
                let goes_on = beyond
                    .is_some_and(|beyond| outline(shape, mesh.nodes()[node], *beyond).points == here.points);
                if !goes_on {
                    tube.cap(&here, &shape.poses[node], node, ahead);
                }
            }
        }
        tube
    }

    fn ring(&mut self, outline: &Outline, pose: &Pose, node: usize) {
        for (point, normal) in &outline.points {
            self.vertex(in_world(pose, *point), pose.rotation * Vec3::new(normal[0], normal[1], 0.0), node);
        }
    }

    /// Closes an end, or a step of the section, as a fan about its first point.
    fn cap(&mut self, outline: &Outline, pose: &Pose, node: usize, ahead: bool) {
        let first = self.positions.len();
        let normal = pose.rotation.cols[2] * if ahead { 1.0 } else { -1.0 };
        for (point, _) in &outline.points {
            self.vertex(in_world(pose, *point), normal, node);
        }
        for [i, j] in &outline.sides {
            if *i != 0
                && *j != 0
                && outline.points[*i].0 != outline.points[0].0
                && outline.points[*j].0 != outline.points[0].0
            {
                let (i, j) = if ahead { (*i, *j) } else { (*j, *i) };
                self.triangles.push([first, first + i, first + j]);
            }
        }
    }

    fn vertex(&mut self, position: Vec3, normal: Vec3, node: usize) {
        self.positions.push(position);
        self.normals.push(normal);
        self.nodes.push(node);
    }
}

fn in_world(pose: &Pose, [x, y]: [f64; 2]) -> Vec3 {
    pose.position + pose.rotation * Vec3::new(x, y, 0.0)
}

/// The outline of the section at `s`, on the side of `towards`.
fn outline(shape: &Shape<'_>, s: f64, towards: f64) -> Outline {
    match &shape.rod.problem.rod.description().profile {
        Profile::Given { half_extent, .. } => round(*half_extent),
        Profile::Stations(stations) => {
            let after =
                stations.partition_point(|station| if towards < s { station.s < s } else { station.s <= s });
            let before = &stations[after.saturating_sub(1)];
            let section = match stations.get(after) {
                Some(next) if next.s > before.s && s > before.s => before
                    .section
                    .interpolate(&next.section, (s - before.s) / (next.s - before.s))
                    .unwrap_or(before.section),
                _ => before.section,
            };
            match section {
                Section::Rectangle { .. } => rectangular(section.half_extent()),
                _ => round(section.half_extent()),
            }
        }
    }
}

fn round([a, b]: [f64; 2]) -> Outline {
    let point = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / SIDES as f64).sin_cos();
        let normal = [cos * b, sin * a];
        let size = normal[0].hypot(normal[1]);
        ([a * cos, b * sin], [normal[0] / size, normal[1] / size])
    };
    Outline {
        points: (0..SIDES).map(point).collect(),
        sides: (0..SIDES).map(|i| [i, (i + 1) % SIDES]).collect(),
    }
}

/// Every corner twice, once for each side that meets there.
fn rectangular([a, b]: [f64; 2]) -> Outline {
    let side = |normal: [f64; 2]| {
        let [x, y] = normal;
        let end = |along: f64| [a * (x - along * y), b * (y + along * x)];
        [(end(-1.0), normal), (end(1.0), normal)]
    };
    let points = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].into_iter().flat_map(side).collect();
    Outline { points, sides: (0..4).map(|i| [2 * i, 2 * i + 1]).collect() }
}
