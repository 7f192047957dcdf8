//! From one equilibrium to the next along paths.
//!
//! A support is led away, or the loads are, until the [path](super::super::continuation) turns back in a fold; where it comes back to the problem it
//! does so in another equilibrium. A support that is turned once round leads to the next twist class.

use super::super::continuation::{PathEnd, PathSettings, follow_from};
use super::super::problem::Problem;
use super::Seeker;
use crate::math::{Quat, Vec3};
use core::f64::consts::TAU;

/// Points that a path may have: a longer one has lost its way.
const MOST_POINTS: usize = 120;

impl Seeker<'_> {
    /// Follows paths from what has been found, least energy first.
    pub fn follow_paths(&mut self, most: usize) {
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
