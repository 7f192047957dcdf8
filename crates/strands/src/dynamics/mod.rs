//! Motion: a rod with inertia, step by step in time.
//!
//! The nodes and elements are those of [`statics`], and so is the linear system: a [`Simulation`] solves for frames and wrenches at
//! once, so a step may be as long as the motion that is looked for allows, however stiff the rod is against stretching. Inertia is lumped at the nodes.
//! Nothing is damped but by what is asked for, and by the [`Integrator`] where its documentation says so.

mod energy;
mod integrator;
mod stage;

pub use energy::Budget;
pub use integrator::Integrator;

use crate::math::{Pose, SimdLevel, Vec3, Vec6, Wrench};
use crate::rod::{Order, Rod};
use crate::statics::{self, Method, Nodal, Problem, Record, Scheme, SolveFailure, Workspace, meet};
use integrator::{IMPLICIT_EULER, RungeKutta, SDIRK4};
use stage::Stage;
use thiserror::Error;

/// What takes energy out of a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Kelvin–Voigt: how much stress there is for the rate of a strain, over its stiffness, s.
    pub viscous: f64,
    /// How fast momentum is lost, 1/s.
    pub mass: f64,
}

/// How to step in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How a step is made.
    pub integrator: Integrator,
    /// How long it is, s.
    pub time_step: f64,
    /// The residual at which a stage is solved, as that of statics: forces and moments over `EI/L²` and `EI/L` or the largest carried, turns in rad and
    /// shifts over the length. Where round-off of the frames leaves more, as in very short steps, that.
    pub tolerance: f64,
    /// How many Newton iterations a stage may take.
    pub max_iterations: usize,
    /// Whether a stage takes that many and is then as good as it is, for steps of bounded cost: its residual is in the [`Step`]. Otherwise a stage that is
    /// not solved by then is a failure.
    pub bounded: bool,
    /// What takes energy out.
    pub damping: Damping,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Bdf2,
            time_step: 1e-3,
            tolerance: 1e-9,
            max_iterations: 20,
            bounded: false,
            damping: Damping::default(),
        }
    }
}

/// Where a simulation starts.
#[derive(Clone, Debug)]
pub enum Start {
    /// In static equilibrium, at rest.
    Equilibrium,
    /// In the shape that it has when nothing acts on it, at rest.
    Rest,
    /// From a state of a simulation of the same rod.
    State(Box<State>),
}

/// A rod at some time: all that its future depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The time, s.
    pub time: f64,
    /// The frames of the nodes.
    pub poses: Vec<Pose>,
    /// How nodes turn, in their own axes, rad/s, and shift in the world, m/s.
    pub velocities: Vec<Vec6>,
    /// The momenta of the nodes about the simulation's origin, world axes, N·m·s and N·s.
    pub momenta: Vec<Wrench>,
    /// The wrench that each element carries through its far node, in that node's frame, where a stage was solved last.
    pub wrenches: Vec<Wrench>,
    /// What has been taken out of the rod since the start, J.
    pub dissipated: f64,
    /// What the integrator looks back on: frames and momenta of the step before (BDF2).
    before: Option<(Vec<Pose>, Vec<Wrench>)>,
}

/// How a step went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The time at its end, s.
    pub time: f64,
    /// Newton iterations of all its stages.
    pub iterations: usize,
    /// The largest residual of its stages.
    pub residual: f64,
}

/// Why there is no next step. The state is that before it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepFailure {
    /// Newton's method did not come to the tolerance.
    #[error("at {time} s a step of {step} s was not solved in {} iterations: residuals {}", history.len() - 1, written(history))]
    NotConverged {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
        /// The residuals.
        history: Vec<f64>,
    },
    /// A pivot vanished, or a frame is not finite.
    #[error("at {time} s a step of {step} s led nowhere: residuals {}", written(history))]
    Singular {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
        /// The residuals until then.
        history: Vec<f64>,
    },
}

fn written(history: &[f64]) -> String {
    history.iter().map(|residual| format!("{residual:.1e}")).collect::<Vec<_>>().join(", ")
}

/// A rod at rest may be so far from its supports, in rad and over the length, and is put there.
const AT_REST: f64 = 1e-6;

/// Why a rod cannot be simulated.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// It is not of order 2 with a diagonal law.
    #[error("only rods of order 2 whose law is diagonal in the strains can move")]
    Law,
    /// It has no mass somewhere.
    #[error("node {0} has no mass: a rod that moves needs one everywhere")]
    Massless(usize),
    /// A number of the settings cannot be.
    #[error("{what} is {value}, and must be {wanted}")]
    Setting {
        /// Which.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// At rest it would not be where it is held.
    #[error(
        "in its rest shape the rod is not where it is held at s = {0} m: start in equilibrium, or hold it there"
    )]
    NotHeldThere(f64),
    /// The state is of a rod with another number of nodes.
    #[error("the state has {got} nodes and the rod {needed}")]
    Unfit {
        /// How many it has.
        got: usize,
        /// How many the rod has.
        needed: usize,
    },
    /// It has no equilibrium to start from.
    #[error("there is no equilibrium to start from: {0}")]
    NoEquilibrium(#[from] SolveFailure),
}

/// A rod that moves.
///
/// ```
/// # use strands::dynamics::{Integrator, Settings, Simulation, Start};
/// # use strands::load::NodalLoads;
/// # use strands::math::{Pose, Vec3};
/// # use strands::rod::{Kinematics, Material, Order, Profile, Rod, RodDescription, Section, Station};
/// # use strands::statics::Problem;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A suture, straight at first, falls under its weight.
/// let nylon = Material::from_poisson(750e6, 0.4, 1300.0)?;
/// let section = Section::Circle { radius: 0.2e-3 };
/// let description = RodDescription {
///     length: 0.1,
///     kinematics: Kinematics::Cosserat,
///     profile: Profile::Stations(vec![Station { s: 0.0, section, material: nylon }]),
///     rest: Default::default(),
///     base: Pose::IDENTITY,
/// };
/// let rod = Rod::with_elements(description, 50, &[], Order::Second)?;
/// let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(9.81, 0.0, 0.0));
/// let settings = Settings { integrator: Integrator::Bdf2, time_step: 1e-3, ..Settings::default() };
/// let mut simulation = Simulation::new(Problem { loads, ..Problem::cantilever(rod) }, settings, Start::Rest)?;
/// for _ in 0..100 {
///     simulation.step()?;
/// }
/// assert!(simulation.state().poses[50].position.x > 0.01);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Simulation {
    problem: Problem,
    settings: Settings,
    state: State,
    /// Where momenta are about.
    origin: Vec3,
    work: Work,
}

/// Scratch of a simulation.
#[derive(Clone, Debug)]
struct Work {
    level: SimdLevel,
    nodal: Nodal,
    record: Record,
    stage: Stage,
    /// Rates of the coordinates, and momenta of the stages before, of all nodes one stage after the other.
    coordinate_rates: Vec<Vec6>,
    momentum_rates: Vec<Wrench>,
    history: Vec<f64>,
}

impl Simulation {
    /// Puts a rod where it starts.
    ///
    /// # Errors
    /// Where it is not one that can move, or has nowhere to start.
    pub fn new(problem: Problem, settings: Settings, start: Start) -> Result<Self, SimulationError> {
        check(&problem.rod, &settings)?;
        let nodes = problem.rod.elements() + 1;
        let mut record = Record::default();
        record.fit(nodes - 1);
        let mut state = State {
            time: 0.0,
            poses: problem.rod.rest_poses(),
            velocities: vec![Vec6::ZERO; nodes],
            momenta: vec![Wrench::ZERO; nodes],
            wrenches: vec![Wrench::ZERO; nodes - 1],
            dissipated: 0.0,
            before: None,
        };
        match start {
            Start::Rest => {
                for (node, support) in problem.supports() {
                    let apart = state.poses[node].between(&meet(support, &state.poses[node])).log();
                    let far = apart.angular.max_abs().max(apart.linear.max_abs() / problem.rod.length());
                    if far > AT_REST {
                        return Err(SimulationError::NotHeldThere(problem.rod.mesh().nodes()[node]));
                    }
                }
            }
            Start::Equilibrium => {
                let mut workspace = Workspace::default();
                let how = statics::Settings {
                    method: Method::Equilibrium,
                    scheme: Scheme::Element,
                    ..statics::Settings::default()
                };
                state.poses = statics::solve(&problem, &how, None, &mut workspace)?.poses;
                state.wrenches.clone_from(&workspace.record.wrenches);
            }
            Start::State(given) => {
                if given.poses.len() != nodes {
                    return Err(SimulationError::Unfit { got: given.poses.len(), needed: nodes });
                }
                state = *given;
            }
        }
        let origin = problem.rod.description().base.position;
        let work = Work {
            level: SimdLevel::detect(),
            nodal: Nodal::default(),
            record,
            stage: Stage::default(),
            coordinate_rates: Vec::new(),
            momentum_rates: Vec::new(),
            history: Vec::new(),
        };
        Ok(Self { problem, settings, state, origin, work })
    }

    /// The rod, its loads and supports.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The same, to move a support, let go of it or change a load between steps. The rod and its number of nodes stay.
    pub fn problem_mut(&mut self) -> &mut Problem {
        &mut self.problem
    }

    /// How steps are made.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where it is now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Sets it going: how nodes turn, in their own axes, rad/s, and shift in the world, m/s.
    pub fn set_velocities(&mut self, velocities: &[Vec6]) {
        self.state.velocities.copy_from_slice(velocities);
        let inertia = self.problem.rod.node_inertia();
        for (i, momentum) in self.state.momenta.iter_mut().enumerate() {
            let pose = &self.state.poses[i];
            let spin = pose.rotation * inertia[i].rotational.scale(velocities[i].angular);
            let linear = velocities[i].linear * inertia[i].mass;
            *momentum = Wrench::new(spin + (pose.position - self.origin).cross(linear), linear);
        }
        self.state.before = None;
    }

    /// Makes one step.
    ///
    /// # Errors
    /// Where it cannot be made; the state is then as before.
    pub fn step(&mut self) -> Result<Step, StepFailure> {
        match self.settings.integrator {
            Integrator::ImplicitEuler => self.runge_kutta(&IMPLICIT_EULER),
            Integrator::Sdirk4 => self.runge_kutta(&SDIRK4),
            Integrator::Bdf2 => self.bdf2(),
        }
    }

    fn runge_kutta(&mut self, method: &RungeKutta) -> Result<Step, StepFailure> {
        let (h, nodes) = (self.settings.time_step, self.state.poses.len());
        let (mut taken, viscous) = (Taken::default(), self.settings.damping.viscous > 0.0);
        self.work.coordinate_rates.clear();
        self.work.momentum_rates.clear();
        self.work.stage.begin(&self.state, &self.problem, viscous);
        let mut dissipated = 0.0;
        for (number, before) in method.before.iter().enumerate() {
            let Work { stage, coordinate_rates, momentum_rates, .. } = &mut self.work;
            stage.set_up(method.diagonal * h, &self.state);
            let rates = coordinate_rates.chunks(nodes).zip(momentum_rates.chunks(nodes));
            for (a, (coordinates, momenta)) in before.iter().zip(rates) {
                stage.add_history(a * h, coordinates, momenta);
            }
            if number == 0 {
                stage.predict_by_velocities(&self.state.velocities);
            } else {
                stage.predict_by_velocities(&coordinate_rates[(number - 1) * nodes..]);
            }
            taken.add(self.solve_stage()?);
            let Work { stage, coordinate_rates, momentum_rates, .. } = &mut self.work;
            coordinate_rates.extend_from_slice(&stage.coordinate_rates);
            momentum_rates.extend(stage.momentum_rates());
            let weight = weight_of(method, number);
            dissipated += weight * h * self.dissipation();
        }
        Ok(self.taken(taken, dissipated))
    }

    fn bdf2(&mut self) -> Result<Step, StepFailure> {
        let Some((poses, momenta)) = self.state.before.take() else {
            let now = (self.state.poses.clone(), self.state.momenta.clone());
            let step = self.runge_kutta(&SDIRK4)?;
            self.state.before = Some(now);
            return Ok(step);
        };
        let h = self.settings.time_step;
        let viscous = self.settings.damping.viscous > 0.0;
        let stage = &mut self.work.stage;
        stage.begin(&self.state, &self.problem, viscous);
        stage.set_up(2.0 / 3.0 * h, &self.state);
        stage.look_back(&poses, &momenta);
        stage.predict_by_velocities(&self.state.velocities);
        let mut taken = Taken::default();
        match self.solve_stage() {
            Ok(stage) => taken.add(stage),
            Err(failure) => {
                self.state.before = Some((poses, momenta));
                return Err(failure);
            }
        }
        let dissipated = h * self.dissipation();
        let state = &mut self.state;
        let (mut before_poses, mut before_momenta) = (poses, momenta);
        before_poses.copy_from_slice(&state.poses);
        before_momenta.copy_from_slice(&state.momenta);
        state.before = Some((before_poses, before_momenta));
        Ok(self.taken(taken, dissipated))
    }

    /// Ends a step where its last stage is.
    fn taken(&mut self, taken: Taken, dissipated: f64) -> Step {
        let Self { state, work: Work { record, stage, .. }, settings, .. } = self;
        state.poses.copy_from_slice(&record.poses);
        state.wrenches.copy_from_slice(&record.wrenches);
        state.velocities.copy_from_slice(&stage.velocities);
        state.momenta.copy_from_slice(&stage.momenta);
        state.dissipated += dissipated;
        state.time += settings.time_step;
        Step { time: state.time, iterations: taken.iterations, residual: taken.residual }
    }
}

/// How its stages went.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    iterations: usize,
    residual: f64,
}

impl Taken {
    fn add(&mut self, stage: Self) {
        self.iterations += stage.iterations;
        self.residual = self.residual.max(stage.residual);
    }
}

/// The weight of a stage in the step.
fn weight_of(method: &RungeKutta, stage: usize) -> f64 {
    let last = method.before.len() - 1;
    if stage == last { method.diagonal } else { method.before[last][stage] }
}

/// A pose as seen from axes about another origin.
fn about(origin: Vec3, pose: &Pose) -> Pose {
    Pose { rotation: pose.rotation, position: pose.position - origin }
}

fn check(rod: &Rod, settings: &Settings) -> Result<(), SimulationError> {
    if rod.order() != Order::Second || rod.diagonal_points().is_none() {
        return Err(SimulationError::Law);
    }
    if let Some(node) = rod.node_inertia().iter().position(|node| node.mass <= 0.0) {
        return Err(SimulationError::Massless(node));
    }
    let Settings { time_step, tolerance, damping, .. } = *settings;
    let setting = |what, value, fits: bool, wanted| {
        if fits { Ok(()) } else { Err(SimulationError::Setting { what, value, wanted }) }
    };
    let positive = |value: f64| value > 0.0 && value.is_finite();
    setting("the time step", time_step, positive(time_step), "greater than 0")?;
    setting("the tolerance", tolerance, positive(tolerance), "greater than 0")?;
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    setting("the viscous damping", damping.viscous, not_negative(damping.viscous), "0 or more")?;
    setting("the damping of mass", damping.mass, not_negative(damping.mass), "0 or more")?;
    Ok(())
}

#[cfg(test)]
mod tests;
