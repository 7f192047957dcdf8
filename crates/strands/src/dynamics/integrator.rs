//! Integrators in time, as coefficients of one equation.
//!
//! All of them solve, once or several times a step, for frames at which momentum has changed by what acts there. With `q` the canonical coordinates of a
//! node's frame about that at the step's beginning, a rotation vector `θ` and a shift, and the momentum `Π` of the node about a fixed place, a stage is
//!
//! ```text
//! q = Δ + a q̇,   Π = Π̂ + a W(q)
//! ```
//!
//! where `W` is all that acts on the node but inertia, and `Δ`, `Π̂` and `a` are known. Its angular velocity is `T(θ) θ̇` in its own axes. `q` and `Π` live
//! in vector spaces, so a method keeps the order that it has there (Munthe-Kaas 1998), and the sum of `Π` over all nodes changes by nothing but what
//! acts from outside.

/// How a step in time is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Backward Euler, of order 1: it takes energy out of all that is faster than a few steps.
    ImplicitEuler,
    /// Backward differences of order 2. The first step is one of [`Integrator::Sdirk4`].
    Bdf2,
    /// The generalised-α method of order 2 for equations of the first order (Jansen, Whiting & Hulbert 2000), in canonical coordinates about each
    /// step's beginning. The first step is one of [`Integrator::Sdirk4`].
    GeneralizedAlpha {
        /// What is left after a step of a motion that is much faster, from 0 to 1: the spectral radius `ρ∞`.
        spectral_radius: f64,
    },
    /// The midpoint rule, of order 2, so that energy and momentum are kept to the tolerance: nothing that is faster than the steps dies away. For rods
    /// without bodies and hinges, and turns of less than half a circle a step.
    Midpoint,
    /// A singly diagonally implicit Runge–Kutta method of order 4 with five stages, L-stable. Of order 2 for viscous rods, and where supports move.
    Sdirk4,
}

impl Integrator {
    /// Its name in scene files and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ImplicitEuler => "implicit_euler",
            Self::Bdf2 => "bdf2",
            Self::GeneralizedAlpha { .. } => "generalized_alpha",
            Self::Midpoint => "midpoint",
            Self::Sdirk4 => "sdirk4",
        }
    }
}

/// A diagonally implicit Runge–Kutta method whose last stage is the step.
pub(super) struct RungeKutta {
    /// What stands on the diagonal.
    pub diagonal: f64,
    /// What stands before it, row by row.
    pub before: &'static [&'static [f64]],
}

impl RungeKutta {
    /// When a stage is, as a part of the step.
    pub fn time(&self, stage: usize) -> f64 {
        self.before[stage].iter().sum::<f64>() + self.diagonal
    }

    /// The weight of a stage in the step.
    pub fn weight(&self, stage: usize) -> f64 {
        let last = self.before.len() - 1;
        if stage == last { self.diagonal } else { self.before[last][stage] }
    }
}

pub(super) const IMPLICIT_EULER: RungeKutta = RungeKutta { diagonal: 1.0, before: &[&[]] };

/// Stages at 1/4, 0, 7/10, 1 and 1 of the step: with these the conditions of order 4 leave one solution, whose entries are all small. In the
/// method of Hairer & Wanner (table IV.6.5) weights of nearly 8 cancel one another, and in a rod that vibrates faster than its steps what is left of them adds
/// energy.
pub(super) const SDIRK4: RungeKutta = RungeKutta {
    diagonal: 0.25,
    before: &[
        &[],
        &[-0.25],
        &[27.0 / 200.0, 63.0 / 200.0],
        &[-3.0 / 34.0, 249.0 / 476.0, 75.0 / 238.0],
        &[32.0 / 81.0, 1.0 / 14.0, 250.0 / 567.0, -17.0 / 108.0],
    ],
};

/// By how much the weights of the stages differ from those of the method of order 3 with the same stages (same place).
pub(super) const SDIRK4_ERROR: [f64; 5] = [-14.0 / 81.0, 1.0 / 12.0, 25.0 / 162.0, -17.0 / 54.0, 0.25];

#[cfg(test)]
mod tests {
    use super::{IMPLICIT_EULER, RungeKutta, SDIRK4, SDIRK4_ERROR};

    /// `Σ b c^k` is `1/(k + 1)`, and the two conditions with products of the matrix, up to order 4 (Hairer, Nørsett & Wanner, II.2).
    fn order(method: &RungeKutta) -> usize {
        let weights: Vec<f64> = (0..method.before.len()).map(|stage| method.weight(stage)).collect();
        order_with(method, &weights)
    }

    fn order_with(method: &RungeKutta, b: &[f64]) -> usize {
        let stages = method.before.len();
        let a = |i: usize, j: usize| match j.cmp(&i) {
            core::cmp::Ordering::Less => method.before[i][j],
            core::cmp::Ordering::Equal => method.diagonal,
            core::cmp::Ordering::Greater => 0.0,
        };
        let times = |x: &[f64]| -> Vec<f64> {
            (0..stages).map(|i| (0..stages).map(|j| a(i, j) * x[j]).sum()).collect()
        };
        let c = times(&vec![1.0; stages]);
        let product = |x: &[f64], y: &[f64]| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x * y).collect() };
        let sum = |x: &[f64]| -> f64 { product(b, x).iter().sum() };
        let (c2, ac) = (product(&c, &c), times(&c));
        let conditions: [&[(f64, f64)]; 4] = [
            &[(sum(&vec![1.0; stages]), 1.0)],
            &[(sum(&c), 0.5)],
            &[(sum(&c2), 1.0 / 3.0), (sum(&ac), 1.0 / 6.0)],
            &[
                (sum(&product(&c2, &c)), 0.25),
                (sum(&product(&c, &ac)), 0.125),
                (sum(&times(&c2)), 1.0 / 12.0),
                (sum(&times(&ac)), 1.0 / 24.0),
            ],
        ];
        let met = |of: &&&[(f64, f64)]| of.iter().all(|(got, wanted)| (got - wanted).abs() < 1e-14);
        conditions.iter().take_while(met).count()
    }

    #[test]
    fn methods_have_the_order_that_they_are_said_to_have() {
        assert_eq!(order(&IMPLICIT_EULER), 1);
        assert_eq!(order(&SDIRK4), 4);
        let within: Vec<f64> = (0..5).map(|stage| SDIRK4.weight(stage) - SDIRK4_ERROR[stage]).collect();
        assert_eq!(order_with(&SDIRK4, &within), 3);
    }
}
