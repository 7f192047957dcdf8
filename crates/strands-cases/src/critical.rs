//! Critical loads: where the primary branch of a family of problems loses its stability, one way after another.
//!
//! The branch is followed by Newton's method alone ([`nearest`]), from a small load on, past where it is unstable. The Morse index says between
//! which loads a way to lower the energy appears. It counts with a little in favour of stability, so that round-off does not decide: the load itself
//! is where the branch's stiffness against a small disturbing force vanishes, `F/u = 0`. That needs no potential, so it also finds the first critical
//! load of a rod under follower loads.

use crate::{CaseError, Setup};
use std::fmt;
use std::sync::Arc;
use strands::math::Vec3;
use strands::rod::Order;
use strands::statics::{Guess, Problem, Settings, Solution, Workspace, nearest};

/// Named families with reference critical loads.
#[derive(Clone, Debug)]
pub struct CriticalCase {
    /// Its name, as one types it.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Who published it, and how the figures were found.
    pub source: &'static str,
    /// The relative error within which a converged critical load matches.
    pub tolerance: f64,
    /// How many elements of order 4 reach the tolerance on every branch.
    pub elements: usize,
    /// Its branches.
    pub branches: Vec<Branch>,
    /// What else there is to know.
    pub remark: Option<&'static str>,
}

/// A family of problems that a load leads through.
#[derive(Clone)]
pub struct Branch {
    /// What sets it apart from the other branches.
    pub label: String,
    /// The rod at a load.
    pub family: Family,
    /// The end of the primary branch at a load, where it is known and following it from load to load would be a detour.
    pub end: Option<EndOfBranch>,
    /// Where along the rod a small force disturbs it, m, and in which direction; none where the index alone must do.
    pub disturbed: Option<(f64, Vec3)>,
    /// The critical loads, growing. None up to [`Branch::up_to`] where there is none.
    pub critical: Vec<f64>,
    /// How many ways to lower the energy appear at each.
    pub ways: usize,
    /// The load up to which the branch is followed.
    pub up_to: f64,
}

/// The rod at a load.
pub type Family = Arc<dyn Fn(f64) -> Setup + Send + Sync>;

/// The end of a branch at a load.
pub type EndOfBranch = Arc<dyn Fn(f64) -> Guess + Send + Sync>;

/// A load at which ways to lower the energy appear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalLoad {
    /// The load.
    pub load: f64,
    /// How many ways there are below and above; none where the loads have no potential.
    pub index: Option<[usize; 2]>,
}

impl fmt::Debug for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Branch")
            .field("label", &self.label)
            .field("critical", &self.critical)
            .finish_non_exhaustive()
    }
}

/// The first load, and the steps from one to the next, over [`Branch::up_to`].
const STEPS: f64 = 48.0;
/// How close the index brings a critical load, relative to it: where it is all there is, and where the stiffness takes over.
const CLOSE: f64 = 1e-6;
const CLOSE_ENOUGH: f64 = 2.5e-4;
/// The loads beside the critical one at which the stiffness is taken, in these parts of it: so near that a polynomial through them bears with where
/// the stiffness is infinite, between two modes, and so far that the rod answers in proportion.
const BESIDE: [f64; 6] = [-3e-3, -2e-3, -1e-3, 1e-3, 2e-3, 3e-3];
/// The disturbing force, over `EI/L²`: large beside round-off, and so small that the rod answers in proportion.
const DISTURBANCE: f64 = 3e-10;

impl Branch {
    /// The load from which on the branch is followed.
    pub fn first_load(&self) -> f64 {
        self.up_to / STEPS
    }

    /// Follows the branch and finds its critical loads.
    ///
    /// # Errors
    /// Where the branch is lost, or the rod cannot be cut into so few elements.
    pub fn critical_loads(&self, elements: usize, order: Order) -> Result<Vec<CriticalLoad>, CaseError> {
        let mut follower = Follower::new(self, elements, order)?;
        let mut found: Vec<CriticalLoad> = Vec::new();
        let (mut below, mut lost) = (self.first_load(), 0);
        while below < self.up_to {
            let above = below + self.first_load();
            let unstable = follower.unstable_ways(above)?;
            while unstable > lost {
                let (load, now) = follower.first_with_more(lost, below, above)?;
                let index = follower.counts.then_some([lost, now]);
                let load = if self.disturbed.is_some() { follower.vanishing_stiffness(load)? } else { load };
                found.push(CriticalLoad { load, index });
                lost = now;
            }
            if !follower.counts && lost > 0 {
                break;
            }
            below = above;
        }
        Ok(found)
    }
}

/// The primary branch, at the load last looked at.
struct Follower<'a> {
    branch: &'a Branch,
    problem: Problem,
    workspace: Workspace,
    guess: Option<Guess>,
    /// Whether the loads have a potential, so that the index is known.
    counts: bool,
}

impl<'a> Follower<'a> {
    fn new(branch: &'a Branch, elements: usize, order: Order) -> Result<Self, CaseError> {
        let places: Vec<f64> = branch.disturbed.iter().map(|(place, _)| *place).collect();
        let problem = (branch.family)(branch.first_load()).problem(elements, order, &places)?;
        let workspace = Workspace::default();
        let mut follower = Self { branch, problem, workspace, guess: None, counts: true };
        follower.counts = follower.at(branch.first_load(), Vec3::ZERO)?.report.morse_index.is_some();
        Ok(follower)
    }

    /// The branch at a load, disturbed by a force.
    fn at(&mut self, load: f64, force: Vec3) -> Result<Solution, CaseError> {
        let mut setup = (self.branch.family)(load);
        if let (Some((place, _)), true) = (self.branch.disturbed, force != Vec3::ZERO) {
            setup = setup.with_force(place, force);
        }
        setup.apply(&mut self.problem)?;
        let settings = Settings { tolerance: 1e-12, max_iterations: 60, ..Settings::default() };
        let guess = self.branch.end.as_ref().map(|end| end(load)).or(self.guess);
        let solution = nearest(&self.problem, &settings, guess.as_ref(), &mut self.workspace)?;
        self.guess = Some(solution.guess);
        Ok(solution)
    }

    /// How many ways there are to lower the energy; where there is none, whether the disturbed rod gives way against the force.
    fn unstable_ways(&mut self, load: f64) -> Result<usize, CaseError> {
        if self.counts {
            return Ok(self.at(load, Vec3::ZERO)?.report.morse_index.unwrap_or(0));
        }
        Ok(usize::from(self.stiffness(load)? < 0.0))
    }

    /// The first load with more unstable ways than so many, and how many it has.
    fn first_with_more(
        &mut self,
        lost: usize,
        mut below: f64,
        mut above: f64,
    ) -> Result<(f64, usize), CaseError> {
        let close = if self.branch.disturbed.is_some() { CLOSE_ENOUGH } else { CLOSE };
        let mut now = lost;
        while above - below > close * above {
            let between = 0.5 * (below + above);
            let ways = self.unstable_ways(between)?;
            if ways > lost {
                (above, now) = (between, ways);
            } else {
                below = between;
            }
        }
        Ok((0.5 * (below + above), now))
    }

    /// The disturbing force over how far the rod moves along it, N/m.
    fn stiffness(&mut self, load: f64) -> Result<f64, CaseError> {
        let (place, along) = self.branch.disturbed.unwrap_or((0.0, Vec3::ZERO));
        let node = self.problem.rod.mesh().node_at(place).unwrap_or(0);
        let force = DISTURBANCE * self.problem.rod.scale().force;
        let still = self.at(load, Vec3::ZERO)?.poses[node].position;
        self.at(load, along * force)?;
        // So close to where it gives way a step more is worth it.
        let disturbed = self.at(load, along * force)?.poses[node].position;
        // Back to where it was: what is left of the disturbance would be seen at the next load.
        self.at(load, Vec3::ZERO)?;
        Ok(force / (disturbed - still).dot(along))
    }

    /// The load near another at which the stiffness vanishes.
    fn vanishing_stiffness(&mut self, near: f64) -> Result<f64, CaseError> {
        let load = self.interpolated(near)?;
        // What the index, in favour of stability, says too late is not in the middle of the loads that were looked at.
        if (load / near - 1.0).abs() > CLOSE_ENOUGH { self.interpolated(load) } else { Ok(load) }
    }

    /// The load as a polynomial of the stiffness through those beside one, at zero (Neville's scheme).
    fn interpolated(&mut self, near: f64) -> Result<f64, CaseError> {
        let mut loads = BESIDE.map(|part| near * (1.0 + part));
        let mut stiffnesses = [0.0; BESIDE.len()];
        for (stiffness, load) in stiffnesses.iter_mut().zip(loads) {
            *stiffness = self.stiffness(load)?;
        }
        for width in 1..loads.len() {
            for i in 0..loads.len() - width {
                let (a, b) = (stiffnesses[i], stiffnesses[i + width]);
                loads[i] = (b * loads[i] - a * loads[i + 1]) / (b - a);
            }
        }
        Ok(loads[0])
    }
}
