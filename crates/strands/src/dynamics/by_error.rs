//! Steps that are as long as their error allows.

use super::integrator::RungeKutta;
use super::{Simulation, Step, StepFailure, Taken};
use crate::math::{Vec6, larger};

/// A step is so much shorter than its error would allow, and never so many times longer or shorter than the last.
const SAFETY: f64 = 0.9;
const LONGER: f64 = 4.0;
const SHORTER: f64 = 0.2;
/// One that is made again is at most so long: where much vibrates faster than the steps, their error falls slowly with their length.
const AGAIN: f64 = 0.7;
/// Steps are not shortened below this part of the longest for their error.
const SHORTEST: f64 = 1e-9;

impl Simulation {
    /// Makes a step as long as its error allows, by a method and the other one in it.
    pub(super) fn step_by_error(
        &mut self,
        method: &RungeKutta,
        allowed: f64,
        longest: f64,
    ) -> Result<Step, StepFailure> {
        let (integrator, before) = (self.settings.integrator, self.state.clone());
        let (mut iterations, mut cause) = (0, None);
        let longest = longest.min(self.settings.time_step);
        // One that is nearly over is divided evenly.
        let mut step = if before.next_step < longest && 2.0 * before.next_step > longest {
            0.5 * longest
        } else {
            longest.min(before.next_step)
        };
        for tries in 1.. {
            let made = self.undivided(integrator, step);
            let error = self.local_error(method) / allowed;
            let grows = match &made {
                Ok(_) => (SAFETY / error.powf(1.0 / method.error_order)).clamp(SHORTER, LONGER),
                Err(_) => SHORTER,
            };
            match made {
                Ok(taken) if error <= 1.0 => {
                    // One like that which was just too long is not tried again at once.
                    let grows = if tries == 1 { grows } else { grows.min(1.0) };
                    let cut = step < before.next_step && tries == 1;
                    self.state.next_step =
                        if cut { before.next_step.max(step * grows) } else { step * grows };
                    iterations += taken.iterations;
                    return Ok(self.report(Taken { iterations, ..taken }, step, tries));
                }
                Err(failure)
                    if step < SHORTEST * self.settings.time_step
                        || matches!(failure, StepFailure::TooShort { .. }) =>
                {
                    self.state = before;
                    return Err(cause.unwrap_or(failure));
                }
                Ok(taken) if step < SHORTEST * self.settings.time_step => {
                    self.state.clone_from(&before);
                    let history = vec![taken.residual, error];
                    return Err(StepFailure::NotConverged { time: before.time, step, history });
                }
                Ok(taken) => (iterations, cause) = (iterations + taken.iterations, None),
                Err(failure) => cause = Some(failure),
            }
            self.state.clone_from(&before);
            step *= grows.min(AGAIN);
        }
        unreachable!("steps are shortened until they are too short")
    }

    /// How much a step of a method moves frames otherwise than the other one in it: turns in rad, and shifts over the longest rod's length.
    fn local_error(&self, method: &RungeKutta) -> f64 {
        let frames = self.state.poses.len();
        let size = self.assembly.size();
        let rates = &self.work.coordinate_rates;
        let error = (0..frames).map(|frame| {
            let terms = method.error.iter().enumerate();
            let apart = terms.fold(Vec6::ZERO, |sum, (stage, weight)| {
                sum + rates.get(stage * frames + frame).map_or(Vec6::ZERO, |rate| *rate * *weight)
            });
            let shift = if size > 0.0 { apart.linear.norm() / size } else { apart.linear.norm() };
            larger(apart.angular.norm(), shift)
        });
        error.fold(0.0, larger) * self.work.step
    }
}
