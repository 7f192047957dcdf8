//! Many equilibria of one problem.
//!
//! First from many [starts](starts): shapes and shots at random, and shots from about what has been found. Then along [paths](paths) from what has
//! been found, by which stable equilibria are joined to each other through unstable ones. That none is missed cannot be said.
//!
//! A search of many thousand tries is made on elements of order 2, which are much the faster; what it finds there is refined on the problem's own.

mod paths;
mod starts;

use super::equilibrium::{found, nearest};
use super::march::Record;
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace};
use super::solution::{FailureReason, Method, Scheme, Settings, Solution, SolveReport};
use super::{fit, has_energy, multiple_shooting, solution, stability};
use crate::math::Pose;
use crate::rod::Order;
use fastrand::Rng;

/// How hard to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// How to solve.
    pub solver: Settings,
    /// Random starts, at most: where many in a row bring nothing new, no more are made.
    pub starts: usize,
    /// Paths that are followed at most.
    pub paths: usize,
    /// The same seed gives the same search.
    pub seed: u64,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { solver: Settings::default(), starts: 20_000, paths: 20, seed: 0 }
    }
}

/// Two equilibria closer than this, in rad and over the length, at a quarter, half and three quarters of the rod, are one.
const SAME: f64 = 1e-5;
/// Of equilibria that differ only in how the rod as a whole lies, so many are kept: where it may be turned about an axis at will, as a round column
/// that buckles, there is a circle of them.
pub const MOST_ALIKE: usize = 8;
/// How much curvatures of such differ at most, over one over the length.
const ALIKE: f64 = 1e-4;
/// A try may take so many iterations: most that get anywhere need fewer.
const ITERATIONS: usize = 40;
/// The turn, rad, of an element beside its rest that the mesh cannot show: with more, what is found is the mesh's and not the rod's.
const LARGEST_TURN: f64 = 1.0;

/// Searches for equilibria, stable and unstable, and gives them by growing energy. Of those that are alike, the same shape lying otherwise, it gives
/// [`MOST_ALIKE`] at most.
///
/// # Errors
/// Where the problem cannot be posed, or its elements have no energy to lower (order 1, the multistep scheme).
pub fn equilibria(
    problem: &Problem,
    settings: &SearchSettings,
    workspace: &mut Workspace,
) -> Result<Vec<Solution>, FailureReason> {
    if let Some(reason) = fit::unfit(problem, &settings.solver) {
        return Err(reason);
    }
    if !has_energy(problem, &settings.solver) {
        return Err(FailureReason::NoEnergy);
    }
    let solver = Settings {
        max_iterations: ITERATIONS.min(settings.solver.max_iterations),
        method: Method::Auto,
        scheme: Scheme::Element,
        ..settings.solver
    };
    let quick = problem.of_second_order();
    let random = Rng::with_seed(settings.seed);
    let mut seeker = Seeker { problem: &quick, solver, workspace, random, found: Vec::new() };
    seeker.try_starts(settings.starts);
    seeker.follow_paths(settings.paths);
    let mut all = seeker.found;
    if problem.rod.order() != Order::Second {
        let random = seeker.random;
        let mut seeker = Seeker { problem, solver, workspace: seeker.workspace, random, found: Vec::new() };
        seeker.refine(&all);
        seeker.shoot_some_more(settings.starts / 40);
        all = seeker.found;
    }
    Ok(all.into_iter().map(|found| found.solution).collect())
}

/// An equilibrium with its state.
struct Found {
    solution: Solution,
    record: Record,
    /// Whether the paths from it have been followed.
    followed: bool,
}

impl Found {
    fn energy(&self) -> f64 {
        self.solution.energy.total()
    }
}

struct Seeker<'a> {
    problem: &'a Problem,
    solver: Settings,
    workspace: &'a mut Workspace,
    random: Rng,
    /// By growing energy.
    found: Vec<Found>,
}

impl Seeker<'_> {
    /// Looks for the equilibrium nearest to the state in the workspace by the nodal Newton method, which goes far.
    fn nearest(&mut self) {
        let mut report = SolveReport { method: Method::Equilibrium, path_steps: 1, ..SolveReport::default() };
        let search = nearest(self.problem, &self.solver, self.workspace, &mut report);
        self.keep(search, report);
    }

    /// The same by multiple shooting, which gives up early where there is none near.
    fn nearest_by_shooting(&mut self) -> Outcome {
        let mut report =
            SolveReport { method: Method::MultipleShooting, path_steps: 1, ..SolveReport::default() };
        let outcome = multiple_shooting::nearest(self.problem, &self.solver, self.workspace, &mut report);
        self.keep(found(self.problem, outcome, self.workspace), report);
        outcome
    }

    /// Finds what has been found on other elements on the problem's own.
    fn refine(&mut self, rough: &[Found]) {
        for other in rough {
            self.workspace.record.clone_from(&other.record);
            let outcome = self.nearest_by_shooting();
            if outcome != Outcome::Converged {
                self.workspace.record.clone_from(&other.record);
                self.nearest();
            }
        }
    }

    /// Keeps what a search has found, if it is new.
    fn keep(&mut self, search: Search, mut report: SolveReport) {
        let new = search.outcome == Outcome::Converged
            && self.is_shown_by_the_mesh()
            && !self.knows(&self.workspace.record.poses)
            && self.alike() < MOST_ALIKE;
        if !new {
            return;
        }
        report.morse_index = stability::morse_index(self.problem, self.workspace);
        let solution = solution(self.problem, &search, self.workspace, report);
        let found = Found { solution, record: self.workspace.record.clone(), followed: false };
        let place = self.found.partition_point(|other| other.energy() <= found.energy());
        self.found.insert(place, found);
    }

    fn is_shown_by_the_mesh(&self) -> bool {
        let (rod, strains) = (&self.problem.rod, &self.workspace.record.strains);
        (0..rod.elements()).all(|e| {
            let bent = strains[e][0].angular - rod.rest_strains(e)[0].angular;
            bent.norm() * rod.element_length(e) < LARGEST_TURN
        })
    }

    /// How many of those that have been found have the shape of the one in the workspace.
    fn alike(&self) -> usize {
        let (rod, strains) = (&self.problem.rod, &self.workspace.record.strains);
        let near = ALIKE / rod.length();
        let same = |other: &Found| {
            let strains = strains.iter().zip(&other.record.strains).step_by(1 + strains.len() / 16);
            strains.into_iter().all(|(a, b)| {
                let (a, b) = (a[0].angular, b[0].angular);
                (a.x.hypot(a.y) - b.x.hypot(b.y)).abs() < near && (a.z - b.z).abs() < near
            })
        };
        self.found.iter().filter(|found| same(found)).count()
    }

    fn knows(&self, poses: &[Pose]) -> bool {
        let (n, length) = (poses.len() - 1, self.problem.rod.length());
        let same = |other: &Solution| {
            [n / 4, n / 2, 3 * n / 4, n].iter().all(|i| {
                let (a, b) = (&other.poses[*i], &poses[*i]);
                a.rotation.turn_to(&b.rotation).norm() < SAME
                    && (b.position - a.position).norm() < SAME * length
            })
        };
        self.found.iter().any(|found| same(&found.solution))
    }
}
