//! What acts on a rod: gravity, forces and moments at points and along stretches, dead or following.

use crate::math::{Vec3, Wrench};
use crate::rod::{Rod, RodError};

/// The frame in which a load keeps its direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// A dead load: fixed in the world.
    #[default]
    World,
    /// A follower load: fixed in the material frame of the place it acts on.
    Body,
}

/// A force and a moment at a point of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad {
    /// Where, m from the rod's start. The mesh must have a node there.
    pub at: f64,
    /// Moment (N·m) and force (N).
    pub wrench: Wrench,
    /// In which frame they are given and keep their direction.
    pub frame: Frame,
}

/// A force and a moment per unit rest length along a stretch of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistributedLoad {
    /// Start of the stretch, m. The mesh must have a node there.
    pub from: f64,
    /// End of the stretch, m. The mesh must have a node there.
    pub to: f64,
    /// Moment (N) and force (N/m) per unit length.
    pub per_length: Wrench,
    /// In which frame they are given and keep their direction.
    pub frame: Frame,
}

/// The loads of a rod, summed onto its nodes: at each a dead wrench in world axes and a follower wrench in body axes, both about the node.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalLoads {
    /// Dead wrenches, world axes, N·m and N.
    pub world: Vec<Wrench>,
    /// Follower wrenches, body axes, N·m and N.
    pub body: Vec<Wrench>,
}

impl NodalLoads {
    /// No load on a rod.
    pub fn none(rod: &Rod) -> Self {
        let nodes = rod.mesh().nodes().len();
        Self { world: vec![Wrench::ZERO; nodes], body: vec![Wrench::ZERO; nodes] }
    }

    /// Adds the weight in a field of gravity, m/s², world axes.
    #[must_use]
    pub fn with_gravity(mut self, rod: &Rod, gravity: Vec3) -> Self {
        for (load, mass) in self.world.iter_mut().zip(rod.node_mass()) {
            load.linear += gravity * *mass;
        }
        self
    }

    /// Adds a load at a point.
    ///
    /// # Errors
    /// Where no node lies there.
    pub fn with_point(mut self, rod: &Rod, load: &PointLoad) -> Result<Self, RodError> {
        let node = node(rod, "a load", load.at)?;
        self.of(load.frame)[node] += load.wrench;
        Ok(self)
    }

    /// Adds a load along a stretch, summed onto the nodes by a rule of the rod's order. Of order 4 the rule is where the stretch has at least
    /// two elements between breaks.
    ///
    /// # Errors
    /// Where no node lies at one of its ends, or it ends before it starts.
    pub fn with_distributed(mut self, rod: &Rod, load: &DistributedLoad) -> Result<Self, RodError> {
        let (from, to) = (load.from, load.to);
        let [start, end] = [node(rod, "a load's start", from)?, node(rod, "a load's end", to)?];
        if start > end {
            return Err(RodError::Backwards { what: "a load", from, to });
        }
        let target = self.of(load.frame);
        rod.mesh().distribute(rod.order(), from, to, |node, _, _, weight| {
            target[node] += load.per_length * weight;
        });
        Ok(self)
    }

    /// Each load times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |loads: &[Wrench]| loads.iter().map(|load| *load * factor).collect();
        Self { world: scale(&self.world), body: scale(&self.body) }
    }

    /// Whether any dead load acts, so that the stress depends on where the rod points.
    pub fn any_in_world(&self) -> bool {
        self.world.iter().any(|load| *load != Wrench::ZERO)
    }

    fn of(&mut self, frame: Frame) -> &mut [Wrench] {
        match frame {
            Frame::World => &mut self.world,
            Frame::Body => &mut self.body,
        }
    }
}

/// The node at a place on a rod, where something acts.
fn node(rod: &Rod, what: &'static str, s: f64) -> Result<usize, RodError> {
    if let Some(node) = rod.mesh().node_at(s) {
        return Ok(node);
    }
    let length = rod.length();
    if !(0.0..=length).contains(&s) {
        return Err(RodError::OutsideRod { what, s, length });
    }
    let nodes = rod.mesh().nodes();
    let after = nodes.partition_point(|node| *node < s);
    let (before, after) = (nodes[after - 1], nodes[after]);
    let nearest = if s - before <= after - s { before } else { after };
    Err(RodError::NotANode { what, s, nearest })
}

#[cfg(test)]
mod tests;
