//! The shape that a rod's motion starts from.

use strands::math::{Mat3, Pose, Quat, Strain, Vec3};
use strands::rod::Rod;

/// A line through points, along which a rod lies.
#[derive(Clone, Debug)]
pub(crate) struct Initial {
    points: Vec<Vec3>,
    /// How far along it each point is, m.
    places: Vec<f64>,
    /// The frame at its start, as far as the line does not turn it.
    base: Mat3,
    /// 1/m.
    twist: f64,
}

/// How soon a frame that is beside the line comes back to it, in elements.
const BACK: f64 = 4.0;

impl Initial {
    /// The line through two points or more, each apart from the one before.
    pub fn new(points: Vec<Vec3>, base: Mat3, twist: f64) -> Self {
        let mut places = vec![0.0];
        places.extend(points.windows(2).scan(0.0, |s, pair| {
            *s += (pair[1] - pair[0]).norm();
            Some(*s)
        }));
        Self { points, places, base, twist }
    }

    /// The frames of a rod's nodes. Each element is bent by as much everywhere and keeps its length, so that nothing but bending and twist acts in it: frames
    /// are carried along with the least turn (Bishop 1975) and the twist beside it, their third axes as the line goes about them, and towards it where they
    /// are off.
    pub fn poses(&self, rod: &Rod) -> Vec<Pose> {
        let scale = self.places[self.places.len() - 1] / rod.length();
        let nodes = rod.mesh().nodes();
        let last = nodes.len() - 1;
        let direction = |from: f64, to: f64| {
            let way = self.at(to * scale) - self.at(from * scale);
            way.normalized().unwrap_or(self.base.cols[2])
        };
        let element = |i: usize| direction(nodes[i], nodes[i + 1]);
        let inner = |i: usize| direction(0.5 * (nodes[i - 1] + nodes[i]), 0.5 * (nodes[i] + nodes[i + 1]));
        // About an end the line goes on to bend as it does beside it.
        let along = |i: usize| match i {
            _ if last == 1 => element(0),
            0 => mirrored(inner(1), element(0)),
            _ if i == last => mirrored(inner(last - 1), element(last - 1)),
            _ => inner(i),
        };
        let turned = least_turn(self.base.transpose_mul(along(0)));
        let rotation = self.base * Quat::from_rotation_vector(turned).to_matrix();
        let mut pose = Pose { rotation, position: self.points[0] };
        let mut poses = vec![pose];
        for i in 1..=last {
            let length = rod.element_length(i - 1);
            let off = self.at(nodes[i - 1] * scale) - pose.position;
            let aim = along(i) + off * (1.0 / (BACK * length));
            let aim = aim.normalized().unwrap_or(pose.rotation.cols[2]);
            let angular = turn(pose.rotation.transpose_mul(aim), self.twist * length);
            pose = pose.compose(&Pose::exp(Strain { angular, linear: Vec3::Z * length }));
            poses.push(pose);
        }
        poses
    }

    /// The place on the line so far along it, m.
    fn at(&self, s: f64) -> Vec3 {
        let after = self.places.partition_point(|place| *place < s).clamp(1, self.places.len() - 1);
        let [from, to] = [after - 1, after].map(|k| self.points[k]);
        let [began, ends] = [after - 1, after].map(|k| self.places[k]);
        from + (to - from) * ((s - began) / (ends - began)).clamp(0.0, 1.0)
    }
}

/// A unit direction as it is on the other side of another.
fn mirrored(way: Vec3, about: Vec3) -> Vec3 {
    about * (2.0 * way.dot(about)) - way
}

/// The least rotation vector that takes the third axis to a unit direction.
fn least_turn(to: Vec3) -> Vec3 {
    let axis = Vec3::Z.cross(to);
    let (sine, cosine) = (axis.norm(), to.z);
    match axis.normalized() {
        Some(axis) => axis * sine.atan2(cosine),
        None if cosine < 0.0 => Vec3::X * core::f64::consts::PI,
        None => Vec3::ZERO,
    }
}

/// The rotation vector with a given third component that takes the third axis to a unit direction, by as many turns of the others as it takes.
fn turn(to: Vec3, twist: f64) -> Vec3 {
    let mut turn = Vec3::Z * twist;
    for _ in 0..50 {
        let so_far = Quat::from_rotation_vector(turn).to_matrix();
        let missing = least_turn(so_far.transpose_mul(to));
        let across = so_far * missing;
        turn += Vec3::new(across.x, across.y, 0.0);
        if missing.max_abs() < 1e-15 {
            break;
        }
    }
    turn
}
