//! A scene as understood: rods, bodies, joints, loads and supports in SI units, validated, ready to solve and to move.

mod body;
mod held;
mod initial;
mod motion;

pub use body::{BodyShape, ModelBody};
pub(crate) use held::{Held, Target};
pub(crate) use initial::Initial;
pub use motion::OUTPUT_RATE;

use crate::file::DynamicsFile;
use strands::assembly::{Drag, Joint, MassMatrix};
use strands::contact::{Eyelet, Obstacle, Surfaces};
use strands::coupling::VirtualCoupling;
use strands::load::{DistributedLoad, DistributedPull, NodalLoads, PointLoad, PointPull};
use strands::math::Vec3;
use strands::rod::{Order, Rod, RodError};
use strands::statics::{Problem, RefineError, Refined, Settings, Support, refine};
use thiserror::Error;

/// The most elements that the rods of a scene may have together.
pub(crate) const MAX_ELEMENTS: usize = 200_000;

/// A scene, checked. It does not change.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene's name.
    pub name: String,
    /// Acceleration of gravity, world axes, m/s².
    pub gravity: Vec3,
    /// The rods, in the order of the file.
    pub rods: Vec<ModelRod>,
    /// The rigid bodies, in the order of the file.
    pub bodies: Vec<ModelBody>,
    /// What ties rods and bodies together, in the order of the file.
    pub joints: Vec<Joint>,
    /// How the medium around moves, world axes, m/s.
    pub wind: Vec3,
    /// How surfaces touch, where they do.
    pub surfaces: Option<Surfaces>,
    /// What stands still and is touched, in the order of the file.
    pub obstacles: Vec<Obstacle>,
    /// What rods slide through, in the order of the file.
    pub eyelets: Vec<Eyelet>,
    /// How to solve.
    pub settings: Settings,
    /// How to simulate motion, as the scene says it.
    pub dynamics: DynamicsFile,
}

/// A rod of a scene.
#[derive(Clone, Debug)]
pub struct ModelRod {
    /// Its name.
    pub name: String,
    /// The rod on its mesh, what acts on it and how it is held. Where the mesh is to be chosen for a tolerance, this one has 100
    /// elements, and [`Model::refined`] gives the other.
    pub problem: Problem,
    /// How a hand holds the rod's end when someone moves it.
    pub hand: Option<VirtualCoupling>,
    /// How the mesh is chosen.
    pub mesh: MeshChoice,
    /// The Kelvin–Voigt damping time of its material, s.
    pub damping: f64,
    /// What the medium around takes.
    pub drag: Drag,
    /// How its inertia is summed onto its nodes.
    pub mass_matrix: MassMatrix,
    pub(crate) loads: Loads,
    /// The shape that motion starts from, where that is another than at rest.
    pub(crate) initial: Option<Initial>,
    pub(crate) supports: Vec<Held>,
    /// Where joints are, m.
    pub(crate) ties: Vec<f64>,
}

/// How a rod's mesh is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshChoice {
    /// That many elements, as even as steps and loads allow.
    Elements(usize),
    /// As many as the relative error asks for.
    Tolerance(f64),
}

/// Why no mesh was found for a tolerance.
#[derive(Clone, Debug, Error)]
#[error("no mesh for rod `{rod}`: {reason}")]
pub struct MeshError {
    /// The rod's name.
    pub rod: String,
    /// Why.
    #[source]
    pub reason: RefineError,
}

/// What cannot be solved rod by rod.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "joints tie rods of this scene, or nothing holds them, and each alone has no equilibrium; such rods come to rest with `strands simulate`, start = \"equilibrium\""
)]
pub struct Tied;

/// What acts on a rod, apart from any mesh.
#[derive(Clone, Debug)]
pub(crate) struct Loads {
    pub gravity: Vec3,
    pub points: Vec<PointLoad>,
    pub stretches: Vec<DistributedLoad>,
    pub pulls: Vec<PointPull>,
    pub pulled_stretches: Vec<DistributedPull>,
}

impl Model {
    /// This model with a mesh chosen for every rod that gives a tolerance, and with the solver's own tolerance as small as those ask for.
    ///
    /// # Errors
    /// Where a rod cannot be solved, or its tolerance not be met.
    pub fn refined(&self) -> Result<Self, MeshError> {
        let mut model = self.clone();
        for name in self.rods.iter().map(|rod| &rod.name) {
            model.refine(name)?;
        }
        Ok(model)
    }

    /// Chooses the mesh of one rod, if it gives a tolerance and is here. The solver's own tolerance becomes as small as that asks for.
    ///
    /// # Errors
    /// Where the rod cannot be solved, or its tolerance not be met; the model is then as it was.
    pub fn refine(&mut self, name: &str) -> Result<(), MeshError> {
        let settings = self.settings;
        let Some(rod) = self.rods.iter_mut().find(|rod| rod.name == name) else { return Ok(()) };
        let MeshChoice::Tolerance(tolerance) = rod.mesh else { return Ok(()) };
        let refined =
            rod.refine(tolerance, &settings).map_err(|reason| MeshError { rod: rod.name.clone(), reason })?;
        (rod.problem, self.settings) = (refined.problem, refined.settings);
        Ok(())
    }

    /// Makes sure that each of its rods can be solved by itself.
    ///
    /// # Errors
    /// Where joints tie rods to each other or to bodies, or nothing holds one: what is tied or touches comes to rest together.
    pub fn each_alone(&self) -> Result<(), Tied> {
        if self.rods.iter().any(ModelRod::is_tied) { Err(Tied) } else { Ok(()) }
    }

    /// Whether its rods come to rest by moving only: joints tie them, nothing holds one, or surfaces touch.
    pub fn moves_only(&self) -> bool {
        self.surfaces.is_some() || self.each_alone().is_err()
    }

    /// The rod of a name.
    pub fn rod(&self, name: &str) -> Option<&ModelRod> {
        self.rods.iter().find(|rod| rod.name == name)
    }
}

impl ModelRod {
    /// Whether joints tie it to something, or nothing holds it. Then it cannot be solved alone.
    pub fn is_tied(&self) -> bool {
        !self.ties.is_empty() || self.supports.is_empty()
    }

    fn refine(&self, tolerance: f64, settings: &Settings) -> Result<Refined, RefineError> {
        let rod = &self.problem.rod;
        let order: Order = rod.order();
        let breaks = breaks(&self.loads, &self.supports, &self.ties);
        let pose = |rod: Rod| self.loads.problem(rod, &self.supports, self.initial.as_ref());
        refine(rod.description(), order, &breaks, tolerance, MAX_ELEMENTS, settings, pose)
    }
}

/// Where the mesh must have nodes for loads, supports and joints, m.
pub(crate) fn breaks(loads: &Loads, supports: &[Held], ties: &[f64]) -> Vec<f64> {
    loads.breaks().into_iter().chain(supports.iter().map(|held| held.s)).chain(ties.iter().copied()).collect()
}

impl Loads {
    /// Where the mesh must have nodes for these loads, m.
    fn breaks(&self) -> Vec<f64> {
        let stretches = self.stretches.iter().map(|load| [load.from, load.to]);
        let pulled = self.pulled_stretches.iter().map(|pull| [pull.from, pull.to]);
        let points = self.points.iter().map(|load| load.at);
        points.chain(self.pulls.iter().map(|pull| pull.at)).chain(stretches.chain(pulled).flatten()).collect()
    }

    /// The problem of a rod under these loads and so held, where supports that do not say where hold it in its initial shape, or else at rest. The mesh has a node
    /// wherever it is held.
    pub fn problem(
        &self,
        rod: Rod,
        supports: &[Held],
        initial: Option<&Initial>,
    ) -> Result<Problem, RodError> {
        let mut loads = NodalLoads::none(&rod).with_gravity(&rod, self.gravity);
        for load in &self.points {
            loads = loads.with_point(&rod, load)?;
        }
        for load in &self.stretches {
            loads = loads.with_distributed(&rod, load)?;
        }
        for pull in &self.pulls {
            loads = loads.with_pull(&rod, pull)?;
        }
        for pull in &self.pulled_stretches {
            loads = loads.with_distributed_pull(&rod, pull)?;
        }
        let rest = rod.rest_poses();
        let unheld = initial.map_or_else(|| rest.clone(), |initial| initial.poses(&rod));
        let last = rod.elements();
        let (start, end) = (Support::free(rest[0]), Support::free(rest[last]));
        let mut problem = Problem { loads, start, end, between: Vec::new(), rod };
        for held in supports {
            let node = problem.rod.mesh().node_at(held.s);
            let node = node.unwrap_or_else(|| unreachable!("the supports are among the mesh's breaks"));
            let support = held.support(unheld[node]);
            match problem.support_mut(node) {
                Some(end) => *end = support,
                None => problem.between.push((node, support)),
            }
        }
        Ok(problem)
    }
}
