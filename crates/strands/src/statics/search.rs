//! Many equilibria of one problem.
//!
//! First from many starts: the rod laid out between its supports in every twist class and with random bends, from where it falls to rest or
//! Newton's method goes to what is nearest, stable or not; and shots with random wrenches at the end. Then along paths: from each equilibrium that
//! has been found, a support is led away, or the loads are, until the [path](super::continuation) turns back in a fold; where it comes back to
//! the problem it does so in another equilibrium. A support that is turned once round leads to the next twist class. Stable equilibria are joined
//! to each other through unstable ones in this way, so that few are missed; that none is missed cannot be said.

use super::boundary::EndState;
use super::continuation::{PathEnd, PathSettings, follow_from};
use super::march::Record;
use super::problem::Problem;
use super::shooting::{Outcome, Search, Workspace, shoot};
use super::solution::{FailureReason, Guess, Method, Scheme, Settings, Solution, SolveReport};
use super::{equilibrium, fit, has_energy, solution, stability};
use crate::math::{Pose, Quat, Vec3, Wrench};
use core::f64::consts::{PI, TAU};
use fastrand::Rng;

/// How hard to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// How to solve.
    pub solver: Settings,
    /// Random starts.
    pub starts: usize,
    /// Paths that are followed at most.
    pub paths: usize,
    /// The same seed gives the same search.
    pub seed: u64,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { solver: Settings::default(), starts: 300, paths: 200, seed: 0 }
    }
}

/// Twist classes, to either side.
const TWIST_CLASSES: i32 = 4;
/// Points that a path may have: a longer one has lost its way.
const MOST_POINTS: usize = 120;
/// Two equilibria closer than this, in rad and over the length, at a quarter, half and three quarters of the rod, are one.
const SAME: f64 = 1e-5;
/// A random start may take so many iterations: most that get anywhere need fewer.
const ITERATIONS: usize = 30;

/// Searches for equilibria, stable and unstable, and gives them by growing energy.
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
        max_iterations: ITERATIONS,
        method: Method::Auto,
        scheme: Scheme::Element,
        ..settings.solver
    };
    let random = Rng::with_seed(settings.seed);
    let mut seeker = Seeker { problem, solver, workspace, random, found: Vec::new() };
    seeker.try_starts(settings.starts);
    seeker.follow_paths(settings.paths);
    seeker.found.sort_by(|a, b| a.energy().total_cmp(&b.energy()));
    Ok(seeker.found.into_iter().map(|found| found.solution).collect())
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
        self.solution.energy.elastic + self.solution.energy.load
    }
}

struct Seeker<'a> {
    problem: &'a Problem,
    solver: Settings,
    workspace: &'a mut Workspace,
    random: Rng,
    found: Vec<Found>,
}

impl Seeker<'_> {
    fn try_starts(&mut self, starts: usize) {
        let length = self.problem.rod.length();
        for class in -TWIST_CLASSES..=TWIST_CLASSES {
            for side in [Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y] {
                let bend = (side * PI + Vec3::Z * (TAU * f64::from(class))) * (1.0 / length);
                equilibrium::lay_out(self.problem, |_| bend, &mut self.workspace.record);
                self.fall();
            }
        }
        for start in 0..starts {
            match start % 4 {
                0 => {
                    self.lay_out_at_random();
                    self.fall();
                }
                1 | 2 => {
                    self.lay_out_at_random();
                    self.nearest();
                }
                _ if self.problem.can_be_shot() => self.shoot_at_random(),
                _ => {
                    self.lay_out_at_random();
                    self.nearest();
                }
            }
        }
    }

    fn fall(&mut self) {
        let mut report = SolveReport::default();
        let search = equilibrium::fall(self.problem, &self.solver, self.workspace, &mut report);
        self.keep(search, report);
    }

    fn nearest(&mut self) {
        let mut report = SolveReport { method: Method::Equilibrium, path_steps: 1, ..SolveReport::default() };
        let search = equilibrium::nearest(self.problem, &self.solver, self.workspace, &mut report);
        self.keep(search, report);
    }

    /// Three numbers about zero, of a size.
    fn vector(&mut self, size: f64) -> Vec3 {
        let mut normal = || (0..12).map(|_| self.random.f64()).sum::<f64>() - 6.0;
        Vec3::new(normal(), normal(), normal()) * size
    }

    /// A number between two, its logarithm even.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.random.f64())
    }

    /// Bends and twists that change slowly along the rod, up to a few turns.
    fn lay_out_at_random(&mut self) {
        let size = self.between(1.0, 10.0) / self.problem.rod.length();
        let [even, odd, twice] = [(); 3].map(|()| self.vector(size));
        let twist = Vec3::Z * self.vector(2.0 * size).z;
        let bend = |s: f64| even + odd * (PI * s).cos() + twice * (TAU * s).cos() + twist;
        equilibrium::lay_out(self.problem, bend, &mut self.workspace.record);
    }

    /// From the end, where it is held, with a wrench anywhere between what bends the rod and many times that.
    fn shoot_at_random(&mut self) {
        let scale = self.problem.rod.scale();
        let (moment, force) = (self.between(1.0, 20.0), self.between(1.0, 500.0));
        let wrench = Wrench::new(self.vector(moment * scale.moment), self.vector(force * scale.force));
        let turn = Quat::from_rotation_vector(self.vector(1.0)).to_matrix();
        let held = &self.problem.end.pose;
        let pose = Pose { rotation: held.rotation * turn, position: held.position };
        let state = EndState::from_guess(self.problem, &Guess::new(pose, wrench));
        let mut report = SolveReport { method: Method::Shooting, path_steps: 1, ..SolveReport::default() };
        let search = shoot(self.problem, &self.solver, state, None, self.workspace, &mut report);
        self.keep(search, report);
    }

    /// Keeps what a search has found, if it is new.
    fn keep(&mut self, search: Search, mut report: SolveReport) {
        if search.outcome != Outcome::Converged || self.knows(&self.workspace.record.poses) {
            return;
        }
        report.morse_index = stability::morse_index(self.problem, self.workspace);
        let solution = solution(self.problem, &search, self.workspace, report);
        self.found.push(Found { solution, record: self.workspace.record.clone(), followed: false });
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

    /// Follows paths from what has been found, least energy first.
    fn follow_paths(&mut self, most: usize) {
        let excursions = excursions(self.problem);
        let mut paths = 0;
        while paths < most {
            let unfollowed = self.found.iter_mut().filter(|found| !found.followed);
            let Some(next) = unfollowed.min_by(|a, b| a.energy().total_cmp(&b.energy())) else { return };
            next.followed = true;
            let record = next.record.clone();
            for excursion in &excursions {
                if paths == most {
                    return;
                }
                paths += 1;
                self.workspace.record.clone_from(&record);
                self.along(excursion);
            }
        }
    }

    fn along(&mut self, excursion: &Excursion) {
        let settings = PathSettings {
            solver: self.solver,
            largest_step: 0.2,
            most_points: MOST_POINTS,
            switch_at: None,
        };
        let family = |at: f64| Ok(excursion.problem(self.problem, at));
        let Some(path) = follow_from(family, &settings, self.workspace) else { return };
        let back = match path.end {
            PathEnd::Returned => true,
            PathEnd::Reached => excursion.closes(),
            _ => false,
        };
        if back {
            // The state is in the workspace; one step more on the problem itself.
            self.nearest();
        }
    }
}

/// A way to lead a problem away.
#[derive(Clone, Copy)]
enum Excursion {
    /// A support, shifted in the world.
    Shift { node: usize, by: Vec3 },
    /// A support, turned once about an axis of its frame.
    Turn { node: usize, axis: Vec3 },
    /// All loads, to their opposites.
    Loads,
}

/// The ways there are.
fn excursions(problem: &Problem) -> Vec<Excursion> {
    let mut all = Vec::new();
    let length = problem.rod.length();
    for (node, support) in problem.supports().filter(|(node, _)| *node > 0) {
        for sign in [1.0, -1.0] {
            for (k, axis) in [Vec3::Z, Vec3::X, Vec3::Y].into_iter().enumerate() {
                if support.fixed[..3] == [true; 3] {
                    all.push(Excursion::Turn { node, axis: axis * sign });
                }
                if support.fixed[3 + k] {
                    all.push(Excursion::Shift { node, by: support.shift_axes.cols[k] * (sign * length) });
                }
            }
        }
    }
    if problem.load_size() > 0.0 {
        all.push(Excursion::Loads);
    }
    all
}

impl Excursion {
    fn problem(&self, problem: &Problem, at: f64) -> Problem {
        let mut led = problem.clone();
        match *self {
            Self::Shift { node, by } => {
                if let Some(support) = led.support_mut(node) {
                    support.pose.position += by * at;
                }
            }
            Self::Turn { node, axis } => {
                if let Some(support) = led.support_mut(node) {
                    let turn = Quat::from_rotation_vector(axis * (TAU * at)).to_matrix();
                    support.pose.rotation = support.pose.rotation * turn;
                }
            }
            Self::Loads => {
                led.loads.set_scaled(&problem.loads, 1.0 - 2.0 * at);
            }
        }
        led
    }

    /// Whether it ends in the problem from which it starts.
    fn closes(&self) -> bool {
        matches!(self, Self::Turn { .. })
    }
}
