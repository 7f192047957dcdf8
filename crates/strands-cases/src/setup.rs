//! A rod with what acts on it and what holds it, before it is cut into elements.

use strands::load::{DistributedLoad, Frame, NodalLoads, PointLoad, PointPull};
use strands::math::{Pose, Vec3, Wrench};
use strands::rod::{Mesh, Order, Rod, RodDescription, RodError};
use strands::statics::{Problem, Support};

/// A rod, what acts on it and what holds it.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The rod.
    pub description: RodDescription,
    /// Dead force per length all along it, N/m, world axes.
    pub force_per_length: Vec3,
    /// Forces and moments at places along it, the tip too.
    pub loads: Vec<PointLoad>,
    /// Pulls towards points.
    pub pulls: Vec<PointPull>,
    /// Where along it it is held, m, and how. An end of which nothing is said is free.
    pub supports: Vec<(f64, Support)>,
    /// Pieces of its mesh, by where each ends, m, and the part of all elements that it gets; none where all elements are alike. For rods that
    /// bend over a short length at a place that is known.
    pub pieces: Vec<(f64, f64)>,
}

/// What is given at the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tip {
    /// A force and a moment.
    Wrench {
        /// Moment (N·m) and force (N).
        wrench: Wrench,
        /// Dead or following.
        frame: Frame,
    },
    /// The place and orientation.
    Pose(Pose),
}

impl Setup {
    /// A rod clamped at its base, nothing acting on it.
    pub fn cantilever(description: RodDescription) -> Self {
        let base = description.base;
        Self {
            description,
            force_per_length: Vec3::ZERO,
            loads: Vec::new(),
            pulls: Vec::new(),
            supports: vec![(0.0, Support::clamped(base))],
            pieces: Vec::new(),
        }
    }

    /// The same rod under a dead force all along it, N/m, world axes.
    #[must_use]
    pub fn with_weight(self, force_per_length: Vec3) -> Self {
        Self { force_per_length, ..self }
    }

    /// The same rod under one more force, dead, world axes, at a place along it.
    #[must_use]
    pub fn with_force(mut self, at: f64, force: Vec3) -> Self {
        let wrench = Wrench::new(Vec3::ZERO, force);
        self.loads.push(PointLoad { at, wrench, frame: Frame::World });
        self
    }

    /// The same rod, at a place along it held as said and no more as it was.
    #[must_use]
    pub fn held(mut self, at: f64, support: Support) -> Self {
        self.supports.retain(|(place, _)| *place != at);
        self.supports.push((at, support));
        self.supports.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        self
    }

    /// The same rod, at its tip held or loaded as said and no more as it was.
    #[must_use]
    pub fn with_tip(mut self, tip: Tip) -> Self {
        let at = self.description.length;
        self.loads.retain(|load| load.at != at);
        self.supports.retain(|(place, _)| *place != at);
        match tip {
            Tip::Pose(pose) => return self.held(at, Support::clamped(pose)),
            Tip::Wrench { wrench, frame } => self.loads.push(PointLoad { at, wrench, frame }),
        }
        self
    }

    /// The same rod, cut finer at its two ends: a third of its elements over this length at each.
    #[must_use]
    pub fn fine_at_ends(self, over: f64) -> Self {
        let length = self.description.length;
        let half = 0.5 * length;
        let pieces = [(over, 1.0 / 3.0), (half, 1.0 / 6.0), (length - over, 1.0 / 6.0), (length, 1.0 / 3.0)];
        Self { pieces: pieces.to_vec(), ..self }
    }

    /// The problem on a mesh with nodes wherever the rod is loaded or held, and at further `places`.
    ///
    /// # Errors
    /// Where there are fewer elements than stretches between the places.
    pub fn problem(&self, elements: usize, order: Order, places: &[f64]) -> Result<Problem, RodError> {
        let loaded = self.loads.iter().map(|load| load.at).chain(self.pulls.iter().map(|pull| pull.at));
        let held = self.supports.iter().map(|(place, _)| *place);
        let places: Vec<f64> = places.iter().copied().chain(loaded).chain(held).collect();
        let rod = if self.pieces.is_empty() {
            Rod::with_elements(self.description.clone(), elements, &places, order)?
        } else {
            let count = |part: f64| ((part * elements as f64).round() as usize).max(1);
            let pieces: Vec<_> = self.pieces.iter().map(|(end, part)| (*end, count(*part))).collect();
            Rod::new(self.description.clone(), Mesh::from_pieces(&pieces)?, order)?
        };
        let mut problem = Problem::cantilever(rod);
        self.apply(&mut problem)?;
        Ok(problem)
    }

    /// Loads and holds the rod of a problem, which is of this description, and no more as it was.
    ///
    /// # Errors
    /// Where the rod's mesh has no node at a place that is loaded or held.
    pub fn apply(&self, problem: &mut Problem) -> Result<(), RodError> {
        let rod = &problem.rod;
        let weight = DistributedLoad {
            from: 0.0,
            to: rod.length(),
            per_length: Wrench::new(Vec3::ZERO, self.force_per_length),
            frame: Frame::World,
        };
        let mut loads = NodalLoads::none(rod).with_distributed(rod, &weight)?;
        for load in &self.loads {
            loads = loads.with_point(rod, load)?;
        }
        for pull in &self.pulls {
            loads = loads.with_pull(rod, pull)?;
        }
        let free = Support::free(rod.description().base);
        let (mut start, mut end, mut between) = (free.clone(), free, Vec::new());
        for (place, support) in &self.supports {
            match rod.mesh().node_at(*place) {
                Some(0) => start = support.clone(),
                Some(node) if node == rod.elements() => end = support.clone(),
                Some(node) => between.push((node, support.clone())),
                None => return Err(no_node(rod, *place)),
            }
        }
        (problem.loads, problem.start, problem.end, problem.between) = (loads, start, end, between);
        Ok(())
    }
}

/// There is no node where something should hold the rod.
fn no_node(rod: &Rod, s: f64) -> RodError {
    let distance = |node: &f64| (node - s).abs();
    let nearest = rod.mesh().nodes().iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    RodError::NotANode { what: "a support", s, nearest: nearest.unwrap_or(0.0) }
}
