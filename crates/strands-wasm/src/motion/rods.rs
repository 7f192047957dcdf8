//! The rods of a scene in motion: the one place that speaks to [`strands::dynamics`].

use super::obstacles::ring;
use std::slice::SliceIndex;
use strands::assembly::{Member, Strand};
use strands::contact::{Contact, Passage};
use strands::coupling::Grip;
use strands::dynamics::{Budget, Settings, Simulation, Step};
use strands::math::{Pose, Vec3, Wrench};
use strands::statics::{Energy, Guess, Problem, Reaction, Solution, SolveReport, Support};
use strands_scene::Model;

/// The residual at which a step is solved. What is over `EI/L²` is far less than any rod here weighs, and no eye sees it.
const TOLERANCE: f64 = 1e-6;

/// All rods of a scene.
pub struct Rods {
    names: Vec<String>,
    simulation: Simulation,
    /// How it began.
    start: Simulation,
    /// The frames before the last step.
    before: Vec<Pose>,
    last: Step,
}

/// What the elements of all rods bear, in flat arrays.
#[derive(Debug, Default)]
pub struct Borne {
    /// Six numbers each, body frame.
    pub strain: Vec<f64>,
    pub stress: Vec<f64>,
    /// Elastic energy per length, J/m.
    pub energy_density: Vec<f64>,
}

impl Rods {
    /// Puts the rods of a scene where they start.
    ///
    /// # Errors
    /// Where the scene asks for what there is not, or a rod cannot move.
    pub fn of(model: &Model) -> Result<Self, String> {
        let settings = Settings { tolerance: TOLERANCE, ..model.motion() };
        let start = model.start().ok_or_else(|| {
            let file = model.dynamics.start.as_deref().unwrap_or_default();
            format!(
                "dynamics.start: the page cannot read {file}; give \"equilibrium\", \"rest\" or \"initial\""
            )
        })?;
        let simulation = model.simulation(settings, start).map_err(|error| error.to_string())?;
        let names = model.rods.iter().map(|rod| rod.name.clone()).collect();
        let before = simulation.state().poses.clone();
        Ok(Self { names, start: simulation.clone(), simulation, before, last: AT_REST })
    }

    /// Goes back to the start.
    pub fn rewind(&mut self) {
        self.simulation.clone_from(&self.start);
        self.before.clone_from(&self.simulation.state().poses);
        self.last = AT_REST;
    }

    /// Makes a step.
    ///
    /// # Errors
    /// Why there is no next one; all is then as before.
    pub fn step(&mut self) -> Result<(), String> {
        let before = self.simulation.state().poses.clone();
        self.last = self.simulation.step().map_err(|failure| failure.to_string())?;
        self.before = before;
        Ok(())
    }

    /// Lets the air around move, m/s, from now on and from the start on.
    pub fn set_wind(&mut self, velocity: Vec3) {
        self.simulation.assembly_mut().wind = velocity;
        self.start.assembly_mut().wind = velocity;
    }

    pub fn time(&self) -> f64 {
        self.simulation.state().time
    }

    pub fn time_step(&self) -> f64 {
        self.simulation.settings().time_step
    }

    pub fn last_step(&self) -> &Step {
        &self.last
    }

    /// Where the energy is.
    pub fn energy(&self) -> Budget {
        self.simulation.energy()
    }

    /// Names and numbers of nodes, as JSON.
    pub fn named(&self) -> serde_json::Value {
        let one = |(rod, name): (usize, &String)| serde_json::json!({ "name": name, "nodes": self.simulation.assembly().nodes(rod).len() });
        self.names.iter().enumerate().map(one).collect()
    }

    pub fn half_extent(&self) -> Vec<f64> {
        let strands = &self.simulation.assembly().strands;
        strands.iter().flat_map(|strand| strand.problem.rod.half_extent()).flatten().copied().collect()
    }

    /// The frames of all nodes so far on the way from before the last step to now.
    pub fn between(&self, part: f64) -> Vec<Pose> {
        let first = self.simulation.assembly().first_body();
        self.on_the_way(..first, part)
    }

    /// The bodies' frames so far on the way from before the last step to now.
    pub fn bodies_between(&self, part: f64) -> Vec<Pose> {
        let first = self.simulation.assembly().first_body();
        self.on_the_way(first.., part)
    }

    fn on_the_way(&self, frames: impl SliceIndex<[Pose], Output = [Pose]> + Clone, part: f64) -> Vec<Pose> {
        let now = &self.simulation.state().poses[frames.clone()];
        if part >= 1.0 {
            return now.to_vec();
        }
        self.before[frames].iter().zip(now).map(|(from, to)| from.towards(to, part)).collect()
    }

    /// The rods as they are now, as shapes of a [`Session`](crate::Session). What holds them and what energy they have is not known of each alone, and is
    /// given as nothing.
    pub fn shapes(&self) -> Vec<Solution> {
        let (assembly, state) = (self.simulation.assembly(), self.simulation.state());
        let shape = |(number, strand): (usize, &Strand)| {
            let problem = &strand.problem;
            let poses = state.poses[assembly.nodes(number)].to_vec();
            let wrenches = &state.wrenches[assembly.elements(number)];
            let (strain, stress) = problem.rod.strains_and_stresses(&poses, wrenches);
            let last = problem.rod.elements();
            let between = problem.between.iter().map(|(node, _)| *node);
            let held = std::iter::once(0).chain(between).chain([last]);
            let unknown = |node: usize| Reaction {
                s: problem.rod.mesh().nodes()[node],
                force: Vec3::ZERO,
                moment: Vec3::ZERO,
            };
            Solution {
                strain,
                stress,
                reactions: held.map(unknown).collect(),
                energy: Energy::default(),
                guess: Guess::new(poses[last], Wrench::ZERO),
                report: SolveReport::default(),
                poses,
            }
        };
        assembly.strands.iter().enumerate().map(shape).collect()
    }

    /// What touched in the last step.
    pub fn contacts(&self) -> &[Contact] {
        &self.simulation.state().contacts
    }

    /// What rods pass through since the last step, where they are so far on the way to now, as [`ring`] tells it.
    pub fn rings(&self, part: f64) -> Vec<f64> {
        let (assembly, passages) = (self.simulation.assembly(), &self.simulation.state().passages);
        if passages.is_empty() {
            return Vec::new();
        }
        let poses = self.between(part);
        let of = |passage: &Passage| {
            let along = assembly.strands[passage.rod].problem.rod.mesh().nodes();
            ring(passage, &poses[assembly.nodes(passage.rod)], along)
        };
        passages.iter().flat_map(of).collect()
    }

    /// What all elements bear.
    pub fn borne(&self) -> Borne {
        let (assembly, state) = (self.simulation.assembly(), self.simulation.state());
        let mut all = Borne::default();
        for (number, strand) in assembly.strands.iter().enumerate() {
            let rod = &strand.problem.rod;
            let (nodes, elements) = (assembly.nodes(number), assembly.elements(number));
            let (strains, stresses) =
                rod.strains_and_stresses(&state.poses[nodes], &state.wrenches[elements]);
            all.strain.extend(strains.iter().flat_map(|strain| strain.to_array()));
            all.stress.extend(stresses.iter().flat_map(|stress| stress.to_array()));
            all.energy_density.extend(strains.iter().enumerate().map(|(e, strain)| {
                let points = rod.points(e);
                points.iter().map(|point| point.law.energy(*strain - point.rest)).sum::<f64>()
                    / points.len() as f64
            }));
        }
        all
    }

    /// A rod and what holds it; `None` where there are not so many.
    pub fn problem(&self, rod: usize) -> Option<&Problem> {
        self.simulation.assembly().strands.get(rod).map(|strand| &strand.problem)
    }

    /// Where a node is.
    pub fn pose(&self, rod: usize, node: usize) -> Pose {
        self.simulation.state().poses[self.simulation.assembly().nodes(rod).start + node]
    }

    /// Holds a node of a rod in another way, and gives how it was held so far. `None` takes a support between the ends away.
    pub fn hold(&mut self, rod: usize, node: usize, support: Option<Support>) -> Option<Support> {
        let problem = &mut self.simulation.assembly_mut().strands[rod].problem;
        let place = problem.between.partition_point(|(other, _)| *other < node);
        match (problem.support_mut(node), support) {
            (Some(held), Some(support)) => Some(std::mem::replace(held, support)),
            (Some(_), None) => Some(problem.between.remove(place).1),
            (None, Some(support)) => {
                problem.between.insert(place, (node, support));
                None
            }
            (None, None) => None,
        }
    }

    /// The grip of a node that a hand holds, to move the hand: it is there at the end of the next step.
    pub fn grip_mut(&mut self, rod: usize, node: usize) -> Option<&mut Grip> {
        self.simulation.support_mut(Member::Node { rod, node }).and_then(|support| support.grip.as_mut())
    }

    pub fn grip(&self, rod: usize, node: usize) -> Option<&Grip> {
        self.problem(rod)?.support(node)?.grip.as_ref()
    }
}

const AT_REST: Step = Step { time: 0.0, seconds: 0.0, iterations: 0, residual: 0.0, pieces: 0 };
