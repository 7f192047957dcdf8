//! Integrators in time, as coefficients of one equation.
//!
//! All of them solve, once or several times a step, for frames at which momentum has changed by what acts there. With `q` the canonical coordinates of a
//! node's frame about that at the step's beginning, a rotation vector `θ` and a shift, and the momentum `Π` of the node about itself, a stage is
//!
//! ```text
//! q = Δ + a q̇,   Π = Π̂ + a W(q)
//! ```
//!
//! where `W` is all that acts on the node but inertia, and `Δ`, `Π̂` and `a` are known. Its angular velocity is `T(θ) θ̇` in its own axes. `q` and `Π` live
//! in vector spaces, so a method keeps the order that it has there (Munthe-Kaas 1998), and the sum of the linear parts of `Π` over all nodes changes by nothing
//! but what acts from outside.

/// How a step in time is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Backward Euler, of order 1: it takes energy out of all that is faster than a few steps.
    ImplicitEuler,
    /// Backward differences of order 2. The first step, and one after a step in pieces, is one of [`Integrator::TrBdf2`].
    Bdf2,
    /// The generalised-α method of order 2 for equations of the first order (Jansen, Whiting & Hulbert 2000), in canonical coordinates about each
    /// step's beginning. The first step, and one after a step in pieces, is one of [`Integrator::TrBdf2`].
    GeneralizedAlpha {
        /// What is left after a step of a motion that is much faster, from 0 to 1: the spectral radius `ρ∞`. Where rods that do not stretch turn fast, errors
        /// of their wrenches grow with one near 1 (with 0.8 at 0.03 rad a step, with 0.5 not at 0.05), and steps fail.
        spectral_radius: f64,
    },
    /// The midpoint rule, of order 2, so that energy and momentum are kept to the tolerance: nothing that is faster than the steps dies away. For rods
    /// without bodies and hinges, and turns of less than half a circle a step.
    Midpoint,
    /// A singly diagonally implicit Runge–Kutta method of order 4, L-stable, with an explicit stage and five implicit ones: ESDIRK4(3)6L\[2\]SA of Kennedy &
    /// Carpenter (2003). Of an order between 3 and 4 for viscous rods. Rods that do not stretch should hardly turn: where they do it is of order 2, and gains
    /// energy, which what is not damped keeps.
    Sdirk4,
    /// Half a step of the trapezoidal rule and of backward differences of order 2 through its ends, as a Runge–Kutta method (Hosea & Shampine 1996): of order 2,
    /// L-stable, and it looks back on no step before.
    TrBdf2,
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
            Self::TrBdf2 => "tr_bdf2",
        }
    }

    /// The method by which the error of its steps is known, where there is one.
    pub(super) fn embedding(self) -> Option<&'static RungeKutta> {
        match self {
            Self::Sdirk4 => Some(&SDIRK4),
            Self::TrBdf2 => Some(&TR_BDF2),
            _ => None,
        }
    }
}

/// Numbers of the generalised-α method: the `α_m` and `α_f` of Jansen, Whiting & Hulbert are one less these.
pub(super) struct GeneralizedAlpha {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub gamma: f64,
}

impl GeneralizedAlpha {
    /// With this spectral radius of what is fast.
    pub fn new(radius: f64) -> Self {
        let alpha_m = (3.0 * radius - 1.0) / (2.0 * (1.0 + radius));
        let alpha_f = radius / (1.0 + radius);
        Self { alpha_m, alpha_f, gamma: 0.5 - alpha_m + alpha_f }
    }
}

/// A diagonally implicit Runge–Kutta method whose last stage is the step.
pub(super) struct RungeKutta {
    /// Whether there is a stage at the step's beginning, with the rates that the last step ended with.
    pub explicit: bool,
    /// What stands on the diagonal of the other stages.
    pub diagonal: f64,
    /// What stands before it, row by row.
    pub before: &'static [&'static [f64]],
    /// By how much the weights of the stages differ from those of another method with the same stages; the order of what that makes of a step.
    pub error: &'static [f64],
    pub error_order: f64,
}

impl RungeKutta {
    /// When a stage is, as a part of the step.
    pub fn time(&self, stage: usize) -> f64 {
        self.before[stage].iter().sum::<f64>() + self.diagonal
    }

    /// What stands in the last row, which is the step: for each stage its weight.
    pub fn weights(&self) -> impl Iterator<Item = f64> {
        let last = self.before.last().copied().unwrap_or_default();
        last.iter().copied().chain([self.diagonal])
    }
}

pub(super) const IMPLICIT_EULER: RungeKutta =
    RungeKutta { explicit: false, diagonal: 1.0, before: &[&[]], error: &[], error_order: 0.0 };

/// The implicit part of ARK4(3)6L\[2\]SA (Kennedy & Carpenter 2003, appendix C), and its method of order 3. Its stages are of order 2, which the explicit
/// one is for: with stages of order 1 the wrenches of rods that do not stretch would have errors that no shorter step makes smaller (Hairer, Lubich & Roche 1989).
pub(super) const SDIRK4: RungeKutta = RungeKutta {
    explicit: true,
    diagonal: 0.25,
    before: &[
        &[0.25],
        &[8611.0 / 62500.0, -1743.0 / 31250.0],
        &[5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0],
        &[
            15267082809.0 / 155376265600.0,
            -71443401.0 / 120774400.0,
            730878875.0 / 902184768.0,
            2285395.0 / 8070912.0,
        ],
        &[82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0],
    ],
    error: &[
        82889.0 / 524892.0 - 4586570599.0 / 29645900160.0,
        0.0,
        15625.0 / 83664.0 - 178811875.0 / 945068544.0,
        69875.0 / 102672.0 - 814220225.0 / 1159782912.0,
        -2260.0 / 8211.0 + 3700637.0 / 11593932.0,
        0.25 - 61727.0 / 225920.0,
    ],
    error_order: 4.0,
};

/// Half the root of two.
const HALF_ROOT: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// The trapezoidal rule and backward differences with one slope matrix for both, and the method of order 3 with the same stages (Hosea & Shampine 1996).
pub(super) const TR_BDF2: RungeKutta = RungeKutta {
    explicit: true,
    diagonal: 1.0 - HALF_ROOT,
    before: &[&[1.0 - HALF_ROOT], &[0.5 * HALF_ROOT, 0.5 * HALF_ROOT]],
    error: &[
        0.5 * HALF_ROOT - (1.0 - 0.5 * HALF_ROOT) / 3.0,
        0.5 * HALF_ROOT - (1.0 + 1.5 * HALF_ROOT) / 3.0,
        (1.0 - HALF_ROOT) * (2.0 / 3.0),
    ],
    error_order: 3.0,
};

#[cfg(test)]
mod tests {
    use super::{IMPLICIT_EULER, RungeKutta, SDIRK4, TR_BDF2};
    use core::iter::{once, repeat_n};

    /// The method's matrix, row by row.
    fn matrix(method: &RungeKutta) -> Vec<Vec<f64>> {
        let stages = method.before.len() + usize::from(method.explicit);
        let full = |row: Vec<f64>| row.iter().copied().chain(repeat_n(0.0, stages - row.len())).collect();
        let explicit = method.explicit.then(|| vec![0.0; stages]);
        let implicit =
            method.before.iter().map(|row| full(row.iter().copied().chain(once(method.diagonal)).collect()));
        explicit.into_iter().chain(implicit).collect()
    }

    fn product(x: &[f64], y: &[f64]) -> Vec<f64> {
        x.iter().zip(y).map(|(x, y)| x * y).collect()
    }

    fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
        matrix.iter().map(|row| product(row, x).iter().sum()).collect()
    }

    /// `Σ b c^k` is `1/(k + 1)`, and the two conditions with products of the matrix, up to order 4 (Hairer, Nørsett & Wanner, II.2).
    fn order(method: &RungeKutta, b: &[f64]) -> usize {
        let a = matrix(method);
        let ones = vec![1.0; a.len()];
        let c = times(&a, &ones);
        let sum = |x: &[f64]| -> f64 { product(b, x).iter().sum() };
        let (c2, ac) = (product(&c, &c), times(&a, &c));
        let conditions: [&[(f64, f64)]; 4] = [
            &[(sum(&ones), 1.0)],
            &[(sum(&c), 0.5)],
            &[(sum(&c2), 1.0 / 3.0), (sum(&ac), 1.0 / 6.0)],
            &[
                (sum(&product(&c2, &c)), 0.25),
                (sum(&product(&c, &ac)), 0.125),
                (sum(&times(&a, &c2)), 1.0 / 12.0),
                (sum(&times(&a, &ac)), 1.0 / 24.0),
            ],
        ];
        let met = |of: &&&[(f64, f64)]| of.iter().all(|(got, wanted)| (got - wanted).abs() < 1e-14);
        conditions.iter().take_while(met).count()
    }

    #[test]
    fn methods_have_the_order_that_they_are_said_to_have() {
        let weights = |method: &RungeKutta| method.weights().collect::<Vec<_>>();
        assert_eq!(order(&IMPLICIT_EULER, &weights(&IMPLICIT_EULER)), 1);
        for (method, its, of_other) in [(&SDIRK4, 4, 3), (&TR_BDF2, 2, 3)] {
            assert_eq!(order(method, &weights(method)), its);
            let other: Vec<f64> = method.weights().zip(method.error).map(|(b, error)| b - error).collect();
            assert_eq!(order(method, &other), of_other);
            assert_eq!(method.error_order, f64::from(its.min(of_other) as u32 + 1));
            // Stages of order 2: `A c = c²/2`.
            let a = matrix(method);
            let c = times(&a, &vec![1.0; a.len()]);
            for (ac, c) in times(&a, &c).iter().zip(&c) {
                assert!((ac - 0.5 * c * c).abs() < 1e-15, "{ac} {c}");
            }
        }
    }
}
