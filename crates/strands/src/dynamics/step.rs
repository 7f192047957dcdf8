//! One step in time, and what becomes of one that cannot be made at once.

use super::holds::Held;
use super::piece::{Piece, WHOLE};
use super::{Integrator, Past, Simulation, State, Step, StepFailure, Taken};
use crate::math::{Pose, larger};

/// Into so many pieces is a step cut that was not solved, one after the other until it is.
const PIECES: [usize; 3] = [4, 16, 64];
/// Where an element bends by more in a step, rad, the step does not follow it, and is cut: methods that look back would gain energy.
const FOLLOWED: f64 = 0.25;

impl Simulation {
    /// Makes one step: of [`Settings::time_step`](super::Settings::time_step), or one that [`Settings::local_error`](super::Settings::local_error)
    /// allows. A step whose equations are not solved is cut into pieces, which [`Step::pieces`] tells.
    ///
    /// # Errors
    /// Where it cannot be made; the state is then as before.
    pub fn step(&mut self) -> Result<Step, StepFailure> {
        self.step_towards(f64::INFINITY)
    }

    /// Makes one step, which does not go beyond a time (s) where its error chooses it.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn step_towards(&mut self, until: f64) -> Result<Step, StepFailure> {
        if let (Some(allowed), Some(method)) =
            (self.settings.local_error, self.settings.integrator.embedding())
        {
            return self.step_by_error(method, allowed, until - self.state.time);
        }
        self.work.step = self.settings.time_step;
        let held = Held::begin(self);
        let step = self.whole_or_in_pieces(&held);
        held.end(self);
        step
    }

    /// Makes steps until a time, s. Where all steps are alike the last one ends nearest to it.
    ///
    /// # Errors
    /// Where one cannot be made; the state is then that before it.
    pub fn advance(&mut self, until: f64) -> Result<Step, StepFailure> {
        let mut all = Step { time: self.state.time, seconds: 0.0, iterations: 0, residual: 0.0, pieces: 0 };
        while !self.has_come_to(until) {
            let step = self.step_towards(until)?;
            all.time = step.time;
            all.seconds += step.seconds;
            all.iterations += step.iterations;
            all.residual = larger(all.residual, step.residual);
            all.pieces += step.pieces;
        }
        Ok(all)
    }

    /// Whether a time, s, is over. Where all steps are alike no other one would end nearer to it.
    pub fn has_come_to(&self, time: f64) -> bool {
        let near = if self.settings.local_error.is_some() { 1e-9 } else { 0.5 };
        self.state.time >= time - near * self.settings.time_step
    }

    fn whole_or_in_pieces(&mut self, held: &Held) -> Result<Step, StepFailure> {
        let (integrator, bounded) = (self.settings.integrator, self.settings.bounded);
        self.work.before.clone_from(&self.state);
        // Where surfaces touch, what does not come nearer to a solution soon is better cut.
        self.work.hasty = self.assembly.surfaces.is_some();
        let whole = self.piece(integrator, held, WHOLE);
        let failure = match whole {
            Ok(taken) if bounded || self.follows() => return Ok(self.report(taken, self.work.step, 1)),
            Ok(_) => None,
            Err(failure) => Some(failure),
        };
        let before = self.work.before.clone();
        self.state.clone_from(&before);
        if bounded {
            return self.damped(held, before).map_err(|worse| failure.unwrap_or(worse));
        }
        // A piece cannot look back on steps of another length, nor the next step on one that it does not follow: it would gain energy.
        let alone = match integrator {
            Integrator::Bdf2 | Integrator::GeneralizedAlpha { .. } => Integrator::TrBdf2,
            other => other,
        };
        for pieces in PIECES {
            let finest = pieces == PIECES[PIECES.len() - 1];
            self.work.hasty &= !finest;
            if let Some(taken) = self.pieces(alone, held, pieces, finest) {
                // Not a sum of pieces.
                self.state.time = before.time + self.work.step;
                return Ok(self.report(taken, self.work.step, pieces));
            }
            self.state.clone_from(&before);
        }
        match failure {
            Some(failure) if self.assembly.surfaces.is_none() => Err(failure),
            // Given up too soon, or solved, if not followed: nothing looks back on it.
            _ => {
                let taken = self.piece(integrator, held, WHOLE)?;
                if alone != integrator {
                    self.state.past = Past::None;
                }
                Ok(self.report(taken, self.work.step, 1))
            }
        }
    }

    /// Makes a step in pieces; `None` where one is not solved, or does not follow what bends.
    fn pieces(&mut self, integrator: Integrator, held: &Held, pieces: usize, finest: bool) -> Option<Taken> {
        let length = 1.0 / pieces as f64;
        let mut taken = Taken::default();
        for piece in 0..pieces {
            taken.add(self.piece(integrator, held, Piece { begin: piece as f64 * length, length }).ok()?);
            if !finest && !self.follows() {
                return None;
            }
        }
        Some(taken)
    }

    /// Makes a step of bounded cost once more, by the method that takes the energy out of what it does not follow.
    fn damped(&mut self, held: &Held, before: State) -> Result<Step, StepFailure> {
        let taken = self.piece(Integrator::ImplicitEuler, held, WHOLE)?;
        match self.settings.integrator {
            Integrator::GeneralizedAlpha { .. } | Integrator::Sdirk4 | Integrator::TrBdf2 => {
                self.remember_rates();
            }
            other => self.look_back_on(other, before.poses, before.momenta),
        }
        Ok(self.report(taken, self.work.step, 2))
    }

    /// Whether no element has bent by too much since the step, or the piece of it, began.
    fn follows(&self) -> bool {
        let (before, now) = (&self.work.stage.base, &self.state.poses);
        let seen = |near: &Pose, far: &Pose| near.rotation.transpose_mul(far.rotation.cols[2]);
        (0..self.assembly.strands.len()).all(|rod| {
            let nodes = self.assembly.nodes(rod);
            let mut pairs = now[nodes.clone()].windows(2).zip(before[nodes].windows(2));
            pairs.all(|(now, before)| {
                let bent = seen(&now[0], &now[1]) - seen(&before[0], &before[1]);
                bent.dot(bent) <= FOLLOWED * FOLLOWED
            })
        })
    }

    /// Makes a step of a length, or fails.
    pub(super) fn undivided(&mut self, integrator: Integrator, seconds: f64) -> Result<Taken, StepFailure> {
        self.work.step = seconds;
        let held = Held::begin(self);
        let made = self.piece(integrator, &held, WHOLE);
        held.end(self);
        made
    }

    pub(super) fn report(&self, taken: Taken, seconds: f64, pieces: usize) -> Step {
        let Taken { iterations, residual } = taken;
        Step { time: self.state.time, seconds, iterations, residual, pieces }
    }
}
