//! Continuation: the whole path of equilibria along which a parameter changes, round its folds, with the places where it branches.
//!
//! The path is followed by its pseudo-arclength (Keller 1977): a step along its tangent, then Newton's method on the
//! [nodal system](super::nodal) with one equation more, that the corrections be normal to the tangent, and one unknown more, the parameter. So a
//! fold, where the parameter turns back, is a place as any other. A step's length is that of the motion of all nodes (root mean square of turns in
//! rad and of shifts over half the length) and of the parameter together. At a fold the parameter's part of the tangent changes its sign;
//! where the number of negative pivots changes and it does not, the path branches.

use super::boundary::meet;
use super::equilibrium::{finish, found};
use super::march::Record;
use super::nodal::Nodal;
use super::problem::Problem;
use super::shooting::{Outcome, Workspace};
use super::solution::{Method, Settings, Solution, SolveFailure, SolveReport};
use super::stability::{morse_index, rigid_compliance, strength};
use super::{bending_length, fit, solution, solve};
use crate::math::{SimdLevel, Vec6, Wrench};
use crate::rod::Order;
use thiserror::Error;

/// How to follow a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// How to solve at each point.
    pub solver: Settings,
    /// The longest step: of the parameter, which runs from 0 to 1, or of the nodes.
    pub largest_step: f64,
    /// After so many points it stops.
    pub most_points: usize,
    /// At which of the bifurcations, from 0, to go over to the other branch. `None` stays on the first.
    pub switch_at: Option<usize>,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self { solver: Settings::default(), largest_step: 0.05, most_points: 2000, switch_at: None }
    }
}

/// A path.
#[derive(Clone, Debug)]
pub struct Path {
    /// Its points, in order.
    pub points: Vec<PathPoint>,
    /// Its folds and bifurcations, in order.
    pub events: Vec<Event>,
    /// Why it ends where it does.
    pub end: PathEnd,
}

/// A point of a path.
#[derive(Clone, Debug)]
pub struct PathPoint {
    /// The parameter, from 0 to 1.
    pub at: f64,
    /// The equilibrium.
    pub solution: Solution,
}

/// What happens on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// What.
    pub kind: EventKind,
    /// The parameter there.
    pub at: f64,
    /// How many points of the path lie before it.
    pub after_points: usize,
    /// How many ways to lower the energy there are before and after it. `None` where the loads have no potential.
    pub morse_index: [Option<usize>; 2],
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The parameter turns back: beyond it there is no equilibrium nearby.
    Fold,
    /// Another branch crosses.
    Bifurcation,
}

/// Why a path ends.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEnd {
    /// The parameter has reached 1.
    Reached,
    /// It has come back to 0.
    Returned,
    /// So many points were asked for at most.
    MostPoints,
    /// No further point was found, however short the step.
    Stuck {
        /// Why the last try failed.
        why: String,
    },
}

/// Why there is no path.
#[derive(Debug, Error)]
pub enum PathError<E> {
    /// The problem at its start could not be made.
    #[error(transparent)]
    Problem(E),
    /// There is no equilibrium where it starts.
    #[error(transparent)]
    Start(#[from] SolveFailure),
}

/// The parameter's step for differences.
const DIFFERENCE: f64 = 1e-6;
/// The same on elements of order 4. A support that is shifted by it stretches one element, whose equation is not linear in its slack as that of order 2
/// is: with longer steps the tangents on either side differ.
const DIFFERENCE_OF_FOURTH_ORDER: f64 = 1e-8;
/// Iterations that a point may take; after more, the step was too long.
const MOST_ITERATIONS: usize = 12;
/// A point that takes no more is a reason for a longer step.
const ENOUGH_ITERATIONS: usize = 6;
/// And so is one whose first correction turns (rad) and shifts (over half the length) no node by more, however many follow: a rod that is stiff against
/// stretching takes seven for the smallest step.
const SMALL_CORRECTION: f64 = 0.01;
/// The largest turn (rad) or shift (over half the length) of a node in one step.
const LARGEST_MOTION: f64 = 0.25;
/// The tangent may turn so far in one step (cosine): further, it is another branch's.
const LEAST_COSINE: f64 = 0.85;
/// Steps shorter than this part of the longest are none.
const SHORTEST_STEP: f64 = 1e-7;
/// Halvings by which a fold or a bifurcation is found.
const HALVINGS: usize = 36;
/// How often a step with several events is halved to tell them apart.
const SPLITS: usize = 12;
/// So many stabilities may change at one place, with room: two do where a rod is round.
const MOST_AT_ONCE: usize = 6;
/// A step that is shorter than this part of the longest and has more is at an infinite tension.
const SHORTEST_TO_LEAP: f64 = 1e-3;
/// A path creeps in steps that are shorter than this part of the longest, and after so many of them in a row it is left.
const CREEPING: f64 = 1e-3;
const MOST_CREPT: usize = 60;
/// Iterations for a critical mode.
const MODE_ITERATIONS: usize = 6;

/// Follows the path of a family of problems, all on meshes of as many elements, from the equilibrium that [`solve`] finds for the parameter 0
/// to the parameter 1.
///
/// # Errors
/// Where the family or the solver has nothing to start from. What goes wrong later ends the path, and [`Path::end`] says so.
pub fn follow_path<E: core::fmt::Display>(
    mut family: impl FnMut(f64) -> Result<Problem, E>,
    settings: &PathSettings,
    workspace: &mut Workspace,
) -> Result<Path, PathError<E>> {
    let problem = family(0.0).map_err(PathError::Problem)?;
    let first = solve(&problem, &settings.solver, None, workspace)?;
    let mut family = |at: f64| family(at).map_err(|error| error.to_string());
    let mut follower = Follower { family: &mut family, settings, workspace, scratch: Nodal::default() };
    let start = match follower.refined(0.0, &first.report) {
        Ok(start) => start,
        Err(why) => {
            let points = vec![PathPoint { at: 0.0, solution: first }];
            return Ok(Path { points, events: Vec::new(), end: PathEnd::Stuck { why } });
        }
    };
    Ok(follower.follow(start))
}

/// The same from the equilibrium in the workspace, of the parameter 0. The last point's state is left there. `None` where there is no way from it.
pub(crate) fn follow_from(
    mut family: impl FnMut(f64) -> Result<Problem, String>,
    settings: &PathSettings,
    workspace: &mut Workspace,
) -> Option<Path> {
    let mut follower = Follower { family: &mut family, settings, workspace, scratch: Nodal::default() };
    let start = follower.refined(0.0, &SolveReport::default()).ok()?;
    Some(follower.follow(start))
}

/// A point of the path as the follower needs it.
#[derive(Clone)]
struct Point {
    at: f64,
    problem: Problem,
    record: Record,
    report: SolveReport,
    /// The first correction of what was predicted: how far it moved a node.
    correction: f64,
    /// The system there, its other solution the change of the state with the parameter (or with the way along a mode).
    nodal: Nodal,
    tangent: Tangent,
    /// Whether the number of negative pivots is odd: the sign of the determinant.
    odd: bool,
    index: Option<usize>,
}

/// The direction of a path, of length one.
#[derive(Clone, Default)]
struct Tangent {
    /// Motions of the nodes.
    motions: Vec<Vec6>,
    /// The parameter's part.
    parameter: f64,
    /// How many of the other solutions it holds.
    others: f64,
}

impl Tangent {
    /// Only the parameter: what is normal to it keeps the parameter.
    fn of_parameter() -> Self {
        Self { motions: Vec::new(), parameter: 1.0, others: 0.0 }
    }

    /// The product with motions (by a step of a system) and a change of the parameter.
    fn product(&self, steps: &[Vec6], parameter: f64) -> f64 {
        let sum: f64 = self.motions.iter().zip(steps).map(|(a, step)| inner(*a, *step)).sum();
        sum / steps.len() as f64 + self.parameter * parameter
    }

    fn cosine(&self, other: &Self) -> f64 {
        let sum: f64 = self.motions.iter().zip(&other.motions).map(|(a, b)| inner(*a, *b)).sum();
        sum / self.motions.len().max(1) as f64 + self.parameter * other.parameter
    }
}

/// What ends a path at an infinite tension.
const STRAIGHT: &str =
    "the rod is pulled straight, and its tension grows without bound: beyond lies what it cannot reach";

/// Whether a rod is so taut that it bends over less than an element.
fn is_straight(here: &Point) -> bool {
    let rod = &here.problem.rod;
    bending_length(rod, here.record.largest_force()) * (rod.elements() as f64) < rod.length()
}

/// Whether more stabilities change than a path can lose at once: from an infinite tension a step leads to an infinite pressure.
fn leaps(here: &Point, next: &Point) -> bool {
    matches!((here.index, next.index), (Some(a), Some(b)) if a.abs_diff(b) > MOST_AT_ONCE)
}

fn inner(a: Vec6, b: Vec6) -> f64 {
    a.angular.dot(b.angular) + 4.0 * a.linear.dot(b.linear)
}

struct Follower<'a> {
    family: &'a mut dyn FnMut(f64) -> Result<Problem, String>,
    settings: &'a PathSettings,
    workspace: &'a mut Workspace,
    scratch: Nodal,
}

impl Follower<'_> {
    fn follow(&mut self, start: Point) -> Path {
        let mut path =
            Path { points: vec![self.shown(&start)], events: Vec::new(), end: PathEnd::MostPoints };
        let mut here = start;
        let (mut step, mut bifurcations) = (0.2 * self.settings.largest_step, 0);
        let mut crept = 0;
        while path.points.len() < self.settings.most_points {
            step = step.min(self.longest_step(&here));
            let (next, taken) = match self.step_adapted(&here, step) {
                Ok(found) => found,
                Err(why) => {
                    let why = if is_straight(&here) { STRAIGHT.into() } else { why };
                    path.end = PathEnd::Stuck { why };
                    break;
                }
            };
            let over = next.at > 1.0 || next.at < 0.0;
            let next = if over {
                let target = if next.at > 1.0 { 1.0 } else { 0.0 };
                match self.at_value(&here, target) {
                    Ok(last) => last,
                    Err(why) => {
                        path.end = PathEnd::Stuck { why };
                        break;
                    }
                }
            } else {
                next
            };
            let mut switched = None;
            for (event, before) in self.events_between(&here, &next, taken, path.points.len(), SPLITS) {
                path.events.push(event);
                if event.kind == EventKind::Bifurcation {
                    if self.settings.switch_at == Some(bifurcations) {
                        switched = self.switched(&before);
                    }
                    bifurcations += 1;
                }
                if switched.is_some() {
                    break;
                }
            }
            if let Some(switched) = switched {
                path.points.push(self.shown(&switched));
                here = switched;
                step = 0.2 * self.settings.largest_step;
                continue;
            }
            path.points.push(self.shown(&next));
            if over {
                path.end = if next.at > 0.5 { PathEnd::Reached } else { PathEnd::Returned };
                break;
            }
            let easy = next.report.iterations <= ENOUGH_ITERATIONS || next.correction <= SMALL_CORRECTION;
            crept = if taken < CREEPING * self.settings.largest_step { crept + 1 } else { 0 };
            if crept == MOST_CREPT {
                let why = "it goes on in steps that are hardly any, as where the rod is pulled straight between its supports and what is asked is out of its reach";
                path.end = PathEnd::Stuck { why: why.into() };
                break;
            }
            step = taken * if easy { 1.5 } else { 0.8 };
            here = next;
        }
        path
    }

    /// As long as the parameter and the nodes may move at once.
    fn longest_step(&self, here: &Point) -> f64 {
        let fastest = here.tangent.motions.iter().map(|m| m.angular.norm().max(2.0 * m.linear.norm()));
        let fastest = fastest.fold(0.0, f64::max);
        let largest = self.settings.largest_step;
        (LARGEST_MOTION / fastest).min(largest / here.tangent.parameter.abs().max(0.1))
    }

    /// A step along the path, made shorter until it succeeds. Gives also how long it was.
    fn step_adapted(&mut self, here: &Point, step: f64) -> Result<(Point, f64), String> {
        let mut step = step;
        loop {
            match self.step(here, step) {
                Ok(next) if leaps(here, &next) => {
                    if step < SHORTEST_TO_LEAP * self.settings.largest_step {
                        return Err(STRAIGHT.into());
                    }
                    step *= 0.5;
                }
                Ok(next) if next.tangent.cosine(&here.tangent) >= LEAST_COSINE => return Ok((next, step)),
                Ok(_) if step < SHORTEST_STEP * self.settings.largest_step => {
                    return Err("the path turns sharply".into());
                }
                Err(why) if step < SHORTEST_STEP * self.settings.largest_step => return Err(why),
                _ => step *= 0.5,
            }
        }
    }

    /// The point a step along the path.
    fn step(&mut self, here: &Point, step: f64) -> Result<Point, String> {
        let at = here.at + step * here.tangent.parameter;
        let mut ahead = here.nodal.clone();
        ahead.step_is_other(step * here.tangent.others);
        self.corrected(here, ahead, at, &here.tangent, &here.tangent)
    }

    /// The point of the path where the parameter has a value, from one nearby.
    fn at_value(&mut self, here: &Point, at: f64) -> Result<Point, String> {
        let mut ahead = here.nodal.clone();
        let part = (at - here.at) / here.tangent.parameter;
        ahead.step_is_other(part * here.tangent.others);
        self.corrected(here, ahead, at, &Tangent::of_parameter(), &here.tangent)
    }

    /// The equilibrium of the workspace's record, with what the follower needs.
    fn refined(&mut self, at: f64, report: &SolveReport) -> Result<Point, String> {
        let problem = (self.family)(at)?;
        let record = self.workspace.record.clone();
        let forwards = Tangent::of_parameter();
        self.converged(at, problem, record, report.clone(), 0.0, &forwards)
    }

    /// Newton's method from a predicted state: the corrections are normal to `normal`.
    fn corrected(
        &mut self,
        here: &Point,
        ahead: Nodal,
        at: f64,
        normal: &Tangent,
        before: &Tangent,
    ) -> Result<Point, String> {
        let level = self.workspace.simd;
        let mut at = at;
        let mut problem = self.problem(at, here)?;
        let mut record = here.record.clone();
        ahead.take(&problem, level, 1.0, &mut record);
        let mut nodal = ahead;
        let mut correction = 0.0;
        let mut report = SolveReport { method: Method::Equilibrium, path_steps: 1, ..SolveReport::default() };
        loop {
            let lent = rigid_compliance(strength(&problem, &record));
            let distance = nodal.linearise(&problem, level, lent, &mut record);
            let residual = distance.map_or(f64::NAN, |distance| distance.residual());
            report.residual = residual;
            report.residual_history.push(residual);
            if !residual.is_finite() {
                return Err("the numbers overflowed".into());
            }
            if residual <= self.settings.solver.tolerance {
                return self.converged(at, problem, record, report, correction, before);
            }
            if report.iterations >= MOST_ITERATIONS {
                return Err(format!("the residual stays at {residual:.1e}"));
            }
            self.differentiate(at, &problem, lent, level, &record, &mut nodal)?;
            report.factorisations += 1;
            if nodal.solve(level, 0.0).is_none() {
                return Err("the system is singular".into());
            }
            let slope = normal.product(&nodal.other_steps, 1.0);
            let change = -normal.product(&nodal.steps, 0.0) / slope;
            nodal.add_other(change);
            let size = nodal.step_size();
            if !(change.is_finite() && size < 2.0 * LARGEST_MOTION) {
                return Err("a correction is larger than the step".into());
            }
            if report.iterations == 0 {
                correction = size;
            }
            at += change;
            problem = self.problem(at, here)?;
            nodal.take(&problem, level, 1.0, &mut record);
            report.iterations += 1;
        }
    }

    /// The problem at a value of the parameter, if it is one that can be compared with the last.
    fn problem(&mut self, at: f64, here: &Point) -> Result<Problem, String> {
        let problem = (self.family)(at)?;
        if problem.rod.elements() != here.problem.rod.elements() {
            return Err("the number of elements changes along the path".into());
        }
        match fit::unfit(&problem, &self.settings.solver) {
            Some(reason) => Err(reason.to_string()),
            None => Ok(problem),
        }
    }

    /// Sets the other right-hand side to the change with the parameter.
    fn differentiate(
        &mut self,
        at: f64,
        problem: &Problem,
        lent: f64,
        level: SimdLevel,
        record: &Record,
        nodal: &mut Nodal,
    ) -> Result<(), String> {
        // Towards the inside, beyond which the family may not exist.
        let fourth = problem.rod.order() == Order::Fourth;
        let step = if fourth { DIFFERENCE_OF_FOURTH_ORDER } else { DIFFERENCE };
        let step = if at > 0.5 { -step } else { step };
        let there = (self.family)(at + step)?;
        if there.rod.elements() != problem.rod.elements() {
            return Err("the number of elements changes along the path".into());
        }
        let mut moved = record.clone();
        for (node, support) in there.supports() {
            moved.poses[node] = meet(support, &moved.poses[node]);
        }
        nodal
            .linearise_towards(&there, level, (lent, step), &mut moved, &mut self.scratch)
            .ok_or_else(|| "an element's law has no solution".into())
    }

    /// Completes a point whose state is an equilibrium: its tangent, in the direction of the one before, and its index.
    fn converged(
        &mut self,
        at: f64,
        problem: Problem,
        mut record: Record,
        report: SolveReport,
        correction: f64,
        before: &Tangent,
    ) -> Result<Point, String> {
        let level = self.workspace.simd;
        finish(&problem, level, &mut record);
        let mut nodal = Nodal::default();
        let lent = rigid_compliance(strength(&problem, &record));
        nodal.linearise(&problem, level, lent, &mut record).ok_or("an element's law has no solution")?;
        self.differentiate(at, &problem, lent, level, &record, &mut nodal)?;
        let negative = nodal.solve(level, 0.0).ok_or("the system is singular")?;
        let tangent = tangent(&nodal, 1.0, before).ok_or("the system is singular")?;
        self.workspace.record.clone_from(&record);
        let index = morse_index(&problem, self.workspace);
        Ok(Point { at, problem, record, report, correction, nodal, tangent, odd: negative % 2 == 1, index })
    }

    /// The folds and bifurcations between two points of a path, each with the point just before it. A step with several is split.
    fn events_between(
        &mut self,
        here: &Point,
        next: &Point,
        step: f64,
        points: usize,
        splits: usize,
    ) -> Vec<(Event, Point)> {
        let turns = |a: &Point| a.tangent.parameter.signum() != here.tangent.parameter.signum();
        let changes = |a: &Point| a.index != here.index || a.index.is_none() && a.odd != here.odd;
        let kind = match (turns(next), changes(next)) {
            (true, _) => EventKind::Fold,
            (false, true) => EventKind::Bifurcation,
            (false, false) => return Vec::new(),
        };
        let one = match (here.index, next.index) {
            (Some(a), Some(b)) => a.abs_diff(b) == 1,
            _ => here.odd != next.odd,
        };
        if !one
            && splits > 0
            && let Ok(middle) = self.step(here, 0.5 * step)
        {
            let mut events = self.events_between(here, &middle, 0.5 * step, points, splits - 1);
            events.extend(self.events_between(&middle, next, 0.5 * step, points, splits - 1));
            return events;
        }
        let beyond = |a: &Point| if kind == EventKind::Fold { turns(a) } else { changes(a) };
        let (mut before, mut low, mut high) = (here.clone(), 0.0, step);
        let mut at = next.at;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            // Where the path is hardest to follow the last halvings may fail: then the place is as exact as it gets.
            let Ok(point) = self.step(here, middle) else { break };
            at = point.at;
            if beyond(&point) {
                high = middle;
            } else {
                (low, before) = (middle, point);
            }
            if high - low < 1e-12 * (1.0 + step) {
                break;
            }
        }
        let event = Event { kind, at, after_points: points, morse_index: [here.index, next.index] };
        vec![(event, before)]
    }

    /// Goes over to the other branch at a bifurcation: along the mode that is critical there.
    fn switched(&mut self, at: &Point) -> Option<Point> {
        let level = self.workspace.simd;
        let mut nodal = at.nodal.clone();
        let n = at.problem.rod.elements();
        // A start that has no symmetry, then inverse iteration.
        let askew = |i: usize| {
            let s = i as f64 / n as f64;
            Wrench::from([0.53, -0.41, 0.37, 0.61, 0.47, 0.29].map(|x| x * (1.0 + s) / (n + 1) as f64))
        };
        let mut forces: Vec<Wrench> = (0..=n).map(askew).collect();
        let mut mode = Tangent::default();
        for _ in 0..MODE_ITERATIONS {
            nodal.act_with(forces.iter().copied());
            nodal.solve(level, 0.0)?;
            mode = tangent(&nodal, 0.0, &mode)?;
            // What is along the path is not the mode.
            for (i, force) in forces.iter_mut().enumerate() {
                let step = nodal.other_steps[i] * (1.0 / (n + 1) as f64);
                *force = step * mode.others;
            }
        }
        let mut step = 0.2 * self.settings.largest_step;
        for _ in 0..8 {
            let mut ahead = nodal.clone();
            ahead.step_is_other(step * mode.others);
            if let Ok(mut point) = self.corrected(at, ahead, at.at, &mode, &mode) {
                // Away from where it came from.
                if point.tangent.cosine(&mode) < 0.0 {
                    point.tangent = tangent(&point.nodal, 1.0, &mode)?;
                }
                return Some(point);
            }
            step *= 2.0;
        }
        None
    }

    fn shown(&mut self, point: &Point) -> PathPoint {
        self.workspace.record.clone_from(&point.record);
        let search = found(&point.problem, Outcome::Converged, self.workspace);
        let report = SolveReport { morse_index: point.index, ..point.report.clone() };
        PathPoint { at: point.at, solution: solution(&point.problem, &search, self.workspace, report) }
    }
}

/// The tangent by the other solution of a system and a change of the parameter by `parameter`, in the direction of the one before.
fn tangent(nodal: &Nodal, parameter: f64, before: &Tangent) -> Option<Tangent> {
    let motions = nodal.other_steps.clone();
    let square: f64 = motions.iter().map(|m| inner(*m, *m)).sum::<f64>() / motions.len() as f64;
    let length = (square + parameter * parameter).sqrt();
    if !(length.is_finite() && length > 0.0) {
        return None;
    }
    let mut tangent = Tangent { motions, parameter, others: 1.0 };
    let sign = if tangent.cosine(before) < 0.0 { -1.0 } else { 1.0 };
    let scale = sign / length;
    tangent.motions.iter_mut().for_each(|motion| *motion = *motion * scale);
    (tangent.parameter, tangent.others) = (tangent.parameter * scale, scale);
    Some(tangent)
}
