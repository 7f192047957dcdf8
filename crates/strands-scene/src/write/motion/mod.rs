//! A simulation: frames in time, one format a module.

mod csv;
mod glb;
mod json;
mod npz;
mod pvd;
mod usda;

pub use csv::motion_csv;
pub use glb::{TooManyNodes, motion_glb};
pub use json::{End, Ran, motion_json};
pub use npz::motion_npz;
pub use pvd::motion_pvd;
pub use usda::motion_usda;

use super::Shape;
use crate::model::Model;
use strands::contact::{Contact, Passage};
use strands::math::{Pose, Strain, Stress, Vec6, Wrench};
use strands::rod::Rod;
use strands::statics::Reaction;

/// A scene at one time.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The time, s.
    pub time: f64,
    /// The rods, in the scene's order.
    pub rods: Vec<MovedRod>,
    /// The rigid bodies, the same ones in every frame.
    pub bodies: Vec<MovedBody>,
    /// What touches.
    pub contacts: Vec<Contact>,
    /// What rods pass through.
    pub passages: Vec<Passage>,
    /// Where the energy of all of them is.
    pub energy: FrameEnergy,
    /// Newton iterations since the frame before, of all together.
    pub iterations: usize,
    /// The largest residual since then.
    pub residual: f64,
}

/// A rod at one time.
#[derive(Clone, Debug)]
pub struct MovedRod {
    /// The frames of the nodes.
    pub poses: Vec<Pose>,
    /// How the nodes turn, in their own axes, rad/s, and shift in the world, m/s.
    pub velocities: Vec<Vec6>,
    /// The strains of the elements, body frame.
    pub strain: Vec<Strain>,
    /// The stresses of the elements, body frame.
    pub stress: Vec<Stress>,
    /// What its supports exert on it, where that is known.
    pub reactions: Vec<Reaction>,
}

impl MovedRod {
    /// A rod whose nodes are at `poses` and move with `velocities` while its elements carry `wrenches` through their far nodes, in those nodes' frames.
    pub fn new(rod: &Rod, poses: &[Pose], velocities: &[Vec6], wrenches: &[Wrench]) -> Self {
        let (strain, stress) = rod.strains_and_stresses(poses, wrenches);
        Self { poses: poses.to_vec(), velocities: velocities.to_vec(), strain, stress, reactions: Vec::new() }
    }
}

/// A rigid body at one time.
#[derive(Clone, Debug)]
pub struct MovedBody {
    /// Its name, which no rod has.
    pub name: String,
    /// Its frame.
    pub pose: Pose,
    /// How it turns, in its own axes, rad/s, and shifts in the world, m/s.
    pub velocity: Vec6,
}

/// Energies of a scene, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameEnergy {
    /// Of its motion.
    pub kinetic: f64,
    /// Stored in it.
    pub elastic: f64,
    /// Of dead loads and pulls, gravity among them.
    pub load: f64,
    /// Taken out of it by damping since the start.
    pub dissipated: f64,
    /// Done on it since the start by what has no potential: supports that move, loads that follow. `None` where that is not known.
    pub work: Option<f64>,
}

impl FrameEnergy {
    /// What stays the same where the integrator takes nothing away.
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.load + self.dissipated - self.work.unwrap_or(0.0)
    }
}

impl Frame {
    /// The rods in their shapes, with how they move.
    fn shapes<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = (Shape<'a>, &'a MovedRod)> {
        assert_eq!(model.rods.len(), self.rods.len(), "a frame has all rods of the model");
        model.rods.iter().zip(&self.rods).map(|(rod, moved)| {
            let MovedRod { poses, strain, stress, .. } = moved;
            (Shape { rod, poses, strain, stress }, moved)
        })
    }
}
