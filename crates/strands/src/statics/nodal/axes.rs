//! The axes of a nodal system.

use super::super::march::Record;
use super::super::problem::Problem;
use crate::math::{Mat6, Pose, Vec3, Vec6, Wrench};

/// Fixed axes in which lengths, forces and moments are numbers of order one, and from where places are told, the rod's start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    pub(super) origin: Vec3,
    pub(super) length: f64,
    pub(super) force: f64,
    pub(super) moment: f64,
}

impl Default for Axes {
    fn default() -> Self {
        Self { origin: Vec3::ZERO, length: 1.0, force: 1.0, moment: 1.0 }
    }
}

impl Axes {
    pub(super) fn new(problem: &Problem, record: &Record) -> Self {
        let scale = problem.rod.scale();
        let origin = record.poses[0].position;
        Self { origin, length: scale.length, force: scale.force, moment: scale.moment }
    }

    /// What lengths are over, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    pub(super) fn at(&self, position: Vec3) -> Vec3 {
        (position - self.origin) * (1.0 / self.length)
    }

    pub(super) fn frame(&self, pose: &Pose) -> Pose {
        Pose { rotation: pose.rotation, position: self.at(pose.position) }
    }

    pub(super) fn in_world(&self, pose: &Pose) -> Pose {
        Pose { rotation: pose.rotation, position: self.origin + pose.position * self.length }
    }

    pub(super) fn wrench(&self, wrench: Wrench) -> Wrench {
        Wrench::new(wrench.angular * (1.0 / self.moment), wrench.linear * (1.0 / self.force))
    }

    /// A wrench, in N·m and N again.
    pub(super) fn in_units(&self, wrench: Wrench) -> Wrench {
        Wrench::new(wrench.angular * self.moment, wrench.linear * self.force)
    }

    /// How an element yields, by its diagonal.
    pub(super) fn compliance(&self, diagonal: Vec6) -> Vec6 {
        Vec6::new(diagonal.angular * self.moment, diagonal.linear * (self.force / self.length))
    }

    /// A variation in the axes of a frame, its shift over the length.
    pub(super) fn shift(&self, variation: Vec6) -> Vec6 {
        Vec6::new(variation.angular, variation.linear * (1.0 / self.length))
    }

    /// A stiffness, seen from axes of the same directions about the same place.
    pub(super) fn stiffness(&self, stiffness: &Mat6) -> Mat6 {
        let scales =
            [[1.0 / self.moment, self.length / self.moment], [1.0 / self.force, self.length / self.force]];
        let mut g = *stiffness;
        for (blocks, scales) in g.blocks.iter_mut().zip(scales) {
            for (block, scale) in blocks.iter_mut().zip(scales) {
                *block = block.scaled(scale);
            }
        }
        g
    }
}
