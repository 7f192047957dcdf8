//! Motion: rods, bodies and the joints between them, step by step in time.
//!
//! The nodes and elements are those of [`statics`](crate::statics), and so is the linear system: a [`Simulation`] solves for frames and wrenches at
//! once, so a step may be as long as the motion that is looked for allows, however stiff the rods are against stretching. Inertia is lumped at the nodes, or that of
//! the consistent [mass matrix](crate::assembly::MassMatrix).
//! Nothing is damped but by what is asked for, and by the [`Integrator`] where its documentation says so.

mod by_error;
mod consistent;
mod contacts;
mod coordinates;
mod energy;
mod failure;
mod holds;
mod inertia;
mod integrator;
mod midpoint;
mod near;
mod newton;
mod pair;
mod passages;
mod piece;
mod pierce;
mod stage;
mod start;
mod state;
mod step;

pub use energy::{Budget, Power};
pub use failure::{SimulationError, StepFailure};
pub use integrator::Integrator;
pub use start::Start;
pub use state::{Means, Past, State};

use crate::assembly::{Assembly, Body, Cluster, JointKind, Member, Strand, Ties};
use crate::contact::Toucher;
use crate::math::{Pose, SimdLevel, Vec3, Vec6, Wrench};
use crate::rod::{NodeInertia, Order};
use crate::statics::{Network, Problem, Support};
use contacts::Contacts;
use core::ops::Range;
use newton::{Group, RodSystem};
use stage::Stage;

/// How to step in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How a step is made.
    pub integrator: Integrator,
    /// How long it is, s; where its error chooses it, how long it is at most.
    pub time_step: f64,
    /// How far off the other method in it a step of [`Integrator::Sdirk4`] or [`Integrator::TrBdf2`] may be, in rad and over the longest rod's length. Steps
    /// are then as long as that allows; otherwise they are all alike.
    pub local_error: Option<f64>,
    /// The residual at which a stage is solved, as that of statics: forces and moments over `EI/L²` and `EI/L` or the largest carried, turns in rad and
    /// shifts over the length. Where round-off of the frames leaves more, as in very short steps, that, up to a tenth. A stage's first guess must be a hundred
    /// times better to be its solution.
    pub tolerance: f64,
    /// How many Newton iterations a stage may take.
    pub max_iterations: usize,
    /// Whether a stage takes that many and is then as good as it is, for steps of bounded cost: its residual is in the [`Step`]. Where more than a tenth is
    /// left over, the step is made once more by backward Euler's method, and then is a failure. Otherwise a stage that is not solved by then is one.
    pub bounded: bool,
    /// How fast everything loses its momentum, 1/s.
    pub mass_damping: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Bdf2,
            time_step: 1e-3,
            local_error: None,
            tolerance: 1e-7,
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
    /// How long it was, s.
    pub seconds: f64,
    /// Newton iterations of all its stages.
    pub iterations: usize,
    /// The largest residual of its stages.
    pub residual: f64,
    /// In how many pieces it was made; where its error chose it or its cost is bounded, how often it was tried.
    pub pieces: usize,
}

/// Rods, bodies and joints that move.
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
    /// Where the angular momentum of all is about.
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
    /// The state before the step.
    before: State,
    /// The frames of the stage.
    poses: Vec<Pose>,
    /// The same as they were guessed, where surfaces touch.
    guessed: Vec<Pose>,
    /// How long the step is, s.
    step: f64,
    /// Rates of the coordinates, and momenta of the stages before, of all frames one stage after the other.
    coordinate_rates: Vec<Vec6>,
    momentum_rates: Vec<Wrench>,
    /// The same of the exponents of all elements.
    strain_rates: Vec<Vec6>,
    /// The nodes and the elements of viscous rods.
    viscous: Vec<(Range<usize>, Range<usize>)>,
    history: Vec<f64>,
    contacts: Contacts,
    /// Whether a stage that does not come nearer to a solution soon is given up.
    hasty: bool,
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
        let touch = assembly.surfaces.is_some();
        let clusters = if touch { vec![Cluster::of_all(&assembly)] } else { assembly.clusters(&ties) };
        let groups = clusters.into_iter().map(|Cluster { rods, bodies }| {
            let is_tied = |rod: &usize| assembly.nodes(*rod).any(|frame| ties.tied[frame]);
            let alone = bodies.is_empty() && !rods.iter().any(is_tied);
            let network = (!alone || touch).then(|| Network::new(&assembly, &ties, &rods, &bodies));
            let rods = rods.iter().map(|rod| RodSystem::new(&assembly, *rod)).collect();
            Group { rods, bodies, network }
        });
        let state = State::at_rest(&assembly, assembly.rest_poses(), settings.time_step);
        let work = Work {
            before: state.clone(),
            level: SimdLevel::detect(),
            groups: groups.collect(),
            ties,
            inertia,
            lengths,
            stage: Stage::default(),
            poses: assembly.rest_poses(),
            guessed: Vec::new(),
            step: settings.time_step,
            coordinate_rates: Vec::new(),
            momentum_rates: Vec::new(),
            strain_rates: Vec::new(),
            viscous: Vec::new(),
            history: Vec::new(),
            contacts: Contacts::default(),
            hasty: false,
        };
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

    /// The same, to change loads, drag and wind, or what is held, between steps: all at once, so rates of before are forgotten. The rods, their numbers of
    /// nodes, their mass matrices, the bodies' inertia, the joints, and the numbers of obstacles and eyelets stay.
    pub fn assembly_mut(&mut self) -> &mut Assembly {
        if matches!(self.state.past, Past::Rates { .. }) {
            self.state.past = Past::None;
        }
        self.work.contacts.forget();
        &mut self.assembly
    }

    /// What holds a frame, to move it: it gets there by the end of the next step.
    pub fn support_mut(&mut self, member: Member) -> Option<&mut Support> {
        self.assembly.support_mut(member)
    }

    /// How steps are made.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where all is now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Goes to a state of this simulation, or of another one of the same assembly, the mass matrices too: their momenta are other ones.
    ///
    /// # Errors
    /// Where it is of another assembly, by its numbers or by where joints tie, or no step can begin from it.
    pub fn restore(&mut self, state: State) -> Result<(), SimulationError> {
        let [got, needed] = [&state, &self.state].map(|state| [state.poses.len(), state.wrenches.len()]);
        if !state.fits(needed) {
            return Err(SimulationError::Unfit { got, needed });
        }
        let known = |toucher: &Toucher| match *toucher {
            Toucher::Element { rod, element } => {
                self.assembly.strands.get(rod).is_some_and(|strand| element < strand.problem.rod.elements())
            }
            Toucher::Node { rod, node } => self.assembly.frame(Member::Node { rod, node }).is_some(),
            Toucher::Obstacle { obstacle, .. } => obstacle < self.assembly.obstacles.len(),
        };
        if let Some(contact) = state.contacts.iter().find(|contact| !contact.between.iter().all(known)) {
            return Err(SimulationError::UnknownContact { between: contact.between });
        }
        if let Some(passage) = state.passages.iter().find(|passage| !passages::is_of(&self.assembly, passage))
        {
            return Err(SimulationError::UnknownPassage { rod: passage.rod, at: passage.at });
        }
        if !state.can_begin() {
            return Err(SimulationError::NotFinite);
        }
        self.work.ties.put_together(&self.assembly, &mut state.poses.clone())?;
        self.state = state;
        holds::put_as_planned(&mut self.assembly, self.state.time);
        self.weigh();
        Ok(())
    }

    /// Sets all going: how frames turn, in their own axes, rad/s, and shift in the world, m/s.
    pub fn set_velocities(&mut self, velocities: &[Vec6]) {
        let Self { state, work, .. } = self;
        state.velocities.copy_from_slice(velocities);
        for (i, momentum) in state.momenta.iter_mut().enumerate() {
            let (pose, NodeInertia { mass, rotational }) = (&state.poses[i], work.inertia[i]);
            let spin = pose.rotation * rotational.scale(velocities[i].angular);
            let linear = velocities[i].linear * mass;
            *momentum = Wrench::new(spin, linear);
        }
        for system in work.groups.iter().flat_map(|group| &group.rods) {
            let nodes = system.nodes();
            let (velocities, poses) = (&velocities[nodes.clone()], &state.poses[nodes.clone()]);
            system.couplings.couple(velocities, poses, &mut state.momenta[nodes]);
        }
        state.past = Past::None;
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
    passages::check(assembly)?;
    if assembly.surfaces.is_some() {
        if integrator != Integrator::ImplicitEuler {
            return Err(SimulationError::NoContactBy(integrator.name()));
        }
        if settings.local_error.is_some() {
            return Err(SimulationError::NoErrorOfContact);
        }
        if settings.bounded {
            return Err(SimulationError::UnboundedContact);
        }
    }
    if let Some(error) = settings.local_error {
        setting("the local error", error, positive(error), "greater than 0")?;
        if integrator.embedding().is_none() {
            return Err(SimulationError::NoErrorOf(integrator.name()));
        }
    }
    let hinges = assembly.joints.iter().any(|joint| joint.kind == JointKind::Hinge);
    if integrator == Integrator::Midpoint && (hinges || !assembly.bodies.is_empty()) {
        return Err(SimulationError::NoMidpoint);
    }
    if integrator == Integrator::Midpoint && settings.bounded {
        return Err(SimulationError::UnboundedMidpoint);
    }
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
