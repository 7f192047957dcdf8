//! Shooting: Newton's method on the six unknowns of the rod's end, with a backtracking line search (paper, section 4).
//!
//! An evaluation is one [`march`]. The Jacobian is formed where the search starts and wherever the last one has stopped paying; between, it is
//! kept up by Broyden's update, which costs nothing beside a march.

use super::boundary::{EndState, residual, residual_slope, unknown_scale};
use super::march::{Record, Section, march, march_lanes};
use super::multiple_shooting::MultipleShooting;
use super::nodal::{Nodal, SecondVariation};
use super::problem::Problem;
use super::solution::{Guess, Jacobian, Scheme, Settings, SolveReport};
use super::variation::vary;
use crate::math::{Lanes, Mat3, Pose, SimdLevel, Vec3, Vec6, largest, lu};

/// A step that gains less than this factor asks for a new Jacobian.
const WORTHWHILE: f64 = 0.1;
/// A line search that would cut the step below this has failed.
const SMALLEST_STEP: f64 = 1.0 / 1024.0;
/// The largest turn that one step may make, rad.
const LARGEST_TURN: f64 = 1.0;

/// Scratch of the solvers: made once, reused by every solve of any rod; the only thing that allocates.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The march of the accepted state.
    pub(crate) record: Record,
    trial: Record,
    pub(crate) nodal: Nodal,
    pub(crate) variation: SecondVariation,
    pub(crate) multiple: MultipleShooting,
    /// The vector instructions that the kernels use.
    pub simd: SimdLevel,
}

impl Default for Workspace {
    fn default() -> Self {
        Self {
            record: Record::default(),
            trial: Record::default(),
            nodal: Nodal::default(),
            variation: SecondVariation::default(),
            multiple: MultipleShooting::default(),
            simd: SimdLevel::detect(),
        }
    }
}

impl Workspace {
    /// The frames of the nodes after the last search or march.
    pub fn poses(&self) -> &[Pose] {
        &self.record.poses
    }
}

/// Where a search ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    pub state: EndState,
    pub start: Section,
    pub outcome: Outcome,
    /// The inverse Jacobian that it ended with.
    pub inverse: Option<Inverse>,
}

impl Search {
    /// What the next search starts from.
    pub fn guess(&self, problem: &Problem) -> Guess {
        let section = self.state.section(problem);
        Guess { inverse: self.inverse, ..Guess::new(section.pose, section.wrench) }
    }
}

/// The inverse of the Jacobian of the residual by the unknowns, each over its scale.
pub(crate) type Inverse = [[f64; 6]; 6];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Converged,
    Stalled,
    Singular,
    NotFinite,
}

/// Where the inverse Jacobian at hand comes from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// A search before this one.
    Inherited,
    /// Formed where the search is.
    Fresh,
    /// Kept up since.
    Updated,
}

/// One evaluated state.
#[derive(Clone, Copy)]
struct Point {
    state: EndState,
    start: Section,
    residual: [f64; 6],
}

/// Searches from a state, with the inverse Jacobian of a search nearby where there is one. Adds to the report what it does; the accepted march
/// is left in the workspace's record.
pub(crate) fn shoot(
    problem: &Problem,
    settings: &Settings,
    state: EndState,
    mut inverse: Option<Inverse>,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Search {
    let scheme = settings.scheme;
    let scale = unknown_scale(&problem.end, &problem.rod.scale());
    let mut point = evaluate(problem, scheme, state, workspace, report, false);
    let ended =
        |point: &Point, outcome, inverse| Search { state: point.state, start: point.start, outcome, inverse };
    note(report, &point);
    if !norm(&point.residual).is_finite() {
        return ended(&point, Outcome::NotFinite, None);
    }
    let mut origin = Origin::Inherited;
    for _ in 0..settings.max_iterations {
        if largest(&point.residual) <= settings.tolerance {
            return ended(&point, Outcome::Converged, inverse);
        }
        let usable = match inverse {
            Some(usable) => usable,
            None => {
                let slope = jacobian(problem, scheme, settings.jacobian, &point, workspace, report);
                let Some(new) = slope.and_then(|slope| invert(&slope, &scale)) else {
                    return ended(&point, Outcome::Singular, None);
                };
                origin = Origin::Fresh;
                new
            }
        };
        let step = limited(problem, negative_product(&usable, &point.residual));
        match line_search(problem, scheme, &point, &step, &scale, origin, workspace, report) {
            Some((next, part)) => {
                report.iterations += 1;
                let gain = norm(&next.residual) / norm(&point.residual);
                inverse = (gain <= WORTHWHILE)
                    .then(|| broyden(usable, &step.map(|x| x * part), &point.residual, &next.residual))
                    .flatten();
                origin = Origin::Updated;
                point = next;
                note(report, &point);
            }
            None if origin == Origin::Fresh => return ended(&point, Outcome::Stalled, None),
            None => inverse = None,
        }
    }
    let outcome =
        if largest(&point.residual) <= settings.tolerance { Outcome::Converged } else { Outcome::Stalled };
    ended(&point, outcome, inverse)
}

fn note(report: &mut SolveReport, point: &Point) {
    report.residual = largest(&point.residual);
    report.residual_history.push(report.residual);
}

fn evaluate(
    problem: &Problem,
    scheme: Scheme,
    state: EndState,
    workspace: &mut Workspace,
    report: &mut SolveReport,
    trial: bool,
) -> Point {
    let record = if trial { &mut workspace.trial } else { &mut workspace.record };
    let end = state.section(problem);
    let start = march(workspace.simd, &problem.rod, scheme, &problem.loads, end, record);
    report.sweeps += 1;
    Point { state, start, residual: residual(problem, &start) }
}

/// Halves the step until the residual falls (Armijo). Without a fresh Jacobian it does not insist, and an inherited one must serve well: it
/// may be of another problem altogether. Gives the point and the part of
/// the step taken.
#[expect(clippy::too_many_arguments, reason = "the parts of one Newton step, used here alone")]
fn line_search(
    problem: &Problem,
    scheme: Scheme,
    point: &Point,
    step: &[f64; 6],
    scale: &[f64; 6],
    origin: Origin,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Option<(Point, f64)> {
    let before = norm(&point.residual);
    let mut part = 1.0;
    while part >= SMALLEST_STEP {
        let taken = core::array::from_fn(|i| part * step[i] * scale[i]);
        let next = evaluate(problem, scheme, point.state.stepped(problem, &taken), workspace, report, true);
        let after = norm(&next.residual);
        let enough = if origin == Origin::Inherited { WORTHWHILE } else { 1.0 - 1e-4 * part };
        if after <= enough * before {
            core::mem::swap(&mut workspace.record, &mut workspace.trial);
            return Some((next, part));
        }
        if origin != Origin::Fresh {
            return None;
        }
        report.line_search_cuts += 1;
        // The minimum of the parabola through the two norms and the slope at the point, kept within a tenth and a half.
        let parabola = if after.is_finite() {
            0.5 / (1.0 + (after * after / (before * before) - 1.0) / 2.0)
        } else {
            0.1
        };
        part *= parabola.clamp(0.1, 0.5);
    }
    None
}

/// The scaled step without the part that would turn the end further than one radian at once.
fn limited(problem: &Problem, mut step: [f64; 6]) -> [f64; 6] {
    let turn = (0..3).filter(|i| !problem.end.fixed[*i]).fold(0.0_f64, |max, i| max.max(step[i].abs()));
    if turn > LARGEST_TURN {
        step.iter_mut().for_each(|x| *x *= LARGEST_TURN / turn);
    }
    step
}

/// The Jacobian of the residual by the unknowns, `[row][column]`.
fn jacobian(
    problem: &Problem,
    scheme: Scheme,
    how: Jacobian,
    point: &Point,
    workspace: &mut Workspace,
    report: &mut SolveReport,
) -> Option<[[f64; 6]; 6]> {
    report.jacobians += 1;
    let in_lanes = how == Jacobian::VariationalLanes;
    match how {
        Jacobian::Variational | Jacobian::VariationalLanes => {
            let columns = point.state.columns(problem);
            let at_start =
                vary(workspace.simd, &problem.rod, &problem.loads, &workspace.record, &columns, in_lanes)?;
            Some(residual_slope(problem, &point.start, &at_start))
        }
        Jacobian::FiniteDifferences => {
            let perturbed = |k| {
                evaluate(problem, scheme, perturbed(problem, point, k).0, workspace, report, true).residual
            };
            Some(differences(problem, point, core::array::from_fn(perturbed)))
        }
        Jacobian::FiniteDifferenceLanes => {
            let sections: [Section; 6] =
                core::array::from_fn(|k| perturbed(problem, point, k).0.section(problem));
            let lane = |i: usize| &sections[i.min(5)];
            let gather = |pick: &dyn Fn(&Section) -> Vec3| {
                let part = |axis: usize| Lanes::<8>::from_fn(|i| pick(lane(i))[axis]);
                Vec3::new(part(0), part(1), part(2))
            };
            let rotation = Mat3 { cols: core::array::from_fn(|c| gather(&|s| s.pose.rotation.cols[c])) };
            let end = Section {
                pose: Pose { rotation, position: gather(&|s| s.pose.position) },
                wrench: Vec6::new(gather(&|s| s.wrench.angular), gather(&|s| s.wrench.linear)),
            };
            let Some(out) = march_lanes(workspace.simd, &problem.rod, scheme, &problem.loads, end) else {
                return jacobian(problem, scheme, Jacobian::FiniteDifferences, point, workspace, report);
            };
            report.sweeps += 1;
            let pick = |v: Vec3<Lanes<8>>, i: usize| Vec3::new(v.x.0[i], v.y.0[i], v.z.0[i]);
            let residuals = core::array::from_fn(|i| {
                let rotation = Mat3 { cols: core::array::from_fn(|c| pick(out.pose.rotation.cols[c], i)) };
                let start = Section {
                    pose: Pose { rotation, position: pick(out.pose.position, i) },
                    wrench: Vec6::new(pick(out.wrench.angular, i), pick(out.wrench.linear, i)),
                };
                residual(problem, &start)
            });
            Some(differences(problem, point, residuals))
        }
    }
}

/// How far an unknown is moved for a difference, as a part of its scale: the square root of round-off.
const DIFFERENCE_STEP: f64 = 1.5e-8;

fn perturbed(problem: &Problem, point: &Point, k: usize) -> (EndState, f64) {
    let step = DIFFERENCE_STEP * unknown_scale(&problem.end, &problem.rod.scale())[k];
    let mut steps = [0.0; 6];
    steps[k] = step;
    (point.state.stepped(problem, &steps), step)
}

fn differences(problem: &Problem, point: &Point, residuals: [[f64; 6]; 6]) -> [[f64; 6]; 6] {
    let scale = unknown_scale(&problem.end, &problem.rod.scale());
    core::array::from_fn(|i| {
        core::array::from_fn(|k| (residuals[k][i] - point.residual[i]) / (DIFFERENCE_STEP * scale[k]))
    })
}

/// The inverse of the Jacobian by the scaled unknowns.
fn invert(slope: &[[f64; 6]; 6], scale: &[f64; 6]) -> Option<Inverse> {
    let factors = lu::<6>(core::array::from_fn(|i| core::array::from_fn(|k| slope[i][k] * scale[k])))?;
    let mut inverse = [[0.0; 6]; 6];
    for k in 0..6 {
        let column = factors.solve(&core::array::from_fn(|i| f64::from(u8::from(i == k))));
        if column.iter().any(|x| !x.is_finite()) {
            return None;
        }
        (0..6).for_each(|i| inverse[i][k] = column[i]);
    }
    Some(inverse)
}

/// Broyden's good update of an inverse: the matrix nearest to it that takes the change of the residual to the step.
fn broyden(mut inverse: Inverse, step: &[f64; 6], before: &[f64; 6], after: &[f64; 6]) -> Option<Inverse> {
    let change: [f64; 6] = core::array::from_fn(|i| after[i] - before[i]);
    let reached = negative_product(&inverse, &change).map(|x| -x);
    let through: f64 = (0..6).map(|i| step[i] * reached[i]).sum();
    let row: [f64; 6] = core::array::from_fn(|k| (0..6).map(|i| step[i] * inverse[i][k]).sum());
    let size: f64 = step.iter().map(|x| x * x).sum();
    if through.abs() <= 1e-3 * size {
        return None;
    }
    for i in 0..6 {
        let factor = (step[i] - reached[i]) / through;
        (0..6).for_each(|k| inverse[i][k] += factor * row[k]);
    }
    Some(inverse)
}

fn negative_product(a: &[[f64; 6]; 6], x: &[f64; 6]) -> [f64; 6] {
    core::array::from_fn(|i| -(0..6).map(|k| a[i][k] * x[k]).sum::<f64>())
}

fn norm(residual: &[f64; 6]) -> f64 {
    residual.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The Jacobian at a guess by each way, for the test that compares them.
#[cfg(test)]
pub(crate) fn slopes(problem: &Problem, guess: &super::solution::Guess) -> [(Jacobian, [[f64; 6]; 6]); 4] {
    let mut workspace = Workspace::default();
    let mut report = SolveReport::default();
    let state = EndState::from_guess(problem, guess);
    let point = evaluate(problem, Scheme::Element, state, &mut workspace, &mut report, false);
    [
        Jacobian::VariationalLanes,
        Jacobian::Variational,
        Jacobian::FiniteDifferences,
        Jacobian::FiniteDifferenceLanes,
    ]
    .map(|how| {
        let slope = jacobian(problem, Scheme::Element, how, &point, &mut workspace, &mut report);
        (how, slope.unwrap_or([[f64::NAN; 6]; 6]))
    })
}
