//! A two-point boundary value problem: a rod, what acts on it, and how its two ends are held.

use crate::coupling::Grip;
use crate::load::NodalLoads;
use crate::math::Pose;
use crate::rod::Rod;

/// How one end is held.
///
/// The six freedoms are, in this order: the turns about the held frame's `d1` and `d2` (the tangent's direction), the turn
/// about its `d3` (twist), and the shifts along the world's x, y and z. What is not fixed is free, and then sees the loads
/// at that end and the wrench of the grip, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// Which freedoms are fixed.
    pub fixed: [bool; 6],
    /// The frame they are fixed to.
    pub pose: Pose,
    /// A hand that holds this end through a spring and damper. At the rod's end only: a problem with one at its start is refused.
    pub grip: Option<Grip>,
}

impl End {
    /// Everything fixed: a clamp.
    pub fn clamped(pose: Pose) -> Self {
        Self { fixed: [true; 6], pose, grip: None }
    }

    /// Nothing fixed. The pose is where a search may start.
    pub fn free(pose: Pose) -> Self {
        Self { fixed: [false; 6], pose, grip: None }
    }

    /// Only the position fixed: a ball joint.
    pub fn pinned(pose: Pose) -> Self {
        Self { fixed: [false, false, false, true, true, true], pose, grip: None }
    }

    /// Held by a hand through a virtual coupling.
    pub fn gripped(grip: Grip) -> Self {
        Self { fixed: [false; 6], pose: grip.hand, grip: Some(grip) }
    }
}

/// A rod, its loads and its two ends.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The rod.
    pub rod: Rod,
    /// What acts on its nodes, the two ends' nodes too.
    pub loads: NodalLoads,
    /// How the start, `s = 0`, is held.
    pub start: End,
    /// How the end, `s = L`, is held.
    pub end: End,
}

impl Problem {
    /// The nodes that are held or gripped, in order, and how.
    pub(crate) fn holds(&self) -> impl DoubleEndedIterator<Item = (usize, &End)> {
        [(0, &self.start), (self.rod.elements(), &self.end)].into_iter()
    }

    /// The forces that act on the rod, all together, over `EI/L²`.
    pub(crate) fn load_size(&self) -> f64 {
        let forces = self.loads.world.iter().chain(&self.loads.body).map(|load| load.linear.norm());
        forces.sum::<f64>() / self.rod.scale().force
    }

    /// A rod clamped at its base frame, its other end free, nothing acting on it.
    pub fn cantilever(rod: Rod) -> Self {
        let loads = NodalLoads::none(&rod);
        let base = rod.description().base;
        Self { rod, loads, start: End::clamped(base), end: End::free(base) }
    }
}
