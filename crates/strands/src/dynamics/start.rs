//! Where a simulation starts.

use super::holds::put_as_planned;
use super::{Integrator, Past, Power, Settings, Simulation, SimulationError, State};
use crate::contact::Toucher;
use crate::math::{Pose, Vec6, Wrench, larger};
use crate::statics::{self, Method, Scheme, Workspace, meet};

/// Where a simulation starts.
#[derive(Clone, Debug)]
pub enum Start {
    /// In static equilibrium, at rest.
    Equilibrium,
    /// In the shape that it has when nothing acts on it, at rest.
    Rest,
    /// At rest in these frames: of the nodes of the rods, rod by rod, and then of the bodies
    /// ([`Assembly::nodes`](crate::assembly::Assembly::nodes)). What bends the rods there acts from then on.
    Shape(Vec<Pose>),
    /// From a state of a simulation of the same assembly.
    State(Box<State>),
}

/// A rod at rest may be so far from its supports, in rad and over the length, and is put there.
const AT_REST: f64 = 1e-6;
/// How often the search for rest may lengthen or shorten its steps.
const RELAXATIONS: usize = 400;
/// By how much it lengthens a step that was solved in few iterations, and shortens one that was not solved.
const LENGTHEN: f64 = 3.0;
const SHORTEN: f64 = 0.2;
const FEW: usize = 6;
/// Steps of this many times the time that the slowest motion takes (of a free end's fall, roughly) are as good as infinite.
const LONG: f64 = 1e6;

impl Simulation {
    pub(super) fn start(&mut self, start: Start) -> Result<(), SimulationError> {
        self.put(start)?;
        if let Some(between) = self.overlap() {
            return Err(SimulationError::Overlap { between });
        }
        self.weigh();
        Ok(())
    }

    /// Surfaces that pass into each other.
    fn overlap(&mut self) -> Option<[Toucher; 2]> {
        let Self { assembly, state, work, .. } = self;
        let surfaces = assembly.surfaces.as_ref()?;
        work.contacts.begin(
            assembly,
            surfaces.friction,
            (&state.poses, &state.poses),
            1.0,
            (&[], &state.passages),
        );
        work.contacts.overlap(&state.poses)
    }

    fn put(&mut self, start: Start) -> Result<(), SimulationError> {
        put_as_planned(&mut self.assembly, 0.0);
        match start {
            Start::State(state) => self.restore(*state),
            Start::Rest => self.at_rest(true),
            Start::Shape(poses) => {
                let got = [poses.len(), self.state.wrenches.len()];
                let needed = [self.state.poses.len(), got[1]];
                if got != needed {
                    return Err(SimulationError::Unfit { got, needed });
                }
                if !poses.iter().all(Pose::is_finite) {
                    return Err(SimulationError::NotFinite);
                }
                self.state.poses = poses;
                self.at_rest(true)
            }
            Start::Equilibrium => {
                self.at_rest(false)?;
                let alone = |group: &super::Group| group.network.is_none();
                if self.work.groups.iter().all(alone) {
                    return self.equilibria();
                }
                // The time that it takes to come to rest is none.
                let moving = core::mem::take(&mut self.assembly.moving);
                let relaxed = self.relax();
                self.assembly.moving = moving;
                relaxed
            }
        }
    }

    /// All at rest where it is, where what is held has to be where it is held, or is put there.
    fn at_rest(&mut self, must_be_held: bool) -> Result<(), SimulationError> {
        let Self { assembly, state, work, .. } = self;
        for (rod, strand) in assembly.strands.iter().enumerate() {
            let (nodes, problem) = (assembly.nodes(rod), &strand.problem);
            for (node, support) in problem.supports().filter(|_| must_be_held) {
                let pose = state.poses[nodes.start + node];
                let apart = pose.between(&meet(support, &pose)).log();
                let far = larger(apart.angular.max_abs(), apart.linear.max_abs() / problem.rod.length());
                if far > AT_REST {
                    let s = problem.rod.mesh().nodes()[node];
                    return Err(SimulationError::NotHeldThere { rod, s });
                }
            }
        }
        Ok(work.ties.put_together(assembly, &mut state.poses)?)
    }

    /// Every rod where it rests alone.
    fn equilibria(&mut self) -> Result<(), SimulationError> {
        let Self { assembly, state, .. } = self;
        let mut workspace = Workspace::default();
        let settings = statics::Settings {
            method: Method::Equilibrium,
            scheme: Scheme::Element,
            ..statics::Settings::default()
        };
        for (rod, strand) in assembly.strands.iter().enumerate() {
            let solution = statics::solve(&strand.problem, &settings, None, &mut workspace)
                .map_err(|reason| SimulationError::NoEquilibrium { rod, reason: Box::new(reason) })?;
            state.poses[assembly.nodes(rod)].copy_from_slice(&solution.poses);
            state.wrenches[assembly.elements(rod)].copy_from_slice(&workspace.record.wrenches);
        }
        Ok(())
    }

    /// Where all comes to rest, by steps of backward Euler's method from rest that grow as it gets there (Kelley & Keyes 1998): one that is long
    /// beside all motion is a step of Newton's method for the equilibrium itself.
    fn relax(&mut self) -> Result<(), SimulationError> {
        let settings = self.settings;
        (self.settings.bounded, self.settings.max_iterations) = (false, Settings::default().max_iterations);
        let gravity = self.pull();
        let slowest = if gravity > 0.0 { (self.assembly.size() / gravity).sqrt() } else { 1.0 };
        let mut step = 0.1 * slowest;
        let mut outcome = Ok(());
        for _ in 0..RELAXATIONS {
            outcome = self.undivided(Integrator::ImplicitEuler, step).map(|taken| {
                if taken.iterations <= FEW {
                    step *= LENGTHEN;
                }
            });
            // What is left to move is not to go on by itself.
            self.stop();
            if outcome.is_err() {
                step *= SHORTEN;
            } else if self.work.step > LONG * slowest {
                break;
            }
        }
        self.settings = settings;
        let last = self.work.step;
        let State { time, dissipated, worked, next_step, .. } = &mut self.state;
        (*time, *dissipated, *worked, *next_step) = (0.0, 0.0, 0.0, self.settings.time_step);
        if last <= LONG * slowest || outcome.is_err() {
            return Err(SimulationError::NoRest { history: self.work.history.clone() });
        }
        Ok(())
    }

    /// Stops all motion.
    fn stop(&mut self) {
        let State { velocities, momenta, past, power, .. } = &mut self.state;
        velocities.fill(Vec6::ZERO);
        momenta.fill(Wrench::ZERO);
        (*past, *power) = (Past::None, Power::default());
    }

    /// The largest acceleration that loads give to a rod or body as a whole, m/s².
    fn pull(&self) -> f64 {
        let rods = self.assembly.strands.iter().map(|strand| {
            let loads = &strand.problem.loads;
            let force = loads.world.iter().chain(&loads.body).map(|load| load.linear.norm()).sum::<f64>();
            force / strand.problem.rod.mass()
        });
        let bodies = self.assembly.bodies.iter().map(|body| body.load.linear.norm() / body.inertia.mass);
        rods.chain(bodies).fold(0.0, f64::max)
    }
}
