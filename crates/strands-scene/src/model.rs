//! A scene as understood: rods, loads and supports in SI units, validated, ready to solve.

use strands::coupling::VirtualCoupling;
use strands::load::{DistributedLoad, NodalLoads, PointLoad};
use strands::math::Vec3;
use strands::rod::{Order, Rod, RodError};
use strands::statics::{End, Problem, RefineError, Refined, Settings, refine};
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
    /// How to solve.
    pub settings: Settings,
}

/// A rod of a scene.
#[derive(Clone, Debug)]
pub struct ModelRod {
    /// Its name.
    pub name: String,
    /// The rod on its mesh, what acts on it and how its ends are held. Where the mesh is to be chosen for a tolerance, this one has 100
    /// elements, and [`Model::refined`] gives the other.
    pub problem: Problem,
    /// How a hand holds the rod's end when someone moves it.
    pub hand: Option<VirtualCoupling>,
    /// How the mesh is chosen.
    pub mesh: MeshChoice,
    pub(crate) loads: Loads,
    pub(crate) end_given: GivenTargets,
}

/// Which of the end's targets the supports give. The others are those of the unloaded rod, on whichever mesh it is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct GivenTargets {
    /// x, y and z.
    pub position: [bool; 3],
    /// The frame.
    pub orientation: bool,
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

/// What acts on a rod, apart from any mesh.
#[derive(Clone, Debug)]
pub(crate) struct Loads {
    pub gravity: Vec3,
    pub points: Vec<PointLoad>,
    pub stretches: Vec<DistributedLoad>,
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

    /// The rod of a name.
    pub fn rod(&self, name: &str) -> Option<&ModelRod> {
        self.rods.iter().find(|rod| rod.name == name)
    }
}

impl ModelRod {
    fn refine(&self, tolerance: f64, settings: &Settings) -> Result<Refined, RefineError> {
        let Problem { rod, start, end, .. } = &self.problem;
        let pose = |rod: Rod| {
            let end = self.end_given.on_mesh(end, &rod);
            self.loads.problem(rod, start.clone(), end)
        };
        let order: Order = rod.order();
        refine(rod.description(), order, &self.loads.breaks(), tolerance, MAX_ELEMENTS, settings, pose)
    }
}

impl GivenTargets {
    /// An end, with the targets that are not given taken from the unloaded rod.
    fn on_mesh(&self, end: &End, rod: &Rod) -> End {
        let (mut end, rest) = (end.clone(), rod.rest_poses()[rod.elements()]);
        for i in (0..3).filter(|i| !self.position[*i]) {
            end.pose.position[i] = rest.position[i];
        }
        if !self.orientation {
            end.pose.rotation = rest.rotation;
        }
        end
    }
}

impl Loads {
    /// Where the mesh must have nodes for these loads, m.
    pub fn breaks(&self) -> Vec<f64> {
        let stretches = self.stretches.iter().flat_map(|load| [load.from, load.to]);
        self.points.iter().map(|load| load.at).chain(stretches).collect()
    }

    /// The problem of a rod under these loads, held at its ends.
    pub fn problem(&self, rod: Rod, start: End, end: End) -> Result<Problem, RodError> {
        let mut loads = NodalLoads::none(&rod).with_gravity(&rod, self.gravity);
        for load in &self.points {
            loads = loads.with_point(&rod, load)?;
        }
        for load in &self.stretches {
            loads = loads.with_distributed(&rod, load)?;
        }
        Ok(Problem { rod, loads, start, end })
    }
}
