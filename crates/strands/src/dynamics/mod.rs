//! Motion: a rod with inertia, step by step in time.
//!
//! The nodes and elements are those of [`statics`], and so is the linear system: a [`Simulation`] solves for frames and wrenches at
//! once, so a step may be as long as the motion that is looked for allows, however stiff the rod is against stretching. Inertia is lumped at the nodes.
//! Nothing is damped but by what is asked for, and by the [`Integrator`] where its documentation says so.

mod energy;
mod failure;
mod holds;
mod integrator;
mod newton;
mod stage;
mod start;
mod state;

pub use energy::Budget;
pub use failure::{SimulationError, StepFailure};
pub use integrator::Integrator;
pub use start::Start;
pub use state::{Past, State};

use crate::assembly::{Assembly, Body, Cluster, Strand, Ties};
use crate::math::{Pose, SimdLevel, Vec3, Vec6, Wrench};
use crate::rod::{NodeInertia, Order};
use crate::statics::{Network, Problem};
use energy::Power;
use integrator::{IMPLICIT_EULER, RungeKutta, SDIRK4};
use newton::{Group, RodSystem};
use stage::Stage;

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
    /// How fast everything loses its momentum, 1/s.
    pub mass_damping: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Bdf2,
            time_step: 1e-3,
            tolerance: 1e-9,
            max_iterations: 20,
            bounded: false,
            mass_damping: 0.0,
        }
    }
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
    assembly: Assembly,
    settings: Settings,
    state: State,
    /// Where momenta are about.
    origin: Vec3,
    work: Work,
}

/// Scratch of a simulation, and what does not change.
#[derive(Clone, Debug)]
struct Work {
    level: SimdLevel,
    ties: Ties,
    groups: Vec<Group>,
    /// Of all frames: what they carry, and how long a piece of a rod they stand for, m.
    inertia: Vec<NodeInertia>,
    lengths: Vec<f64>,
    stage: Stage,
    /// The frames of the stage.
    poses: Vec<Pose>,
    /// How long the step is, s.
    step: f64,
    /// Rates of the coordinates, and momenta of the stages before, of all frames one stage after the other.
    coordinate_rates: Vec<Vec6>,
    momentum_rates: Vec<Wrench>,
    history: Vec<f64>,
}

impl Simulation {
    /// Puts a rod, or rods and bodies, where they start.
    ///
    /// # Errors
    /// Where they are not such that can move, or have nowhere to start.
    pub fn new(
        assembly: impl Into<Assembly>,
        settings: Settings,
        start: Start,
    ) -> Result<Self, SimulationError> {
        let assembly = assembly.into();
        check(&assembly, &settings)?;
        let ties = Ties::new(&assembly)?;
        let mut inertia = Vec::with_capacity(assembly.frames());
        let mut lengths = Vec::with_capacity(assembly.frames());
        for Strand { problem: Problem { rod, .. }, .. } in &assembly.strands {
            inertia.extend_from_slice(rod.node_inertia());
            let length = |element: Option<usize>| element.map_or(0.0, |element| rod.element_length(element));
            let about = |i: usize| length(i.checked_sub(1)) + length((i < rod.elements()).then_some(i));
            lengths.extend((0..=rod.elements()).map(|i| 0.5 * about(i)));
        }
        inertia.extend(assembly.bodies.iter().map(|body| body.inertia));
        lengths.resize(inertia.len(), 0.0);
        let groups = assembly.clusters(&ties).into_iter().map(|Cluster { rods, bodies }| {
            let is_tied = |rod: &usize| assembly.nodes(*rod).any(|frame| ties.tied[frame]);
            let alone = bodies.is_empty() && !rods.iter().any(is_tied);
            let network = (!alone).then(|| Network::new(&assembly, &ties, &rods, &bodies));
            let rods = rods.iter().map(|rod| RodSystem::new(&assembly, *rod)).collect();
            Group { rods, bodies, network }
        });
        let work = Work {
            level: SimdLevel::detect(),
            groups: groups.collect(),
            ties,
            inertia,
            lengths,
            stage: Stage::default(),
            poses: Vec::new(),
            step: settings.time_step,
            coordinate_rates: Vec::new(),
            momentum_rates: Vec::new(),
            history: Vec::new(),
        };
        let state = State::at_rest(&assembly, assembly.rest_poses());
        let first = assembly.strands.first().map(|strand| strand.problem.rod.description().base.position);
        let origin = first.unwrap_or(Vec3::ZERO);
        let mut simulation = Self { assembly, settings, state, origin, work };
        simulation.start(start)?;
        Ok(simulation)
    }

    /// The rods, bodies and joints.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// The same, to change loads, drag and wind, to move what holds it or to let go of it between steps. The rods, their numbers of nodes, the bodies'
    /// inertia and the joints stay.
    pub fn assembly_mut(&mut self) -> &mut Assembly {
        &mut self.assembly
    }

    /// How steps are made.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where all is now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Goes to a state of this simulation, or of another one of the same assembly.
    ///
    /// # Errors
    /// Where it is of another assembly.
    pub fn restore(&mut self, state: State) -> Result<(), SimulationError> {
        let needed = self.assembly.frames();
        let got = state.poses.len();
        let fits = got == needed
            && [state.velocities.len(), state.momenta.len()] == [needed; 2]
            && state.wrenches.len() == self.state.wrenches.len();
        if !fits {
            return Err(SimulationError::Unfit { got, needed });
        }
        self.state = state;
        Ok(())
    }

    /// Sets all going: how frames turn, in their own axes, rad/s, and shift in the world, m/s.
    pub fn set_velocities(&mut self, velocities: &[Vec6]) {
        self.state.velocities.copy_from_slice(velocities);
        for (i, momentum) in self.state.momenta.iter_mut().enumerate() {
            let (pose, NodeInertia { mass, rotational }) = (&self.state.poses[i], self.work.inertia[i]);
            let spin = pose.rotation * rotational.scale(velocities[i].angular);
            let linear = velocities[i].linear * mass;
            *momentum = Wrench::new(spin + (pose.position - self.origin).cross(linear), linear);
        }
        self.state.past = Past::None;
    }

    /// Makes one step.
    ///
    /// # Errors
    /// Where it cannot be made; the state is then as before.
    pub fn step(&mut self) -> Result<Step, StepFailure> {
        self.work.step = self.settings.time_step;
        let held = holds::Held::begin(self);
        let step = match self.settings.integrator {
            Integrator::ImplicitEuler => self.runge_kutta(&IMPLICIT_EULER, &held),
            Integrator::Sdirk4 => self.runge_kutta(&SDIRK4, &held),
            Integrator::Bdf2 => self.bdf2(&held),
            Integrator::GeneralizedAlpha { spectral_radius } => {
                self.generalized_alpha(spectral_radius, &held)
            }
        };
        held.end(self);
        step
    }

    fn runge_kutta(&mut self, method: &RungeKutta, held: &holds::Held) -> Result<Step, StepFailure> {
        let (h, frames) = (self.work.step, self.state.poses.len());
        let (mut taken, mut lost) = (Taken::default(), Power::default());
        self.work.coordinate_rates.clear();
        self.work.momentum_rates.clear();
        self.work.stage.begin(&self.state);
        for (number, before) in method.before.iter().enumerate() {
            held.at(method.time(number), self);
            let Work { stage, coordinate_rates, momentum_rates, poses, .. } = &mut self.work;
            stage.set_up(method.diagonal * h, &self.state);
            let rates = coordinate_rates.chunks(frames).zip(momentum_rates.chunks(frames));
            for (a, (coordinates, momenta)) in before.iter().zip(rates) {
                stage.add_history(a * h, coordinates, momenta);
            }
            poses.resize(frames, Pose::IDENTITY);
            match number.checked_sub(1) {
                None => stage.predict(&self.state.velocities, poses),
                Some(last) => stage.predict(&coordinate_rates[last * frames..], poses),
            }
            taken.add(self.solve_stage()?);
            let Work { stage, coordinate_rates, momentum_rates, .. } = &mut self.work;
            coordinate_rates.extend_from_slice(&stage.coordinate_rates);
            momentum_rates.extend(stage.momentum_rates());
            let (power, times) = (self.power(), method.weight(number) * h);
            lost.dissipated += power.dissipated * times;
            lost.worked += power.worked * times;
        }
        Ok(self.taken(taken, lost))
    }

    fn bdf2(&mut self, held: &holds::Held) -> Result<Step, StepFailure> {
        let Past::Before { poses, momenta } = &self.state.past else {
            let now = (self.state.poses.clone(), self.state.momenta.clone());
            let step = self.runge_kutta(&SDIRK4, held)?;
            self.state.past = Past::Before { poses: now.0, momenta: now.1 };
            return Ok(step);
        };
        let h = self.work.step;
        let Work { stage, poses: guess, .. } = &mut self.work;
        stage.begin(&self.state);
        stage.set_up(2.0 / 3.0 * h, &self.state);
        stage.look_back(poses, momenta);
        guess.resize(poses.len(), Pose::IDENTITY);
        stage.predict(&self.state.velocities, guess);
        let taken = self.solve_stage()?;
        let Power { dissipated, worked } = self.power();
        let state = &mut self.state;
        if let Past::Before { poses, momenta } = &mut state.past {
            poses.copy_from_slice(&state.poses);
            momenta.copy_from_slice(&state.momenta);
        }
        Ok(self.taken(taken, Power { dissipated: dissipated * h, worked: worked * h }))
    }

    fn generalized_alpha(&mut self, radius: f64, held: &holds::Held) -> Result<Step, StepFailure> {
        let Past::Rates { momentum, mean_velocity, mean_momentum } = &self.state.past else {
            let step = self.runge_kutta(&SDIRK4, held)?;
            let momentum: Vec<Wrench> = self.work.stage.momentum_rates().collect();
            self.state.past = Past::Rates {
                mean_velocity: self.state.velocities.clone(),
                mean_momentum: momentum.clone(),
                momentum,
            };
            return Ok(step);
        };
        // In terms of Jansen, Whiting & Hulbert `α_m` and `α_f` are one less these.
        let alpha_m = (3.0 * radius - 1.0) / (2.0 * (1.0 + radius));
        let alpha_f = radius / (1.0 + radius);
        let gamma = 0.5 - alpha_m + alpha_f;
        let h = self.work.step;
        let (of_mean, of_now) = (gamma * alpha_m / (1.0 - alpha_m), gamma / (1.0 - alpha_m));
        let Work { stage, poses, .. } = &mut self.work;
        stage.begin(&self.state);
        stage.set_up(of_now * (1.0 - alpha_f) * h, &self.state);
        stage.add_history(h * (1.0 - gamma - of_mean), mean_velocity, mean_momentum);
        stage.add_history(h * of_now * alpha_f, &self.state.velocities, momentum);
        poses.resize(self.state.poses.len(), Pose::IDENTITY);
        stage.predict(&self.state.velocities, poses);
        let taken = self.solve_stage()?;
        let Power { dissipated, worked } = self.power();
        let Self { state, work: Work { stage, poses, .. }, .. } = self;
        let mean = |now: Vec6, before: Vec6, mean: Vec6| {
            (now * (1.0 - alpha_f) + before * alpha_f - mean * alpha_m) * (1.0 / (1.0 - alpha_m))
        };
        if let Past::Rates { momentum, mean_velocity, mean_momentum } = &mut state.past {
            for (i, rate) in stage.momentum_rates().enumerate() {
                let velocity = mean(stage.coordinate_rates[i], state.velocities[i], mean_velocity[i]);
                mean_velocity[i] = stage.turned_with(i, &poses[i], velocity);
                mean_momentum[i] = mean(rate, momentum[i], mean_momentum[i]);
                momentum[i] = rate;
            }
        }
        Ok(self.taken(taken, Power { dissipated: dissipated * h, worked: worked * h }))
    }

    /// Ends a step where its last stage is.
    fn taken(&mut self, taken: Taken, lost: Power) -> Step {
        let Self { state, work: Work { groups, stage, poses, step, .. }, assembly, .. } = self;
        state.poses.copy_from_slice(poses);
        for RodSystem { rod, record, .. } in groups.iter().flat_map(|group| &group.rods) {
            state.wrenches[assembly.elements(*rod)].copy_from_slice(&record.wrenches);
        }
        state.velocities.copy_from_slice(&stage.velocities);
        state.momenta.copy_from_slice(&stage.momenta);
        state.dissipated += lost.dissipated;
        state.worked += lost.worked;
        state.time += *step;
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

/// A pose as seen from axes about another origin.
fn about(origin: Vec3, pose: &Pose) -> Pose {
    Pose { rotation: pose.rotation, position: pose.position - origin }
}

fn check(assembly: &Assembly, settings: &Settings) -> Result<(), SimulationError> {
    for (i, Strand { problem: Problem { rod, .. }, .. }) in assembly.strands.iter().enumerate() {
        if rod.order() != Order::Second || rod.diagonal_points().is_none() {
            return Err(SimulationError::Law(i));
        }
        if rod.node_inertia().iter().any(|node| node.mass <= 0.0) {
            return Err(SimulationError::Massless { what: "rod", which: i });
        }
    }
    let light = |body: &Body| {
        body.inertia.mass <= 0.0 || body.inertia.rotational.to_array().iter().any(|x| *x <= 0.0)
    };
    if let Some(which) = assembly.bodies.iter().position(light) {
        return Err(SimulationError::Massless { what: "body", which });
    }
    let setting = |what, value, fits: bool, wanted| {
        if fits { Ok(()) } else { Err(SimulationError::Setting { what, value, wanted }) }
    };
    let Settings { time_step, tolerance, mass_damping, integrator, .. } = *settings;
    let positive = |value: f64| value > 0.0 && value.is_finite();
    setting("the time step", time_step, positive(time_step), "greater than 0")?;
    setting("the tolerance", tolerance, positive(tolerance), "greater than 0")?;
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    setting("the damping of mass", mass_damping, not_negative(mass_damping), "0 or more")?;
    if let Integrator::GeneralizedAlpha { spectral_radius: radius } = integrator {
        setting("the spectral radius", radius, (0.0..=1.0).contains(&radius), "from 0 to 1")?;
    }
    for Strand { viscosity, drag, .. } in &assembly.strands {
        setting("the viscosity", *viscosity, not_negative(*viscosity), "0 or more")?;
        setting("the linear drag", drag.linear, not_negative(drag.linear), "0 or more")?;
        setting("the quadratic drag", drag.quadratic, not_negative(drag.quadratic), "0 or more")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
