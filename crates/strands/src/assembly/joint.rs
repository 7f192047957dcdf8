//! Joints: what ties one frame to another.

use super::{Assembly, AssemblyError, Member};
use crate::math::{Mat3, Pose, Vec3};

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Nothing.
    Rigid,
    /// All turns.
    Ball,
    /// The turn about one axis.
    Hinge,
}

/// A place on a frame where a joint is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// The frame.
    pub member: Member,
    /// The joint's own frame as seen from it: rigid joints keep the joint's two frames together, ball joints their origins, hinges their origins and
    /// third axes.
    pub frame: Pose,
}

/// A joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// What it leaves free.
    pub kind: JointKind,
    /// What it ties together.
    pub between: [Attachment; 2],
}

impl Joint {
    /// A joint of two frames as they are at rest.
    ///
    /// It is at the node that it ties, or at the first of the two; between two bodies at a `place` of the world that has to be given. An `axis` of the
    /// world is what a hinge turns about.
    ///
    /// # Errors
    /// Where there is no such frame, or two nodes are apart: the number in the error is that of the next joint of the assembly.
    pub fn at_rest(
        assembly: &Assembly,
        kind: JointKind,
        members: [Member; 2],
        place: Option<Vec3>,
        axis: Vec3,
    ) -> Result<Self, AssemblyError> {
        Self::in_shape(assembly, &assembly.rest_poses(), kind, members, place, axis)
    }

    /// The same of two frames as they are where all frames are these.
    ///
    /// # Errors
    /// As [`at_rest`](Joint::at_rest).
    pub fn in_shape(
        assembly: &Assembly,
        shape: &[Pose],
        kind: JointKind,
        members: [Member; 2],
        place: Option<Vec3>,
        axis: Vec3,
    ) -> Result<Self, AssemblyError> {
        let joint = assembly.joints.len();
        let mut poses = [Pose::IDENTITY; 2];
        for (pose, member) in poses.iter_mut().zip(members) {
            *pose = shape[assembly.frame(member).ok_or(AssemblyError::Missing { joint, member })?];
        }
        let is_node = |member: &Member| matches!(member, Member::Node { .. });
        let node = members.iter().position(is_node).unwrap_or(0);
        let rotation = match axis.normalized() {
            Some(third) => {
                let first = third.any_orthonormal();
                Mat3::from_cols(first, third.cross(first), third)
            }
            None => Mat3::IDENTITY,
        };
        let here = Pose { rotation, position: place.unwrap_or(poses[node].position) };
        if members.iter().all(is_node) {
            let apart = (poses[0].position - poses[1].position).norm();
            if apart > super::ties::AT_REST * assembly.size() {
                return Err(AssemblyError::Apart { joint, apart, turned: 0.0 });
            }
        }
        let attach = |i: usize| Attachment { member: members[i], frame: poses[i].between(&here) };
        Ok(Self { kind, between: [attach(0), attach(1)] })
    }
}

impl Assembly {
    /// The length of its longest rod, m.
    pub fn size(&self) -> f64 {
        self.strands.iter().map(|strand| strand.problem.rod.length()).fold(0.0, f64::max)
    }
}
