//! From many starts to what is near.
//!
//! Four kinds of start take turns, of which each finds what the others miss:
//!
//! - a *shape*: the rod bent and twisted at random between its supports. Newton's method on all frames at once wanders from there until it comes upon
//!   an equilibrium, stable or not. Damped, by multiple shooting, it goes to what is near or soon gives up, and finds less;
//! - a *shot*: a march from the rod's end with a random wrench, and multiple shooting from what it makes;
//! - a shot from about the end of an equilibrium that is known, the more often the less its energy: its neighbours, most often those of the next
//!   Morse index, have wrenches of its kind;
//! - a shot from *among* the known, half of them: from where one would end if it were moved by a part of what two others differ by, or between two.
//!   How far and which way to go is so learnt from what has been found (as in differential evolution, Storn & Price 1997, J. Glob. Optim.
//!   11:341–359), whatever the stiffnesses and however large the wrenches are. These find most of what there is.

use super::super::boundary::EndState;
use super::super::equilibrium::{fall, lay_out};
use super::super::march::march;
use super::super::solution::{Guess, Scheme, SolveReport};
use super::Seeker;
use crate::math::{Pose, Quat, Strain, Vec3, Wrench};
use core::f64::consts::{PI, TAU};

/// Twist classes, to either side.
const TWIST_CLASSES: i32 = 6;
/// After so many starts in a row that brought nothing new, and this part of all, it is enough.
const MANY: usize = 4000;
const PART: f64 = 0.25;
/// How large bends, twists (rad), and forces (square roots, over `EI/L²`) are at random, and by which part of itself a known wrench is changed.
const BENDS: [f64; 2] = [0.5, 10.0];
const TWISTS: [f64; 2] = [0.5, 40.0];
const FORCES: [f64; 2] = [0.5, 8.0];
const CHANGES: [f64; 2] = [0.02, 0.7];
/// Parts of a difference by which a known end is moved; between two, or so far beyond either of them.
const PARTS: [f64; 2] = [0.05, 1.0];
const BEYOND: f64 = 0.5;

impl Seeker<'_> {
    pub fn try_starts(&mut self, starts: usize) {
        let length = self.problem.rod.length();
        for class in -TWIST_CLASSES..=TWIST_CLASSES {
            for side in [Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y] {
                let bend = (side * PI + Vec3::Z * (TAU * f64::from(class))) * (1.0 / length);
                lay_out(self.problem, |_| bend, &mut self.workspace.record);
                self.fall();
            }
        }
        let can_shoot = self.problem.can_be_shot();
        let can_march = self.problem.loads.pulls().is_empty();
        let (mut last, mut known) = (0, self.found.len());
        for start in 0..starts {
            match start % 6 {
                1 if can_shoot => self.shoot(),
                2 if can_shoot && !self.found.is_empty() => self.shoot_from_known(),
                3.. if can_shoot && self.found.len() > 1 => self.shoot_among_known(),
                3.. if can_march => {
                    self.lay_out_at_random();
                    self.nearest_by_shooting();
                }
                _ => {
                    self.lay_out_at_random();
                    self.nearest();
                }
            }
            if self.found.len() > known {
                (last, known) = (start, self.found.len());
            }
            if start - last > MANY && (start - last) as f64 > PART * start as f64 {
                break;
            }
        }
    }

    /// Shoots from about what is known, for what only these elements show.
    pub fn shoot_some_more(&mut self, times: usize) {
        if self.problem.can_be_shot() && !self.found.is_empty() {
            for time in 0..times {
                if time % 4 == 0 {
                    self.shoot_from_known();
                } else {
                    self.shoot_among_known();
                }
            }
        }
    }

    /// From the state in the workspace to where it rests.
    fn fall(&mut self) {
        let mut report = SolveReport::default();
        let search = fall(self.problem, &self.solver, self.workspace, &mut report);
        self.keep(search, report);
    }

    /// Three numbers about zero, of a size.
    fn vector(&mut self, size: f64) -> Vec3 {
        let mut normal = || (0..12).map(|_| self.random.f64()).sum::<f64>() - 6.0;
        Vec3::new(normal(), normal(), normal()) * size
    }

    /// A number between two, its logarithm even.
    fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low * (high / low).powf(self.random.f64())
    }

    /// Bends and twists that change slowly along the rod, up to a few turns. Gives those at the end, 1/m.
    fn lay_out_at_random(&mut self) -> Vec3 {
        let length = self.problem.rod.length();
        let size = self.between(BENDS) / length;
        let [even, odd, twice] = [(); 3].map(|()| self.vector(size));
        let twist = self.between(TWISTS) / length;
        let twist = Vec3::Z * self.vector(twist).z;
        let bend = |s: f64| even + odd * (PI * s).cos() + twice * (TAU * s).cos() + twist;
        lay_out(self.problem, bend, &mut self.workspace.record);
        bend(1.0)
    }

    /// Shoots with the moment that would bend the end as in a random shape, and any force.
    fn shoot(&mut self) {
        let bend = self.lay_out_at_random();
        let rod = &self.problem.rod;
        let last = rod.elements();
        let moment = rod.points(last - 1)[0].law.stress(Strain::new(bend, Vec3::ZERO)).angular;
        let force = self.between(FORCES).powi(2) * rod.scale().force;
        let wrench = Wrench::new(moment, self.vector(force));
        self.shoot_from(&Guess::new(self.workspace.record.poses[last], wrench));
    }

    /// Shoots from about the end of an equilibrium that is known.
    fn shoot_from_known(&mut self) {
        let Guess { pose, wrench, .. } = self.known_end();
        let scale = self.problem.rod.scale();
        let change = self.between(CHANGES);
        let moment = wrench.angular.norm().max(scale.moment) * change;
        let force = wrench.linear.norm().max(scale.force) * change;
        let wrench = wrench + Wrench::new(self.vector(moment), self.vector(force));
        let moved = Pose {
            rotation: Quat::from_rotation_vector(self.vector(change)).to_matrix(),
            position: self.vector(change * scale.length),
        };
        let pose =
            Pose { rotation: pose.rotation * moved.rotation, position: pose.position + moved.position };
        self.shoot_from(&Guess::new(pose, wrench));
    }

    /// Shoots from an end between those of two known equilibria or a little beyond, or from one that is moved as two others differ.
    fn shoot_among_known(&mut self) {
        let [one, other, third] = [(); 3].map(|()| self.known_end());
        let (from, part) = if self.random.bool() {
            (one, self.random.f64() * (1.0 + 2.0 * BEYOND) - BEYOND)
        } else {
            (third, self.between(PARTS))
        };
        let moved = Pose::exp(from.pose.between(&other.pose).log() * part);
        let wrench = one.wrench + (other.wrench - from.wrench) * part;
        self.shoot_from(&Guess::new(one.pose.compose(&moved), wrench));
    }

    /// The end of an equilibrium that is known, rather one of low energy.
    fn known_end(&mut self) -> Guess {
        let place = self.random.f64().powi(2) * self.found.len() as f64;
        self.found[place as usize].solution.guess
    }

    fn shoot_from(&mut self, guess: &Guess) {
        let end = EndState::from_guess(self.problem, guess).section(self.problem);
        let (rod, loads) = (&self.problem.rod, &self.problem.loads);
        march(self.workspace.simd, rod, Scheme::Element, loads, end, &mut self.workspace.record);
        self.nearest_by_shooting();
    }
}
