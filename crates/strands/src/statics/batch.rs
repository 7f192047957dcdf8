//! Rods side by side in vector lanes: hair, brushes, bundles of tubes, samples of a distribution.

use super::boundary::meet;
use super::equilibrium::{
    HARDLY_ANY, MUCH_STIFFER, SMALL_MOTION, WARM, finish, found, from_rest, move_on, put_between_supports,
    warmly_lent,
};
use super::fit::{fitted, unfit};
use super::march::Record;
use super::nodal::{Inertia, SideBySide, of_lane};
use super::problem::{Problem, Support};
use super::shooting::{Outcome, Workspace};
use super::solution::{Method, Scheme, Settings, Solution, SolveFailure, SolveReport};
use super::stability::{clear_of_round_off, has_potential, morse_index};
use super::{solution, solve};
use crate::load::NodalLoads;
#[cfg(target_arch = "x86_64")]
use crate::math::{Eight, Four};
use crate::math::{Pose, Register, SimdLevel, Vec6, Wide};
use crate::rod::Order;
use std::borrow::Cow;
use thiserror::Error;

/// How many rods run side by side at most.
const MOST_LANES: usize = 8;

/// Rods of one number of elements, held at the same nodes, whose equilibria are followed side by side, four or eight in the lanes of vector registers, as the machine has them.
///
/// Each rod has lengths, stiffnesses, rest shape, loads and places of its supports of its own. What [`follow`](super::follow) does for one rod with
/// [`Method::Equilibrium`], [`Batch::follow`] does for all, and where they keep up finds the same shapes to round-off. A rod that cannot keep up,
/// as one that snaps or is free to turn as a whole, is solved alone. On a machine with neither AVX2 nor AVX-512 all are.
///
/// ```
/// use strands::math::{Pose, Vec3};
/// use strands::rod::{Order, Rod};
/// use strands::statics::{Batch, Problem, Settings, Support};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let description = strands::rod::RodDescription {
/// #     length: 0.1,
/// #     kinematics: strands::rod::Kinematics::Cosserat,
/// #     profile: strands::rod::Profile::Stations(vec![strands::rod::Station {
/// #         s: 0.0,
/// #         section: strands::rod::Section::Circle { radius: 4e-5 },
/// #         material: strands::rod::Material::new(4e9, 1.5e9, 1300.0)?,
/// #     }]),
/// #     rest: Default::default(),
/// #     base: Pose::IDENTITY,
/// # };
/// // Sixteen hairs, each held at its tip.
/// let rod = Rod::with_elements(description, 30, &[], Order::Second)?;
/// let tip = Pose { position: Vec3::new(0.02, 0.0, 0.09), ..Pose::IDENTITY };
/// let hair = Problem { end: Support::pinned(tip), ..Problem::cantilever(rod) };
/// let settings = Settings::default();
/// let mut hairs = Batch::new(vec![hair; 16], &settings)?;
/// for number in 0..hairs.len() {
///     hairs.end_mut(number).position += Vec3::new(0.0, 1e-4 * number as f64, 0.0);
/// }
/// assert!(hairs.follow(&settings));
/// assert!(hairs.solution(15).end_reaction().force.norm() > 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Batch {
    problems: Vec<Problem>,
    states: Vec<State>,
    /// How many rods are side by side.
    lanes: usize,
    sides: Vec<Box<dyn Beside>>,
    workspace: Workspace,
}

/// Of one rod.
#[derive(Clone, Debug)]
struct State {
    report: SolveReport,
    solved: bool,
    /// Whether something else than the place of its end has changed since.
    changed: bool,
    /// Of its loads: their size, over `EI/L²`, and whether they have a potential.
    load_size: f64,
    potential: bool,
    /// Whether it has become one that cannot run beside others.
    alone: bool,
}

/// Why rods cannot be followed side by side.
#[derive(Debug, Error)]
pub enum BatchError {
    /// There are none.
    #[error("there is no rod")]
    Empty,
    /// One has another number of elements or is held at other nodes than the first.
    #[error(
        "rod {rod} has {elements} elements and is held at nodes {held:?}, the first has {first} and is held at {first_held:?}: rods side by side must agree in both"
    )]
    Unlike {
        /// Which.
        rod: usize,
        /// How many it has.
        elements: usize,
        /// Where it is held.
        held: Vec<usize>,
        /// How many the first has.
        first: usize,
        /// Where that is held.
        first_held: Vec<usize>,
    },
    /// One is made of what runs alone only.
    #[error("rod {rod} cannot run beside others: {why}")]
    Alone {
        /// Which.
        rod: usize,
        /// Why, and what to do.
        why: &'static str,
    },
    /// One has no equilibrium to start from.
    #[error("rod {rod}: {failure}")]
    Unsolved {
        /// Which.
        rod: usize,
        /// Why.
        failure: Box<SolveFailure>,
    },
}

impl Batch {
    /// Puts rods side by side and finds where each rests.
    ///
    /// # Errors
    /// Where the rods differ in their number of elements or in the nodes that are held; where one is not of order 2 with a law that is diagonal in
    /// its strains, is held by a grip, or pulled towards a point; where one finds no equilibrium.
    pub fn new(problems: Vec<Problem>, settings: &Settings) -> Result<Self, BatchError> {
        Self::at_level(problems, settings, SimdLevel::detect())
    }

    /// The same with given vector instructions, or the widest below them that the machine has.
    pub(crate) fn at_level(
        problems: Vec<Problem>,
        settings: &Settings,
        level: SimdLevel,
    ) -> Result<Self, BatchError> {
        let first = problems.first().ok_or(BatchError::Empty)?;
        let held = |problem: &Problem| problem.supports().map(|(node, _)| node).collect::<Vec<_>>();
        for (rod, problem) in problems.iter().enumerate() {
            if problem.rod.elements() != first.rod.elements() || held(problem) != held(first) {
                return Err(BatchError::Unlike {
                    rod,
                    elements: problem.rod.elements(),
                    held: held(problem),
                    first: first.rod.elements(),
                    first_held: held(first),
                });
            }
            if let Some(why) = must_be_alone(problem) {
                return Err(BatchError::Alone { rod, why });
            }
        }
        let level = level.min(SimdLevel::detect());
        let mut workspace = Workspace::default();
        workspace.simd = level;
        let side = |problems: &[Problem]| -> Box<dyn Beside> {
            match level {
                #[cfg(target_arch = "x86_64")]
                SimdLevel::Avx512 => Box::new(Side::<Eight>::new(problems)),
                #[cfg(target_arch = "x86_64")]
                SimdLevel::Avx2 => Box::new(Side::<Four>::new(problems)),
                _ => Box::new(Side::<f64>::new(problems)),
            }
        };
        let lanes = if level == SimdLevel::Baseline { 1 } else { level.width() };
        let sides = problems.chunks(lanes).map(side).collect();
        let states = Vec::with_capacity(problems.len());
        let mut batch = Self { problems, states, lanes, sides, workspace };
        for rod in 0..batch.problems.len() {
            let problem = &batch.problems[rod];
            let settings = all_at_once(settings);
            let solution = solve(problem, &settings, None, &mut batch.workspace)
                .map_err(|failure| BatchError::Unsolved { rod, failure: Box::new(failure) })?;
            batch.sides[rod / lanes].put_state(rod % lanes, &batch.workspace.record);
            // All is new: it is looked at before it is followed.
            batch.states.push(State {
                report: solution.report,
                solved: true,
                changed: true,
                load_size: 0.0,
                potential: false,
                alone: false,
            });
        }
        Ok(batch)
    }

    /// How many rods there are.
    pub fn len(&self) -> usize {
        self.problems.len()
    }

    /// Whether there is none, which cannot be.
    pub fn is_empty(&self) -> bool {
        self.problems.is_empty()
    }

    /// One of the rods, its loads and supports.
    pub fn problem(&self, rod: usize) -> &Problem {
        &self.problems[rod]
    }

    /// How the end of a rod is held, to move it.
    pub fn end_mut(&mut self, rod: usize) -> &mut Pose {
        &mut self.problems[rod].end.pose
    }

    /// How a node of a rod is held, to move or change it; `None` where nothing can hold it. A rod that is gripped from then on is solved alone.
    pub fn support_mut(&mut self, rod: usize, node: usize) -> Option<&mut Support> {
        self.states[rod].changed = true;
        self.problems[rod].support_mut(node)
    }

    /// Changes what acts on a rod. One that is pulled towards a point from then on is solved alone; one with loads for another number of nodes is
    /// not solved.
    pub fn set_loads(&mut self, rod: usize, loads: NodalLoads) {
        self.states[rod].changed = true;
        self.problems[rod].loads = loads;
    }

    /// Follows all rods to where their supports are now. Gives whether all were solved; see [`Batch::is_solved`]. Of a rod that was not the last
    /// equilibrium stays, from which it goes on the next time; before it comes to that it is searched for from rest too, unless
    /// [`Settings::restart_from_rest`] says no.
    pub fn follow(&mut self, settings: &Settings) -> bool {
        let settings = all_at_once(settings);
        let Self { problems, states, lanes, sides, workspace } = self;
        let side_by_side = problems.chunks(*lanes).zip(states.chunks_mut(*lanes)).zip(sides);
        for ((problems, states), side) in side_by_side {
            for (lane, (problem, state)) in problems.iter().zip(states.iter_mut()).enumerate() {
                state.report.restart(Method::Equilibrium);
                if state.changed {
                    state.look_at(problem);
                    if !state.alone {
                        side.put_loads(lane, problem);
                    }
                }
            }
            side.follow(problems, states, &settings, workspace);
            for (lane, (problem, state)) in problems.iter().zip(states).enumerate() {
                state.changed = false;
                if !state.solved {
                    side.take_back(lane);
                    side.take_state(lane, &mut workspace.record);
                    state.solved = solved_alone(problem, &settings, workspace, &mut state.report);
                    if state.solved {
                        side.put_state(lane, &workspace.record);
                        state.report.morse_index = morse_index(problem, workspace);
                    }
                }
            }
        }
        states.iter().all(|state| state.solved)
    }

    /// Whether a rod was solved when all were followed last. One that was not has the shape that it had before.
    pub fn is_solved(&self, rod: usize) -> bool {
        self.states[rod].solved
    }

    /// How the last search for a rod's equilibrium went.
    pub fn report(&self, rod: usize) -> &SolveReport {
        &self.states[rod].report
    }

    /// The frames of a rod's nodes.
    pub fn read_poses(&self, rod: usize, poses: &mut Vec<Pose>) {
        self.sides[rod / self.lanes].read_poses(rod % self.lanes, poses);
    }

    /// The equilibrium of a rod: strains, stresses, reactions and energies beside its frames. Of a rod that is not solved: of the shape that it had
    /// before, as the problem is now; where its loads are another rod's, without loads.
    pub fn solution(&mut self, rod: usize) -> Solution {
        let Self { problems, states, lanes, sides, workspace } = self;
        let fits = unfit(&problems[rod], &Settings::default()).is_none();
        let problem = if fits { Cow::Borrowed(&problems[rod]) } else { fitted(&problems[rod]) };
        sides[rod / *lanes].take_state(rod % *lanes, &mut workspace.record);
        finish(&problem, workspace.simd, &mut workspace.record);
        let search = found(&problem, Outcome::Converged, workspace);
        solution(&problem, &search, workspace, states[rod].report.clone())
    }
}

impl State {
    fn look_at(&mut self, problem: &Problem) {
        self.load_size = problem.load_size();
        self.potential = has_potential(problem);
        self.alone = must_be_alone(problem).is_some() || unfit(problem, &Settings::default()).is_some();
    }
}

/// All frames at once, each element by its own equation.
fn all_at_once(settings: &Settings) -> Settings {
    Settings { method: Method::Equilibrium, scheme: Scheme::Element, ..*settings }
}

/// Moves a rod on from the state in the workspace, or else from rest.
fn solved_alone(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> bool {
    if unfit(problem, settings).is_some() {
        return false;
    }
    // What was last solved alone was another rod.
    workspace.nodal.forget();
    let moved = move_on(problem, settings, workspace, report).outcome == Outcome::Converged;
    moved
        || settings.restart_from_rest
            && from_rest(problem, settings, workspace, report).outcome == Outcome::Converged
}

/// Why a rod cannot run beside others.
fn must_be_alone(problem: &Problem) -> Option<&'static str> {
    if problem.rod.order() != Order::Second || problem.rod.diagonal_points().is_none() {
        Some("only elements of order 2 with a law that is diagonal in its strains do")
    } else if problem.supports().any(|(_, support)| support.grip.is_some()) {
        Some("it is held by a grip; hold it by a support")
    } else if !problem.loads.pulls().is_empty() {
        Some("it is pulled towards a point")
    } else {
        None
    }
}

/// Rods in the lanes of registers.
trait Beside: core::fmt::Debug + Send + Sync {
    fn put_loads(&mut self, lane: usize, problem: &Problem);
    fn put_state(&mut self, lane: usize, state: &Record);
    fn take_state(&self, lane: usize, state: &mut Record);
    /// Gives a rod the state back that it had before all were followed last.
    fn take_back(&mut self, lane: usize);
    fn read_poses(&self, lane: usize, poses: &mut Vec<Pose>);
    /// Follows the rods, and marks those that were solved.
    fn follow(
        &mut self,
        problems: &[Problem],
        states: &mut [State],
        settings: &Settings,
        workspace: &mut Workspace,
    );
}

#[derive(Debug)]
struct Side<R> {
    rods: SideBySide<R>,
    /// Of which rods the system was last solved at a solution.
    answers: [bool; MOST_LANES],
}

impl<R: Register> Side<R> {
    fn new(problems: &[Problem]) -> Self {
        Self { rods: SideBySide::new(problems), answers: [false; MOST_LANES] }
    }

    /// Moves the rods on as they answer to how their ends have moved, and puts those between their supports anew that have been changed otherwise
    /// or have moved far.
    fn lead(&mut self, problems: &[Problem], states: &[State], workspace: &mut Workspace) {
        let mut motions = [Vec6::ZERO; MOST_LANES];
        let mut led = [false; MOST_LANES];
        let last = problems[0].rod.elements();
        for (lane, (problem, state)) in problems.iter().zip(states).enumerate() {
            let end = self.rods.pose(lane, last);
            let motion = end.between(&meet(&problem.end, &end)).log();
            let linear = motion.linear * (1.0 / problem.rod.length());
            let small = Vec6::new(motion.angular, linear).max_abs() <= SMALL_MOTION;
            if self.answers[lane] && !state.changed && small {
                (motions[lane], led[lane]) = (motion, true);
            } else {
                self.rods.take_state(lane, &mut workspace.record);
                put_between_supports(problem, &mut workspace.record.poses);
                self.rods.put_state(lane, &workspace.record);
            }
        }
        if led.contains(&true) {
            let moves = R::from_lanes(|lane| f64::from(*of_lane(&led[..problems.len()], lane)));
            self.rods.follow_ends(problems, &motions, moves);
        }
        self.answers = [false; MOST_LANES];
    }
}

impl<R: Register> Beside for Side<R> {
    fn put_loads(&mut self, lane: usize, problem: &Problem) {
        self.rods.put_loads(lane, problem);
    }

    fn put_state(&mut self, lane: usize, state: &Record) {
        self.rods.put_state(lane, state);
        self.answers[lane] = false;
    }

    fn take_back(&mut self, lane: usize) {
        self.rods.take_back(lane);
        self.answers[lane] = false;
    }

    fn take_state(&self, lane: usize, state: &mut Record) {
        self.rods.take_state(lane, state);
    }

    fn read_poses(&self, lane: usize, poses: &mut Vec<Pose>) {
        poses.clear();
        poses.extend(self.rods.poses(lane));
    }

    /// As the search of one rod alone from near an equilibrium, without its ways out of trouble.
    fn follow(
        &mut self,
        problems: &[Problem],
        states: &mut [State],
        settings: &Settings,
        workspace: &mut Workspace,
    ) {
        self.rods.keep();
        self.lead(problems, states, workspace);
        let force = self.rods.largest_force();
        let strength = R::from_lanes(|lane| 1.0 + of_lane(states, lane).load_size + force.number(lane));
        let lent = |residual: f64, lane: usize| {
            warmly_lent(of_lane(problems, lane), strength.number(lane), residual)
        };
        // A rod that drops out stays where it is.
        let mut keeps_up = R::from_lanes(|lane| f64::from(!of_lane(states, lane).alone));
        let mut lends = R::from_lanes(|lane| lent(f64::INFINITY, lane));
        for step in 1..=MOST_STEPS {
            let residual = self.rods.linearise(problems, lends);
            let keeping = |lane: usize| keeps_up.number(lane) > 0.5;
            let there = |lane: usize| residual.number(lane) <= settings.tolerance;
            // The last step is for those alone that are there.
            let near = step == MOST_STEPS || (0..R::LANES).all(|lane| !keeping(lane) || there(lane));
            let goes_on =
                |lane: usize| keeping(lane) && residual.number(lane).is_finite() && (!near || there(lane));
            keeps_up = R::from_lanes(|lane| f64::from(goes_on(lane)));
            let on = states.iter_mut().enumerate().filter(|(lane, _)| keeps_up.number(*lane) > 0.5);
            for (lane, state) in on {
                state.report.residual = residual.number(lane);
                state.report.residual_history.push(residual.number(lane));
                state.report.iterations += usize::from(!near);
                state.report.factorisations += 1;
            }
            if !near {
                lends = R::from_lanes(|lane| lent(residual.number(lane), lane));
                keeps_up = upright(keeps_up, &self.rods.solve(R::zero()));
                self.rods.take(problems, WARM.stride, false, keeps_up);
                continue;
            }
            // Stable against all but round-off.
            let round_off = self.rods.round_off();
            let potential = |lane: usize| of_lane(states, lane).potential;
            let clear =
                R::from_lanes(|lane| clear_of_round_off(round_off.number(lane), strength.number(lane)));
            let against =
                |lane: usize| if potential(lane) { -clear.number(lane) } else { clear.number(lane) };
            let drag = R::from_lanes(against);
            keeps_up = upright(keeps_up, &self.rods.solve(drag));
            let along = self.rods.stiffness_along_step();
            let newtons = |lane: usize| {
                keeps_up.number(lane) < 0.5
                    || potential(lane) && along.number(lane) > MUCH_STIFFER * clear.number(lane)
            };
            if !(0..R::LANES).all(newtons) {
                let drag = strength * R::splat(HARDLY_ANY);
                keeps_up = upright(keeps_up, &self.rods.solve(drag));
                states.iter_mut().for_each(|state| state.report.factorisations += 1);
            }
            // One Newton step more takes what is left down to round-off.
            self.rods.take(problems, WARM.stride, true, keeps_up);
            break;
        }
        for (lane, state) in states.iter_mut().enumerate() {
            state.solved = keeps_up.number(lane) > 0.5;
            state.report.morse_index = if state.solved && state.potential { Some(0) } else { None };
        }
        states.iter().enumerate().for_each(|(lane, state)| self.answers[lane] = state.solved);
    }
}

/// More steps than this are taken alone.
const MOST_STEPS: usize = 20;

/// Which rods keep up: those of which no pivot is negative or vanishes.
fn upright<R: Wide>(keeps_up: R, inertia: &Inertia<R>) -> R {
    R::from_lanes(|lane| {
        let upright = inertia.negative.number(lane) == 0.0 && inertia.vanished.number(lane) == 0.0;
        if upright { keeps_up.number(lane) } else { 0.0 }
    })
}
