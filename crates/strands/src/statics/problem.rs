//! A boundary value problem: a rod, what acts on it, and how it is held at its ends and between.

use crate::coupling::Grip;
use crate::load::NodalLoads;
use crate::math::{Mat3, Pose, Vec3};
use crate::rod::{Kinematics, Rod, RodDescription};

/// How a node is held.
///
/// The six freedoms are, in this order: the turns about three axes of the held frame (its `d1` and `d2`, by which the tangent turns, and its
/// `d3`, the twist), and the shifts along three axes of the world (x, y and z). What is not fixed is free, and then sees the loads
/// at that node and the wrench of the grip, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Which freedoms are fixed.
    pub fixed: [bool; 6],
    /// The frame they are fixed to.
    pub pose: Pose,
    /// The axes of the turns, orthonormal, in the held frame.
    pub turn_axes: Mat3,
    /// The axes of the shifts, orthonormal, in the world.
    pub shift_axes: Mat3,
    /// A hand that holds this node through a spring and damper. Not at the rod's start: a problem with one there is refused.
    pub grip: Option<Grip>,
}

impl Support {
    /// Everything fixed: a clamp.
    pub fn clamped(pose: Pose) -> Self {
        Self::of([true; 6], pose)
    }

    /// Nothing fixed. The pose is where a search may start.
    pub fn free(pose: Pose) -> Self {
        Self::of([false; 6], pose)
    }

    /// Only the position fixed: a ball joint.
    pub fn pinned(pose: Pose) -> Self {
        Self::of([false, false, false, true, true, true], pose)
    }

    /// Held by a hand through a virtual coupling.
    pub fn gripped(grip: Grip) -> Self {
        Self { grip: Some(grip), ..Self::free(grip.hand) }
    }

    /// Some freedoms fixed: turns about `d1`, `d2` and `d3`, shifts along x, y and z.
    pub fn of(fixed: [bool; 6], pose: Pose) -> Self {
        Self { fixed, pose, turn_axes: Mat3::IDENTITY, shift_axes: Mat3::IDENTITY, grip: None }
    }

    /// The same, but free to slide along an axis of the world through its place, as a collar on a rail. All positions are then held but along that
    /// axis.
    #[must_use]
    pub fn sliding_along(mut self, axis: Vec3) -> Self {
        self.shift_axes = axes_about(axis);
        self.fixed[3..].copy_from_slice(&[true, true, false]);
        self
    }

    /// The same, but free to turn about an axis of the world, as a hinge. All turns are then held but that one.
    #[must_use]
    pub fn turning_about(mut self, axis: Vec3) -> Self {
        self.turn_axes = axes_about(self.pose.rotation.transpose_mul(axis));
        self.fixed[..3].copy_from_slice(&[true, true, false]);
        self
    }

    /// Whether it fixes the position wholly.
    pub fn holds_position(&self) -> bool {
        self.fixed[3..] == [true; 3]
    }

    /// Whether it fixes or grips anything.
    pub fn holds_anything(&self) -> bool {
        self.fixed.contains(&true) || self.grip.is_some()
    }
}

/// Orthonormal axes of which the third is the one given.
fn axes_about(axis: Vec3) -> Mat3 {
    let third = axis * (1.0 / axis.norm());
    let across = if third.x.abs() < 0.6 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let second = third.cross(across);
    let second = second * (1.0 / second.norm());
    Mat3::from_cols(second.cross(third), second, third)
}

/// A rod, its loads and what holds it.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The rod.
    pub rod: Rod,
    /// What acts on its nodes, the two ends' nodes too.
    pub loads: NodalLoads,
    /// How the start, `s = 0`, is held.
    pub start: Support,
    /// How the end, `s = L`, is held.
    pub end: Support,
    /// How nodes between are held: their numbers, growing, and their supports.
    pub between: Vec<(usize, Support)>,
}

/// A stretch of a rod between two nodes of which the places are held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The node where it begins.
    pub from: usize,
    /// The node where it ends.
    pub to: usize,
    /// From place to place, m.
    pub chord: Vec3,
    /// How long the rod is between, m.
    pub length: f64,
}

impl Stretch {
    /// How much longer the rod is than its ends are apart, over its length; negative where it has to stretch.
    pub fn spare(&self) -> f64 {
        1.0 - self.chord.norm() / self.length
    }
}

impl Problem {
    /// The stretches between places that are held in all three directions, in order.
    pub fn stretches(&self) -> Vec<Stretch> {
        let nodes = self.rod.mesh().nodes();
        let held: Vec<_> = self.supports().filter(|(_, support)| support.holds_position()).collect();
        let stretch = |pair: &[(usize, &Support)]| {
            let ((from, a), (to, b)) = (pair[0], pair[1]);
            Stretch { from, to, chord: b.pose.position - a.pose.position, length: nodes[to] - nodes[from] }
        };
        held.windows(2).map(stretch).collect()
    }

    /// A stretch of a rod that cannot stretch whose ends are further apart than it is long, if there is one.
    pub fn out_of_reach(&self) -> Option<Stretch> {
        let stretches = || self.stretches().into_iter().find(|stretch| stretch.spare() < -1e-12);
        if self.rod.kinematics() == Kinematics::Kirchhoff { stretches() } else { None }
    }

    /// The two ends and the nodes that are held between, in order, and how.
    pub fn supports(&self) -> impl DoubleEndedIterator<Item = (usize, &Support)> {
        let between = self.between.iter().map(|(node, support)| (*node, support));
        [(0, &self.start)].into_iter().chain(between).chain([(self.rod.elements(), &self.end)])
    }

    /// How a node is held; `None` where nothing can hold it.
    pub fn support(&self, node: usize) -> Option<&Support> {
        self.supports().find(|(at, _)| *at == node).map(|(_, support)| support)
    }

    /// The same, to change.
    pub fn support_mut(&mut self, node: usize) -> Option<&mut Support> {
        let last = self.rod.elements();
        let between = self.between.iter_mut().map(|(node, support)| (*node, support));
        let all = [(0, &mut self.start)].into_iter().chain(between).chain([(last, &mut self.end)]);
        all.into_iter().find(|(at, _)| *at == node).map(|(_, support)| support)
    }

    /// The forces that act on the rod, all together, over `EI/L²`.
    pub(crate) fn load_size(&self) -> f64 {
        let forces = self.loads.world.iter().chain(&self.loads.body).map(|load| load.linear.norm());
        let pulls = self.loads.pulls().iter().map(|pull| pull.tension.abs());
        forces.chain(pulls).sum::<f64>() / self.rod.scale().force
    }

    /// Whether all that acts before an end is known along the way from it: not what supports between the ends bear, and in which direction a pull
    /// acts only at its node.
    pub(crate) fn can_be_shot(&self) -> bool {
        self.between.is_empty() && self.loads.pulls().is_empty()
    }

    /// The same on elements of order 2.
    pub(crate) fn of_second_order(&self) -> Self {
        Self { rod: self.rod.clone().of_second_order(), ..self.clone() }
    }

    /// The same of a rod that stretches and shears as its section does, where this one does not.
    pub(crate) fn that_stretches(&self) -> Option<Self> {
        let (rod, description) = (&self.rod, self.rod.description());
        if description.kinematics == Kinematics::Cosserat {
            return None;
        }
        let description = RodDescription { kinematics: Kinematics::Cosserat, ..description.clone() };
        let rod = Rod::new(description, rod.mesh().clone(), rod.order()).ok()?;
        Some(Self { rod, ..self.clone() })
    }

    /// A rod clamped at its base frame, its other end free, nothing acting on it.
    pub fn cantilever(rod: Rod) -> Self {
        let loads = NodalLoads::none(&rod);
        let base = rod.description().base;
        Self { rod, loads, start: Support::clamped(base), end: Support::free(base), between: Vec::new() }
    }
}
