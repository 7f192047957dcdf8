//! What acts on a rod: gravity, forces and moments at points and along stretches, dead or following, and forces towards a fixed point.

use crate::math::{Mat3, Pose, Vec3, Wrench};
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

/// A force of constant size at a point of the rod, towards a point of the world wherever the rod moves: a guy wire under constant tension, as one
/// that runs over a pulley there to a weight. Its energy is its tension times how long the wire is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointPull {
    /// Where, m from the rod's start. The mesh must have a node there.
    pub at: f64,
    /// The point it pulls towards, m, world axes.
    pub towards: Vec3,
    /// How hard, N. Negative pushes away.
    pub tension: f64,
}

/// The same per unit rest length along a stretch of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistributedPull {
    /// Start of the stretch, m. The mesh must have a node there.
    pub from: f64,
    /// End of the stretch, m. The mesh must have a node there.
    pub to: f64,
    /// The point it pulls towards, m, world axes.
    pub towards: Vec3,
    /// How hard, N/m. Negative pushes away.
    pub tension_per_length: f64,
}

/// A pull towards a point at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// The node.
    pub node: usize,
    /// The point it pulls towards, m, world axes.
    pub towards: Vec3,
    /// How hard, N.
    pub tension: f64,
}

impl Pull {
    /// The force on its node at a place, N, world axes; none where the node has arrived.
    pub fn force(&self, place: Vec3) -> Vec3 {
        self.direction(place).map_or(Vec3::ZERO, |(along, _)| along * self.tension)
    }

    /// How the force changes with the place, `∂f/∂p = −(T/d) (1 − e eᵀ)` at a distance `d` in the direction `e`, N/m.
    pub fn slope(&self, place: Vec3) -> Mat3 {
        self.direction(place).map_or(Mat3::ZERO, |(along, distance)| {
            (Mat3::outer(along, along) - Mat3::IDENTITY).scaled(self.tension / distance)
        })
    }

    /// Its energy with the node at a place, `T d`, J.
    pub fn energy(&self, place: Vec3) -> f64 {
        self.tension * (self.towards - place).norm()
    }

    /// Where to, and how far it is, m.
    fn direction(&self, place: Vec3) -> Option<(Vec3, f64)> {
        let way = self.towards - place;
        let distance = way.norm();
        (distance > 0.0).then(|| (way * (1.0 / distance), distance))
    }
}

/// The loads of a rod, summed onto its nodes: at each a dead wrench in world axes and a follower wrench in body axes, both about the node; and the
/// pulls towards points.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalLoads {
    /// Dead wrenches, world axes, N·m and N.
    pub world: Vec<Wrench>,
    /// Follower wrenches, body axes, N·m and N.
    pub body: Vec<Wrench>,
    /// Pulls towards points, by their nodes.
    pulls: Vec<Pull>,
}

impl NodalLoads {
    /// No load on a rod.
    pub fn none(rod: &Rod) -> Self {
        let nodes = rod.mesh().nodes().len();
        Self { world: vec![Wrench::ZERO; nodes], body: vec![Wrench::ZERO; nodes], pulls: Vec::new() }
    }

    /// The energy of the dead forces and the pulls, minus force times position and tension times distance, where the nodes are, J.
    pub(crate) fn energy(&self, poses: &[Pose]) -> f64 {
        let dead = poses.iter().zip(&self.world).map(|(pose, load)| -load.linear.dot(pose.position));
        let pulls = self.pulls.iter().map(|pull| pull.energy(poses[pull.node].position));
        dead.chain(pulls).sum()
    }

    /// Adds the weight in a field of gravity, m/s², world axes.
    #[must_use]
    pub fn with_gravity(mut self, rod: &Rod, gravity: Vec3) -> Self {
        for (load, node) in self.world.iter_mut().zip(rod.node_inertia()) {
            load.linear += gravity * node.mass;
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
        stretch(rod, load.from, load.to)?;
        let target = self.of(load.frame);
        rod.mesh().distribute(rod.order(), load.from, load.to, |node, _, _, weight| {
            target[node] += load.per_length * weight;
        });
        Ok(self)
    }

    /// Adds a pull towards a point.
    ///
    /// # Errors
    /// Where no node lies there.
    pub fn with_pull(mut self, rod: &Rod, pull: &PointPull) -> Result<Self, RodError> {
        let node = node(rod, "a load", pull.at)?;
        self.put(Pull { node, towards: pull.towards, tension: pull.tension });
        Ok(self)
    }

    /// Adds a pull along a stretch towards a point, summed onto the nodes as [`NodalLoads::with_distributed`] does.
    ///
    /// # Errors
    /// Where no node lies at one of its ends, or it ends before it starts.
    pub fn with_distributed_pull(mut self, rod: &Rod, pull: &DistributedPull) -> Result<Self, RodError> {
        stretch(rod, pull.from, pull.to)?;
        rod.mesh().distribute(rod.order(), pull.from, pull.to, |node, _, _, weight| {
            self.put(Pull { node, towards: pull.towards, tension: pull.tension_per_length * weight });
        });
        Ok(self)
    }

    /// The pulls towards points, by their nodes.
    pub fn pulls(&self) -> &[Pull] {
        &self.pulls
    }

    /// What does not follow a node, with the node at a place: its dead wrench and its pulls, N·m and N, world axes.
    pub(crate) fn in_world(&self, node: usize, place: Vec3) -> Wrench {
        let mut wrench = self.world[node];
        wrench.linear += self.pulls_at(node).iter().fold(Vec3::ZERO, |sum, pull| sum + pull.force(place));
        wrench
    }

    /// Those at a node.
    pub fn pulls_at(&self, node: usize) -> &[Pull] {
        let from = self.pulls.partition_point(|pull| pull.node < node);
        let to = self.pulls.partition_point(|pull| pull.node <= node);
        &self.pulls[from..to]
    }

    /// Adds a pull to those of its node; to one towards the same point.
    fn put(&mut self, pull: Pull) {
        let to = self.pulls.partition_point(|other| other.node <= pull.node);
        let same = self.pulls[..to].iter_mut().rev().take_while(|other| other.node == pull.node);
        match same.into_iter().find(|other| other.towards == pull.towards) {
            Some(other) => other.tension += pull.tension,
            None => self.pulls.insert(to, pull),
        }
    }

    /// Makes each load `factor` times what it is in others of the same rod, without making room for them.
    pub(crate) fn set_scaled(&mut self, whole: &Self, factor: f64) {
        let scale = |now: &mut [Wrench], whole: &[Wrench]| {
            now.iter_mut().zip(whole).for_each(|(now, whole)| *now = *whole * factor);
        };
        scale(&mut self.world, &whole.world);
        scale(&mut self.body, &whole.body);
        let pulls = self.pulls.iter_mut().zip(&whole.pulls);
        pulls.for_each(|(now, whole)| now.tension = whole.tension * factor);
    }

    /// Each load times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.set_scaled(self, factor);
        scaled
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

/// Whether a load may act along a stretch.
fn stretch(rod: &Rod, from: f64, to: f64) -> Result<(), RodError> {
    let [start, end] = [node(rod, "a load's start", from)?, node(rod, "a load's end", to)?];
    if start > end { Err(RodError::Backwards { what: "a load", from, to }) } else { Ok(()) }
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
