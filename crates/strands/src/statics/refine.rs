//! A mesh for a tolerance: the fewest elements, each as long as the rod's shape allows there.
//!
//! The problem is solved twice, on a mesh and on one of half as many elements. Their difference tells the error of the finer one, and
//! where along the rod it comes from: a stretch whose relative frames differ by `d` has the error density `C = d/h^(p+1)`.
//! The sum of local errors for a number of elements is least when `h ∝ C^(−1/(p+1))` (Ascher, Mattheij & Russell 1995, ch. 9).

use super::problem::Problem;
use super::shooting::Workspace;
use super::solution::{Guess, Settings, Solution, SolveFailure};
use super::solve;
use crate::math::{Pose, Vec6};
use crate::rod::{Mesh, Order, Rod, RodDescription, RodError};
use thiserror::Error;

/// Blocks of elements that the first mesh has in each stretch between breaks.
const FIRST_BLOCKS: usize = 4;
/// Elements of a block. The half mesh has two, which Simpson's rule needs.
const BLOCK: usize = 4;
/// Rounds of refining; each takes the error down by the order's power, so that few are needed.
const MAX_ROUNDS: usize = 10;
/// The part of the tolerance that a new mesh aims for.
const AIM: f64 = 0.4;
/// The part of it that the solver may leave, so that it does not count.
const SOLVER_SHARE: f64 = 0.01;
/// No search gets below this.
const ROUND_OFF: f64 = 1e-13;
/// From one round to the next the number of blocks grows at most by this factor.
const MAX_GROWTH: f64 = 6.0;

/// A problem on the mesh that was found, and its solution.
#[derive(Clone, Debug)]
pub struct Refined {
    /// The problem.
    pub problem: Problem,
    /// Its solution.
    pub solution: Solution,
    /// What it was solved with: the settings given, their tolerance a small part of the mesh's where it was not.
    pub settings: Settings,
    /// The estimated error of the nodes' frames: turns in rad, shifts over the rod's length, the largest of all.
    pub estimated_error: f64,
}

/// Why no mesh was found.
#[derive(Clone, Debug, Error)]
pub enum RefineError {
    /// The tolerance is not a small positive number.
    #[error("the tolerance is {0}, but must be a number between 0 and 1")]
    Tolerance(f64),
    /// The rod could not be built.
    #[error(transparent)]
    Rod(#[from] RodError),
    /// The problem could not be solved on one of the meshes.
    #[error(transparent)]
    Solve(#[from] SolveFailure),
    /// The mesh would grow beyond reason.
    #[error(
        "an error of {reached:.2e} is the best that {elements} elements reach, not the tolerance {tolerance:.1e}; ask for less, or use \
         order = 4"
    )]
    TooFine {
        /// The error reached.
        reached: f64,
        /// Elements used.
        elements: usize,
        /// The tolerance asked for.
        tolerance: f64,
        /// The problem on the last mesh, with its solution: an equilibrium, but not within the tolerance.
        nearest: Box<Refined>,
    },
}

/// Finds the mesh, each solve more precise than the mesh's tolerance. `breaks` are places that must be nodes besides the rod's own steps; `pose` makes the problem of a rod on a mesh.
///
/// # Errors
/// As [`RefineError`] says.
pub fn refine<E>(
    description: &RodDescription,
    order: Order,
    breaks: &[f64],
    tolerance: f64,
    max_elements: usize,
    settings: &Settings,
    pose: impl Fn(Rod) -> Result<Problem, E>,
) -> Result<Refined, RefineError>
where
    RefineError: From<E>,
{
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(RefineError::Tolerance(tolerance));
    }
    description.validate()?;
    let within = (SOLVER_SHARE * tolerance).max(ROUND_OFF);
    let settings = Settings { tolerance: settings.tolerance.min(within), ..*settings };
    let spans = spans(description, breaks);
    let mut blocks: Vec<f64> = spans.iter().flat_map(|&(from, to)| evenly(from, to, FIRST_BLOCKS)).collect();
    let mut workspace = Workspace::default();
    let (mut half_guess, mut guess): (Option<Guess>, Option<Guess>) = (None, None);
    let mut round = 0;
    loop {
        round += 1;
        let mut on =
            |elements: usize, guess: &mut Option<Guess>| -> Result<(Problem, Solution), RefineError> {
                let pieces: Vec<(f64, usize)> = blocks.iter().map(|&end| (end, elements)).collect();
                let problem = pose(Rod::new(description.clone(), Mesh::from_pieces(&pieces)?, order)?)?;
                let solution = solve(&problem, &settings, guess.as_ref(), &mut workspace)?;
                *guess = Some(solution.guess);
                Ok((problem, solution))
            };
        let (_, half) = on(BLOCK / 2, &mut half_guess)?;
        if guess.is_none() {
            guess = half_guess;
        }
        let (problem, solution) = on(BLOCK, &mut guess)?;
        let power = i32::try_from(order.as_number()).unwrap_or(4);
        let length = description.length;
        let gained = 2.0_f64.powi(power) - 1.0;
        let error = (0..=blocks.len())
            .map(|i| size(&half.poses[i * BLOCK / 2].between(&solution.poses[i * BLOCK]).log(), length))
            .fold(0.0, f64::max)
            / gained;
        let found = Refined { problem, solution, settings, estimated_error: error };
        if error <= tolerance {
            return Ok(found);
        }
        let densities = densities(&blocks, &half.poses, &found.solution.poses, length, power);
        let factor = (error / (AIM * tolerance)).powf(1.0 / f64::from(power));
        blocks = remeshed(&spans, &blocks, &densities, factor.min(MAX_GROWTH), power);
        if blocks.len() * BLOCK > max_elements || round == MAX_ROUNDS {
            let elements = found.problem.rod.elements();
            return Err(RefineError::TooFine {
                reached: error,
                elements,
                tolerance,
                nearest: Box::new(found),
            });
        }
    }
}

fn size(x: &Vec6, length: f64) -> f64 {
    x.angular.max_abs().max(x.linear.max_abs() / length)
}

/// Stretches between breaks.
fn spans(description: &RodDescription, breaks: &[f64]) -> Vec<(f64, f64)> {
    let length = description.length;
    let slack = 1e-9 * length;
    let mut cuts: Vec<f64> = description.breaks();
    cuts.extend_from_slice(breaks);
    cuts.retain(|s| *s > slack && *s < length - slack);
    cuts.push(length);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| *a - *b <= slack);
    let starts = core::iter::once(0.0).chain(cuts.iter().copied());
    starts.zip(cuts.iter().copied()).collect()
}

/// The ends of `n` equal pieces.
fn evenly(from: f64, to: f64, n: usize) -> impl Iterator<Item = f64> {
    (1..=n).map(move |i| if i == n { to } else { from + (to - from) * i as f64 / n as f64 })
}

/// The wish for elements in each block: `C^(1/(p+1))`, with a floor so that no stretch is left without.
fn densities(blocks: &[f64], half: &[Pose], full: &[Pose], length: f64, power: i32) -> Vec<f64> {
    let exponent = 1.0 / f64::from(power + 1);
    let mut start = 0.0;
    let wishes: Vec<f64> = blocks
        .iter()
        .enumerate()
        .map(|(i, &end)| {
            let block = end - start;
            start = end;
            let relative = |poses: &[Pose], n: usize| poses[i * n].between(&poses[(i + 1) * n]);
            let differ = relative(half, BLOCK / 2).between(&relative(full, BLOCK)).log();
            size(&differ, length).powf(exponent) / block
        })
        .collect();
    let mean = wishes.iter().sum::<f64>() / wishes.len() as f64;
    wishes.iter().map(|wish| wish.max(0.2 * mean).max(f64::MIN_POSITIVE)).collect()
}

/// New blocks: as many as before times `factor` when the error is spread as now, fewer where the wishes gather it.
fn remeshed(spans: &[(f64, f64)], blocks: &[f64], wishes: &[f64], factor: f64, power: i32) -> Vec<f64> {
    // With h = 1/(k wish), the error is Σ C h^p ds = k^−p Σ wish ds; today it is Σ C h₀^p ds.
    let exponent = 1.0 / f64::from(power);
    let edges: Vec<f64> = core::iter::once(0.0).chain(blocks.iter().copied()).collect();
    let lengths: Vec<f64> = edges.windows(2).map(|e| e[1] - e[0]).collect();
    let now: f64 = wishes.iter().zip(&lengths).map(|(w, l)| w.powi(power + 1) * l.powi(power) * l).sum();
    let then: f64 = wishes.iter().zip(&lengths).map(|(w, l)| w * l).sum();
    let k = factor * (then / now).powf(exponent);
    let mut out = Vec::new();
    for &(from, to) in spans {
        let inside: Vec<usize> =
            (0..blocks.len()).filter(|&i| edges[i] >= from - 1e-12 && edges[i + 1] <= to + 1e-12).collect();
        let total: f64 = inside.iter().map(|&i| k * wishes[i] * lengths[i]).sum();
        let count = (total.ceil() as usize).max(1);
        // The ends at equal shares of the wishes.
        let (mut seen, mut next) = (0.0, 1);
        for &i in &inside {
            let here = k * wishes[i] * lengths[i];
            while next < count && seen + here >= total * next as f64 / count as f64 {
                let part = (total * next as f64 / count as f64 - seen) / here;
                out.push(edges[i] + part * lengths[i]);
                next += 1;
            }
            seen += here;
        }
        out.push(to);
    }
    out
}
