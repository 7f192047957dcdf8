//! Moving to rest: the rod is put between its supports somehow, and moves from there, against a drag that fades, to where it rests.
//!
//! A step is one linear solve of the [nodal system](super::nodal), implicit in the motion: with the drag it is a step of an overdamped
//! rod in time, and as the drag fades a Newton step. A step along which the energy would not fall, by the signs of the pivots, is made again
//! against more drag. So where it comes to rest is a stable equilibrium, and from near one it gets there at Newton's rate. At the outset the rod
//! is as long as its supports are far apart; the compliance lent to it fades with its slack.

use super::boundary::{EndState, borne, meet, renormalised};
use super::march::{Record, Section, march};
use super::nodal::{Distance, take_strains};
use super::path::MOST_STEPS;
use super::problem::{Problem, Stretch, Support};
use super::shooting::{Outcome, Search, Workspace};
use super::solution::{Guess, Method, Scheme, Settings, Solution, SolveReport};
use super::stability::{clear_of_round_off, has_potential, strength, way_down};
use crate::element;
use crate::math::{Mat3, Pose, SimdLevel, Strain, Vec3, Vec6, Wrench};
use crate::rod::Order;

/// How a rod is first laid out, and how it may move from there.
pub(super) struct Plan {
    /// By how much it is bent over its length beside its rest shape, rad.
    bend: Vec3,
    /// The drag at first, over `EI/L³`.
    drag: f64,
    /// The compliance against shifts lent to it for each unit of slack, over `L³/EI`.
    lent: f64,
    /// How far, in rad and half lengths, a node may move in one step.
    pub(super) stride: f64,
    /// Steps after which another plan is tried.
    steps: usize,
}

/// The plans, in order. The first finds all but about one in a thousand of rods held at random; which it misses is chance, so that the others
/// differ from it in every way.
const PLANS: [Plan; 6] = [
    Plan { bend: Vec3::ZERO, drag: 3.0, lent: 1e-3, stride: 0.5, steps: 80 },
    Plan { bend: Vec3::new(0.3, 0.2, 0.1), drag: 3.0, lent: 1e-4, stride: 0.5, steps: 100 },
    Plan { bend: Vec3::new(-0.4, 0.5, 0.0), drag: 30.0, lent: 1e-3, stride: 0.25, steps: 150 },
    Plan { bend: Vec3::new(1.0, -1.0, 0.5), drag: 3.0, lent: 3e-4, stride: 0.5, steps: 150 },
    Plan { bend: Vec3::new(-2.0, -1.0, -0.5), drag: 100.0, lent: 1e-3, stride: 0.2, steps: 300 },
    Plan { bend: Vec3::new(2.0, 3.0, 1.0), drag: 10.0, lent: 3e-4, stride: 0.3, steps: 300 },
];
/// From near an equilibrium.
pub(super) const WARM: Plan = Plan { bend: Vec3::ZERO, drag: 0.0, lent: 1e-3, stride: 0.5, steps: 100 };

/// The compliance lent at most, over that for one unit of slack.
const MOST_SLACK: f64 = 3.0;
/// The least that is lent to an element, over `L³/EI`: were it any stiffer, round-off in its stiffness would decide the signs of the pivots.
const LEAST_LENT: f64 = 1e-12;
/// The least that is lent to all, over `L³/EI`, by Newton's method alone, and elsewhere over the [`strength`]: close to where the rod loses its
/// stability round-off is magnified.
const STEADY_LENT: f64 = 1e-7;
/// What a step against the energy's fall takes: this much more drag, and at least this much.
const MORE_DRAG: f64 = 4.0;
const SOME_DRAG: f64 = 1.0;
/// A support that moves less, in rad and lengths, has not moved.
const ROUND_OFF: f64 = 1e-12;
/// A motion up to this is answered linearly.
pub(super) const SMALL_MOTION: f64 = 0.1;
/// More drag than this stops everything.
const MOST_DRAG: f64 = 1e15;
/// Where a rod is stiffer than a drag by more than this, a step against that is as good as Newton's.
pub(super) const MUCH_STIFFER: f64 = 100.0;
/// The drag against which a rod leaves an unstable equilibrium, over what would hold it there.
const HARDLY_HELD: f64 = 1.1;
/// A node moves so little in one step that many are needed: so many are allowed for each iteration that a search may take.
const STEPS_OF_ITERATION: usize = 8;
/// Drag below this is left away: a shift by a tenth of the length would meet less force than a hair's weight.
const LEAST_DRAG: f64 = 1e-3;
/// What is left of it, over the [`strength`], so that a rod that is free to turn as a whole stays where it is.
pub(super) const HARDLY_ANY: f64 = 4e-5;

/// Searches from the rod laid out between its supports by its rest shape; where that is too taut or too heavy for the way there to be smooth,
/// from under less load and with the supports nearer to each other, by degrees.
pub(crate) fn from_rest(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let laid_out = |problem: &Problem, workspace: &mut Workspace, report: &mut SolveReport| {
        laid_out(problem, settings, workspace, report)
    };
    let on = |problem: &Problem, workspace: &mut Workspace, report: &mut SolveReport| {
        from_state(problem, settings, workspace, report)
    };
    let outcome = by_degrees(problem, &Mild::new(problem), settings, laid_out, on, workspace, report);
    found(problem, outcome, workspace)
}

/// Tries the plans, one after the other.
fn laid_out(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    let mut outcome = Outcome::Stalled;
    for plan in &PLANS {
        let bend = plan.bend * (1.0 / problem.rod.length());
        lay_out(problem, |_| bend, &mut workspace.record);
        outcome = relax(problem, settings, plan, workspace, report);
        if outcome == Outcome::Converged {
            break;
        }
    }
    outcome
}

/// Lays the rod out between its supports, bent from its rest shape by a curvature and twist (1/m) that may change along it (`s` over the length).
/// It carries nothing.
pub(crate) fn lay_out(problem: &Problem, bend: impl Fn(f64) -> Vec3, record: &mut Record) {
    bend_from_rest(problem, bend, record);
    put_between_supports(problem, &mut record.poses);
}

/// The same without regard to the supports.
pub(crate) fn bend_from_rest(problem: &Problem, bend: impl Fn(f64) -> Vec3, record: &mut Record) {
    let rod = &problem.rod;
    let nodes = rod.mesh().nodes();
    record.fit(rod.elements());
    record.wrenches.fill(Wrench::ZERO);
    record.poses[0] = rod.description().base;
    for e in 0..rod.elements() {
        record.strains[e] = rod.rest_strains(e);
        let bend = Strain::new(bend(0.5 * (nodes[e] + nodes[e + 1]) / rod.length()), Vec3::ZERO);
        let bent = record.strains[e].map(|strain| strain + bend);
        let relative = Pose::exp(element::exponent(rod.order(), rod.element_length(e), &bent));
        record.poses[e + 1] = record.poses[e].compose(&relative);
    }
}

/// A milder problem, from which to get to a hard one by degrees.
pub(crate) struct Mild {
    /// The part of the loads that acts.
    load: f64,
    /// The stretches between places that are held.
    stretches: Vec<Stretch>,
}

/// Loads beyond this, over `EI/L²`, are hard.
const HARD_LOAD: f64 = 100.0;
/// Less length to spare than this part of the length is hard.
const HARD_SPARE: f64 = 0.05;
/// Less than this is none: the rod has to stretch.
const LEAST_SPARE: f64 = 1e-9;
/// The first step of the way from the mild problem to the hard one, and that below which none is made smaller.
const FIRST_STEP: f64 = 0.25;
const SMALLEST_STEP: f64 = 1e-3;

impl Mild {
    pub fn new(problem: &Problem) -> Self {
        let load = (HARD_LOAD / problem.load_size()).min(1.0);
        Self { load, stretches: problem.stretches() }
    }

    /// Whether the problem itself is mild.
    fn is_it(&self) -> bool {
        self.load >= 1.0 && self.stretches.iter().all(|stretch| stretch.spare() >= HARD_SPARE)
    }

    /// The problem at a place on the way from the mild to the hard one. The loads change by equal factors in equal steps, and
    /// so does what there is to spare, where the hard problem has any.
    fn set(&self, problem: &Problem, at: f64, family: &mut Problem) {
        let load = self.load.powf(1.0 - at);
        family.loads.set_scaled(&problem.loads, load);
        let mut beyond = Vec3::ZERO;
        for stretch in &self.stretches {
            let hard = stretch.spare();
            let mild = 2.0 * HARD_SPARE;
            if at < 1.0 && hard < mild {
                let spare = if hard > LEAST_SPARE {
                    mild.powf(1.0 - at) * hard.powf(at)
                } else {
                    mild + (hard - mild) * at
                };
                beyond -= stretch.chord * (1.0 - (1.0 - spare) / (1.0 - hard));
            }
            if let (Some(whole), Some(now)) = (problem.support(stretch.to), family.support_mut(stretch.to)) {
                now.pose.position = whole.pose.position + beyond;
            }
        }
    }
}

/// Walks from the milder problem, searched for from the rod laid out, to the hard one, each step from the state that the one before has left.
/// Where a step fails for good, that state is left: what the rod bears there is true, and what a failed search leaves behind may be anything.
pub(crate) fn by_degrees(
    problem: &Problem,
    mild: &Mild,
    settings: &Settings,
    laid_out: impl Fn(&Problem, &mut Workspace, &mut SolveReport) -> Outcome,
    on: impl Fn(&Problem, &mut Workspace, &mut SolveReport) -> Outcome,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    if mild.is_it() {
        return laid_out(problem, workspace, report);
    }
    let mut family = problem.clone();
    mild.set(problem, 0.0, &mut family);
    let mut outcome = laid_out(&family, workspace, report);
    if outcome != Outcome::Converged {
        return outcome;
    }
    let (mut at, mut step) = (0.0, FIRST_STEP);
    let smallest = SMALLEST_STEP.max(settings.halved(FIRST_STEP));
    let most = report.path_steps + MOST_STEPS;
    let mut reached = workspace.record.clone();
    while outcome == Outcome::Converged && at < 1.0 {
        let next = f64::min(at + step, 1.0);
        mild.set(problem, next, &mut family);
        report.path_steps += 1;
        outcome = on(&family, workspace, report);
        if outcome == Outcome::Converged {
            (at, step) = (next, 1.5 * step);
            reached.clone_from(&workspace.record);
        } else {
            workspace.record.clone_from(&reached);
            if step <= smallest {
                return outcome;
            }
            step *= 0.4;
            outcome = Outcome::Converged;
        }
        if report.path_steps >= most && at < 1.0 {
            return Outcome::Stalled;
        }
    }
    outcome
}

/// Searches from a solution, with the supports where they are now: from the state in the workspace where that is it, and elsewhere from what a
/// march from its end makes of it.
pub(crate) fn from_guess(
    problem: &Problem,
    settings: &Settings,
    guess: &Guess,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    if !is_known(guess, problem, workspace) {
        return from_rest(problem, settings, workspace, report);
    }
    put_guess(guess, problem, workspace, report);
    move_on(problem, settings, workspace, report)
}

/// Whether the state that a guess stands for is at hand: what supports between the ends bear, and how pulls act, is not in the guess itself.
pub(crate) fn is_known(guess: &Guess, problem: &Problem, workspace: &Workspace) -> bool {
    problem.can_be_shot() || holds_state_of(guess, problem, &workspace.record)
}

/// Puts the state that a guess stands for into the workspace, where it is not there yet: what a march from the guess makes.
pub(crate) fn put_guess(
    guess: &Guess,
    problem: &Problem,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) {
    if holds_state_of(guess, problem, &workspace.record) {
        return;
    }
    let end = Section { pose: guess.pose, wrench: guess.wrench };
    march(workspace.simd, &problem.rod, Scheme::Element, &problem.loads, end, &mut workspace.record);
    report.sweeps += 1;
}

/// Moves on from the state in the workspace, put between the supports where they are now.
fn from_state(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    if !led_by_end(problem, workspace) {
        put_between_supports(problem, &mut workspace.record.poses);
    }
    relax(problem, settings, &WARM, workspace, report)
}

/// Where nothing but the held end has moved, and that little, moves the rod on as it answers to that. Gives whether it did.
fn led_by_end(problem: &Problem, workspace: &mut Workspace) -> bool {
    let Workspace { record, nodal, simd, .. } = workspace;
    let last = problem.rod.elements();
    if !nodal.is_of(record) || !problem.end.fixed.contains(&true) {
        return false;
    }
    let motion = |node: usize, support: &Support| {
        record.poses[node].between(&meet(support, &record.poses[node])).log()
    };
    let size =
        |motion: Vec6| Vec6::new(motion.angular, motion.linear * (1.0 / problem.rod.length())).max_abs();
    let mut others = problem.supports().take_while(|(node, _)| *node < last);
    let by = motion(last, &problem.end);
    if !others.all(|(node, support)| size(motion(node, support)) < ROUND_OFF) || size(by) > SMALL_MOTION {
        return false;
    }
    nodal.step_with_end(&record.poses[last], by);
    nodal.take(problem, *simd, 1.0, record);
    true
}

/// Searches by Newton's method alone for the equilibrium nearest to the state in the workspace, stable or not.
pub(crate) fn nearest(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let Workspace { record, nodal, simd, .. } = &mut *workspace;
    let simd = *simd;
    let mut outcome = Outcome::Stalled;
    let lend = WARM.lent / (1.0 + problem.load_size());
    let lent = |residual: f64| lent_for(lend, residual, STEADY_LENT);
    // From close by little is lent from the first step on.
    let first = nodal.linearise(problem, simd, lent(MOST_SLACK), record);
    let mut residual = first.map_or(f64::NAN, |distance| distance.residual());
    for _ in 0..settings.max_iterations {
        if note(nodal.linearise(problem, simd, lent(residual), record), report).is_none() {
            outcome = Outcome::NotFinite;
            break;
        }
        residual = report.residual;
        report.factorisations += 1;
        let solved = nodal.solve(simd, 0.0).is_some();
        if residual <= settings.tolerance {
            // One step more costs little and takes what is left down to round-off.
            if solved && nodal.step_size() <= WARM.stride {
                nodal.take(problem, simd, 1.0, record);
            }
            finish(problem, simd, record);
            outcome = Outcome::Converged;
            break;
        }
        if !solved {
            outcome = Outcome::Singular;
            break;
        }
        report.iterations += 1;
        nodal.take(problem, simd, (WARM.stride / nodal.step_size()).min(1.0), record);
    }
    found(problem, outcome, workspace)
}

/// Puts a residual on record; `None` where it is not finite.
fn note(distance: Option<Distance>, report: &mut SolveReport) -> Option<Distance> {
    report.residual = distance.map_or(f64::NAN, |distance| distance.residual());
    report.residual_history.push(report.residual);
    distance.filter(|_| report.residual.is_finite())
}

/// Whether a record is of the solution that a guess comes from.
fn holds_state_of(guess: &Guess, problem: &Problem, record: &Record) -> bool {
    let n = problem.rod.elements();
    if record.wrenches.len() != n {
        return false;
    }
    let scale = problem.rod.scale();
    let (pose, wrench) = (guess.pose.between(&record.poses[n]), guess.wrench - record.wrenches[n - 1]);
    let apart = (pose.rotation - Mat3::IDENTITY).max_abs()
        + pose.position.max_abs() / scale.length
        + wrench.angular.max_abs() / scale.moment
        + wrench.linear.max_abs() / scale.force;
    apart < 1e-6 * (1.0 + guess.wrench.linear.max_abs() / scale.force)
}

/// Puts a chain of frames between the supports: the best held of these is met by moving the whole, and what the others miss is spread evenly
/// over the rod between.
pub(crate) fn put_between_supports(problem: &Problem, poses: &mut [Pose]) {
    let fixed = |(_, end): &(usize, &Support)| end.fixed.iter().filter(|fixed| **fixed).count();
    let anchor = problem.supports().fold(None, |best, hold| match best {
        Some(best) if fixed(&best) >= fixed(&hold) => Some(best),
        _ => Some(hold),
    });
    let Some((anchor, end)) = anchor else { return };
    let moved = meet(end, &poses[anchor]).compose(&poses[anchor].inverse());
    poses.iter_mut().for_each(|pose| *pose = moved.compose(pose));
    let nodes = problem.rod.mesh().nodes();
    let held = |end: &Support| end.fixed.contains(&true);
    let mut spread = |from: usize, to: usize, end: &Support| {
        // The rod beyond goes along.
        let miss = poses[to].between(&meet(end, &poses[to])).log();
        let before = poses[to];
        let (low, high) = (from.min(to), from.max(to));
        for i in low..=high {
            let part = ((nodes[i] - nodes[from]) / (nodes[to] - nodes[from])).abs();
            poses[i] = poses[i].compose(&Pose::exp(miss * part));
        }
        let moved = poses[to].compose(&before.inverse());
        let beyond = if to > from { to + 1..poses.len() } else { 0..to };
        poses[beyond].iter_mut().for_each(|pose| *pose = moved.compose(pose));
    };
    let mut last = anchor;
    for (node, end) in problem.supports().filter(|(node, end)| *node > anchor && held(end)) {
        spread(last, node, end);
        last = node;
    }
    last = anchor;
    for (node, end) in problem.supports().rev().filter(|(node, end)| *node < anchor && held(end)) {
        spread(last, node, end);
        last = node;
    }
}

/// Puts the state of a solution of the problem's rod and loads into the workspace: frames, strains, and the wrenches that the elements carry.
pub(crate) fn recall(problem: &Problem, solution: &Solution, record: &mut Record) {
    let last = problem.rod.elements() - 1;
    record.fit(last + 1);
    record.poses.copy_from_slice(&solution.poses);
    record.strains.iter_mut().zip(&solution.strain).for_each(|(points, mean)| *points = [*mean; 2]);
    record.wrenches[last] = solution.guess.wrench;
    // The first reaction is the start's.
    let borne = solution.reactions[1..].iter();
    let mut held = problem.between.iter().zip(borne).rev().peekable();
    for e in (0..last).rev() {
        let node = e + 1;
        let mut carried = record.carried_with_loads(node, &problem.loads);
        if let Some((_, reaction)) = held.next_if(|((at, _), _)| *at == node) {
            carried +=
                Wrench::new(reaction.moment, reaction.force).turned_back_by(&record.poses[node].rotation);
        }
        record.wrenches[e] = carried;
    }
}

/// Lets the rod move on from the state in the workspace to where it rests.
pub(crate) fn move_on(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let outcome = from_state(problem, settings, workspace, report);
    found(problem, outcome, workspace)
}

/// Moves the rod from the state in the workspace to rest, as one that has just been laid out.
pub(crate) fn fall(
    problem: &Problem,
    settings: &Settings,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let outcome = relax(problem, settings, &PLANS[0], workspace, report);
    found(problem, outcome, workspace)
}

/// Moves the rod from the state in the workspace to rest.
fn relax(
    problem: &Problem,
    settings: &Settings,
    plan: &Plan,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Outcome {
    report.method = Method::Equilibrium;
    let Workspace { record, nodal, variation, simd, .. } = workspace;
    let simd = *simd;
    // Where the loads are larger than what bends the rod, forces are of their size.
    let strength = strength(problem, record);
    let lend = plan.lent / strength;
    let (mut drag, mut lent) = (plan.drag * strength, lend * MOST_SLACK);
    let potential = has_potential(problem);
    let mut last = f64::INFINITY;
    for _ in 0..plan.steps.min(settings.max_iterations.saturating_mul(STEPS_OF_ITERATION)) {
        if note(nodal.linearise(problem, simd, lent, record), report).is_none() {
            return Outcome::NotFinite;
        }
        let residual = report.residual;
        if residual <= settings.tolerance {
            // It may rest only because nothing pushes it off a ridge.
            let clear = clear_of_round_off(nodal.round_off(), strength);
            report.factorisations += 1;
            let sure = nodal.solve(simd, if potential { -clear } else { clear }) == Some(0);
            let down = if sure { None } else { way_down(problem, simd, nodal, variation, record) };
            let Some(down) = down else {
                // One Newton step more costs little and takes what is left down to round-off.
                let newtons = sure && potential && nodal.stiffness_along_step() > MUCH_STIFFER * clear;
                report.factorisations += usize::from(!newtons);
                let solved = newtons || nodal.solve(simd, HARDLY_ANY * strength) == Some(0);
                if solved && nodal.step_size() <= plan.stride {
                    nodal.take(problem, simd, 1.0, record);
                }
                finish(problem, simd, record);
                return Outcome::Converged;
            };
            drag = (-HARDLY_HELD * down.slope).max(SOME_DRAG);
            nodal.step_along(record, &down.motion, plan.stride);
            nodal.take(problem, simd, 1.0, record);
            last = f64::INFINITY;
            continue;
        }
        lent = lent_for(lend, residual, least_lent(problem, strength));
        loop {
            report.factorisations += 1;
            match nodal.solve(simd, drag) {
                Some(0) => break,
                _ if drag > MOST_DRAG => return Outcome::Stalled,
                _ => {
                    // It may be round-off.
                    let clear = clear_of_round_off(nodal.round_off(), strength);
                    drag = if drag < clear { clear } else { (drag * MORE_DRAG).max(SOME_DRAG * strength) };
                }
            }
        }
        report.iterations += 1;
        let size = nodal.step_size();
        if !size.is_finite() {
            return Outcome::NotFinite;
        }
        nodal.take(problem, simd, (plan.stride / size).min(1.0), record);
        drag = if size > 2.0 * plan.stride {
            // Hardly resisted: the time step was too long.
            (2.0 * drag).max(0.1 * SOME_DRAG * strength)
        } else if size > 0.5 * plan.stride {
            0.7 * drag
        } else {
            0.3 * (residual / last).clamp(0.1, 1.0) * drag
        };
        if drag < LEAST_DRAG * strength {
            drag = HARDLY_ANY * strength;
        }
        last = residual;
    }
    Outcome::Stalled
}

/// What is lent by [`WARM`] to all elements of a rod of that strength.
pub(super) fn warmly_lent(problem: &Problem, strength: f64, residual: f64) -> f64 {
    lent_for(WARM.lent / strength, residual, least_lent(problem, strength))
}

/// What is lent by so much for a unit of slack.
fn lent_for(lend: f64, residual: f64, least: f64) -> f64 {
    (lend * residual.min(MOST_SLACK)).max(least)
}

/// The least that is lent to all elements together.
fn least_lent(problem: &Problem, strength: f64) -> f64 {
    (LEAST_LENT * problem.rod.elements() as f64).max(STEADY_LENT / strength)
}

/// Balances the nodes, and gives the elements the strains that belong to what they carry, so that what is not free is as it must be to the
/// last bit.
pub(crate) fn finish(problem: &Problem, simd: SimdLevel, record: &mut Record) {
    let rod = &problem.rod;
    balance(problem, record);
    // The strains of a general element are solved for already.
    if let (Order::Second, Some(points)) = (rod.order(), rod.diagonal_points()) {
        take_strains(rod, points, simd, record);
    }
}

/// Carries the wrench at the end through all elements, so that force and moment balance to round-off at every node.
pub(crate) fn balance(problem: &Problem, record: &mut Record) {
    record.poses.iter_mut().for_each(|pose| pose.rotation = renormalised(pose.rotation));
    // What the end leaves free bears its loads to the last bit.
    let last = problem.rod.elements() - 1;
    let end = EndState::from_guess(problem, &Guess::new(record.poses[last + 1], record.wrenches[last]));
    record.wrenches[last] = end.section(problem).wrench;
    for e in (0..last).rev() {
        let node = e + 1;
        let pose = &record.poses[node];
        let mut balanced = record.carried_with_loads(node, &problem.loads);
        if let Some(support) = problem.support(node) {
            if let Some(grip) = &support.grip {
                balanced += grip.wrench(pose).turned_back_by(&pose.rotation);
            }
            // What is still out of balance is the support's, as far as it can bear it.
            let rest = (record.wrenches[e] - balanced).turned_by(&pose.rotation);
            balanced += borne(support, pose, rest).turned_back_by(&pose.rotation);
        }
        record.wrenches[e] = balanced;
    }
}

/// The state in the workspace as one that shooting can go on from.
pub(crate) fn found(problem: &Problem, outcome: Outcome, workspace: &Workspace) -> Search {
    let record = &workspace.record;
    let n = problem.rod.elements();
    let guess = Guess::new(record.poses[n], record.wrenches[n - 1]);
    Search {
        state: EndState::from_guess(problem, &guess),
        start: Section { pose: record.poses[0], wrench: record.carried_beyond(0) },
        outcome,
        inverse: None,
    }
}
