//! How to solve and simulate, as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How to solve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SolverFile {
    /// The solver. Default "auto".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<MethodName>,
    /// The order of the discretisation: 1 (the paper's Euler scheme), 2 or 4. Default 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<usize>,
    /// The dimensionless residual at which a solution is accepted. Default 1e-9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// How many Newton iterations one search may take. Default 40.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<usize>,
    /// How the Jacobian is found. Default "variational_lanes".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jacobian: Option<JacobianName>,
    /// How an element's exponent is found. Default "element".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeName>,
}

/// Which solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MethodName {
    /// The one that fits.
    Auto,
    /// Two sweeps, for one end clamped and the wrench at the other given.
    Sweep,
    /// A search for what is unknown at the end.
    Shooting,
    /// The same at several places along the rod at once: for long and taut rods too, and for equilibria that are not stable.
    MultipleShooting,
    /// All frames at once, moving to where the rod rests. Finds stable equilibria only; needs order 2 or 4.
    Equilibrium,
}

/// How the Jacobian of the shooting residual is found. All give the same solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JacobianName {
    /// The linearised recurrence, one column after the other.
    Variational,
    /// The linearised recurrence, its columns side by side in SIMD lanes.
    VariationalLanes,
    /// Differences of perturbed marches.
    FiniteDifferences,
    /// Differences of perturbed marches side by side in SIMD lanes.
    FiniteDifferenceLanes,
}

/// How an element's exponent is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SchemeName {
    /// By its own local equation.
    Element,
    /// From the strains of the two neighbours already known.
    Multistep,
}

/// Wind, or a current: how the medium around moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct WindFile {
    /// Its velocity in world axes, m/s.
    pub velocity: [f64; 3],
}

/// How to simulate motion. It has no effect on a static solve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct DynamicsFile {
    /// The time integrator. Default "bdf2"; with `tolerance` "sdirk4", or "tr_bdf2" where a rod does not stretch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integrator: Option<IntegratorName>,
    /// What is left after a step of a motion that is much faster, from 0 to 1; with "generalized_alpha" only. Default 0.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectral_radius: Option<f64>,
    /// The time step, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_step: Option<f64>,
    /// The local error that the time step is chosen for, in place of `time_step`, with "sdirk4" or "tr_bdf2".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// A set number of Newton iterations for each stage of a step, for steps of bounded cost. Default: as many as the tolerance takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub newton_iterations: Option<usize>,
    /// How fast everything loses its momentum, 1/s. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_damping: Option<f64>,
    /// How long to simulate, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Frames a second in the output, 1/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_rate: Option<f64>,
    /// Where it starts from: "equilibrium"; "rest", the rest shapes; "initial", the rods' `initial` shapes, where they have one; or a saved state's file. Default
    /// "equilibrium".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
}

/// A time integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum IntegratorName {
    /// Backward differences of order two.
    Bdf2,
    /// Backward Euler.
    ImplicitEuler,
    /// Generalised-α.
    GeneralizedAlpha,
    /// The implicit midpoint rule.
    Midpoint,
    /// A singly diagonally implicit Runge–Kutta method of order four, L-stable; for rods that stretch.
    Sdirk4,
    /// The trapezoidal rule and backward differences of order two in one step, L-stable.
    TrBdf2,
}
