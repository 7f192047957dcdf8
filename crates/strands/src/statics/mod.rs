//! Static equilibrium of one rod held at its ends.
//!
//! [`solve`] finds it. The standard boundary value problem of the paper (one end clamped, the wrench at the other given) is two
//! sweeps when the loads follow the rod; with dead loads, whose direction in the material frame depends on how the end is turned, and
//! with a prescribed end, it is a search for what is unknown at the end: [`Method::Shooting`].
//!
//! Many rods of one kind are followed side by side in vector lanes by a [`Batch`].

mod almost_block_diagonal;
mod batch;
mod boundary;
mod chain;
mod continuation;
mod equilibrium;
mod fit;
mod march;
mod multiple_shooting;
mod nodal;
mod path;
mod plan;
mod problem;
mod refine;
mod search;
mod shooting;
mod solution;
mod stability;
mod sweep;
mod variation;

pub use batch::{Batch, BatchError};
pub(crate) use boundary::meet;
pub use continuation::{Event, EventKind, Path, PathEnd, PathError, PathPoint, PathSettings, follow_path};
pub(crate) use march::Record;
pub(crate) use nodal::{Coupled, Inertial, Motion, Network, Nodal, Slopes, Touch, TouchEnd};
pub use plan::{Plan, plan};
pub use problem::{Problem, Stretch, Support};
pub use refine::{RefineError, Refined, refine};
pub use search::{MOST_ALIKE, SearchSettings, equilibria};
pub use shooting::Workspace;
pub use solution::{
    Energy, FailureReason, Guess, Jacobian, Method, Reaction, Scheme, Settings, Solution, SolveFailure,
    SolveReport,
};
pub(crate) use stability::rigid_compliance;
pub use stability::{UnstableMode, unstable_mode};

use crate::math::{Pose, Vec3, Vec6, Wrench};
use crate::rod::{Kinematics, Order, Rod};
use boundary::{EndState, loaded_start};
use plan::Way;
use shooting::{Outcome, Search, shoot};

/// Finds an equilibrium of a problem, starting from a guess (the last frame's solution) or from rest.
///
/// # Errors
/// Where none was found: why, with the nearest state.
pub fn solve(
    problem: &Problem,
    settings: &Settings,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
) -> Result<Solution, SolveFailure> {
    let mut report = SolveReport::default();
    if let Some(reason) = refused(problem, settings) {
        return Err(not_tried(problem, reason, guess, workspace, report));
    }
    let search = find(problem, settings, guess, workspace, &mut report);
    concluded(problem, settings, &search, workspace, report)
}

/// What a search has come to.
fn concluded(
    problem: &Problem,
    settings: &Settings,
    search: &Search,
    workspace: &mut Workspace,
    mut report: SolveReport,
) -> Result<Solution, SolveFailure> {
    report.morse_index =
        if search.outcome == Outcome::Converged { stability::morse_index(problem, workspace) } else { None };
    let reason = match search.outcome {
        Outcome::Converged => {
            let found = solution(problem, search, workspace, report);
            if found.is_finite() {
                return Ok(found);
            }
            report = found.report;
            FailureReason::NotFinite { node: first_bad_node(workspace) }
        }
        Outcome::Singular => FailureReason::Singular,
        Outcome::NotFinite => FailureReason::NotFinite { node: first_bad_node(workspace) },
        Outcome::Stalled => {
            too_coarse(problem, workspace).unwrap_or_else(|| stalled(settings, workspace, &report))
        }
    };
    Err(failure(problem, search, reason, workspace, report))
}

/// Finds by Newton's method alone the equilibrium nearest to a guess (the last problem's solution), or to the rod at rest, put between its
/// supports: stable or not, where [`solve`] moves away from one that is not. So a branch is followed past where it loses its stability, which
/// [`SolveReport::morse_index`] counts.
///
/// From the last problem's solution it starts with all that the workspace still has of it; from another guess, with a march from the end. What the
/// supports between the ends bear is not in a guess: of a rod so held the workspace must be the last problem's.
///
/// # Errors
/// Where there is none near: why, with the nearest state. Where the elements derive from no energy (order 1).
pub fn nearest(
    problem: &Problem,
    settings: &Settings,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
) -> Result<Solution, SolveFailure> {
    let settings = Settings { method: Method::Equilibrium, ..*settings };
    let mut report = SolveReport::default();
    if let Some(reason) = refused(problem, &settings) {
        return Err(not_tried(problem, reason, guess, workspace, report));
    }
    report.restart(Method::Equilibrium);
    match guess {
        Some(guess) => {
            equilibrium::put_guess(guess, problem, workspace, &mut report);
            equilibrium::put_between_supports(problem, &mut workspace.record.poses);
        }
        None => equilibrium::lay_out(problem, |_| Vec3::ZERO, &mut workspace.record),
    }
    let search = equilibrium::nearest(problem, &settings, workspace, &mut report);
    concluded(problem, &settings, &search, workspace, report)
}

/// Lets a rod move on from a solution of it, its supports where they are now, to where it comes to rest: down in energy, as a thread does that
/// has lost its stability, and only to a stable equilibrium. What [`follow`] cannot follow, at a fold, ends here.
///
/// # Errors
/// Where it did not come to rest: why, with the nearest state. Where the elements derive from no energy (order 1).
pub fn rest_from(
    problem: &Problem,
    settings: &Settings,
    last: &Solution,
    workspace: &mut Workspace,
) -> Result<Solution, SolveFailure> {
    let settings = Settings { method: Method::Equilibrium, ..*settings };
    let mut report = SolveReport::default();
    if let Some(reason) = refused(problem, &settings) {
        return Err(not_tried(problem, reason, Some(&last.guess), workspace, report));
    }
    report.restart(Method::Equilibrium);
    let search = if recall(problem, last, workspace) {
        equilibrium::move_on(problem, &settings, workspace, &mut report)
    } else {
        equilibrium::from_rest(problem, &settings, workspace, &mut report)
    };
    concluded(problem, &settings, &search, workspace, report)
}

/// Puts a solution back into a workspace that has been used for something else since, what the supports between the ends bear too, which no guess
/// holds. Gives whether it is one of this rod, held at as many places.
pub fn recall(problem: &Problem, solution: &Solution, workspace: &mut Workspace) -> bool {
    let fits = solution.poses.len() == problem.rod.elements() + 1
        && solution.reactions.len() == problem.between.len() + 2;
    if fits {
        equilibrium::recall(problem, solution, &mut workspace.record);
    }
    fits
}

/// One frame of an interactive loop: searches from the last solution for the one next to it. Nothing is allocated once the workspace and the
/// report have been used for the rod; the frames are in [`Workspace::poses`].
///
/// Where the search fails the guess stays as it was, and [`solve`] can still find a way, or say why there is none.
pub fn follow(
    problem: &Problem,
    settings: &Settings,
    guess: &mut Guess,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> bool {
    report.restart(Method::Shooting);
    if fit::unfit(problem, settings).is_some() {
        return false;
    }
    let search = if settings.method == Method::MultipleShooting {
        multiple_shooting::from_guess(problem, settings, guess, workspace, report)
    } else if all_at_once(problem, settings, guess) {
        equilibrium::from_guess(problem, settings, guess, workspace, report)
    } else {
        let state = EndState::from_guess(problem, guess);
        shoot(problem, settings, state, guess.inverse, workspace, report)
    };
    let converged = search.outcome == Outcome::Converged;
    if converged {
        *guess = search.guess(problem);
    }
    converged
}

/// Takes the way that [`plan`] chooses: two sweeps where they suffice; from a guess a search by shooting where that keeps its digits, and all
/// frames at once where not; and from rest. Where shooting from a guess does not get there, multiple shooting is tried, then all frames at once,
/// then all of it from rest.
fn find(
    problem: &Problem,
    settings: &Settings,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let plan = plan(problem, settings, guess);
    let sweeps = plan.method == Method::Sweep;
    report.method = if sweeps { Method::Sweep } else { Method::Shooting };
    report.path_steps = 1;
    if plan.way == Way::TwoSweeps {
        return sweep::two_sweeps(problem, settings, workspace, report);
    }
    if let Some(guess) = guess {
        let search = from_guess(problem, settings, guess, plan.way, workspace, report);
        if search.outcome == Outcome::Converged || !settings.restart_from_rest {
            return search;
        }
    }
    from_rest(problem, settings, workspace, report)
}

/// Beyond this many of the lengths `ℓ = √(EI/T)` over which a rod under the tension `T` bends, shooting has lost its digits: it loses a
/// factor `exp(L/ℓ)`.
const LONGEST_SHOT: f64 = 18.0;

/// Whether shooting is out of place: for the wrench of a guess, or by what was asked for.
fn all_at_once(problem: &Problem, settings: &Settings, guess: &Guess) -> bool {
    let tension = guess.wrench.linear.z.max(0.0) / problem.rod.scale().force + problem.load_size();
    let taut = tension > LONGEST_SHOT * LONGEST_SHOT;
    settings.method == Method::Equilibrium
        || !problem.can_be_shot()
        || settings.method == Method::Auto && has_energy(problem, settings) && is_held(problem) && taut
}

/// Whether the elements derive from an energy, so that the rod can move down it. Euler's and the multistep scheme do not.
fn has_energy(problem: &Problem, settings: &Settings) -> bool {
    settings.scheme == Scheme::Element && problem.rod.order() != Order::First
}

fn from_guess(
    problem: &Problem,
    settings: &Settings,
    guess: &Guess,
    way: Way,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    match way {
        Way::Settle => return by_moving(problem, settings, workspace, report),
        Way::Move => return equilibrium::from_guess(problem, settings, guess, workspace, report),
        Way::Segments => return multiple_shooting::from_guess(problem, settings, guess, workspace, report),
        _ => {}
    }
    let state = EndState::from_guess(problem, guess);
    let search = shoot(problem, settings, state, guess.inverse, workspace, report);
    if search.outcome == Outcome::Converged {
        return search;
    }
    if settings.method == Method::Auto && has_energy(problem, settings) && is_held(problem) {
        let search = multiple_shooting::from_guess(problem, settings, guess, workspace, report);
        let found = search.outcome == Outcome::Converged;
        if found && stability::morse_index(problem, workspace).unwrap_or(0) == 0 {
            return search;
        }
        return equilibrium::from_guess(problem, settings, guess, workspace, report);
    }
    path::from_solution(shoot, problem, guess, settings, workspace, report)
}

/// Whether the rod is held by more than its clamped start.
fn is_held(problem: &Problem) -> bool {
    problem.end.fixed[3..].contains(&true) || problem.start.fixed != [true; 6] || !problem.between.is_empty()
}

fn from_rest(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    match plan(problem, settings, None).way {
        Way::Settle => return by_moving_or_else(problem, settings, workspace, report),
        Way::Segments => return multiple_shooting::from_rest(problem, settings, workspace, report),
        _ => {}
    }
    // One that hangs free from its clamp is loaded little by little, so that of many equilibria it finds the one on the path of loads.
    let search = by_shooting(problem, settings, workspace, report);
    if search.outcome == Outcome::Converged || settings.method != Method::Auto {
        return search;
    }
    by_moving_or_else(problem, settings, workspace, report)
}

/// Lets the rod move to where it rests, and where it does not come to rest tries what else there is: multiple shooting, for an equilibrium, stable or
/// not, under loads that follow it and may keep it moving, and where it is taut; and of a rod that cannot stretch, from where it rests if it can.
fn by_moving_or_else(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let moved = by_moving(problem, settings, workspace, report);
    let given_up = moved.outcome != Outcome::Converged && settings.method == Method::Auto;
    if !given_up || settings.scheme != Scheme::Element || !has_energy(problem, settings) {
        return moved;
    }
    let (record, residual) = (workspace.record.clone(), report.residual);
    if problem.can_be_shot() {
        let shot = multiple_shooting::from_rest(problem, settings, workspace, report);
        if shot.outcome == Outcome::Converged {
            return shot;
        }
    }
    if let Some(twin) = problem.that_stretches() {
        let rests = equilibrium::from_rest(&twin, settings, workspace, report);
        if rests.outcome == Outcome::Converged {
            let stiffened = equilibrium::move_on(problem, settings, workspace, report);
            if stiffened.outcome == Outcome::Converged {
                return stiffened;
            }
        }
    }
    // What the rod came to is nearer to an equilibrium than what came of these.
    workspace.record = record;
    (report.residual, report.method) = (residual, Method::Equilibrium);
    moved
}

/// Lets the rod move to where it rests. A scheme without an energy starts from where one with an energy does.
fn by_moving(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    if has_energy(problem, settings) {
        return equilibrium::from_rest(problem, settings, workspace, report);
    }
    let twin = problem.of_second_order();
    let rests = equilibrium::from_rest(&twin, settings, workspace, report);
    if settings.scheme == Scheme::Element {
        return equilibrium::nearest(problem, settings, workspace, report);
    }
    report.method = Method::Shooting;
    let state = EndState::from_guess(problem, &rests.guess(&twin));
    shoot(problem, settings, state, None, workspace, report)
}

/// Walks from rest; where the end's place is prescribed, tries the sides to buckle to until the equilibrium found is stable.
fn by_shooting(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    if !problem.end.fixed[3..].contains(&true) {
        return path::from_rest(shoot, problem, settings, Vec3::ZERO, workspace, report);
    }
    let mut best: Option<Search> = None;
    for nudge in path::nudges(problem) {
        let search = path::from_rest(shoot, problem, settings, nudge, workspace, report);
        let converged = search.outcome == Outcome::Converged;
        if converged && stability::morse_index(problem, workspace).unwrap_or(0) == 0 {
            return search;
        }
        if best.is_none_or(|best| best.outcome != Outcome::Converged && converged) {
            best = Some(search);
        }
    }
    // No way led to a stable one: the first that converged, evaluated again so that its march is on record.
    let best = best.unwrap_or_else(|| unreachable!("there are four sides"));
    shoot(problem, settings, best.state.moved(problem), best.inverse, workspace, report)
}

/// Why a problem is not even tried.
fn refused(problem: &Problem, settings: &Settings) -> Option<FailureReason> {
    if let Some(reason) = fit::unfit(problem, settings) {
        return Some(reason);
    }
    if settings.method == Method::Equilibrium && !has_energy(problem, settings) {
        return Some(FailureReason::NoEnergy);
    }
    if settings.method == Method::Sweep
        && let Some(what) = sweep::not_standard(problem)
    {
        return Some(FailureReason::NotStandard { what });
    }
    let nodes = problem.rod.mesh().nodes();
    let Stretch { from, to, chord, length } = problem.out_of_reach()?;
    Some(FailureReason::OutOfReach { distance: chord.norm(), length, from: nodes[from], to: nodes[to] })
}

/// That a search did not come to its tolerance, by the last residual that was a number.
fn stalled(settings: &Settings, workspace: &Workspace, report: &SolveReport) -> FailureReason {
    let Some(residual) = report.residual_history.iter().rev().find(|residual| residual.is_finite()) else {
        return FailureReason::NotFinite { node: first_bad_node(workspace) };
    };
    FailureReason::NotConverged {
        residual: *residual,
        tolerance: settings.tolerance,
        iterations: report.iterations,
    }
}

/// The length `√(EI/T)` over which a rod under a tension bends, m.
fn bending_length(rod: &Rod, tension: f64) -> f64 {
    let scale = rod.scale();
    scale.length * (scale.force / tension).sqrt()
}

/// Whether the tension in the last state bends the rod over less than its elements' length.
fn too_coarse(problem: &Problem, workspace: &Workspace) -> Option<FailureReason> {
    let rod = &problem.rod;
    let longest = (0..rod.elements()).map(|e| rod.element_length(e)).fold(0.0, f64::max);
    let tension = workspace.record.largest_force();
    let (length, bending_length) = (rod.length(), bending_length(rod, tension));
    let needed = (2.0 * length / bending_length).ceil();
    // A search that has gone wild leaves any tension behind.
    (bending_length < longest && needed <= MOST_NEEDED).then_some(FailureReason::TooCoarse {
        tension,
        bending_length,
        element_length: longest,
        needed: (needed as usize).min(MOST_FINER * rod.elements()),
    })
}

/// More elements than this are not advised.
const MOST_NEEDED: f64 = 1e5;
/// Nor more times those that there are: the tension on long elements says little.
const MOST_FINER: usize = 4;

/// The failure of a problem that is not tried: the guess, or the rod at rest, with its residual.
fn not_tried(
    problem: &Problem,
    reason: FailureReason,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
    mut report: SolveReport,
) -> SolveFailure {
    let problem = fit::fitted(problem);
    let guess = guess.copied().unwrap_or_else(|| path::rest(&problem));
    let state = EndState::from_guess(&problem, &guess);
    let only_look = Settings { max_iterations: 0, ..Settings::default() };
    report.method = Method::Shooting;
    let search = shoot(&problem, &only_look, state, None, workspace, &mut report);
    failure(&problem, &search, reason, workspace, report)
}

fn failure(
    problem: &Problem,
    search: &Search,
    reason: FailureReason,
    workspace: &mut Workspace,
    report: SolveReport,
) -> SolveFailure {
    let mut nearest = solution(problem, search, workspace, report);
    if !nearest.is_finite() {
        // What has overflowed is nothing to look at: the rod as it is laid out before a search.
        equilibrium::lay_out(problem, |_| Vec3::ZERO, &mut workspace.record);
        let laid_out = equilibrium::found(problem, Outcome::Stalled, workspace);
        nearest = solution(problem, &laid_out, workspace, nearest.report);
    }
    SolveFailure { reason, nearest: Box::new(nearest) }
}

fn first_bad_node(workspace: &Workspace) -> usize {
    workspace.record.poses.iter().rposition(|pose| !pose.is_finite()).unwrap_or(0)
}

/// Reads a solution off the recorded march.
fn solution(problem: &Problem, search: &Search, workspace: &Workspace, report: SolveReport) -> Solution {
    let rod = &problem.rod;
    let record = &workspace.record;
    let mean = |f: &dyn Fn(usize) -> Vec6, points: usize| {
        (0..points).fold(Vec6::ZERO, |sum, i| sum + f(i)) * (1.0 / points as f64)
    };
    let mut elastic = 0.0;
    let (mut strain, mut stress) = (Vec::with_capacity(rod.elements()), Vec::with_capacity(rod.elements()));
    for (e, strains) in record.strains.iter().enumerate() {
        let points = rod.points(e);
        let elastic_strain = |i: usize| strains[i] - points[i].rest;
        elastic += rod.element_length(e)
            * (0..points.len()).map(|i| points[i].law.energy(elastic_strain(i))).sum::<f64>()
            / points.len() as f64;
        strain.push(mean(&|i| strains[i], points.len()));
        stress.push(match rod.kinematics() {
            Kinematics::Cosserat => mean(&|i| points[i].law.stress(elastic_strain(i)), points.len()),
            // The force is what holds the constraint: the wrench that the element carries, in its mean frame.
            Kinematics::Kirchhoff => {
                let carried = crate::element::mean_wrench(
                    crate::element::exponent(rod.order(), rod.element_length(e), strains),
                    record.wrenches[e],
                );
                let bent = mean(&|i| points[i].law.stress(elastic_strain(i)), points.len());
                Vec6::new(bent.angular, carried.linear)
            }
        });
    }
    let load = problem.loads.energy(&record.poses);
    let start = loaded_start(problem, &search.start);
    let at_start = Reaction {
        s: 0.0,
        force: start.pose.rotation * start.wrench.linear * -1.0,
        moment: start.pose.rotation * start.wrench.angular * -1.0,
    };
    let between = problem.between.iter().map(|(node, _)| reaction_between(problem, record, *node));
    let held = search.state.reaction(problem);
    let at_end = Reaction { s: rod.length(), force: held.linear, moment: held.angular };
    Solution {
        poses: record.poses.clone(),
        strain,
        stress,
        reactions: [at_start].into_iter().chain(between).chain([at_end]).collect(),
        energy: Energy { elastic, load },
        guess: search.guess(problem),
        report,
    }
}

/// What holds a node between the ends: the jump of the wrench that the rod carries, without the loads.
fn reaction_between(problem: &Problem, record: &Record, node: usize) -> Reaction {
    let pose = &record.poses[node];
    let held = record.wrenches[node - 1] - record.carried_with_loads(node, &problem.loads);
    Reaction {
        s: problem.rod.mesh().nodes()[node],
        force: pose.rotation * held.linear,
        moment: pose.rotation * held.angular,
    }
}

impl Solution {
    /// Whether all its numbers are numbers.
    pub fn is_finite(&self) -> bool {
        let held = |reaction: &Reaction| reaction.force.is_finite() && reaction.moment.is_finite();
        self.poses.iter().all(Pose::is_finite)
            && self.strain.iter().chain(&self.stress).all(|strain| strain.is_finite())
            && self.reactions.iter().all(held)
            && self.energy.total().is_finite()
    }

    /// What holds the start.
    pub fn start_reaction(&self) -> &Reaction {
        &self.reactions[0]
    }

    /// What holds the end.
    pub fn end_reaction(&self) -> &Reaction {
        &self.reactions[self.reactions.len() - 1]
    }

    /// How far force and moment are from balance, over the largest force and moment that act: the supports' reactions and every load,
    /// moments about the world's origin, those of the forces' levers too, and of that force across the rod's length. Round-off, whatever the
    /// number of elements.
    pub fn imbalance(&self, problem: &Problem) -> f64 {
        let loads = &problem.loads;
        // Over the largest number of all, so that no square overflows.
        let given = loads.world.iter().chain(&loads.body).map(|load| load.max_abs());
        let pulled = loads.pulls().iter().map(|pull| pull.tension.abs());
        let borne = self.reactions.iter().map(|held| Wrench::new(held.moment, held.force).max_abs());
        let largest = given.chain(pulled).chain(borne).fold(f64::MIN_POSITIVE, f64::max);
        let (mut force, mut moment) = (Vec3::ZERO, Vec3::ZERO);
        let (mut force_size, mut moment_size) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
        let mut add = |f: Vec3, m: Vec3, at: Vec3| {
            let (f, m) = (f * (1.0 / largest), m * (1.0 / largest));
            let lever = at.cross(f);
            force += f;
            moment += m + lever;
            force_size = force_size.max(f.norm());
            // The two apart: together they vanish where the line of the force passes through the origin.
            moment_size = moment_size.max(m.norm()).max(lever.norm());
        };
        for (i, pose) in self.poses.iter().enumerate() {
            let (world, body) = (loads.in_world(i, pose.position), loads.body[i]);
            add(world.linear, world.angular, pose.position);
            add(pose.rotation * body.linear, pose.rotation * body.angular, pose.position);
        }
        for (reaction, (node, _)) in self.reactions.iter().zip(problem.supports()) {
            add(reaction.force, reaction.moment, self.poses[node].position);
        }
        // Forces that all lie on one line through the origin have no lever there.
        moment_size = moment_size.max(force_size * problem.rod.length());
        (force.norm() / force_size).max(moment.norm() / moment_size)
    }
}

#[cfg(test)]
mod tests;
