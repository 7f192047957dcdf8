//! How the tips of the workloads move.

use super::FRAMES;
use crate::{Setup, Tip};
use core::f64::consts::TAU;
use strands::load::Frame;
use strands::math::{Mat3, Pose, Quat, Vec3, Wrench};
use strands::rod::{Law, Profile};
use strands::statics::Guess;

/// How a tip moves, frame by frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// The held tip goes once about the axis on an uneven circle, and turns to and fro about two axes.
    SuturePose,
    /// The same places, with a turn about the axis only.
    SteelPose,
    /// Force and moment at the free tip turn about three times.
    SteelWrench,
}

impl Motion {
    /// What is given at the tip of a rod of the given length in a frame.
    pub(super) fn tip(self, length: f64, frame: usize) -> Tip {
        let turn = TAU * frame as f64 / FRAMES as f64;
        match self {
            Self::SuturePose => {
                let swing = about(Vec3::Z, 0.5 * turn.sin()) * about(Vec3::X, 0.2 * (2.0 * turn).sin());
                Tip::Pose(Pose { rotation: swing, position: place(length, turn) })
            }
            Self::SteelPose => {
                Tip::Pose(Pose { rotation: about(Vec3::Z, 0.2 * turn.sin()), position: place(length, turn) })
            }
            Self::SteelWrench => {
                let (sin, cos) = (3.0 * turn).sin_cos();
                let force = Vec3::new(1.0 + 0.3 * sin, -0.5 + 0.3 * cos, -0.3);
                let moment = Vec3::new(0.1 * cos, -0.05, 0.08);
                Tip::Wrench { wrench: Wrench::new(moment, force), frame: Frame::World }
            }
        }
    }

    /// A place of the held tip a little short of straight, and a guess of the frame and wrench that the first mode of buckling has there.
    ///
    /// Where the rod is so slack that its weight bends it, half the weight hangs on each end, with the moments of a clamped beam under its
    /// weight; where it is stiff, the wrench is the buckling load's.
    pub(super) fn nearly_straight(self, setup: &Setup) -> Option<(Pose, Guess)> {
        let length = setup.description.length;
        let weight = setup.force_per_length.x * length;
        let bending = bending(setup);
        let (part, moment, thrust) = match self {
            Self::SuturePose => (0.999, weight * length / 12.0, 0.0),
            Self::SteelPose => (0.98, 1.777 * bending / length, 39.5 * bending / (length * length)),
            Self::SteelWrench => return None,
        };
        let pose = Pose { rotation: Mat3::IDENTITY, position: Vec3::Z * (part * length) };
        // The tip's frame is the world's, and both ends carry the same moment.
        let force = Vec3::new(-0.5 * weight, 0.0, -thrust);
        Some((pose, Guess::new(pose, Wrench::new(Vec3::Y * moment, force))))
    }
}

/// The tip's place on its way about the axis.
fn place(length: f64, turn: f64) -> Vec3 {
    let (sin, cos) = turn.sin_cos();
    let radius = 0.15 - 0.05 * cos;
    Vec3::new(radius * sin, -radius * cos, 0.82 - 0.02 * cos) * length
}

fn about(axis: Vec3, angle: f64) -> Mat3 {
    Quat::from_rotation_vector(axis * angle).to_matrix()
}

/// `EI`, N·m².
fn bending(setup: &Setup) -> f64 {
    match &setup.description.profile {
        Profile::Given { law: Law::Diagonal(stiffness), .. } => stiffness.bending[0],
        _ => unreachable!("the workloads' rods are given by their stiffness"),
    }
}
