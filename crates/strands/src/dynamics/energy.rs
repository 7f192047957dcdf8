//! Where a moving rod's energy is.

use super::stage::exponents;
use super::{Simulation, about};
use crate::math::{Vec3, Wrench};
use crate::rod::NodeInertia;

/// The energy of a moving rod, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Of its motion.
    pub kinetic: f64,
    /// Stored in it.
    pub elastic: f64,
    /// Of dead loads and pulls, gravity among them.
    pub load: f64,
    /// Taken out of it by damping since the start.
    pub dissipated: f64,
}

impl Budget {
    /// What stays the same where nothing but dead loads acts, nothing that holds it moves, and the integrator takes nothing away.
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.load + self.dissipated
    }
}

impl Simulation {
    /// Where the energy is now.
    pub fn energy(&self) -> Budget {
        let (rod, state) = (&self.problem.rod, &self.state);
        let kinetic = |(i, momentum): (usize, &Wrench)| {
            let body = about(self.origin, &state.poses[i]).inverse().carry_wrench(*momentum);
            let NodeInertia { mass, rotational } = rod.node_inertia()[i];
            let turning = squares_over(&body.angular.to_array(), &rotational.to_array());
            0.5 * (turning + body.linear.dot(body.linear) / mass)
        };
        let points = rod.diagonal_points().unwrap_or_default();
        let elastic = exponents(&state.poses)
            .zip(points)
            .map(|(x, point)| 0.5 * squares_over(&(x - point.rest).to_array(), &point.compliance.to_array()));
        Budget {
            kinetic: state.momenta.iter().enumerate().map(kinetic).sum(),
            elastic: elastic.sum(),
            load: self.problem.loads.energy(&state.poses),
            dissipated: state.dissipated,
        }
    }

    /// The momentum of the whole rod, N·s, and its angular momentum about where the rod's base was described, N·m·s.
    pub fn momentum(&self) -> (Vec3, Vec3) {
        let sum = self.state.momenta.iter().fold(Wrench::ZERO, |sum, momentum| sum + *momentum);
        (sum.linear, sum.angular)
    }

    /// How fast damping takes energy out at the stage that was solved last, W.
    pub(super) fn dissipation(&self) -> f64 {
        let (stage, damping) = (&self.work.stage, self.settings.damping);
        let points = self.problem.rod.diagonal_points().unwrap_or_default();
        let rates = stage.strain_rates.iter().zip(points);
        let of_rates: f64 =
            rates.map(|(rate, point)| squares_over(&rate.to_array(), &point.compliance.to_array())).sum();
        let mut of_motion = 0.0;
        for (velocity, inertia) in stage.velocities.iter().zip(self.problem.rod.node_inertia()) {
            let turning = velocity.angular.dot(inertia.rotational.scale(velocity.angular));
            of_motion += turning + velocity.linear.dot(velocity.linear) * inertia.mass;
        }
        damping.viscous * of_rates + damping.mass * of_motion
    }
}

/// `Σ x²/y`, of what is free: a strain without compliance or a turn without inertia has no energy.
fn squares_over(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| if *y > 0.0 { x * x / y } else { 0.0 }).sum()
}
