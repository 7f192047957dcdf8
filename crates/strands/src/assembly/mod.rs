//! Rods, rigid bodies and joints between them: who is tied to whom.
//!
//! The frames of an assembly are numbered one after the other: the nodes of its rods, rod by rod, and then its bodies. A joint ties one frame to
//! another. Frames that joints tie together hang from one of them, their root: the one that a support holds, or else a body, or else the first. So a
//! network may branch and close on itself through its rods, but not through joints alone.

mod body;
mod joint;
mod keyframes;
mod ties;

pub use body::{Body, ball, block, capsule, cylinder, ring};
pub use joint::{Attachment, Joint, JointKind};
pub use keyframes::Keyframes;
pub(crate) use ties::{Cluster, Ties};

use crate::contact::{Eyelet, Obstacle, Surfaces};
use crate::math::{Pose, Vec3};
use crate::statics::{Problem, Support};
use core::ops::Range;
use thiserror::Error;

/// A rod of an assembly: its problem, and what slows it down.
#[derive(Clone, Debug)]
pub struct Strand {
    /// The rod, its loads and supports.
    pub problem: Problem,
    /// Kelvin–Voigt: how much stress there is for the rate of a strain, over its stiffness, s.
    pub viscosity: f64,
    /// What the air around takes.
    pub drag: Drag,
    /// How its inertia is summed onto its nodes.
    pub mass_matrix: MassMatrix,
}

/// How the inertia of a rod is summed onto its nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// Each node carries the inertia of half of each element beside it.
    #[default]
    Lumped,
    /// The kinetic energy is that of velocities that are linear along each element: of places in the world, of turns in the axes that turn along. So
    /// it couples the momenta of neighbours, and the frequencies of axial and torsional vibration are too high, by as much as they are too low when lumped. Those
    /// of bending are too high by more, but for the first mode of cantilevers and of free rods.
    Consistent,
}

/// The drag of the medium around a rod, per unit length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drag {
    /// Force over length and speed through the medium, N·s/m².
    pub linear: f64,
    /// Force over length and the square of the speed across the rod, N·s²/m³: half of density, drag coefficient and diameter. It acts across the rod.
    pub quadratic: f64,
}

impl From<Problem> for Strand {
    fn from(problem: Problem) -> Self {
        Self { problem, viscosity: 0.0, drag: Drag::default(), mass_matrix: MassMatrix::default() }
    }
}

/// Rods, bodies and joints.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The rods.
    pub strands: Vec<Strand>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// What ties them together.
    pub joints: Vec<Joint>,
    /// Supports that move.
    pub moving: Vec<Keyframes>,
    /// How the medium around moves, m/s, world axes.
    pub wind: Vec3,
    /// How surfaces touch, where they do; else all passes through all.
    pub surfaces: Option<Surfaces>,
    /// What stands still and is touched.
    pub obstacles: Vec<Obstacle>,
    /// What rods slide through, where surfaces touch.
    pub eyelets: Vec<Eyelet>,
}

/// A frame of an assembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// A node of a rod.
    Node {
        /// Which rod.
        rod: usize,
        /// Which of its nodes.
        node: usize,
    },
    /// A body.
    Body(usize),
}

/// Why an assembly cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AssemblyError {
    /// A joint names a frame that there is not.
    #[error("joint {joint} ties {member:?}, which there is not")]
    Missing {
        /// The joint's number.
        joint: usize,
        /// What it names.
        member: Member,
    },
    /// Joints alone close a ring, or tie a frame to itself.
    #[error("joint {0} closes a ring of joints alone: leave it out, or put a rod into the ring")]
    Ring(usize),
    /// Two frames that joints tie together are held.
    #[error(
        "joint {joint} ties together two places that are both held: hold one, and let the joint hold the other"
    )]
    HeldTwice {
        /// The joint's number.
        joint: usize,
    },
    /// The frames that a joint ties together are apart.
    #[error("what joint {joint} ties together is {apart:.2e} m and {turned:.2e} rad apart: put it together")]
    Apart {
        /// The joint's number.
        joint: usize,
        /// By how much, m.
        apart: f64,
        /// And rad.
        turned: f64,
    },
}

impl Default for Assembly {
    fn default() -> Self {
        Self {
            strands: Vec::new(),
            bodies: Vec::new(),
            joints: Vec::new(),
            moving: Vec::new(),
            wind: Vec3::ZERO,
            surfaces: None,
            obstacles: Vec::new(),
            eyelets: Vec::new(),
        }
    }
}

impl From<Problem> for Assembly {
    fn from(problem: Problem) -> Self {
        Strand::from(problem).into()
    }
}

impl From<Strand> for Assembly {
    fn from(strand: Strand) -> Self {
        Self { strands: vec![strand], ..Self::default() }
    }
}

impl Assembly {
    /// The frames of a rod's nodes.
    pub fn nodes(&self, rod: usize) -> Range<usize> {
        let before = self.strands[..rod].iter().map(|strand| strand.problem.rod.elements() + 1).sum();
        before..before + self.strands[rod].problem.rod.elements() + 1
    }

    /// The elements of a rod, where those of all rods are numbered one after the other.
    pub fn elements(&self, rod: usize) -> Range<usize> {
        let nodes = self.nodes(rod);
        nodes.start - rod..nodes.end - rod - 1
    }

    /// How many frames there are.
    pub fn frames(&self) -> usize {
        self.first_body() + self.bodies.len()
    }

    /// The frame of the first body.
    pub fn first_body(&self) -> usize {
        self.strands.iter().map(|strand| strand.problem.rod.elements() + 1).sum()
    }

    /// The number of a frame; `None` where there is no such.
    pub fn frame(&self, member: Member) -> Option<usize> {
        match member {
            Member::Node { rod, node } => {
                let strand = self.strands.get(rod)?;
                (node <= strand.problem.rod.elements()).then(|| self.nodes(rod).start + node)
            }
            Member::Body(body) => (body < self.bodies.len()).then(|| self.first_body() + body),
        }
    }

    /// Which frame has a number.
    pub(crate) fn member(&self, frame: usize) -> Member {
        let mut first = 0;
        for (rod, strand) in self.strands.iter().enumerate() {
            let nodes = strand.problem.rod.elements() + 1;
            if frame < first + nodes {
                return Member::Node { rod, node: frame - first };
            }
            first += nodes;
        }
        Member::Body(frame - first)
    }

    /// How a frame is held, to change: to move it, to let go of it.
    pub fn support_mut(&mut self, member: Member) -> Option<&mut Support> {
        match member {
            Member::Node { rod, node } => self.strands[rod].problem.support_mut(node),
            Member::Body(body) => self.bodies[body].support.as_mut(),
        }
    }

    /// How a frame is held.
    pub fn support(&self, member: Member) -> Option<&Support> {
        match member {
            Member::Node { rod, node } => self.strands[rod].problem.support(node),
            Member::Body(body) => self.bodies[body].support.as_ref(),
        }
    }

    /// Whether its joints can be.
    ///
    /// # Errors
    /// The first that cannot: one that names a frame that there is not, closes a ring of joints alone, ties together two places that are both held, or
    /// whose two sides are apart at rest.
    pub fn check(&self) -> Result<(), AssemblyError> {
        self.check_in_shape(&self.rest_poses())
    }

    /// Whether its joints can be where all frames are these.
    ///
    /// # Errors
    /// As [`check`](Assembly::check).
    pub fn check_in_shape(&self, shape: &[Pose]) -> Result<(), AssemblyError> {
        Ties::new(self)?.put_together(self, &mut shape.to_vec())
    }

    /// All frames when nothing acts on the rods.
    pub fn rest_poses(&self) -> Vec<Pose> {
        let rods = self.strands.iter().flat_map(|strand| strand.problem.rod.rest_poses());
        rods.chain(self.bodies.iter().map(|body| body.pose)).collect()
    }
}
