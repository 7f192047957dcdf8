//! The trees that joints make of frames, and how tied frames follow their roots.

use super::{Assembly, AssemblyError, JointKind, Member};
use crate::math::{Mat3, Pose, Vec3};
use crate::statics::Support;
use core::ops::Range;

/// So far may what a joint ties together be apart at rest, in rad and over the length of the longest rod. It is put together.
pub(super) const AT_REST: f64 = 1e-6;

/// A frame that hangs from another by a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    pub kind: JointKind,
    pub joint: usize,
    pub child: usize,
    pub parent: usize,
    /// The joint's frame, as seen from the parent and from the child.
    of_parent: Pose,
    of_child: Pose,
}

/// All ties, a parent's before its children's.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ties {
    pub list: Vec<Tie>,
    /// For each frame the tie by which it hangs from another.
    pub above: Vec<Option<usize>>,
    /// Whether a joint ties the frame at all.
    pub tied: Vec<bool>,
}

impl Ties {
    /// Hangs the frames of an assembly from their roots.
    pub fn new(assembly: &Assembly) -> Result<Self, AssemblyError> {
        let frames = assembly.frames();
        let mut joints = Vec::with_capacity(assembly.joints.len());
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); frames];
        for (joint, of) in assembly.joints.iter().enumerate() {
            let [a, b] = of.between.map(|attachment| {
                let member = attachment.member;
                assembly.frame(member).ok_or(AssemblyError::Missing { joint, member })
            });
            let (a, b) = (a?, b?);
            at[a].push(joint);
            at[b].push(joint);
            joints.push([a, b]);
        }
        let tied: Vec<bool> = at.iter().map(|joints| !joints.is_empty()).collect();
        let mut ties = Self { list: Vec::with_capacity(joints.len()), above: vec![None; frames], tied };
        let is_held =
            |frame: usize| assembly.support(assembly.member(frame)).is_some_and(Support::holds_anything);
        let first_body = assembly.first_body();
        let held = (0..frames).filter(|frame| ties.tied[*frame] && is_held(*frame));
        let roots: Vec<usize> = held.chain(first_body..frames).chain(0..first_body).collect();
        let mut seen = vec![false; frames];
        let mut used = vec![false; joints.len()];
        for root in roots {
            if seen[root] || !ties.tied[root] {
                continue;
            }
            seen[root] = true;
            let mut ends = vec![root];
            while let Some(parent) = ends.pop() {
                for &joint in &at[parent] {
                    if core::mem::replace(&mut used[joint], true) {
                        continue;
                    }
                    let [a, b] = joints[joint];
                    let child = if a == parent { b } else { a };
                    if core::mem::replace(&mut seen[child], true) {
                        return Err(AssemblyError::Ring(joint));
                    }
                    if is_held(child) {
                        return Err(AssemblyError::HeldTwice { joint });
                    }
                    let [first, second] = assembly.joints[joint].between.map(|at| at.frame);
                    let (of_parent, of_child) = if a == parent { (first, second) } else { (second, first) };
                    ties.above[child] = Some(ties.list.len());
                    let kind = assembly.joints[joint].kind;
                    ties.list.push(Tie { kind, joint, child, parent, of_parent, of_child });
                    ends.push(child);
                }
            }
        }
        // A parent's tie is found before it is followed.
        Ok(ties)
    }

    /// Puts together what is tied; refuses where it is apart.
    pub fn put_together(&self, assembly: &Assembly, poses: &mut [Pose]) -> Result<(), AssemblyError> {
        for tie in &self.list {
            let met = tie.met(&poses[tie.parent], &poses[tie.child]);
            let off = poses[tie.child].between(&met).log();
            let (apart, turned) = (off.linear.norm(), off.angular.norm());
            if apart > AT_REST * assembly.size() || turned > AT_REST {
                return Err(AssemblyError::Apart { joint: tie.joint, apart, turned });
            }
            poses[tie.child] = met;
        }
        Ok(())
    }
}

impl Tie {
    /// The child's frame moved so that the joint is kept.
    pub fn met(&self, parent: &Pose, child: &Pose) -> Pose {
        let (held, now) = (self.place(parent), child.compose(&self.of_child));
        let rotation = match self.kind {
            JointKind::Rigid => held.rotation,
            JointKind::Ball => now.rotation,
            JointKind::Hinge => {
                let [x, y, _] = (held.rotation.transpose() * now.rotation).cols;
                let turn = (x.y - y.x).atan2(x.x + y.y);
                held.rotation * turn_about_third(turn)
            }
        };
        Pose { rotation, position: held.position }.compose(&self.of_child.inverse())
    }

    /// Where the joint is, as its parent has it.
    pub fn place(&self, parent: &Pose) -> Pose {
        parent.compose(&self.of_parent)
    }
}

impl JointKind {
    /// The axes of a joint's frame about which it leaves turns free.
    pub(crate) fn free_turns(self) -> Range<usize> {
        match self {
            Self::Rigid => 0..0,
            Self::Ball => 0..3,
            Self::Hinge => 2..3,
        }
    }
}

fn turn_about_third(turn: f64) -> Mat3 {
    let (sin, cos) = turn.sin_cos();
    Mat3::from_cols(Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0), Vec3::Z)
}

/// Rods and bodies that joints tie together, or one rod or body alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cluster {
    pub rods: Vec<usize>,
    pub bodies: Vec<usize>,
}

impl Cluster {
    /// All rods and bodies.
    pub fn of_all(assembly: &Assembly) -> Self {
        Self { rods: (0..assembly.strands.len()).collect(), bodies: (0..assembly.bodies.len()).collect() }
    }
}

impl Assembly {
    /// What moves independently of all else.
    pub(crate) fn clusters(&self, ties: &Ties) -> Vec<Cluster> {
        let rods = self.strands.len();
        let part = |member: Member| match member {
            Member::Node { rod, .. } => rod,
            Member::Body(body) => rods + body,
        };
        // The first of those that a part moves with, by way of others.
        let mut first: Vec<usize> = (0..rods + self.bodies.len()).collect();
        let root = |first: &[usize], mut part: usize| {
            while first[part] != part {
                part = first[part];
            }
            part
        };
        for tie in &ties.list {
            let [a, b] = [tie.child, tie.parent].map(|frame| root(&first, part(self.member(frame))));
            first[a.max(b)] = a.min(b);
        }
        let mut clusters: Vec<Cluster> = vec![Cluster::default(); first.len()];
        for part in 0..first.len() {
            let cluster = &mut clusters[root(&first, part)];
            if part < rods { cluster.rods.push(part) } else { cluster.bodies.push(part - rods) }
        }
        clusters.retain(|cluster| !(cluster.rods.is_empty() && cluster.bodies.is_empty()));
        clusters
    }
}
